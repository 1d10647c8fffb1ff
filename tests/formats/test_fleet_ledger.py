"""The ledger of a fleet: what is written is read, whoever else writes or is killed meanwhile."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing
from dataclasses import fields, replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibgui.dataset.fleet import (
    Change,
    Estimate,
    FleetCamera,
    FleetEntry,
    FleetFigures,
    FleetStatus,
)
from calibgui.engine.assessment import Grade, PixelError
from calibgui.engine.errors import CalibrationError
from calibgui.formats.fleet_ledger import COLUMNS, VERSION, Ledger, open_ledger

FIGURES = FleetFigures(
    size=(640, 480),
    board="checkerboard 6x7, 30 mm",
    lens_model="lucchese",
    views=11,
    corners=460,
    rms=0.081,
    noise=0.055,
    coverage=0.75,
    grade=Grade.USABLE,
    reason="Nothing is wrong, but the image's edge is known less well.",
    times_better=1.2,
    error=PixelError(0.01, 0.2, float("inf"), 0.1, 0.05, 0.3),
    parameters={"fx": Estimate(650.25, 0.5), "k3": Estimate(0.0, 0.0)},
)
DONE = FleetCamera(
    FleetEntry("line 2/0815", "S-17", "2026-03-01", 21.5),
    FleetStatus.DONE,
    photographs=12,
    exif_date="2026-03-01T08:30:00",
    figures=FIGURES,
    change=Change("line 2/0404", "ab" * 32, 0.1, 0.3, 0.05, 0.001),
    failures=("The edge is known to 0.2 px, beyond the limit of 0.1 px.",),
    digest="cd" * 32,
    state="ef" * 32,
    versions={"calibgui": "0.1.0"},
    result="fleet.results/line 2%2F0815.json",
    cpu_seconds=1.5,
)
REFUSED = FleetCamera(
    FleetEntry("a"),
    FleetStatus.REFUSED,
    "The board was found in none of the images.",
    "Photograph the whole board.",
    failures=("The board was found in none of the images.",),
)


@pytest.fixture(scope="module")
def ledger(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Ledger]:
    with open_ledger(tmp_path_factory.mktemp("any") / "fleet.db", create=True) as ledger:
        yield ledger


def test_what_is_written_is_read(tmp_path: Path) -> None:
    with open_ledger(tmp_path / "fleet.db", create=True) as ledger:
        ledger.write([DONE, REFUSED])
    with open_ledger(tmp_path / "fleet.db") as ledger:
        assert list(ledger.read()) == [REFUSED, DONE]
        found = ledger.find(DONE.id)
        assert found == DONE and found is not None
        assert found.cpu_seconds == DONE.cpu_seconds and not found.passed
        assert ledger.find("b") is None
        assert ledger.locate_result(DONE) == tmp_path / DONE.result
        assert ledger.locate_result(REFUSED) is None


def test_every_field_has_its_columns() -> None:
    flat = {"entry", "figures", "change", "failures", "size", "error", "versions"}
    names = {
        field.name
        for kind in (FleetCamera, FleetEntry, FleetFigures, Change)
        for field in fields(kind)
    } - flat
    stems = {column.removesuffix("_px").removesuffix("_c") for column in COLUMNS}
    known = stems | {column.removeprefix("change_") for column in stems}
    assert names <= known


@given(
    st.text(st.characters(exclude_categories=["Cs"])),
    st.floats(allow_nan=False),
    st.dictionaries(st.text(max_size=5), st.floats(-1e300, 1e300)),
)
def test_any_text_and_number_is_kept(
    ledger: Ledger, text: str, number: float, values: dict[str, float]
) -> None:
    parameters = {name: Estimate(value, 0.5) for name, value in values.items()}
    camera = replace(
        DONE,
        entry=FleetEntry(text, text, text, number),
        figures=replace(FIGURES, rms=number, parameters=parameters, reason=text),
        failures=(text, text),
    )
    ledger.write([camera])
    assert ledger.find(text) == camera


def test_unknown_numbers_are_null(tmp_path: Path) -> None:
    nan = float("nan")
    figures = replace(FIGURES, noise=nan, parameters={"fx": Estimate(650.0, nan)})
    with open_ledger(tmp_path / "fleet.db", create=True) as ledger:
        ledger.write([replace(DONE, figures=figures)])
        (found,) = ledger.read()
    assert found.figures is not None
    assert found.figures.noise != found.figures.noise  # NaN
    assert found.figures.parameters["fx"].sigma != found.figures.parameters["fx"].sigma
    with closing(sqlite3.connect(tmp_path / "fleet.db")) as connection:
        query = "SELECT noise_px, json_extract(parameters, '$.fx[1]'), passed FROM cameras"
        assert connection.execute(query).fetchone() == (None, None, 0)


def test_a_name_that_is_not_unicode_is_escaped(tmp_path: Path) -> None:
    with open_ledger(tmp_path / "fleet.db", create=True) as ledger:
        ledger.write([replace(REFUSED, problem="\udcff.png cannot be read.")])
        (found,) = ledger.read()
    assert found.problem == "\\udcff.png cannot be read."


def test_a_row_takes_the_place_of_its_like(tmp_path: Path) -> None:
    with open_ledger(tmp_path / "fleet.db", create=True) as ledger:
        ledger.write([DONE])
        refused = replace(REFUSED, entry=DONE.entry)
        ledger.write([refused])
        assert list(ledger.read()) == [refused]


def test_a_serial_number_is_read_in_the_order_of_dates(tmp_path: Path) -> None:
    entries = [("c", "S", "2026-02-01"), ("b", "S", "2025-12-31"), ("a", "T", "2026-01-01")]
    cameras = [replace(DONE, entry=FleetEntry(*entry)) for entry in entries]
    with open_ledger(tmp_path / "fleet.db", create=True) as ledger:
        ledger.write(cameras)
        assert [camera.id for camera in ledger.read_serial("S")] == ["b", "c"]


def test_other_files_are_refused_by_name(tmp_path: Path) -> None:
    text, other, newer = (tmp_path / name for name in ("notes.txt", "other.db", "newer.db"))
    text.write_text("not a database, but long enough to have a header" * 10)
    with closing(sqlite3.connect(other)) as connection:
        connection.execute("CREATE TABLE cameras (id TEXT)")
    (empty := tmp_path / "empty.db").touch()
    with open_ledger(newer, create=True) as ledger:
        ledger.write([DONE])
    with closing(sqlite3.connect(newer)) as connection:
        connection.execute(f"PRAGMA user_version = {VERSION + 1}")
    before = [path.read_bytes() for path in (text, other, newer)]
    for path, reason in (
        (text, "not the ledger"),
        (other, "not the ledger"),
        (empty, "empty.db is not the ledger"),
        (newer, f"version {VERSION + 1}.*knows version {VERSION}"),
        (tmp_path / "none.db", "There is no ledger"),
    ):
        with pytest.raises(CalibrationError, match=reason) as caught, open_ledger(path):
            pass
        assert path.name in caught.value.message
        assert caught.value.hint
        if path.exists() and path != empty:
            with pytest.raises(CalibrationError), open_ledger(path, create=True):
                pass
    assert [path.read_bytes() for path in (text, other, newer)] == before


def test_a_missing_folder_is_named(tmp_path: Path) -> None:
    path = tmp_path / "none" / "fleet.db"
    with pytest.raises(CalibrationError, match=r"none.fleet\.db"), open_ledger(path, create=True):
        pass


def test_two_programs_write_to_one_ledger(tmp_path: Path) -> None:
    path = tmp_path / "fleet.db"
    context = multiprocessing.get_context("spawn")
    writers = [context.Process(target=write_many, args=(path, name, 100)) for name in "ab"]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join()
    assert [writer.exitcode for writer in writers] == [0, 0]
    with open_ledger(path) as ledger:
        found = [camera.id for camera in ledger.read()]
    assert found == [f"{name}{k:03}" for name in "ab" for k in range(100)]


def test_a_killed_program_leaves_whole_rows(tmp_path: Path) -> None:
    path = tmp_path / "fleet.db"
    writer = multiprocessing.get_context("spawn").Process(
        target=write_many, args=(path, "a", 100_000)
    )
    writer.start()
    assert writer.pid is not None
    while not path.exists() or count_rows(path) < 20:
        time.sleep(0.01)
    os.kill(writer.pid, signal.SIGKILL)
    writer.join()
    with open_ledger(path, create=True) as ledger:
        found = list(ledger.read())
        assert [camera.id for camera in found] == [f"a{k:03}" for k in range(len(found))]
        assert all(replace(camera, entry=DONE.entry) == DONE for camera in found)
        ledger.write([DONE])
    with closing(sqlite3.connect(path)) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def write_many(path: Path, name: str, count: int) -> None:
    """Write rows one by one, as a driver does."""
    with open_ledger(path, create=True) as ledger:
        for k in range(count):
            ledger.write([replace(DONE, entry=FleetEntry(f"{name}{k:03}"))])


def count_rows(path: Path) -> int:
    try:
        with open_ledger(path) as ledger:
            return sum(1 for _ in ledger.read())
    except CalibrationError:  # it is being made
        return 0
