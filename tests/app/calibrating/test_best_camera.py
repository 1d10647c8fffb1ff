"""The best camera in one go: what is carried out, what is kept, and what is said."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.app.calibrating.best_camera import calibrate_best
from calibgui.app.calibrating.settings import BEST_SETTINGS, DEFAULT_SETTINGS, Settings
from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.dataset.judging import judge_result
from calibgui.engine.assessment import Grade
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.observations import Observation
from tests.engine.scenes import BOARD, VGA, barrel, looking, scene
from tests.faults.sets import project_corners


def make_set(views: list[Observation]) -> CornerSet:
    found = [View(f"{k}.png", ViewStatus.FOUND, points=view) for k, view in enumerate(views)]
    return CornerSet(VGA, tuple(found))


@pytest.fixture(scope="module")
def bowed() -> CornerSet:
    """Twelve views of a board that is bowed by 0.6 mm."""
    xy, rng = BOARD.points(), np.random.default_rng(5)
    x = 2 * (xy[:, 0] - xy[:, 0].mean()) / np.ptp(xy[:, 0])
    board = np.column_stack([xy, 0.6 * (1 - x * x)])
    uv = [project_corners(barrel(), looking(barrel(), rng), board) for _ in range(12)]
    return make_set([Observation(each + rng.normal(0, 0.05, each.shape), xy) for each in uv])


def test_a_bowed_board_is_estimated_and_said(bowed: CornerSet) -> None:
    first, best = calibrate_best(bowed, BEST_SETTINGS, search=False)
    assert first.said == "" and first.result.calibration.board_shape is None
    assert best.result.calibration.board_shape is not None
    assert best.said in best.result.improvements
    assert "Your board is not flat (0." in best.said
    assert "its shape was estimated; errors" in best.said and "times smaller." in best.said
    before, after = (judge_result(step.result).error.covered for step in (first, best))
    assert f"errors {before / after:.1f} times" in best.said
    errors = [
        abs(step.result.calibration.camera.params[0] - barrel().params[0]) for step in (first, best)
    ]
    assert errors[1] < 0.5 * errors[0]


@pytest.mark.parametrize("seed", range(2))
def test_a_laser_print_on_foam_board_gives_a_good_camera(seed: int) -> None:
    """15 photographs of a print that is stretched by 0.2 %, uneven by 0.03 mm and bowed."""
    rng, xy = np.random.default_rng(seed), BOARD.points()
    x, y = (2 * (each - each.mean()) / np.ptp(each) for each in xy.T)
    height = 0.2 * (x * x * rng.normal() + x * y * rng.normal() + y * y * rng.normal())
    print_ = xy * [1.0, 1 + 2e-3 * rng.normal()] + rng.normal(0, 0.03, xy.shape)
    board = np.column_stack([print_, height])
    views = []
    for _ in range(15):
        uv = project_corners(barrel(), looking(barrel(), rng), board)
        uv += rng.normal(0, 0.06, uv.shape)
        inside = ((uv >= 0) & (uv <= [639, 479])).all(axis=1)
        views.append(Observation(uv[inside], xy[inside]))
    *_, last = calibrate_best(make_set(views), BEST_SETTINGS, search=False)
    best = last.result
    assert judge_result(best).grade is Grade.GOOD


@pytest.mark.parametrize(
    "settings",
    [
        DEFAULT_SETTINGS,
        replace(BEST_SETTINGS, board_shape=BoardShapeModel.NOMINAL),
        replace(BEST_SETTINGS, improve=False, board_shape=BoardShapeModel.NOMINAL),
    ],
)
def test_what_is_stated_is_kept(bowed: CornerSet, settings: Settings) -> None:
    (only,) = calibrate_best(bowed, settings, search=False)
    assert only.result.calibration.board_shape is None


def test_nothing_is_carried_out_where_nothing_is_wrong() -> None:
    views = scene(barrel(), 12, seed=3).noisy(0.1, np.random.default_rng(1))
    (only,) = calibrate_best(make_set(views), BEST_SETTINGS, search=False)
    assert only.result.improvements == ()
    assert only.result.calibration.camera.model == "lucchese"


def test_misplaced_corners_are_left_out() -> None:
    views = scene(barrel(), 12, seed=3).noisy(0.1, np.random.default_rng(1))
    spoilt = np.array(views[4].uv)
    spoilt[:8] += 6.0
    views[4] = views[4]._replace(uv=spoilt)
    *_, best = calibrate_best(make_set(views), BEST_SETTINGS, search=False)
    assert "left out; errors" in best.said
    kept = sum(len(view.image) for view in best.result.calibration.residuals)
    assert kept == sum(len(view.uv) for view in views) - 8
