from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import Settings
from calibgui.app.projects import project_file
from calibgui.app.projects.lengths import set_square_sigma
from calibgui.app.projects.project import (
    Project,
    add_result,
    hold_known,
    record_result,
    relocate_images,
    remove_result,
    rename_result,
)
from calibgui.app.projects.project_file import VERSION, encode_project, read_project, write_project
from calibgui.dataset import CornerSet, KnownCamera, judging
from calibgui.dataset.details import Details
from calibgui.dataset.judging import judge_result, keep_verdict
from calibgui.engine.arrays import Array
from calibgui.engine.assessment import Action, ActionKind, Cause, Finding, PixelError
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.errors import CalibrationError
from calibgui.formats.json_document import dumps
from calibgui.formats.node import Node
from tests.app import examples


def test_numbers_read_back_to_the_last_bit(tmp_path: Path) -> None:
    project = examples.calibrated(tmp_path)
    write_project(project, tmp_path / "project.json")
    again = read_project(tmp_path / "project.json")
    for before, after in zip(project.views, again.views, strict=True):
        assert (before.image, before.status) == (after.image, after.status)
        if before.corners is not None and after.corners is not None:
            np.testing.assert_array_equal(before.corners.uv, after.corners.uv)
            np.testing.assert_array_equal(before.corners.grid, after.corners.grid)
    for name, result in project.results.items():
        assert again.is_current(again.results[name])
        for field in ("sigma", "covariance", "pose_covariances"):
            np.testing.assert_array_equal(
                getattr(result.calibration, field), getattr(again.results[name].calibration, field)
            )
    assert (again.size, again.settings, again.board) == (
        project.size,
        project.settings,
        project.board,
    )
    assert again.digests == project.digests


def test_verdicts_are_read_and_not_found_out_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    project = examples.calibrated(tmp_path)
    result = project.results["k3 held"]
    actions = (
        Action(ActionKind.LEAVE_OUT_VIEWS, (1, 3)),
        Action(ActionKind.CHOOSE_LENS_MODEL, model="lucchese", parameters=("k3",)),
        None,
    )
    findings = tuple(
        Finding(Cause.BLUR, "Blurred.", "0.3 px", "Take it again.", 0.2, (2,), action, 1.7)
        for action in actions
    )
    stated = replace(judge_result(result), findings=findings)
    keep_verdict(result, stated)
    unknown = replace(project.results["Calibration 1"].calibration, warnings=())
    undetermined = replace(stated, error=PixelError(*[np.inf] * 6))
    project = record_result(project, "partial", project.views, replace(result, calibration=unknown))
    keep_verdict(project.results["partial"], undetermined)
    write_project(project, tmp_path / "project.json")
    monkeypatch.setattr(judging, "judge_calibration", lambda *_: pytest.fail("judged anew"))
    again = read_project(tmp_path / "project.json")
    assert judge_result(again.results["k3 held"]) == stated
    assert judge_result(again.results["partial"]) == undetermined


def test_folder_and_project_move_together(tmp_path: Path) -> None:
    before, after = tmp_path / "before", tmp_path / "after"
    before.mkdir()
    write_project(examples.calibrated(before), before / "project.json")
    assert "before" not in (before / "project.json").read_text(encoding="utf-8")
    shutil.move(before, after)
    project = read_project(after / "project.json")
    assert project.views[0].image == str(after / "0.png")
    assert project.results["k3 held"].views[0].image == str(after / "0.png")


def test_a_changed_view_makes_its_results_old(tmp_path: Path) -> None:
    project = examples.calibrated(tmp_path)
    first = replace(project.views[0], enabled=False)
    project = replace(project, views=(first, *project.views[1:]))
    write_project(project, tmp_path / "project.json")
    again = read_project(tmp_path / "project.json")
    assert not again.is_current(again.results["k3 held"])
    assert again.results["k3 held"].views[1] is again.views[1]
    assert again.results["k3 held"].views[0] is not again.views[0]


@pytest.mark.parametrize("covariance", [None, np.diag(np.arange(10.0))])
def test_a_camera_that_is_held_is_kept(tmp_path: Path, covariance: Array | None) -> None:
    known = KnownCamera(examples.CAMERA, "cam.yaml", "OpenCV YAML", covariance)
    file = tmp_path / "project.json"
    write_project(hold_known(Project(), known), file)
    kept = read_project(file).settings.known
    assert kept is not None
    assert (kept.file, kept.title, kept.camera.model) == ("cam.yaml", "OpenCV YAML", "lucchese")
    np.testing.assert_array_equal(kept.camera.params, known.camera.params)
    assert (kept.covariance is None) is (covariance is None)
    content = json.loads(file.read_text())
    for damage in ({"size": [0, 3]}, {"params": {}}, {"covariance": [[1]]}, {"model": "glass"}):
        broken = {**content, "settings": {**content["settings"]}}
        broken["settings"]["camera"] = {**content["settings"]["camera"], **damage}
        file.write_text(json.dumps(broken))
        with pytest.raises(CalibrationError, match=r"project\.json"):
            read_project(file)


@pytest.mark.parametrize("shape", [BoardShapeModel.FREE, None, "known"])
def test_results_know_their_settings(tmp_path: Path, shape: BoardShapeModel | str | None) -> None:
    known = BoardShape(
        BoardShapeModel.FREE, examples.BOARD.points()[:, :2], np.zeros((42, 3)), np.ones((42, 3))
    )
    chosen = known if isinstance(shape, str) and shape == "known" else shape
    project = examples.calibrated(tmp_path)
    before = project.settings
    result = project.results["k3 held"]
    after = replace(before, board_shape=chosen, fixed={"fx": 200.0})
    project = record_result(replace(project, settings=after), "new", result.views, result)
    project = rename_result(project, "new", "newer")
    write_project(project, tmp_path / "project.json")
    again = read_project(tmp_path / "project.json")
    newer = again.results["newer"]
    assert again.is_current(newer)
    other = replace(again, settings=before)
    assert not other.is_current(newer) and other.has_views_of(newer)
    assert other.is_current(other.results["k3 held"]), "of unknown settings"
    write_project(other, tmp_path / "project.json")
    later = read_project(tmp_path / "project.json")
    assert not later.is_current(later.results["newer"])
    assert not remove_result(later, "newer").settings_of_results


def test_relocated_images_keep_their_results_current(tmp_path: Path) -> None:
    project = examples.calibrated(tmp_path)
    old, new = project.views[0].image, str(tmp_path / "elsewhere" / "0.png")
    moved = relocate_images(project, {old: new})
    assert moved.views[0].image == new
    assert moved.is_current(moved.results["k3 held"])
    assert moved.digests == {new: "ab" * 32}


def broken(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "broken.json"
    path.write_text(text, encoding="utf-8")
    return path


def test_what_is_no_project_is_refused_by_name(tmp_path: Path) -> None:
    write_project(examples.calibrated(tmp_path), tmp_path / "project.json")
    text = (tmp_path / "project.json").read_text(encoding="utf-8")
    newer = json.dumps(json.loads(text) | {"version": 99})
    for content, says in (
        (text[: len(text) // 2], "cut short"),
        (newer, "version 99"),
        ('{"format": "something"}', "is not a project"),
        (text.replace('"square_mm": 30.0', '"square_mm": -1.0', 1), "a length above 0"),
        (
            text.replace('"model": "lucchese"', '"model": "none"', 1),
            "settings.model is not one of",
        ),
        (text.replace('"model": "lucchese"', '"model": "lucchese-pixels"', 1), "is not one of"),
        (
            text.replace('"model": "lucchese"', '"model": "brown-conrady"', 1).replace(
                '["k3"]', '["p3"]', 1
            ),
            "settings.fixed[0] is not one of fx",
        ),
        (text.replace('"method": "lucchese"', '"method": "none"', 1), "settings.method is not one"),
        (text.replace('"prior_mm": null', '"prior_mm": [0.1, 0]', 1), "two lengths above 0"),
        (text.replace('"plate": "nominal"', '"plate": "round"', 1), "one of nominal"),
        (text.replace('"status": "found"', '"status": "lost"', 1), "view 1 (0.png)"),
    ):
        with pytest.raises(CalibrationError, match=re.escape(says)) as error:
            read_project(broken(tmp_path, content))
        assert "broken.json" in error.value.message
        assert error.value.hint


_ODD_VALUES = (None, [], {}, 3.5, -1, 10**30, "x", [[]], True)
"""Values that some member of a file takes, and others must refuse."""


def list_members(value: Any, depth: int, place: tuple = ()) -> Iterator[tuple]:
    """Yield the places of all members down to a depth; of lists, those of the first entry."""
    members = value.items() if isinstance(value, dict) else enumerate(value[:1])
    for key, member in members:
        yield (*place, key)
        if depth > 1 and isinstance(member, dict | list):
            yield from list_members(member, depth - 1, (*place, key))


def spoil(text: str, place: tuple) -> Iterator[Any]:
    """Yield contents of a file that lack the member at a place, or have an odd one there."""
    for odd in (*_ODD_VALUES, KeyError):
        spoilt = json.loads(text)
        owner = spoilt
        for key in place[:-1]:
            owner = owner[key]
        owner[place[-1]] = odd
        if odd is KeyError:
            del owner[place[-1]]
        yield spoilt


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("version", [1, 2, 3, VERSION])
def test_a_file_with_any_member_lacking_or_odd_is_read_or_refused_by_name(
    tmp_path: Path, version: int
) -> None:
    project = examples.calibrated(tmp_path)
    few = CornerSet(project.size, project.views[:3], project.board)
    project = replace(project, views=project.views[:1], results={})
    if version == VERSION:
        project = add_result(project, "of three views", calibrate_views(few))
    content = {**json.loads(dumps(encode_project(project, tmp_path))), "version": version}
    for place in list_members(content, depth=3):
        for spoilt in spoil(json.dumps(content), place):
            try:
                again = read_project(broken(tmp_path, json.dumps(spoilt)))
            except CalibrationError as error:
                assert "broken.json" in error.message, place
            else:
                assert again.grid_size is None or max(again.grid_size) <= 200
                encode_project(again, tmp_path)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"results": []}, "results is not an object"),
        ({"version": 3, "settings": None}, "settings is not an object"),
        ({"target": {"rows": 0, "cols": 7}}, "target.rows is not a number from 2 to 200"),
        ({"target": {"rows": 6, "cols": 10**30}}, "target.cols is not an integer"),
    ],
)
def test_what_cannot_be_is_named(tmp_path: Path, change: dict, says: str) -> None:
    content = json.loads(dumps(encode_project(examples.calibrated(tmp_path), tmp_path)))
    for name, value in change.items():
        both = isinstance(value, dict)
        content[name] = {**content[name], **value} if both else value
    with pytest.raises(CalibrationError, match=re.escape(says)):
        read_project(broken(tmp_path, json.dumps(content)))


def test_one_image_cannot_be_two_views(tmp_path: Path) -> None:
    content = json.loads(dumps(encode_project(examples.calibrated(tmp_path), tmp_path)))
    first = content["views"][0]
    content["views"].append({**first, "image": f"sub/../{first['image']}"})
    with pytest.raises(CalibrationError, match=f"views 1 and {len(content['views'])} are both of"):
        read_project(broken(tmp_path, json.dumps(content)))


def test_a_version_may_be_written_with_a_point(tmp_path: Path) -> None:
    text = (Path(__file__).parents[2] / "golden" / "project-3.json").read_text(encoding="utf-8")
    old = text.replace('"version": 3', '"version": 3.0', 1)
    assert old != text
    assert read_project(broken(tmp_path, old)).settings.model == "lucchese"


def test_old_versions_are_brought_up_to_date_step_by_step(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_project(examples.calibrated(tmp_path), tmp_path / "project.json")
    old = json.loads((tmp_path / "project.json").read_text(encoding="utf-8"))
    old["board_mm"] = old["target"].pop("square_mm")

    def second(content: Node) -> dict:
        square = {"square_mm": content["board_mm"].value}
        return {"version": first + 1, "target": content["target"].value | square}

    def third(content: Node) -> dict:
        assert content["version"].value == first + 1
        return {"version": first + 2}

    first = project_file.VERSION
    monkeypatch.setattr(project_file, "VERSION", first + 2)
    monkeypatch.setattr(project_file, "_MIGRATIONS", {first: second, first + 1: third})
    assert read_project(broken(tmp_path, json.dumps(old))).square == 30.0


def test_the_board_as_known_is_kept(tmp_path: Path) -> None:
    board_shape = BoardShape(
        BoardShapeModel.BOW,
        examples.BOARD.points(np.array([[0, 0], [0, 1]])),
        np.full((2, 3), 0.1),
        np.zeros((2, 3)),
    )
    project = examples.calibrated(tmp_path)
    for settings in (
        Settings(board_shape=None, robust=True, weigh_views=True, once=True),
        Settings(fixed={"k3": None, "fx": 650.25}, freed=("p3",)),
        Settings(model="brown-conrady", fixed={"k3": 0.5}),
        Settings(model=None, fixed={"cx": None}),
        Settings(model="splined-stereographic-12x8-100", freed=("fx", "fy")),
        Settings(board_shape=BoardShapeModel.FREE, prior=BoardShapePrior(0.125, 0.3)),
        Settings(board_shape=board_shape),
    ):
        write_project(replace(project, settings=settings), tmp_path / "project.json")
        again = read_project(tmp_path / "project.json").settings
        if settings.board_shape is board_shape:
            assert isinstance(again.board_shape, BoardShape)
            np.testing.assert_array_equal(again.board_shape.deviation, board_shape.deviation)
            np.testing.assert_array_equal(again.board_shape.nominal, board_shape.nominal)
            again = replace(again, board_shape=board_shape)
        assert again == settings


def test_the_first_version_knew_a_nominal_plate_only(tmp_path: Path) -> None:
    write_project(examples.calibrated(tmp_path), tmp_path / "project.json")
    old = json.loads((tmp_path / "project.json").read_text(encoding="utf-8"))
    old["version"] = 1
    for name in ("plate", "prior_mm", "robust", "weigh_views", "once"):
        del old["settings"][name]
    del old["target"]["corners"]
    assert read_project(broken(tmp_path, json.dumps(old))).settings == Settings(fixed={"k3": None})


def test_a_project_of_the_version_before_the_lens_model_could_be_chosen(tmp_path: Path) -> None:
    """A file as version 3 wrote it, down to the order of its members."""
    shutil.copy(Path(__file__).parents[2] / "golden" / "project-3.json", tmp_path)
    project = read_project(tmp_path / "project-3.json")
    assert project.settings == Settings(fixed={"k3": None}, freed=("p3",), robust=True)
    assert (project.settings.model, project.settings.method) == ("lucchese", "lucchese")
    assert project.board == examples.BOARD and len(project.usable) == 6
    assert project.is_current(project.results["Forward model"])
    # The result calls its lens model by the name that it had then.
    forward = project.results["Forward model"].calibration
    assert forward.camera.model == forward.settings.model == "brown-conrady"


def test_images_on_another_drive_keep_their_whole_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_way(*_: object) -> str:
        raise ValueError("path is on mount 'D:', start on mount 'C:'")

    monkeypatch.setattr(project_file.os.path, "relpath", no_way)
    project = examples.calibrated(tmp_path)
    write_project(project, tmp_path / "project.json")
    assert read_project(tmp_path / "project.json").views[0].image == project.views[0].image


def test_that_boards_are_marked_by_hand_is_kept(tmp_path: Path) -> None:
    for by_hand in (True, False):
        project = replace(examples.calibrated(tmp_path), by_hand=by_hand)
        write_project(project, tmp_path / "project.json")
        assert read_project(tmp_path / "project.json").by_hand is by_hand


def test_lengths_are_confirmed_in_older_files_with_results_only(tmp_path: Path) -> None:
    project, file = examples.calibrated(tmp_path), tmp_path / "project.json"
    for stated in (False, True):
        write_project(replace(project, lengths_confirmed=stated), file)
        assert read_project(file).lengths_confirmed is stated
    content = json.loads(file.read_text(encoding="utf-8"))
    del content["lengths_confirmed"]
    file.write_text(json.dumps(content), encoding="utf-8")
    assert read_project(file).lengths_confirmed
    file.write_text(json.dumps(content | {"results": {}}), encoding="utf-8")
    assert not read_project(file).lengths_confirmed


def test_the_scale_of_the_board_is_kept(tmp_path: Path) -> None:
    project = set_square_sigma(examples.calibrated(tmp_path), 0.02)
    write_project(project, tmp_path / "project.json")
    again = read_project(tmp_path / "project.json")
    assert again.square_sigma == 0.02 and again.board == project.board
    assert all(again.is_current(result) for result in again.results.values())
    content = encode_project(project, tmp_path)
    content["target"]["square_sigma_mm"] = 40.0
    (tmp_path / "project.json").write_text(dumps(content))
    with pytest.raises(CalibrationError, match=r"target\.square_sigma_mm"):
        read_project(tmp_path / "project.json")


def test_what_is_stated_for_a_report_is_kept(tmp_path: Path) -> None:
    project = replace(examples.calibrated(tmp_path), details=Details(operator="Zoë", lens="16 mm"))
    write_project(project, tmp_path / "project.json")
    assert read_project(tmp_path / "project.json").details == project.details
