"""The levels of the dots on the edges of a lattice.

A dot lies half-way between two corners. Its level is compared with those of the two squares that
share the edge, beside the dot: +1 is the bright one's, -1 the dark one's.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.boards.puzzleboard import DOT_DIAMETER
from calibgui.engine.detection.puzzleboard.place_decoding import Dots
from calibgui.engine.features.lattice import Lattice, estimate_steps
from calibgui.engine.images.sampling import sample_image

_DOT_SAMPLES = DOT_DIAMETER / 4 * np.array([(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)])
"""(k, 2) where a dot is sampled, along and across its edge, squares from its middle: half-way to
its rim."""
_SQUARE_SAMPLES = np.array([(a, b) for a in (-0.15, 0.0, 0.15) for b in (0.28, 0.36)])
"""(m, 2) where the squares are sampled on either side of a dot: outside of it and of the dots on
their other edges."""
_MIN_CONTRAST = 0.3
"""Least difference of the squares beside a dot, over the median; elsewhere something hides it. A
plausibility limit."""


def measure_dots(image: GreyImage, lattice: Lattice) -> Dots:
    """Measure the levels of the dots between neighbouring corners.

    Args:
        image: (h, w) grey levels.
        lattice: the corners.
    """
    row, col = np.indices(lattice.shape)
    dark = lattice.dark ^ ((row + col) % 2 == 1)
    right, down = estimate_steps(lattice.uv)
    return Dots(
        _measure_levels(image, lattice.uv, down, dark),
        _measure_levels(
            image, lattice.uv.swapaxes(0, 1), right.swapaxes(0, 1), dark.swapaxes(0, 1)
        ).T,
    )


def _measure_levels(image: GreyImage, uv: Array, across: Array, dark: BoolArray) -> Array:
    """Measure the levels (rows, cols - 1) of the dots between each corner and the next in its row.

    Args:
        image: (h, w) grey levels.
        uv: (rows, cols, 2) corners, px; NaN where missing.
        across: (rows, cols, 2) steps to the next row, px.
        dark: (rows, cols) True where the square after a corner, (+, +), is dark.

    Returns:
        The levels, NaN where a corner is missing or the squares do not differ.
    """
    along, across = uv[:, 1:] - uv[:, :-1], (across[:, 1:] + across[:, :-1]) / 2
    middle, dark = (uv[:, 1:] + uv[:, :-1]) / 2, dark[:, :-1]
    level = np.full(dark.shape, np.nan)
    seen = np.isfinite(along + across).all(axis=2)
    if not seen.any():
        return level
    dot, after, before = (
        _average_samples(image, middle[seen], along[seen], across[seen], places)
        for places in (_DOT_SAMPLES, _SQUARE_SAMPLES, -_SQUARE_SAMPLES)
    )
    contrast = np.where(dark[seen], before - after, after - before)
    clear = contrast > _MIN_CONTRAST * np.median(contrast)
    value = np.where(clear, 2 * dot - before - after, np.nan) / np.where(clear, contrast, 1.0)
    # Where something hides half a square the dot seems to be brighter or darker than any.
    level[seen] = np.clip(value, -1.0, 1.0)
    return level


def _average_samples(
    image: GreyImage, middle: Array, along: Array, across: Array, places: Array
) -> Array:
    """Average the grey levels (n,) at `places` (k, 2) in steps `along` and `across` (n, 2) px from
    points `middle` (n, 2) px."""
    offset = places[:, :1] * along[:, None] + places[:, 1:] * across[:, None]
    return np.asarray(sample_image(image, middle[:, None] + offset).mean(axis=1))
