"""Fill a lattice's holes and extend its borders, one line of corners at a time.

An empty place next to the lattice is predicted from its neighbours. It is filled by the
saddle point within 0.3 steps whose four sectors look most as the place requires: the two
opposite ones that should be dark darker than the two others, by a fair part of the contrast of
the corners around. At the true border of a board this fails, since beyond it three or four
sectors are alike.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from calibgui.engine import opencv
from calibgui.engine.corners.junctions import Saddles
from calibgui.engine.corners.lattice import (
    DEVIATION,
    Lattice,
    axes,
    bordered,
    crop,
    in_steps,
    predict,
    trim,
)
from calibgui.engine.opencv import Image
from calibgui.engine.types import Array, BoolArray

_TRIED = 6
"""How many saddle points near a prediction are looked at."""
_INSIDE = np.array([0.12, 0.22, 0.32])
"""Where a sector is sampled, in steps along both of its edges."""
_CLEAR = 0.3
"""Least gap between the dark and the bright sectors over their difference."""
_WEAKEST = 0.25
"""Least contrast of a corner over the median of its lattice."""
_ROUNDS = 64


def grow(lattice: Lattice, saddles: Saddles, max_shape: int = 200) -> Lattice:
    """`lattice` with every hole and border filled that the saddle points allow."""
    if not len(saddles.uv):
        return lattice
    tree = cKDTree(saddles.uv)
    for _ in range(_ROUNDS):
        uv = bordered(lattice.uv, 1)
        if max(uv.shape) > max_shape:
            break
        filled = _fill(Lattice(uv, lattice.dark), saddles, tree)
        if filled is None:
            break
        trimmed = trim(crop(filled))
        if trimmed is None or len(trimmed) <= len(lattice):
            break
        lattice = trimmed
    return lattice


def _fill(lattice: Lattice, saddles: Saddles, tree: cKDTree) -> Lattice | None:
    """The lattice with what fits into its empty places, or None where nothing does."""
    predicted = predict(lattice.uv)
    right, down = axes(lattice.uv)
    known = np.isfinite(predicted + right + down).all(axis=2)
    rows, cols = np.nonzero(~lattice.found & known)
    if not len(rows):
        return None
    tried = min(_TRIED, len(saddles.uv))
    _, index = tree.query(predicted[rows, cols], np.arange(1, tried + 1))
    place = np.repeat(np.arange(len(rows)), tried)
    index, r, c = index.ravel(), rows[place], cols[place]
    offset = saddles.uv[index] - predicted[r, c]
    near = in_steps(offset, right[r, c], down[r, c]) < DEVIATION
    place, index, r, c = place[near], index[near], r[near], c[near]
    dark = lattice.dark ^ ((r + c) % 2 == 1)
    gap, contrast = sectors(saddles.smooth, saddles.uv[index], right[r, c], down[r, c], dark)
    fits = (gap > _CLEAR * contrast) & (contrast > _WEAKEST * _median_contrast(lattice, saddles))
    if not fits.any():
        return None
    order = np.flatnonzero(fits)[np.argsort(gap[fits], kind="stable")]  # the best is written last
    uv = lattice.uv.copy()
    uv[r[order], c[order]] = saddles.uv[index[order]]
    return Lattice(uv, lattice.dark)


def sectors(
    image: Image, uv: Array, right: Array, down: Array, dark: BoolArray
) -> tuple[Array, Array]:
    """How clearly the four sectors around corners alternate as their places require.

    Args:
        image: (h, w) grey levels.
        uv: (n, 2) corners, px.
        right, down: (n, 2) steps to the next column and row, px.
        dark: (n,) whether the squares before (-, -) and after (+, +) the corner are dark.

    Returns:
        Gap between the darkest bright and the brightest dark sector (n,), and the difference
        of bright and dark on average (n,), both grey levels and negative where exchanged.
    """
    signs = np.array([(1, 1), (-1, -1), (1, -1), (-1, 1)])
    a, b = (grid.ravel() for grid in np.meshgrid(_INSIDE, _INSIDE))
    a, b = signs[:, :1] * a, signs[:, 1:] * b
    offset = a[..., None] * right[:, None, None] + b[..., None] * down[:, None, None]
    # At the border of the image the sectors are looked at nearer to the corner.
    room = np.minimum(uv, np.array(image.shape[::-1]) - 1.0 - uv)
    reach = np.abs(offset).max(axis=(1, 2))
    offset *= np.clip(room / reach, 0.1, 1.0).min(axis=1)[:, None, None, None]
    values = opencv.sample(image, uv[:, None, None] + offset).mean(axis=2)
    values = np.where(dark[:, None], values, -values)
    low, high = values[:, :2], values[:, 2:]
    difference = high.mean(axis=1) - low.mean(axis=1)
    return high.min(axis=1) - low.max(axis=1), difference


def _median_contrast(lattice: Lattice, saddles: Saddles) -> float:
    right, down = axes(lattice.uv)
    rows, cols = np.nonzero(lattice.found)
    dark = lattice.dark ^ ((rows + cols) % 2 == 1)
    at = rows, cols
    _, contrast = sectors(saddles.smooth, lattice.uv[at], right[at], down[at], dark)
    return float(np.nanmedian(contrast))
