"""First estimates of the corners: Harris' detector (paper 4.1, the red marks of figure 6).

The structure tensor S = sum of w (grad I)(grad I)^T over a neighbourhood has two large
eigenvalues where the grey levels vary in both directions. The neighbourhood must reach well into
the squares: where bright ones outshine dark ones the dark tips stand apart, and a small one
finds each of them instead of the corner. Harris and Stephens (1988) score it by

    det S - 0.04 (tr S)^2

without computing the eigenvalues; the corner is the pixel of the greatest score near where the
lattice predicts it. It is good to a pixel or two: an estimate to look at, which the saddle point
improves.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import kernels, opencv
from calibgui.engine.arrays import Array, GreyImage

_REACH = 2
"""Greatest distance from the predicted pixel along each axis, px."""
_MARGIN = 9
"""Reach of the neighbourhood's weights, px."""
_SENSITIVITY = 0.04
"""Factor of the squared trace (Harris and Stephens 1988)."""


def estimate_corners(image: GreyImage, uv: Array, spacing: Array) -> Array:
    """Find the pixel (n, 2) of the greatest Harris score near each of the corners `uv` (n, 2) px.

    Args:
        image: (h, w) grey levels.
        uv: where corners are predicted.
        spacing: (n,) px to the next corner; it sets the neighbourhood, and the search ends at a
            quarter of it.
    """
    half = _REACH + _MARGIN
    tried = np.arange(-_REACH, _REACH + 1)
    # (n, k, side) weights around each of the k positions tried along an axis.
    width = np.clip(spacing / 6, 1, _MARGIN / 3)[:, None]
    by_distance = np.exp(-0.5 * (np.arange(half + _REACH + 1) / width) ** 2)
    w = by_distance[:, abs(np.arange(-half, half + 1) - tried[:, None])]
    score = _score_positions(image, uv, w, _SENSITIVITY)
    within = abs(tried) <= np.maximum(spacing / 4, 1)[:, None]
    score = np.where(within[:, :, None] & within[:, None, :], score, -np.inf)
    best = np.argmax(score.reshape(len(uv), -1), axis=1)
    v, u = np.unravel_index(best, score.shape[1:])
    return np.asarray(np.rint(uv) + np.column_stack([u, v]) - _REACH)


@kernels.with_kernel("harris", "score_positions")
def _score_positions(image: GreyImage, uv: Array, weights: Array, sensitivity: float) -> Array:
    """Compute the Harris scores (n, k, k) at each of the k x k positions tried, down and across.

    Args:
        image: (h, w) grey levels.
        uv: (n, 2) px.
        weights: (n, k, side) along either axis, of each of the k positions tried along it.
        sensitivity: the factor of the squared trace.
    """
    tiles, _ = opencv.cut_tiles(image, uv, weights.shape[2] // 2)
    gv, gu = (np.asarray(g) for g in np.gradient(tiles.astype(np.float64), axis=(1, 2)))
    Suu, Svv, Suv = (
        weights @ product @ weights.transpose(0, 2, 1) for product in (gu * gu, gv * gv, gu * gv)
    )
    return np.asarray(Suu * Svv - Suv * Suv - sensitivity * (Suu + Svv) ** 2)
