"""Parts of boards are found whole, and nothing that is not there."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.detection.find_corners import find_corners
from tests.benchmarks.corner_partial import KINDS, Count, compare, count, scenes


@pytest.mark.slow
def test_visible_corners_are_found_in_their_places() -> None:
    drawn = [scene for kind in KINDS for scene in scenes(kind, 2)]
    for known in (True, False):
        total = sum((count(scene, known) for scene in drawn), Count())
        assert total.visible > 500
        assert total.found >= 0.98 * total.visible
        assert total.wrong == 0


@pytest.mark.parametrize(("kind", "seed"), [("hand", 9), ("hand, off 1 side", 5)])
def test_where_a_finger_crosses_an_edge_is_no_corner(kind: str, seed: int) -> None:
    """It looked like one, a quarter of a square from where the corner is covered."""
    scene = scenes(kind, seed + 1)[seed]
    assert count(scene, known=True).wrong == 0


def test_a_line_that_leaves_the_image_is_kept() -> None:
    """Its places outside of the image counted as missing, and its corners as beyond the board."""
    scene = scenes("off 3 sides", 5)[4]
    found = count(scene, known=True)
    assert found.found == found.visible > 0


def test_the_count_sees_displaced_and_misplaced_corners() -> None:
    (scene,) = scenes("off 1 side", 1)
    corners = find_corners(scene.photograph(0), scene.conditions.grid_size)
    right, place = compare(corners, scene, known=True)
    assert right.all()
    assert np.array_equal(place, corners.grid)
    corners.uv.flags.writeable = corners.grid.flags.writeable = True
    corners.uv[3] += 6.0
    corners.grid[5] += 1
    right, _ = compare(corners, scene, known=True)
    assert np.flatnonzero(~right).tolist() == [3, 5]
