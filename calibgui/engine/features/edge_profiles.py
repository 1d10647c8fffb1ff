"""Starting values for the edge fit, from grey-level profiles across the edges.

Across an edge, some way along it from the corner, the grey level rises from lo to hi around the
offset e where the edge really lies. From samples over [-R, R], in squares,

    e = R - integral of (I - lo) / (hi - lo),

which averages noise and needs no threshold. Half the difference of e between an edge's two arms
is the overlap or gap w of the squares; an error of the corner off the edge cancels. Between 25 and
75 % of the rise the profile of a Gaussian blur is 1.349 standard deviations wide.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, GreyImage, compute_median
from calibgui.engine.images.sampling import sample_image

_MIN_RELATIVE_RISE = 0.5
"""Least rise of a profile that is measured, over the median."""
_PROFILE_OFFSETS = np.array([0.2, 0.3, 0.4, -0.2, -0.3, -0.4])
"""(k,) where on the two arms profiles are taken, squares from the corner."""
_NEAREST, _FARTHEST = np.array([0, 3]), np.array([2, 5])
"""Indices of the profiles nearest to the corner and farthest from it."""
REACH_SHARE = 0.7
"""R, over how far from its edges a square is of one colour."""
_BLUR_REACH = 6.0
"""Half width of the profile that the blur is measured on, px: the samples of a whole profile of
large squares lie too far apart."""
_SAMPLES = 33
"""Number of samples of a profile."""
_END_SAMPLES = 4
"""Number of samples at either end that give lo and hi."""
_QUARTILE_WIDTH = 1.349
"""Distance of a normal distribution's quartiles, standard deviations."""


class EdgeProfiles(NamedTuple):
    """Measurements of the profiles across one edge of each of n corners."""

    spread: Array
    """(n,) growth of the dark squares on every side, squares; NaN where the edge is unclear."""
    bulge: Array
    """(n,) the spread far from the corner less that near it; NaN where the edge is unclear."""
    blur: Array
    """(n,) px."""
    low: Array
    """(n,) grey level of the dark squares."""
    high: Array
    """(n,) grey level of the bright squares."""


def measure_edge_profiles(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    size: Array,
    sign: Array,
    bare_reach: float = 0.5,
) -> EdgeProfiles:
    """Measure profiles across one edge of each corner, in the direction of the other.

    Args:
        image: (h, w) grey levels.
        uv: (n, 2) corners, px.
        along: (n, 2) step of a square along the edge, px.
        across: (n, 2) step of a square along the other edge, px.
        size: (n,) height of a square over the edge, px.
        sign: (n,) p, +1 where the square towards both steps is bright.
        bare_reach: how far from its edges a square is of one colour, squares.
    """
    reach = REACH_SHARE * bare_reach
    edges = image, uv, along, across, _PROFILE_OFFSETS, reach, _SAMPLES
    ends = _measure_ends(*edges, _END_SAMPLES)
    rise = (ends[1] - ends[0]) * sign[:, None] * np.sign(_PROFILE_OFFSETS)
    typical = float(compute_median(rise.ravel()))
    min_rise = max(_MIN_RELATIVE_RISE * typical, 0.0)
    spread, bulge, width, low, high = _describe_profiles(
        *edges, size, sign, ends, min_rise, _BLUR_REACH
    )
    return EdgeProfiles(spread, bulge, width / _QUARTILE_WIDTH, low, high)


@kernels.with_kernel("edge_profiles", "measure_ends")
def _measure_ends(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    offsets: Array,
    reach: float,
    samples: int,
    ends: int,
) -> Array:
    """Measure the grey levels at both ends of profiles, and their sums.

    Args:
        image, uv, along, across: as `measure_edge_profiles`.
        offsets: (k,) where along the edge profiles are taken, squares.
        reach: half their width, squares.
        samples: number of samples of each.
        ends: number of samples averaged at either end.

    Returns:
        (3, n, k) means of the first and of the last samples, and the sum of all by the trapezoidal
        rule.
    """
    n = len(uv)
    middle, half = np.zeros((n, len(offsets))), np.full(n, reach)
    values = _sample_profiles(image, uv, along, across, offsets, middle, half, samples)
    total = values.sum(axis=2) - values[..., [0, -1]].mean(axis=2)
    return np.stack([values[..., :ends].mean(axis=2), values[..., -ends:].mean(axis=2), total])


@kernels.with_kernel("edge_profiles", "describe_profiles")
def _describe_profiles(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    offsets: Array,
    reach: float,
    samples: int,
    size: Array,
    sign: Array,
    ends: Array,
    min_rise: float,
    blur_reach: float,
) -> Array:
    """Compute `measure_edge_profiles` from the `ends` (3, n, k) of the profiles.

    Args:
        image, uv, along, across, offsets, reach, samples: as `_measure_ends`.
        size, sign: as `measure_edge_profiles`.
        ends: the result of `_measure_ends`.
        min_rise: least rise of a clear profile, grey levels.
        blur_reach: half width of the profile that the blur is measured on, px.

    Returns:
        (5, n) spread and bulge, squares; distance of the quartiles, px; low and high level.
    """
    first, last, total = ends
    rising = sign[:, None] * np.sign(offsets)
    clear = (last - first) * rising > min_rise
    rise = np.where(clear, last - first, np.inf)
    integral = (total / (samples - 1) - first) / rise * 2 * reach
    growth = np.where(clear.all(axis=1, keepdims=True), (reach - integral) * rising, np.nan)
    bulge = np.mean(growth[:, _FARTHEST] - growth[:, _NEAREST], axis=1)
    close = np.minimum(reach, blur_reach / size)
    middle = np.clip(reach - integral, close[:, None] - reach, reach - close[:, None])
    values = _sample_profiles(image, uv, along, across, offsets, middle, close, samples)
    share = (values - first[..., None]) / rise[..., None]
    count = np.asarray(((share > 0.25) & (share < 0.75)).sum(axis=2), dtype=np.float64)
    width = size * compute_median(count) * 2 * close / (samples - 1)
    low = compute_median(np.where(rising > 0, first, last))
    high = compute_median(np.where(rising > 0, last, first))
    return np.stack([np.mean(growth, axis=1), bulge, width, low, high])


def _sample_profiles(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    offsets: Array,
    middle: Array,
    half: Array,
    samples: int,
) -> Array:
    """Sample grey levels (n, k, samples) from `middle` (n, k) up to `half` (n,) squares to both
    sides across the edges."""
    o = middle[..., None] + half[:, None, None] * np.linspace(-1, 1, samples)
    at = uv[:, None, None] + offsets[:, None, None] * along[:, None, None]
    return sample_image(image, at + o[..., None] * across[:, None, None])
