"""A batch: every camera gets its row, what is done is not done again, and nothing else decides."""

from __future__ import annotations

import os
import random
import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pytest
from PIL import Image as Pillow

from calibgui.app.calibrating.redetection import calibrate_twice
from calibgui.app.calibrating.settings import Settings
from calibgui.app.fleet import camera_task, photographs
from calibgui.app.fleet.batch import BatchSummary
from calibgui.app.fleet.manifest import BoardSought, CameraTask, read_manifest
from calibgui.app.photographs.detection import find_views
from calibgui.app.photographs.paths import find_images
from calibgui.app.system.workers import Crashed, do_tasks_here
from calibgui.dataset import View
from calibgui.dataset.fleet import FleetStatus
from calibgui.dataset.limits import Limits
from calibgui.engine.assessment import (
    Grade,
    UncertainCamera,
    choose_covariance,
    measure_drift,
)
from calibgui.engine.images.reading import read_image, write_image
from calibgui.formats.result_json import read_result
from calibgui.report.fleet_overview import make_overview
from tests.app.fleet.conftest import BOARD, Here, read_results, read_rows, run
from tests.scenes.fleet import make_camera, write_camera

T = TypeVar("T")
R = TypeVar("R")


@pytest.fixture
def searched(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The photographs that are searched from now on."""
    images: list[str] = []
    search = camera_task.search_view

    def note(view: View, *args: Any) -> View:
        images.append(view.image)
        return search(view, *args)

    monkeypatch.setattr(camera_task, "search_view", note)
    return images


def copy_ledger(ledger: Path, folder: Path) -> Path:
    """Copy a ledger with its folders."""
    shutil.copytree(ledger.parent, folder, dirs_exist_ok=True)
    return folder / ledger.name


def test_cameras_are_calibrated_near_the_truth(calibrated: Path) -> None:
    rows = read_rows(calibrated)
    assert [row.id for row in rows] == ["c0", "c1", "c2", "c3"]
    for seed, row in enumerate(rows):
        found, truth = row.figures, make_camera(seed)
        assert row.passed
        assert row.photographs == 6
        assert row.cpu_seconds > 0
        assert found is not None
        assert found.size == truth.size
        assert found.board == "checkerboard 6x7 30mm"
        assert 200 < found.corners <= 6 * 42
        assert 0.3 < found.coverage <= 1
        assert found.error.edge < 0.5
        for name, value in zip(truth.names[:4], truth.params, strict=False):
            estimate = found.parameters[name]
            assert abs(estimate.value - value) < 5 * estimate.sigma


def test_a_row_says_what_result_json_says(calibrated: Path) -> None:
    for row in read_rows(calibrated):
        result = read_result(calibrated.parent / row.result)
        found = row.figures
        assert found is not None
        camera = result.calibration.camera
        assert [p.value for p in found.parameters.values()] == camera.params.tolist()
        sigma = [p.sigma for p in found.parameters.values()]
        assert sigma == result.calibration.sigma.tolist()
        assert (found.views, found.corners) == (
            len(result.used),
            sum(len(view.uv) for view in result.observations()),
        )


def test_it_is_the_calibration_of_the_command_line(
    tasks: Sequence[CameraTask], calibrated: Path
) -> None:
    """The same engine on the same corners: the fleet's way adds and leaves out nothing."""
    stored = read_result(calibrated.parent / "fleet.results" / "c0.json")
    with do_tasks_here():
        found = find_views(find_images(tasks[0].paths), (6, 7))
        again = calibrate_twice(found.corner_set(30.0), tasks[0].settings)
    np.testing.assert_array_equal(stored.calibration.camera.params, again.calibration.camera.params)


def test_a_second_run_does_nothing(
    tasks: Sequence[CameraTask], calibrated: Path, searched: list[str]
) -> None:
    before = read_rows(calibrated), read_results(calibrated)
    here = Here()
    assert run(tasks, calibrated, here) == BatchSummary(4, 0, ())
    assert (here.done, searched) == (0, [])
    assert (read_rows(calibrated), read_results(calibrated)) == before


def test_another_run_gives_the_same_bytes_in_any_order(
    tasks: Sequence[CameraTask], calibrated: Path, tmp_path: Path
) -> None:
    class Shuffled(Here):
        def run(self, task: Callable[[T], R], items: Sequence[T]) -> Iterator[tuple[int, R]]:
            done = list(super().run(task, items))
            random.Random(1).shuffle(done)
            yield from done

    ledger = tmp_path / "fleet.db"
    run(tasks, ledger, Shuffled())
    assert read_rows(ledger) == read_rows(calibrated)
    assert read_results(ledger) == read_results(calibrated)


def test_touched_photographs_are_read_but_not_searched(
    fleet: Path, tmp_path: Path, searched: list[str]
) -> None:
    shutil.copytree(fleet / "c0", tmp_path / "fleet" / "c0")
    tasks = read_manifest(tmp_path / "fleet", BOARD, Settings())
    ledger = tmp_path / "f.db"
    run(tasks, ledger, Here())
    (before,) = read_rows(ledger)
    os.utime(tmp_path / "fleet" / "c0" / "view1.png", (1, 1))
    searched.clear()
    here = Here()
    assert run(tasks, ledger, here).worked_on == 0
    (after,) = read_rows(ledger)
    assert (here.done, searched) == (1, [])
    assert after.state != before.state
    assert replace(after, state=before.state) == before
    assert after.cpu_seconds == before.cpu_seconds
    assert run(tasks, ledger, here) == BatchSummary(1, 0, ())
    assert here.done == 1


def test_only_what_changed_is_searched(fleet: Path, tmp_path: Path, searched: list[str]) -> None:
    for name in ("c0", "c1"):
        shutil.copytree(fleet / name, tmp_path / "fleet" / name)
    tasks = read_manifest(tmp_path / "fleet", BOARD, Settings())
    ledger = tmp_path / "f.db"
    run(tasks, ledger, Here())
    before = read_rows(ledger)
    changed = tmp_path / "fleet" / "c1" / "view3.png"
    write_image(changed, read_image(tmp_path / "fleet" / "c0" / "view3.png").pixels)
    searched.clear()
    assert run(tasks, ledger, Here()).worked_on == 1
    assert searched == [str(changed)]
    after = read_rows(ledger)
    assert after[0] == before[0]
    assert after[1].digest != before[1].digest
    # Other settings find the corners as they were.
    searched.clear()
    others = read_manifest(tmp_path / "fleet", BOARD, Settings(model="brown-conrady"))
    assert run(others, ledger, Here()).worked_on == 2
    assert not searched
    assert [r.figures.lens_model for r in read_rows(ledger) if r.figures] == ["brown-conrady"] * 2


def test_what_is_turned_anew_is_searched_again(
    fleet: Path, tmp_path: Path, searched: list[str]
) -> None:
    """Two photographs, then four more for which the camera was held the other way round."""
    folder = tmp_path / "fleet" / "c0"
    folder.mkdir(parents=True)
    ways = [1, 1, 3, 3, 3, 3]
    for k, (path, way) in enumerate(zip(sorted((fleet / "c0").iterdir()), ways, strict=True)):
        if k == 2:
            run(read_manifest(tmp_path / "fleet", BOARD, Settings()), tmp_path / "f.db", Here())
            assert len(searched) == 2
        exif = Pillow.Exif()
        exif[0x010F], exif[0x0112] = "Maker", way
        Pillow.open(path).save(folder / path.name, exif=exif)
    run(read_manifest(tmp_path / "fleet", BOARD, Settings()), tmp_path / "f.db", Here())
    assert len(searched) == 2 + 6
    (row,) = read_rows(tmp_path / "f.db")
    truth = make_camera(0)
    assert row.figures is not None
    cx = row.figures.parameters["cx"]
    assert abs(cx.value - (truth.size[0] - 1 - truth.params[2])) < 4 * cx.sigma < 4.0


def test_what_was_lost_beside_the_ledger_is_made_again(
    tasks: Sequence[CameraTask], calibrated: Path, tmp_path: Path
) -> None:
    ledger = copy_ledger(calibrated, tmp_path / "copy")
    (tmp_path / "copy" / "fleet.results" / "c2.json").unlink()
    (tmp_path / "copy" / "fleet.corners" / "c2.json").write_text("{")
    assert run(tasks, ledger, Here()).worked_on == 1
    assert read_results(ledger) == read_results(calibrated)


def test_what_the_manifest_says_of_a_camera_needs_no_work(
    tasks: Sequence[CameraTask], calibrated: Path, tmp_path: Path
) -> None:
    ledger = copy_ledger(calibrated, tmp_path / "copy")
    entry = replace(tasks[0].entry, serial="S", temperature=21.0)
    assert run([replace(tasks[0], entry=entry)], ledger, Here()).worked_on == 0
    assert read_rows(ledger)[0].entry == entry


def spoil(folder: Path, good: Path) -> dict[str, str]:
    """Write cameras that are bad in five ways; return a word of what is to be said of each."""
    names = ("no-board", "unreadable", "wrong-board", "copies", "empty")
    for name in names:
        shutil.copytree(good, folder / name)
    for file in (folder / "no-board").iterdir():
        write_image(file, np.full((240, 320), 128, np.uint8))
    for file in (folder / "unreadable").iterdir():
        file.write_bytes(file.read_bytes()[:100])
    for file in (folder / "copies").iterdir():
        shutil.copy(good / "view1.png", file)
    for file in (folder / "empty").iterdir():
        file.unlink()
    return {
        "no-board": "found in none of the images",
        "unreadable": "None of the files can be read",
        "wrong-board": "show a board of 6x7, not of 8x9",
        "copies": "not usable",
        "empty": "holds no images",
    }


def test_bad_cameras_are_named_and_stop_nobody(fleet: Path, tmp_path: Path) -> None:
    shutil.copytree(fleet / "c0", tmp_path / "fleet" / "good")
    expected = spoil(tmp_path / "fleet", fleet / "c1")
    tasks = [
        replace(task, board=BoardSought(30.0, (8, 9))) if task.entry.id == "wrong-board" else task
        for task in read_manifest(tmp_path / "fleet", BOARD, Settings())
    ]
    ledger = tmp_path / "f.db"
    summary = run(tasks, ledger, Here())
    rows = {row.id: row for row in read_rows(ledger)}
    assert rows["good"].passed
    assert summary.worked_on == len(tasks), "one without photographs was not done before either"
    assert {camera.id for camera in summary.failed} == expected.keys()
    for name, words in expected.items():
        assert words in rows[name].failures[0]
        assert rows[name].remedy or rows[name].status is FleetStatus.DONE
    copies = rows["copies"].figures
    assert copies is not None
    assert copies.grade is Grade.NOT_USABLE
    # All are done: only the camera without photographs is looked for again, by the driver.
    here = Here()
    assert run(tasks, ledger, here).worked_on == 0
    assert here.done == 0
    assert {row.id: row for row in read_rows(ledger)} == rows


def test_a_bug_costs_its_camera_only(
    tasks: Sequence[CameraTask], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError("of all things")

    ledger = tmp_path / "f.db"
    with monkeypatch.context() as patch:
        patch.setattr(camera_task, "calibrate_twice", fail)
        (failed,) = run(tasks[:1], ledger, Here()).failed
    assert "ZeroDivisionError: of all things" in failed.problem
    assert run(tasks[:1], ledger, Here()) == BatchSummary(1, 1, ())


def test_a_camera_whose_process_dies_is_tried_once_more(
    tasks: Sequence[CameraTask], calibrated: Path, tmp_path: Path
) -> None:
    class Deadly(Here):
        """Processes die at c1 once, and at c2 always."""

        deaths = 0

        def run(self, task: Callable[[T], Any], items: Sequence[T]) -> Iterator[tuple[int, Any]]:
            self.deaths += 1
            for k, result in super().run(task, items):
                dies = result.id == "c2" or (result.id == "c1" and self.deaths == 1)
                yield k, Crashed() if dies else result

    ledger = tmp_path / "fleet.db"
    (failed,) = run(tasks, ledger, Deadly()).failed
    assert failed.id == "c2"
    assert "died twice" in failed.problem
    assert run(tasks, ledger, Here()).worked_on == 1
    assert read_rows(ledger) == read_rows(calibrated)
    assert read_results(ledger) == read_results(calibrated)


def date(tasks: Sequence[CameraTask], *dates: str) -> list[CameraTask]:
    """Return tasks as those of one serial number at several dates."""
    return [
        replace(task, entry=replace(task.entry, serial="S", date=text))
        for task, text in zip(tasks, dates, strict=True)
    ]


def test_changes_are_against_the_last_date_of_a_serial_number(
    tasks: Sequence[CameraTask], calibrated: Path, tmp_path: Path
) -> None:
    ledger = copy_ledger(calibrated, tmp_path / "copy")
    dated = date(tasks, "2026-03-01", "2026-01-01", "", "2026-02-01")
    limits = Limits(largest_change_px=0.5)
    summary = run(dated, ledger, Here(), limits)
    rows = {row.id: row for row in read_rows(ledger)}
    against = {
        name: None if row.change is None else row.change.against for name, row in rows.items()
    }
    assert against == {"c0": "c3", "c1": None, "c2": None, "c3": "c1"}
    # They are different cameras, and what is stored is what the engine says of both results.
    assert [camera.id for camera in summary.failed] == ["c0", "c3"]
    results = [read_result(ledger.parent / rows[name].result) for name in ("c3", "c0")]
    drift = measure_drift(
        *(UncertainCamera(r.calibration.camera, choose_covariance(r.calibration)) for r in results)
    )
    change = rows["c0"].change
    assert change is not None
    assert (change.worst, change.probability) == (drift.difference.worst, drift.probability)
    assert "since c3" in summary.failed[0].failures[0]
    # Nothing is measured again, and a date that moves changes what it is compared with.
    here = Here()
    run(dated, ledger, here, limits)
    assert here.done == 0
    run(date(tasks, "2026-03-01", "2026-01-01", "", "2026-04-01"), ledger, here, limits)
    moved = {row.id: row.change.against for row in read_rows(ledger) if row.change is not None}
    assert moved == {"c0": "c1", "c3": "c0"}
    assert here.done == 2


def test_dates_that_the_manifest_does_not_give_are_those_of_exif(
    fleet: Path, tmp_path: Path, searched: list[str]
) -> None:
    taken = {"c0": "2026:03:01", "c1": "2025:12:31", "c2": "2026:02:01"}
    for name, day in taken.items():
        folder = tmp_path / name
        folder.mkdir()
        for hour, path in enumerate(sorted((fleet / name).iterdir())):
            exif = Pillow.Exif()
            if hour > 0:  # one has lost its EXIF, another is of another year
                year = "2020" if hour == 1 else day[:4]
                exif.get_ifd(0x8769)[0x9003] = f"{year}{day[4:]} {8 + hour:02}:30:00"
            Pillow.open(path).save(folder / f"{path.stem}.jpg", quality=98, exif=exif)
    manifest, ledger = tmp_path / "manifest.csv", tmp_path / "f.db"

    def run_on(*lines: str) -> BatchSummary:
        manifest.write_text("\n".join(["id,paths,serial,date", *lines]))
        return run(read_manifest(manifest, BOARD, Settings()), ledger, Here())

    undated = [f"{name},{name},S," for name in taken]
    assert run_on(*undated).worked_on == 3
    rows = read_rows(ledger)
    dates = ["2026-03-01T11:30:00", "2025-12-31T11:30:00", "2026-02-01T11:30:00"]
    assert [row.entry.date for row in rows] == dates
    against = [None if row.change is None else row.change.against for row in rows]
    assert against == ["c2", None, "c1"]
    (history,) = make_overview(rows).histories.values()
    assert [one.camera.id for one in history] == ["c1", "c2", "c0"]

    # The found dates stay where the driver knows that a camera is done, and where a worker does.
    searched.clear()
    assert run_on(*undated) == BatchSummary(3, 0, ())
    os.utime(tmp_path / "c1" / "view1.jpg", (1, 1))
    assert run_on(*undated).worked_on == 0
    assert not searched
    assert [replace(row, state="") for row in read_rows(ledger)] == [
        replace(row, state="") for row in rows
    ]

    # What the manifest says counts more, for as long as it says it.
    assert run_on(*undated[:2], "c2,c2,S,2024-01-01").worked_on == 0
    after = read_rows(ledger)
    assert [row.entry.date for row in after] == [*dates[:2], "2024-01-01"]
    assert after[2].change is None and after[1].change is not None
    assert run_on(*undated).worked_on == 0
    assert [row.change for row in read_rows(ledger)] == [row.change for row in rows]


def test_an_unchanged_camera_keeps_the_limit(tmp_path: Path) -> None:
    for number, name in enumerate(("before", "after")):
        write_camera(tmp_path / "fleet" / name, make_camera(7), 100 * number, count=5)
    tasks = read_manifest(tmp_path / "fleet", BOARD, Settings())
    dated = date(tasks, "2026-02-01", "2026-01-01")  # after, before
    summary = run(dated, tmp_path / "f.db", Here(), Limits(largest_change_px=0.2))
    assert not summary.failed
    changes = [row.change for row in read_rows(tmp_path / "f.db")]
    assert changes[1] is None
    assert changes[0] is not None
    assert changes[0].worst < 0.2
    assert changes[0].expected > 0


def test_photographs_may_be_where_fsspec_reaches(
    fleet: Path,
    tasks: Sequence[CameraTask],
    calibrated: Path,
    tmp_path: Path,
    searched: list[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fsspec = pytest.importorskip("fsspec", reason="fsspec is not installed")
    monkeypatch.setattr(photographs, "PROTOCOLS", (*photographs.PROTOCOLS, "memory"))
    memory = fsspec.filesystem("memory")
    memory.put(str(fleet / "c0"), "/bucket/", recursive=True)
    ledger = tmp_path / "f.db"
    far = replace(tasks[0], paths=("memory://bucket/c0",))
    try:
        run([far], ledger, Here())
        row = read_rows(ledger)[0]
        expected = read_rows(calibrated)[0]
        assert row.figures == expected.figures
        stored = read_result(ledger.parent / row.result)
        assert [view.image for view in stored.views] == [
            f"memory:///bucket/c0/view{k}.png" for k in range(1, 7)
        ]
        # No name of a temporary file is left.
        text = (ledger.parent / row.result).read_text() + str(row)
        assert not any(os.path.dirname(image) in text for image in searched)  # noqa: PTH120
        # A worker asks whether anything has changed, and does nothing if not.
        searched.clear()
        here = Here()
        assert run([far], ledger, here).worked_on == 0
        assert (here.done, searched) == (1, [])
        memory.pipe("/bucket/c0/view2.png", (fleet / "c1" / "view2.png").read_bytes())
        run([far], ledger, Here())
        assert len(searched) == 1
        (failed,) = run([replace(far, paths=("memory://bucket/none",))], ledger, Here()).failed
        assert "memory://bucket/none" in failed.problem
        (failed,) = run([replace(far, paths=("what://bucket",))], ledger, Here()).failed
        assert "what://bucket is of the protocol 'what'" in failed.problem
    finally:
        memory.rm("/bucket", recursive=True)


def test_two_drivers_on_one_ledger(
    tasks: Sequence[CameraTask], calibrated: Path, tmp_path: Path
) -> None:
    """One runs whenever the other has written a row; both do all, and the rows are whole."""
    ledger = tmp_path / "fleet.db"

    class Nested(Here):
        def run(self, task: Callable[[T], R], items: Sequence[T]) -> Iterator[tuple[int, R]]:
            for k, result in super().run(task, items):
                yield k, result
                if k == 1:
                    run(tasks[::-1], ledger, Here())

    run(tasks, ledger, Nested())
    assert read_rows(ledger) == read_rows(calibrated)
    assert read_results(ledger) == read_results(calibrated)
