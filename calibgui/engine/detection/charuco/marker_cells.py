"""The cells of square markers and tags: which of them are dark, by the level midway between the
darkest and the brightest of their quadrilateral."""

from __future__ import annotations

from functools import cache

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.geometry import homography
from calibgui.engine.images.sampling import sample_image

_SAMPLE_OFFSETS = np.array([(u, v) for v in (-0.2, 0.2) for u in (-0.2, 0.2)])
"""(4, 2) where a cell is sampled, cells from its centre."""


def find_dark_cells(image: GreyImage, quads: Array, side: int) -> BoolArray:
    """Find the dark ones of the side x side cells of quadrilaterals.

    Args:
        image: (h, w) grey levels.
        quads: (n, 4, 2) px, corners in the sense from u to v.
        side: number of cells along a side.

    Returns:
        (n, side, side), True where a cell is darker than the mid level of its quadrilateral.
    """
    level = measure_cells(image, quads, side)
    ends = level.min(axis=(1, 2)), level.max(axis=(1, 2))
    return np.asarray(level < np.mean(ends, axis=0)[:, None, None])


def measure_cells(image: GreyImage, quads: Array, side: int) -> Array:
    """Measure the grey levels (n, side, side) of the cells of quadrilaterals; the arguments are
    those of `find_dark_cells`."""
    n = len(quads)
    square = np.broadcast_to(side * np.array([(0.0, 0), (1, 0), (1, 1), (0, 1)]), (n, 4, 2))
    H = homography.fit_homography(square, quads, np.ones((n, 4)))
    at = _list_samples(side)
    # The same places for all: one product in place of one for each.
    rows = H.reshape(3 * n, 3)
    x, y, z = (rows[:, :2] @ at.T + rows[:, 2:]).reshape(n, 3, len(at)).swapaxes(0, 1)
    values = sample_image(image, np.stack([x / z, y / z], axis=2))
    count = len(_SAMPLE_OFFSETS)
    return (values.reshape(-1, count) @ np.full(count, 1 / count)).reshape(n, side, side)


@cache
def _list_samples(side: int) -> Array:
    """List the places (k, 2) at which side x side cells are sampled, cells."""
    v, u = np.indices((side, side)).reshape(2, -1) + 0.5
    return (np.column_stack([u, v])[:, None] + _SAMPLE_OFFSETS).reshape(-1, 2)
