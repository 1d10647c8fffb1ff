"""Starting values for the edge fit, from grey-level profiles across the edges.

Across an edge, some way along it from the corner, the grey level rises from lo to hi around the
offset e where the edge really lies. From samples over [-R, R], in squares,

    e = R - integral of (I - lo) / (hi - lo),

which averages noise and needs no threshold. Half the difference of e between an edge's two arms
is the overlap or gap w of the squares; what the corner is off the edge drops out. Between 25 and
75 % of the rise the profile of a Gaussian blur is 1.349 standard deviations wide.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.images.sampling import sample

_ALONG = np.array([0.2, 0.3, 0.4, -0.2, -0.3, -0.4])
"""Where on the two arms profiles are taken, squares from the corner."""
_NEAR, _FAR = np.array([0, 3]), np.array([2, 5])
"""Of these the nearest and the farthest."""
_REACH = 0.35
"""R, squares across the edge."""
_CLOSE = 6.0
"""Half width of the profile that tells the blur, px: samples of large squares lie too far apart."""
_SAMPLES = 33
_ENDS = 4
"""Samples at either end that give lo and hi."""
_CLEAR = 0.5
"""Least rise of a profile worth measuring, over the median."""
_QUARTILES = 1.349


class Profile(NamedTuple):
    """What the profiles across one edge of each of n corners say."""

    spread: Array
    """(n,) growth of the dark squares on every side, squares; NaN where the edge is unclear."""
    bulge: Array
    """(n,) the same away from the corner less near it; NaN where the edge is unclear."""
    blur: Array
    """(n,) px."""
    low: Array
    """(n,) grey level of the dark squares."""
    high: Array
    """(n,) grey level of the bright squares."""


class _Edges(NamedTuple):
    """What profiles are taken of: the first arguments of `across_edge`."""

    image: GreyImage
    uv: Array
    along: Array
    across: Array


def across_edge(
    image: GreyImage,
    uv: Array,
    along: Array,
    across: Array,
    size: Array,
    sign: Array,
    plain: float = 0.5,
) -> Profile:
    """Profiles across one edge of each corner, in the direction of the other.

    Args:
        image: (h, w) grey levels.
        uv: (n, 2) corners, px.
        along: (n, 2) step of a square along the edge, px.
        across: (n, 2) step of a square along the other edge, px.
        size: (n,) height of a square over the edge, px.
        sign: (n,) p, +1 where the square towards both steps is bright.
        plain: how far from its edges a square is of one colour, squares.
    """
    edges = _Edges(image, uv, along, across)
    reach = _REACH * 2 * plain
    first, last, total = (_compiled_levels if kernels.COMPILED else _levels)(edges, reach)
    rising = sign[:, None] * np.sign(_ALONG)
    rise = (last - first) * rising
    clear = rise > max(_CLEAR * float(np.median(rise)), 0.0)
    rise = np.where(clear, rise * rising, np.inf)
    integral = (total / (_SAMPLES - 1) - first) / rise * 2 * reach
    growth = np.where(clear.all(axis=1, keepdims=True), (reach - integral) * rising, np.nan)
    bulge = np.mean(growth[:, _FAR] - growth[:, _NEAR], axis=1)
    close = np.minimum(reach, _CLOSE / size)
    middle = np.clip(reach - integral, close[:, None] - reach, reach - close[:, None])
    count = _compiled_between if kernels.COMPILED else _between
    steep = np.median(count(edges, middle, close, first, rise), axis=1)
    blur = size * steep * 2 * close / (_SAMPLES - 1) / _QUARTILES
    low = np.median(np.where(rising > 0, first, last), axis=1)
    high = np.median(np.where(rising > 0, last, first), axis=1)
    return Profile(np.mean(growth, axis=1), bulge, blur, low, high)


def _levels(edges: _Edges, reach: float) -> tuple[Array, Array, Array]:
    """(n, k) grey levels at the first and last ends of the profiles, and the sum over each by the
    trapezoidal rule."""
    n = len(edges.uv)
    values = _sampled(edges, np.zeros((n, len(_ALONG))), np.full(n, reach))
    total = values.sum(axis=2) - values[..., [0, -1]].mean(axis=2)
    return values[..., :_ENDS].mean(axis=2), values[..., -_ENDS:].mean(axis=2), total


def _compiled_levels(edges: _Edges, reach: float) -> tuple[Array, Array, Array]:
    """`_levels` by the compiled kernel."""
    from calibgui.engine.kernels import edge_profiles

    return edge_profiles.levels(*edges, _ALONG, reach, _SAMPLES, _ENDS)


def _between(edges: _Edges, middle: Array, half: Array, first: Array, rise: Array) -> Array:
    """(n, k) how many of the samples around `middle` lie between 25 and 75 % of the rise."""
    share = (_sampled(edges, middle, half) - first[..., None]) / rise[..., None]
    return np.asarray(((share > 0.25) & (share < 0.75)).sum(axis=2), dtype=np.float64)


def _compiled_between(
    edges: _Edges, middle: Array, half: Array, first: Array, rise: Array
) -> Array:
    """`_between` by the compiled kernel."""
    from calibgui.engine.kernels import edge_profiles

    return edge_profiles.between(*edges, _ALONG, middle, half, _SAMPLES, first, rise)


def _sampled(edges: _Edges, middle: Array, half: Array) -> Array:
    """(n, k, samples) grey levels from `middle` (n, k) up to `half` (n,) to both sides, in steps
    across the edge."""
    o = middle[..., None] + half[:, None, None] * np.linspace(-1, 1, _SAMPLES)
    at = edges.uv[:, None, None] + _ALONG[:, None, None] * edges.along[:, None, None]
    return sample(edges.image, at + o[..., None] * edges.across[:, None, None])
