"""Board shapes that the views cannot carry are refused, and the reason is named."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import DegenerateError
from calibgui.engine.errors import CalibrationError
from tests.engine.degenerate_scenes import LONG, in_one_spot, parallel
from tests.engine.scenes import BOARD, Scene, scene


def refusal(
    views: list[Observation], made: Scene, board_shape: BoardShapeModel = BoardShapeModel.FREE
) -> str:
    with pytest.raises(CalibrationError) as caught:
        calibrate(views, made.size, board_shape=board_shape)
    assert caught.value.hint
    return str(caught.value)


def drawn(made: Scene, noise: float = 0.1) -> list[Observation]:
    return made.noisy(noise, np.random.default_rng(5))


@pytest.mark.parametrize(("board_shape", "few"), [("affine", 2), ("bow", 2), ("free", 5)])
def test_few_views(board_shape: BoardShapeModel, few: int) -> None:
    made = scene(LONG, few)
    assert "cannot carry the board shape" in refusal(drawn(made), made, board_shape)


def test_three_views_let_an_affine_board_stand_in_for_the_camera() -> None:
    made = scene(LONG, 3)
    message = refusal(drawn(made), made, BoardShapeModel.AFFINE)
    assert "board shape 'affine' these views leave cx undetermined" in message


@pytest.mark.parametrize("tilt", [0.0, 30.0])
def test_parallel_views(tilt: float) -> None:
    made = parallel(LONG, tilt)
    with pytest.raises(DegenerateError, match="The board's shape is not estimated") as caught:
        calibrate(drawn(made), made.size, board_shape=BoardShapeModel.FREE)
    assert caught.value.partial is not None
    assert caught.value.partial.board_shape is None


@pytest.mark.parametrize("noise", [0.05, 0.4])
def test_all_corners_in_one_spot(noise: float) -> None:
    """The refusal depends on whether the nominal board would still determine the camera."""
    made = in_one_spot(LONG)
    message = refusal(drawn(made, noise), made)
    assert ("All corners lie in one spot" if noise > 0.1 else "look alike") in message


def halves(made: Scene, shared: int) -> list[Observation]:
    """Left and right parts of the board in turn, with some columns in common."""
    views = []
    for k, view in enumerate(drawn(made)):
        column = np.round(view.xy[:, 0] / BOARD.square)
        kept = column < 6 + shared if k % 2 == 0 else column >= 6 - shared
        views.append(Observation(view.uv[kept], view.xy[kept]))
    return views


def test_parts_without_overlap() -> None:
    """The halves' places on the board are then anybody's guess."""
    made = scene(LONG, 16)
    assert "do not determine the board's shape" in refusal(halves(made, 0), made)
    found = calibrate(halves(made, 1), made.size, board_shape=BoardShapeModel.FREE)
    assert found.board_shape is not None
