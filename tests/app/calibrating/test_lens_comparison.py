"""What the comparison of lens models is asked: which views, and calibrated how."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from calibgui.app.calibrating import lens_comparison
from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.lens_comparison import compare_lenses, compare_lenses_again
from calibgui.app.calibrating.settings import Settings
from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.result import Cost
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import VGA, barrel, scene


@pytest.fixture(scope="module")
def corner_set() -> CornerSet:
    views = scene(barrel(), 6, seed=1).noisy(0.1, np.random.default_rng(2))
    found = [View(f"{k}.png", ViewStatus.FOUND, points=view) for k, view in enumerate(views)]
    return CornerSet(VGA, tuple(found))


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What the engine was asked last: views, size and settings."""
    noted: list[Any] = []

    def note(views: Any, size: Any, **settings: Any) -> None:
        noted[:] = [views, size, settings]

    monkeypatch.setattr(lens_comparison, "choose_lens", note)
    return noted


def test_copies_and_unusable_views_are_left_out(corner_set: CornerSet, asked: list[Any]) -> None:
    blank = View("blank.png", ViewStatus.NO_BOARD, "No checkerboard was found.")
    copy = replace(corner_set.views[2], image="copy.png")
    compare_lenses(replace(corner_set, views=(blank, *corner_set.views, copy)))
    assert len(asked[0]) == 6 and asked[1] == VGA
    assert asked[2]["names"] == [f"{k}.png" for k in range(6)]


def test_a_result_is_compared_as_it_was_calibrated(corner_set: CornerSet, asked: list[Any]) -> None:
    for settings, fix, cost, shape in (
        (Settings(), {}, Cost.IMAGE, BoardShapeModel.NOMINAL),
        (Settings(Cost.PAPER), {}, Cost.IMAGE, BoardShapeModel.NOMINAL),
        (Settings(Cost.REFERENCE), {}, Cost.REFERENCE, BoardShapeModel.NOMINAL),
        (
            Settings(fixed={"cx": 301.0, "k2": None}, board_shape=BoardShapeModel.AFFINE),
            {"cx": 301.0},
            Cost.IMAGE,
            BoardShapeModel.AFFINE,
        ),
    ):
        result = calibrate_views(corner_set, settings)
        compare_lenses_again(result)
        views, size, arguments = asked
        assert (len(views), size) == (6, VGA)
        assert arguments["fix"] == fix
        assert (arguments["cost"], arguments["board_shape"]) == (cost, shape)
        assert not arguments.keys() & {"model", "free"}


def test_what_a_lens_model_holds_by_itself_is_not_held_for_others(
    corner_set: CornerSet, asked: list[Any]
) -> None:
    result = calibrate_views(corner_set, Settings(model="splined-stereographic-8x6-80"))
    assert set(result.calibration.fixed) == {"fx", "fy", "cx", "cy"}
    compare_lenses_again(result)
    assert asked[2]["fix"] == {}


def test_few_views_are_refused(corner_set: CornerSet) -> None:
    with pytest.raises(CalibrationError, match="too few to compare"):
        compare_lenses(replace(corner_set, views=corner_set.views[:2]))
