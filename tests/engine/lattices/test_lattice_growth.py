"""Points looked up by their place, from which a lattice grows."""

from __future__ import annotations

import numpy as np

from calibgui.engine.lattices.lattice_growth import MAX_POINTS_PER_PLACE, PointIndex

IMAGE = np.zeros((100, 100), np.uint8)


def test_positions_are_paired_with_the_nearest_points_that_are_near_enough() -> None:
    rng = np.random.default_rng(0)
    points, uv = rng.uniform(0, 100, (300, 2)), rng.uniform(-10, 110, (50, 2))
    position, index = PointIndex(IMAGE, points).pair_nearest(uv, 7.0)
    distance = np.linalg.norm(uv[:, None] - points, axis=2)
    nearest = np.argsort(distance, axis=1)[:, :MAX_POINTS_PER_PLACE]
    expected = [(i, j) for i, near in enumerate(nearest) for j in near if distance[i, j] < 7]
    assert list(zip(position.tolist(), index.tolist(), strict=True)) == expected
    assert 0 < len(np.unique(position)) < len(uv)
