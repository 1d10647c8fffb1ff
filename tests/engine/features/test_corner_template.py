"""Lattices of what is no crossing of edges are no boards."""

from __future__ import annotations

import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.engine.conftest import CAMERA, Scene


@pytest.mark.parametrize(
    ("pattern", "grid_size", "distance"),
    [
        (Circles(True, 1.0), (11, 4), 700.0),
        (Circles(True, 1.2), (11, 4), 300.0),
        (Circles(False, 0.8), (7, 9), 700.0),
    ],
)
def test_circles_are_no_squares(
    pattern: Circles, grid_size: tuple[int, int], distance: float
) -> None:
    """The dark and the bright between them alternate, with saddle points in a lattice."""
    image = Scene(Board(*grid_size, 16.0, pattern), CAMERA, (0.3, 0.2, 0.3), distance).image()
    for one, method in ((image, "edges"), (image, "saddle"), (255 - image, "edges")):
        with pytest.raises(NoBoardError):
            find_corners(one, method=method)


def test_markers_in_the_squares_do_no_harm() -> None:
    board = Board(5, 7, 30.0, Charuco("DICT_4X4_50", 0.5, legacy=False))
    corners = find_corners(Scene(board, distance=600.0).image())
    assert corners.complete
