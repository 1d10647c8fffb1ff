"""The noise near the corners of a board: of pixels, in common to neighbours, and of rounding.

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

**Hard edges**, without a grey pixel, are those of drawings, their screenshots and images of two
levels. A camera's pixel that an edge crosses is grey by what it sees of either side, and that tells
the edge's place to a small part of a pixel. A drawing of two levels shows pixels of either, and an
edge along a row or a column lies anywhere between the middles of two: its place is rounded, with a
variance of 1/12 px^2 (Widrow 1956), and nothing in the residual says so. An edge that leans over m
pixels on the way that is read steps from one row to the next there with probability m, which tells
its place; else that is open to 1 - m px, a variance of (1 - m)^2 / 12. What steps leave of longer
edges shows in the residual.
"""

from __future__ import annotations

import math

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, compute_median
from calibgui.engine.corner_fit.edge_lens_fit import clip_arms
from calibgui.engine.corner_fit.x_corner_model import A, C, M, XCornerModel, accumulate_scores

_MIN_OPPOSITE_PIXELS = 20
"""Number of pairs of opposite pixels from which on their differences give the noise."""
MIN_FREEDOM = 20
"""Number of pixels beyond that of unknowns from which on a corner tells the noise by itself."""
_MIN_RELATIVE_NOISE = 0.25
"""Least square of a corner's noise, over the board's median. 30 pairs of pixels tell less
by chance at one of 100,000 corners. Without it corners of the troubles "two levels" and
"repeated pixels" claimed to be 100 times surer than their neighbours, and were no better."""
MIN_CORRELATION_REACH = 8.0
"""Distance of lines of pixels up to which their errors may be in common at least, px. With 5
chi2 of corners was 1.1 to 1.2 in images enlarged by 3 or smoothed by 1 px ..."""
CORRELATION_REACH = 1 / 3
"""... and over the arms: many pixels of an edge tell what few have in common at distances that
images enlarged by 5 and phones have. With 8 px chi2 was 1.5 and 2.3 there, not 1.2 and 1.4."""
_MIN_CORNERS = 6
"""Number of corners from which on a board tells what neighbouring pixels have in common."""
_READ_CORNERS = 264.0
"""Number of corners that are looked at for that, times the root of their arms' length in px:
a longer one tells more, but no single one tells it. Of 54 corners with 15 px each way a growth
by 1.25 is clear. It takes 3 to 10 % of the time of finding corners."""
_MAX_RELATIVE_GROWTH = 4.0
"""Greatest growth of the covariance that one corner counts with, over the board's median; of
independent noise one in a thousand has more."""
_MIN_GROWTH_SIGMAS = 3.0
"""Least excess of the growth over 1 that is believed, over its standard deviation ..."""
_MIN_EDGE_GROWTH_SIGMAS = 4.0
"""... or of that by errors greater at edges than beside them, whose deviation is smaller. On
200 boards with independent noise the excesses were at most 2.5 and 2.8."""
_READ_CORNERS_WITH_HARD_EDGES = 16
"""Number of corners that are looked at."""
_MIN_DISTANCE_ALONG = 2
"""Least distance from the corner of what is looked at along the edges, px ..."""
_MAX_DISTANCE_ALONG = 8
"""... and the greatest."""
_REACH_ACROSS = 3
"""Number of pixels to either side of an edge that are looked at, for ink spreads."""
_MAX_GREY_LEVEL = 0.8
"""Greatest distance of a grey pixel's level from the middle one, half contrasts."""
_MIN_CROSSING_SHARE = 0.5
"""Share of the places at which a dark and a bright pixel are seen, below which edges are too
wide, or too far away, to tell."""
_MAX_GREY_SHARE = 0.3
"""Share of those with a grey pixel below which edges are hard. Of boards under all of the
troubles it is 0.8 and more, but for "two levels", where it is 0."""
_ROUNDING_VARIANCE = 1 / 12
"""Variance of a place that is rounded to whole pixels, px^2."""


def estimate_noise(square: Array, odd_part: Array) -> Array:
    """Estimate noise^2 (n,) from the mean square (n,) of the residual and from its odd part
    (n, 2)."""
    total, pairs = odd_part.T
    enough = pairs > _MIN_OPPOSITE_PIXELS
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
    share = np.minimum(known / MIN_FREEDOM, 1.0)
    pooled = np.sum(known * noise) / max(float(known.sum()), 1.0)
    noise = share * noise + (1 - share) * pooled
    return np.maximum(noise, _MIN_RELATIVE_NOISE * compute_median(noise))


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
    if len(at) < _MIN_CORNERS:
        return 1.0
    length = float(model.arm[at].sum(axis=1).mean())
    count = min(round(_READ_CORNERS / math.sqrt(length)), len(at))
    at = at[np.linspace(0, len(at) - 1, count).astype(np.int64)]
    reach = max(
        MIN_CORRELATION_REACH,
        CORRELATION_REACH * float(model.arm[at].mean()),
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
    is_clear = growth > 1 + _MIN_GROWTH_SIGMAS * sigma
    is_clear |= at_edges > 1 + _MIN_EDGE_GROWTH_SIGMAS * sigma_at_edges
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
    ratio = np.minimum(ratio, _MAX_RELATIVE_GROWTH * compute_median(ratio))
    mean = float(weight @ ratio)
    return mean, float(np.sqrt(np.sum((weight * (ratio - mean)) ** 2)))


def _compute_window(x: Array) -> Array:
    """Compute Parzen's window."""
    near, far = 1 - 6 * x**2 * (1 - x), 2 * np.maximum(1 - x, 0) ** 3
    return np.where(x < 0.5, near, far)


def has_hard_edges(image: GreyImage, model: XCornerModel) -> bool:
    """Return whether the edges of a board lead from dark to bright without a grey pixel.

    Args:
        image: (h, w) grey levels.
        model: at the corners of the board, some of which, all over it, are looked at.
    """
    n = len(model.unknowns)
    model = model.select(
        np.linspace(0, n - 1, min(n, _READ_CORNERS_WITH_HARD_EDGES)).astype(np.int64)
    )
    levels = _read_across_edges(image, model)
    is_bright, is_dark = levels > _MAX_GREY_LEVEL, levels < -_MAX_GREY_LEVEL
    crosses = np.asarray(is_bright.any(axis=0) & is_dark.any(axis=0))
    if np.count_nonzero(crosses) <= _MIN_CROSSING_SHARE * len(crosses):
        return False
    is_grey = np.asarray(~(is_bright | is_dark).all(axis=0))
    return bool(is_grey[crosses].mean() < _MAX_GREY_SHARE)


def _read_across_edges(image: GreyImage, model: XCornerModel) -> Array:
    """Read the pixels across the edges at places along them, along rows or columns.

    Returns:
        (k, m) levels at k pixels across each of m places in the image: -1 dark, 1 bright.
    """
    tangents = model.tangents()
    reach = np.arange(_MIN_DISTANCE_ALONG, _MAX_DISTANCE_ALONG + 1)
    along = np.concatenate([-reach, reach])[:, None]
    places = model.unknowns[C][:, None, None] + along * tangents[:, :, None]
    is_used = abs(along[:, 0]) < model.arm[:, :, None]
    is_steep = abs(tangents[..., 1]) > abs(tangents[..., 0])
    across = np.where(is_steep[..., None], (1.0, 0.0), (0.0, 1.0))[:, :, None]
    offset = np.arange(-_REACH_ACROSS, _REACH_ACROSS + 1)
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
