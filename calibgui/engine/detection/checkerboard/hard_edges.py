"""Edges without a grey pixel, as in drawings, their screenshots and images of two levels.

A camera's pixel that an edge crosses is grey by what it sees of either side, and that tells the
edge's place to a small part of a pixel. A drawing of two levels shows pixels of either, and an edge
along a row or a column lies anywhere between the middles of two: its place is rounded, with a
variance of 1/12 px^2 (Widrow 1956), and nothing in the residual says so. An edge that leans over m
pixels on the way that is read steps from one row to the next there with probability m, which tells
its place; else that is open to 1 - m px, a variance of (1 - m)^2 / 12. What steps leave of longer
edges shows in the residual.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.detection.checkerboard.fit_thresholds import FIT_THRESHOLDS
from calibgui.engine.detection.checkerboard.x_corner_model import A, C, M, XCornerModel

_THRESHOLDS = FIT_THRESHOLDS.hard_edges
_ROUNDING_VARIANCE = 1 / 12
"""Variance of a place that is rounded to whole pixels, px^2."""


def has_hard_edges(image: GreyImage, model: XCornerModel) -> bool:
    """Return whether the edges of a board lead from dark to bright without a grey pixel.

    Args:
        image: (h, w) grey levels.
        model: at the corners of the board, some of which, all over it, are looked at.
    """
    n = len(model.unknowns)
    model = model.select(np.linspace(0, n - 1, min(n, _THRESHOLDS.read_corners)).astype(np.int64))
    levels = _read_across_edges(image, model)
    is_bright, is_dark = levels > _THRESHOLDS.max_grey_level, levels < -_THRESHOLDS.max_grey_level
    crosses = np.asarray(is_bright.any(axis=0) & is_dark.any(axis=0))
    if np.count_nonzero(crosses) <= _THRESHOLDS.min_crossing_share * len(crosses):
        return False
    is_grey = np.asarray(~(is_bright | is_dark).all(axis=0))
    return bool(is_grey[crosses].mean() < _THRESHOLDS.max_grey_share)


def _read_across_edges(image: GreyImage, model: XCornerModel) -> Array:
    """Read the pixels across the edges at places along them, along rows or columns.

    Returns:
        (k, m) levels at k pixels across each of m places in the image: -1 dark, 1 bright.
    """
    tangents = model.tangents()
    reach = np.arange(_THRESHOLDS.min_distance, _THRESHOLDS.max_distance + 1)
    along = np.concatenate([-reach, reach])[:, None]
    places = model.unknowns[C][:, None, None] + along * tangents[:, :, None]
    is_used = abs(along[:, 0]) < model.arm[:, :, None]
    is_steep = abs(tangents[..., 1]) > abs(tangents[..., 0])
    across = np.where(is_steep[..., None], (1.0, 0.0), (0.0, 1.0))[:, :, None]
    offset = np.arange(-_THRESHOLDS.reach_across, _THRESHOLDS.reach_across + 1)
    pixels = np.rint(places + offset[:, None, None, None, None] * across).astype(np.int64)
    is_inside = ((pixels >= 0) & (pixels < image.shape[::-1])).all(axis=(0, -1))
    u, v = np.moveaxis(pixels[:, is_used & is_inside], -1, 0)
    corner = np.nonzero(is_used & is_inside)[0]
    middle, half = (model.unknowns[of][corner] for of in (M, A))
    return np.asarray((image[v, u] - middle) / half)


def compute_rounding_variance(model: XCornerModel) -> Array:
    """Compute the variance (n, 2) px^2 across each edge of what rounding leaves open of its place,
    where edges are hard."""
    lean = 2 * model.arm * abs(model.tangents()).min(axis=2)
    return np.asarray(_ROUNDING_VARIANCE * np.maximum(1 - lean, 0.0) ** 2)
