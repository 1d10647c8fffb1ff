"""The truth of photographs in trouble is where their boards are seen."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.detection.find_corners import find_corners
from tests.scenes.boards_in_trouble import BOARD_TROUBLES, photograph_in_trouble

BOARD = Board(7, 10, 26.0, Charuco("DICT_4X4_50", 0.75, False))


@pytest.mark.parametrize("trouble", BOARD_TROUBLES)
def test_the_truth_is_where_the_board_is_seen(trouble: str) -> None:
    shot = photograph_in_trouble(BOARD, 5, trouble)
    corners = find_corners(shot.image, BOARD.grid_size, pattern=BOARD.pattern)
    row, col = corners.grid.T
    assert shot.hidden is not None
    assert len(corners.uv) > 0.6 * np.count_nonzero(~shot.hidden)
    off = np.linalg.norm(corners.uv - shot.boards[0][row, col], axis=1)
    assert float(np.median(off)) < 0.2
