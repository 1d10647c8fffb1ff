"""Targets, and views with their regions."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.dataset import View, ViewStatus
from calibgui.engine.boards.board import Board
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features.corners import Corners


@pytest.mark.parametrize(
    ("rows", "cols", "square"),
    [(0, 8, 25.0), (6, -1, 25.0), (6, 8, 0.0), (6, 8, float("nan")), (6, 8, float("inf"))],
)
def test_what_makes_no_board_is_named(rows: int, cols: int, square: float) -> None:
    with pytest.raises(CalibrationError, match="no board"):
        Board(rows, cols, square)


def test_a_views_region_is_its_own() -> None:
    roi = np.zeros((4, 2))
    view = View("a.png", roi=roi)
    roi[0] = 1.0
    assert view.roi is not None
    assert not view.roi.any()


@pytest.mark.parametrize(
    ("grid", "usable"),
    [
        ([(2, 3)], False),
        ([(0, 0), (0, 1), (1, 0)], False),
        ([(1, 0), (1, 1), (1, 2), (1, 3), (1, 4)], False),
        ([(0, 0), (0, 1), (0, 2), (0, 3), (1, 0)], False),
        ([(0, 0), (1, 1), (2, 2), (3, 3), (0, 1)], False),
        ([(0, 0), (0, 1), (1, 0), (1, 1)], True),
        ([(0, 0), (0, 1), (0, 2), (1, 4), (3, 4)], True),
        (np.argwhere(np.ones((4, 5))), True),
    ],
)
def test_corners_that_tell_no_pose_are_kept_out_of_calibrations(
    grid: list[tuple[int, int]], usable: bool
) -> None:
    cells = np.array(grid)
    corners = Corners((4, 5), cells, 10.0 * cells, 10.0 * cells)
    view = View("a.png", ViewStatus.FOUND, corners=corners)
    assert view.usable is usable
    assert ("do not tell where the board is" in view.why_unused) is not usable
