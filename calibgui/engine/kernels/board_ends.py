"""Squares to either side of a line, compiled: see ``lattices.board_ends``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.kernels.common import (
    bilinear,
    compiled,
    compiled_part,
    make_contiguous,
    make_read_only,
)


@compiled_part
def _sample_inside(image: GreyImage, u: float, v: float) -> float:
    """Return the grey level at (u, v), NaN outside of the image."""
    height, width = image.shape
    is_inside = 0 <= u <= width - 1 and 0 <= v <= height - 1
    return bilinear(image, u, v) if is_inside else np.nan


@compiled
def _compare(
    image: GreyImage, place: Array, right: Array, down: Array, offsets: Array, out: Array
) -> None:
    """Fill out (2, m, n)."""
    for side in range(2):
        turn = 1.0 - 2 * side
        for k in range(offsets.shape[0]):
            along, across = offsets[k, 0], turn * offsets[k, 1]
            for i in range(place.shape[0]):
                u, v = place[i, 0] + across * down[i, 0], place[i, 1] + across * down[i, 1]
                du, dv = along * right[i, 0], along * right[i, 1]
                after = _sample_inside(image, u + du, v + dv)
                before = _sample_inside(image, u - du, v - dv)
                out[side, k, i] = turn * (after - before)


def compare_squares(
    image: GreyImage, place: Array, right: Array, down: Array, offsets: Array
) -> Array:
    """Compute ``_compare_squares`` of the reference."""
    out = np.empty((2, len(offsets), len(place)))
    place, right, down, offsets = map(make_contiguous, (place, right, down, offsets))
    _compare(make_read_only(image), place, right, down, offsets, out)
    return out
