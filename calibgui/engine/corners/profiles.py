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

from calibgui.engine import opencv
from calibgui.engine.opencv import Image
from calibgui.engine.types import Array

_ALONG = np.array([0.2, 0.3, 0.4])
"""Where on an arm profiles are taken, squares from the corner."""
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
    blur: Array
    """(n,) px."""
    low: Array
    """(n,) grey level of the dark squares."""
    high: Array
    """(n,) grey level of the bright squares."""


def across_edge(
    image: Image,
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
    s = np.concatenate([_ALONG, -_ALONG])
    reach = _REACH * 2 * plain
    o = np.linspace(-reach, reach, _SAMPLES)
    at = uv[:, None, None] + s[:, None, None] * along[:, None, None]
    at = at + o[:, None] * across[:, None, None]
    arm = np.repeat([1.0, -1.0], len(_ALONG))
    rising = sign[:, None] * arm
    values = opencv.sample(image, at)
    first, last = values[..., :_ENDS].mean(axis=2), values[..., -_ENDS:].mean(axis=2)
    rise = (last - first) * rising
    clear = rise > max(_CLEAR * float(np.median(rise)), 0.0)
    rise = np.where(clear, rise * rising, np.inf)[..., None]
    share = (values - first[..., None]) / rise
    integral = (share.sum(axis=2) - share[..., [0, -1]].mean(axis=2)) * (o[1] - o[0])
    spread = np.where(clear.all(axis=1), np.mean((reach - integral) * rising, axis=1), np.nan)
    close = np.minimum(reach, _CLOSE / size)[:, None]
    middle = np.clip(reach - integral, close - reach, reach - close)
    o = middle[..., None] + close[..., None] * np.linspace(-1, 1, _SAMPLES)
    at = uv[:, None, None] + s[:, None, None] * along[:, None, None]
    at = at + o[..., None] * across[:, None, None]
    share = (opencv.sample(image, at) - first[..., None]) / rise
    between = ((share > 0.25) & (share < 0.75)).sum(axis=2) * 2 * close / (_SAMPLES - 1)
    blur = size * np.median(between, axis=1) / _QUARTILES
    low = np.median(np.where(rising > 0, first, last), axis=1)
    high = np.median(np.where(rising > 0, last, first), axis=1)
    return Profile(spread, blur, low, high)
