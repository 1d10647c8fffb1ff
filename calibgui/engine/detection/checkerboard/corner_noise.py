"""The noise near the corners of a board, pixel by pixel and where neighbours have it in common.

**Pixel by pixel.** Only the odd part of what the edge model leaves unexplained says how well a
corner is known (`x_corner_fit`): noise^2 is half the mean square difference of opposite pixels,
unless that is more than the mean square itself: in a sharp image no two pixels are quite opposite.
It is at least that of rounded grey levels: a drawn or saturated image has no other.

**In common.** JPEG, enlarging, demosaicing and denoising make one pixel's error its neighbours',
and make it greater at edges than beside them. Least squares then scatter by more than

    cov c = noise^2 (sum of g g^T)^-1,        g = grad I,

which counts every pixel as a witness of its own. The scatter is that of the score, the sum of r g
with the residual r (Huber 1967, White 1980). Errors in common reach a few pixels, so the score's
variance is estimated with those of its autocovariances, weighed by Parzen's window (Newey and West
1987, Andrews 1991),

    V = sum of w(|k - l| / (L + 1)) F_k F_l,

    w(x) = 1 - 6 x^2 + 6 x^3 up to x = 1/2, 2 (1 - x)^3 up to 1, then 0,

over lines k, l of pixels across an edge (`accumulate_scores`). Were the noise independent, F_k had
the variance noise^2 h_k, and as the fit leaves no sum of them,

    E V = noise^2 (sum of h_k - sum of w(|k - l| / (L + 1)) h_k h_l / sum of h_k).

The growth of the covariances is the ratio of both sides, over all edges of a board: a single
corner's few lines would tell it to a factor of 2 only. It does not see errors that all lines of an
edge share, nor such of whole blocks of pixels that are longer than L.
"""

from __future__ import annotations

import math

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, compute_median
from calibgui.engine.detection.checkerboard.edge_bend import clip_arms
from calibgui.engine.detection.checkerboard.fit_thresholds import FIT_THRESHOLDS
from calibgui.engine.detection.checkerboard.x_corner_model import (
    C,
    XCornerModel,
    accumulate_scores,
)

_THRESHOLDS = FIT_THRESHOLDS.noise


def estimate_noise(square: Array, odd_part: Array) -> Array:
    """Estimate noise^2 (n,) from the mean square (n,) of the residual and from its odd part
    (n, 2)."""
    total, pairs = odd_part.T
    enough = pairs > _THRESHOLDS.min_opposite_pixels
    noise = np.where(enough, total / np.maximum(pairs - 2, 1), square)
    return square if compute_median(noise) > compute_median(square) else noise


def pool_noise(noise: Array, freedom: Array) -> Array:
    """Return noise^2 (n,) that those corners take from the board which hardly tell it: a model of
    as many unknowns as pixels leaves nothing unexplained, and where pixels have two levels only, or
    are repeated, those opposite each other may happen to be equal all around a corner.

    Args:
        noise: (n,) as each corner tells it, grey levels^2.
        freedom: (n,) number of pixels that were read beyond the number of unknowns.
    """
    known = np.maximum(freedom, 0.0)
    share = np.minimum(known / _THRESHOLDS.min_freedom, 1.0)
    pooled = np.sum(known * noise) / max(float(known.sum()), 1.0)
    noise = share * noise + (1 - share) * pooled
    return np.maximum(noise, _THRESHOLDS.min_relative_noise * compute_median(noise))


def estimate_growth(
    image: GreyImage, model: XCornerModel, noise: Array, usable: BoolArray
) -> float:
    """Estimate the growth of a board's covariances by what neighbouring pixels have in common.

    Args:
        image: (h, w) grey levels.
        model: at the n corners of a board.
        noise: (n,) square of the noise pixel by pixel, grey levels^2.
        usable: (n,) corners that are described by the model up to noise. Some of them, all over
            the board, are looked at, but none whose edges the image cuts: what is even about such a
            corner would not cancel.

    Returns:
        The growth; 1 where it is not clearly more.
    """
    off_middle, _ = clip_arms(model.unknowns[C], model.tangents(), model.arm, image.shape[::-1])
    at = np.flatnonzero(usable & ~off_middle.any(axis=1))
    if len(at) < _THRESHOLDS.min_corners:
        return 1.0
    length = float(model.arm[at].sum(axis=1).mean())
    count = min(round(_THRESHOLDS.read_corners / math.sqrt(length)), len(at))
    at = at[np.linspace(0, len(at) - 1, count).astype(np.int64)]
    reach = max(
        _THRESHOLDS.min_correlation_reach,
        _THRESHOLDS.correlation_reach * float(model.arm[at].mean()),
    )
    return compute_growth(accumulate_scores(image, model.select(at)), noise[at], reach)


def compute_growth(scores: Array, noise: Array, reach: float) -> float:
    """Compute the growth of the covariances; 1 where it is not clearly more. Chance makes it 0.9 to
    1.1 on a board of 54 corners with independent noise.

    Args:
        scores: (n, 2, 2, k) of lines of pixels at n corners, see `accumulate_scores`.
        noise: (n,) square of their noise pixel by pixel, grey levels^2.
        reach: greatest distance of lines whose errors may be in common, px.
    """
    lines = np.arange(scores.shape[3])
    window = _compute_window(lines / (reach + 1))[abs(lines[:, None] - lines)]
    # One product, not one for each corner, which would read all of the window.
    smooth = (scores.reshape(-1, len(lines)) @ window).reshape(scores.shape)
    F, h = scores[:, :, 0], scores[:, :, 1]
    total = np.maximum(h.sum(axis=2), 1e-300)
    growth, sigma = _pool_ratios(smooth[:, :, 0] * F, total, smooth[:, :, 1] * h, noise)
    at_edges, sigma_at_edges = _pool_ratios(F * F, total, h * h, noise)
    is_clear = growth > 1 + _THRESHOLDS.min_growth_sigmas * sigma
    is_clear |= at_edges > 1 + _THRESHOLDS.min_edge_growth_sigmas * sigma_at_edges
    return max(growth, 1.0) if is_clear else 1.0


def _pool_ratios(found: Array, total: Array, lost: Array, noise: Array) -> tuple[float, float]:
    """Pool the ratios of the scores' variances, found and expected, at n corners of a board.

    Args:
        found: (n, 2, k) terms of the variances found.
        total: (n, 2) sums of h.
        lost: (n, 2, k) terms of what the fit takes from the expected variances, times `total`.
        noise: (n,) grey levels^2.

    Returns:
        The ratio for the board, and its standard deviation.
    """
    expected = np.maximum(np.sum(total - lost.sum(axis=2) / total, axis=1), 1e-300)
    ratio, weight = found.sum(axis=(1, 2)) / (noise * expected), expected / expected.sum()
    # What is beside a few corners, as a finger or a stain, is no noise of all.
    ratio = np.minimum(ratio, _THRESHOLDS.max_relative_growth * compute_median(ratio))
    mean = float(weight @ ratio)
    return mean, float(np.sqrt(np.sum((weight * (ratio - mean)) ** 2)))


def _compute_window(x: Array) -> Array:
    """Compute Parzen's window."""
    near, far = 1 - 6 * x**2 * (1 - x), 2 * np.maximum(1 - x, 0) ** 3
    return np.where(x < 0.5, near, far)
