"""Boards in words."""

from __future__ import annotations

import numpy as np

from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.engine.boards import CHECKERBOARD, Board, Pattern, PuzzleBoard
from calibgui.engine.features import Corners
from calibgui.report.boards import describe_recognised_board


def show_part(first: tuple[int, int], size: tuple[int, int], pattern: Pattern) -> View:
    """A view of a part of a board, from a corner on."""
    grid = np.indices(size).reshape(2, -1).T + first
    uv = 20.0 * grid
    shape = first[0] + size[0], first[1] + size[1]
    return View("a.png", ViewStatus.FOUND, corners=Corners(shape, grid, uv, uv, pattern=pattern))


def test_of_a_puzzleboard_the_part_that_was_seen_is_named() -> None:
    pattern = PuzzleBoard()
    views = show_part((50, 101), (6, 10), pattern), show_part((52, 103), (5, 7), pattern)
    corner_set = CornerSet((640, 480), views, Board(57, 111, 20.0, pattern))
    words = describe_recognised_board(CHECKERBOARD, corner_set)
    assert words == (
        "The photographs show: PuzzleBoard, 7 x 10 inner corners of it: rows 50 to 56, columns 101 "
        "to 110 of the whole pattern."
    )
    assert describe_recognised_board(pattern, corner_set) == ""


def test_a_board_of_which_all_was_stated_is_not_described() -> None:
    view = show_part((0, 0), (4, 5), CHECKERBOARD)
    corner_set = CornerSet((640, 480), (view,), Board(4, 5, 20.0, CHECKERBOARD))
    assert describe_recognised_board(CHECKERBOARD, corner_set) == ""
