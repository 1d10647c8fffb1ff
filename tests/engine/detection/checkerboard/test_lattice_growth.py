"""Points looked up by their place, from which a lattice grows."""

from __future__ import annotations

import numpy as np

from calibgui.engine.detection.checkerboard.lattice_growth import PointIndex
from calibgui.engine.detection.checkerboard.thresholds import THRESHOLDS
from calibgui.engine.detection.lattice import Lattice

IMAGE = np.zeros((100, 100), np.uint8)


def test_positions_are_paired_with_the_nearest_points_that_are_near_enough() -> None:
    rng = np.random.default_rng(0)
    points, uv = rng.uniform(0, 100, (300, 2)), rng.uniform(-10, 110, (50, 2))
    position, index = PointIndex(IMAGE, points).pair_nearest(uv, 7.0)
    distance = np.linalg.norm(uv[:, None] - points, axis=2)
    nearest = np.argsort(distance, axis=1)[:, : THRESHOLDS.growth.max_points_per_place]
    expected = [(i, j) for i, near in enumerate(nearest) for j in near if distance[i, j] < 7]
    assert list(zip(position.tolist(), index.tolist(), strict=True)) == expected
    assert 0 < len(np.unique(position)) < len(uv)


def test_a_lattice_may_take_all_points() -> None:
    uv = np.stack(np.meshgrid(np.arange(4.0), np.arange(3.0)), axis=2) * 10
    lattice, points = Lattice(uv, dark=True), uv.reshape(-1, 2)
    assert not PointIndex(IMAGE, points).exceeds(lattice)
    assert not PointIndex(IMAGE, points[3:]).exceeds(lattice)
    assert not PointIndex(IMAGE, points[:0]).exceeds(lattice)
    assert PointIndex(IMAGE, np.vstack([points, [[90.0, 90.0]]])).exceeds(lattice)
    assert PointIndex(IMAGE, np.vstack([points[3:], [[90.0, 90.0]]])).exceeds(lattice)
