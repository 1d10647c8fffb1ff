"""Corners whose squares overlap or part, for which there is no saddle point."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.features.saddle import refine_lattice
from tests.scenes.checkerboards import Scene, draw
from tests.scenes.conditions import Conditions

BOARD = (4, 5)


def scene(ink: float, square: float) -> Scene:
    return draw(Conditions(grid_size=BOARD, square=square, ink=ink, shift=20.0), 0)


@pytest.mark.parametrize("square", [30.0, 55.0])
@pytest.mark.parametrize("ink", [0.08, -0.08])
def test_boards_of_such_squares_are_found_whatever_their_size(ink: float, square: float) -> None:
    """In fine levels their corners are no crossings."""
    drawn = scene(ink, square)
    corners = find_corners(drawn.photograph(0))
    assert corners.complete
    assert sorted(corners.shape) == sorted(BOARD)
    distance, _ = scipy.spatial.cKDTree(drawn.uv.reshape(-1, 2)).query(corners.uv)
    assert distance.max() < 0.05


def test_noise_between_parted_squares_moves_no_corner() -> None:
    for ink, some in ((0.0, True), (0.02, True), (0.08, False), (-0.08, False)):
        drawn = scene(ink, 40.0)
        near = Lattice(drawn.uv.reshape(*BOARD, 2) + 0.5, dark=True)
        moved, at_saddle = refine_lattice(drawn.photograph(0), near)
        assert at_saddle.all() == at_saddle.any() == some
        assert np.array_equal(moved.uv, near.uv) != some
