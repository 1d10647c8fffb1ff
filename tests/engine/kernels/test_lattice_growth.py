"""The compiled growth of lattices, and their borders, against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.detection.circles.grid_labelling import _drop_borders
from calibgui.engine.detection.circles.lattice_growth import _grow


@pytest.mark.parametrize("seed", range(10))
def test_the_same_lattice_grows(seed: int) -> None:
    """Through gaps and among strays, and farther than room was made for at first."""
    rng = np.random.default_rng(seed)
    rows, cols = rng.integers(4, 45, 2)
    places = np.indices((rows, cols)).reshape(2, -1).T
    bent = 20 * places @ (rng.normal(0, 1, (2, 2)) + 2.5 * np.eye(2)) + 0.02 * places**2
    is_seen = rng.random(len(places)) < rng.uniform(0.6, 1)
    begin = int(rng.integers(rows - 1) * cols + rng.integers(cols - 1))
    first = np.array([begin, begin + cols, begin + 1])
    is_seen[first] = True
    seen = bent[is_seen] + rng.normal(0, rng.uniform(0, 2.5), bent[is_seen].shape)
    points = np.vstack([seen, rng.uniform(seen.min(axis=0), seen.max(axis=0), (20, 2))])
    chosen = (np.cumsum(is_seen) - 1)[first]
    start = np.array([(0, 0), (1, 0), (0, 1)])
    expected, found = (grow(start, chosen, points, 0.3) for grow in (_grow.reference, _grow.kernel))
    np.testing.assert_array_equal(found[0], expected[0])
    np.testing.assert_array_equal(found[1], expected[1])


@pytest.mark.parametrize("per_circle", [1, 2])
def test_the_same_borders_are_dropped(per_circle: int) -> None:
    rng = np.random.default_rng(per_circle)
    for _ in range(100):
        is_taken = rng.random(rng.integers(1, 15, 2)) < rng.uniform(0.1, 1)
        is_taken[0, 0] = True
        xy = np.argwhere(is_taken) + rng.integers(-5, 5, 2)
        if per_circle == 2:
            xy = np.column_stack([xy[:, 0] - xy[:, 1], xy.sum(axis=1)])
        expected, found = (
            drop(xy, per_circle, 0.5) for drop in (_drop_borders.reference, _drop_borders.kernel)
        )
        np.testing.assert_array_equal(found, expected)
