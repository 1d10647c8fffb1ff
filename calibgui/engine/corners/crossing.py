"""Are the corners of a lattice crossings of two edges?

Saddle points between bright and dark places that alternate are also found among discs and in nets
of lines. The typical corner tells them from a board's: noise and what hides a few corners do
not show in it, and its surroundings are those of two blurred edges whose squares overlap or part
by a little. In the coordinates (a, b) along the edges, in squares, it is dark where one or
the other of two events is,

    F((g + a) / s_1) F((g + b) / s_2),    F((g - a) / s_1) F((g - b) / s_2),

with the normal distribution F, the overlap g and the blurs s.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import scipy

from calibgui.engine.corners.appearance import PLACES, Placed, pattern, standard
from calibgui.engine.opencv import Image
from calibgui.engine.types import Array

_BLURS = np.array([0.005, 0.02, 0.04, 0.07, 0.1, 0.14, 0.18, 0.22, 0.27])
"""Of the crossings that it may be, squares."""
_OVERLAPS = np.array([-0.1, -0.08, -0.06, -0.04, -0.02, 0.0, 0.02, 0.04, 0.06, 0.08, 0.1])
"""Of these, squares."""
_FAR, _NEAR = 0.5, 0.25
"""How far from the edges squares are taken to be of one colour: in full, or where something is
printed in them."""
_UNLIKE = 0.011
"""Greatest lack of correlation with the nearest of the crossings ..."""
_PLAIN = 0.005
"""... and of what is near the corner with those that do not overlap, where things are printed."""


def crossed(corners: Placed, image: Image) -> tuple[bool, bool]:
    """Whether the typical one of the corners is the crossing of two edges in `image` as far as its
    squares are of one colour; and whether they are throughout, with nothing printed in them."""
    near = pattern(corners.nearer(_NEAR), image)
    if _unlike(near, _crossings(_NEAR)) > _UNLIKE:
        return False, False
    bare = _unlike(pattern(corners, image), _crossings(_FAR)) <= _UNLIKE
    return bare or _unlike(near, _crossings(_NEAR, overlap=False)) <= _PLAIN, bare


def _unlike(seen: Array, crossings: Array) -> float:
    """Lack of correlation of a pattern (k,) with the nearest of crossings (m, k)."""
    return float(1 - np.max(np.abs(crossings @ seen)) / len(seen))


@cache
def _crossings(plain: float, overlap: bool = True) -> Array:
    """(m, k) what crossings look like to ``appearance.pattern``."""
    overlaps = _OVERLAPS if overlap else np.zeros(1)
    s1, s2, g = (x.reshape(-1, 1) for x in np.meshgrid(_BLURS, _BLURS, overlaps))
    a, b = 2 * plain * PLACES.T
    ndtr = scipy.special.ndtr
    one, other = (ndtr((g + sign * a) / s1) * ndtr((g + sign * b) / s2) for sign in (1, -1))
    return standard(one + other - one * other)
