"""A result.json opens as a project that would make the same result again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import BEST_SETTINGS, Settings, get_own_model
from calibgui.app.projects.project import record_result
from calibgui.app.projects.result_project import make_project
from calibgui.dataset import CornerSet, Result
from calibgui.engine.boards import BoardShapeModel
from calibgui.engine.calibration import Cost
from calibgui.formats.result_json import write_result
from tests.app import examples

SETTINGS = [
    Settings(),
    Settings(fixed={"k3": 0.0, "cx": 97.5}),
    Settings(fixed={"p3": 1e-4}),
    Settings(freed=("p3",)),
    Settings(model="brown-conrady-4", fixed={"p1": 0.0, "p2": 0.0}),
    Settings(model="rational", robust=True),
    Settings(cost=Cost.REFERENCE, fixed={"fx": 200.0}),
    Settings(cost=Cost.PAPER),
    Settings(method="zhang", model=get_own_model("zhang")),
    Settings(method="bouguet", model="brown-conrady-4", freed=("skew",)),
    Settings(weigh_views=True),
    Settings(board_shape=BoardShapeModel.AFFINE),
]


def calibrate(folder: Path, settings: Settings) -> Result:
    views = examples.views(folder)
    board = examples.calibrated(folder).board
    return calibrate_views(CornerSet(examples.CAMERA.size, views, board), settings)


@pytest.mark.parametrize("settings", SETTINGS, ids=str)
def test_the_settings_of_a_result_come_with_it(tmp_path: Path, settings: Settings) -> None:
    result = calibrate(tmp_path, settings)
    write_result(result, tmp_path / "result.json")
    project = make_project(tmp_path / "result.json", "far")
    assert project.settings == settings
    assert project.settings_of_results == {"far": project.settings}
    opened = project.results["far"]
    assert project.is_current(opened)
    other = replace(project, settings=replace(project.settings, once=True))
    assert not other.is_current(opened)


def test_a_shape_that_was_held_is_held_again(tmp_path: Path) -> None:
    shape = calibrate(tmp_path, Settings(board_shape=BoardShapeModel.BOW)).calibration.board_shape
    result = calibrate(tmp_path, Settings(board_shape=shape))
    write_result(result, tmp_path / "result.json")
    project = make_project(tmp_path / "result.json", "far")
    assert project.is_current(project.results["far"])
    held = project.settings.board_shape
    assert shape is not None and held is not None and not isinstance(held, BoardShapeModel)
    np.testing.assert_allclose(held.deviation, shape.deviation)


@pytest.mark.slow
def test_a_lens_model_that_was_chosen_is_named(tmp_path: Path) -> None:
    """With it the same camera is found again, whatever another choice would be."""
    result = calibrate(tmp_path, BEST_SETTINGS)
    write_result(result, tmp_path / "result.json")
    project = make_project(tmp_path / "result.json", "far")
    assert project.settings.model == result.calibration.camera.model
    assert project.size is not None
    again = calibrate_views(CornerSet(project.size, project.views, project.board), project.settings)
    np.testing.assert_allclose(
        again.calibration.camera.params, result.calibration.camera.params, rtol=1e-9
    )
    assert again.calibration.fixed == result.calibration.fixed
    later = record_result(project, "again", project.views, again)
    assert later.is_current(again)
