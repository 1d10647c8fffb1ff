"""Could a lattice be a board's? A glance at some of its corners tells, before any are fitted.

What alternates like a board's squares is told from them where the edges cross (`crossing`), and by
profiles across the edges near that. In squares,

- they are narrow: the crests of waves cross likewise, but across a sine the blur would be 0.25;
- they are straight: the dark has spread as far near the corner as away from it, while discs bulge;
- they are of one print: the dark has spread alike across all that run in one direction, and much
  the same across the others, where a camera may sharpen otherwise; or steadily more to one side,
  where light that grows to the other blinds the camera. The dots of a printed picture grow with
  its tone; where stripes are shifted the edges along them stand where they should, those across
  them do not. Tone may change slowly, and a part of the picture then pass for one print: but
  around that the pattern goes on, in dots that are smaller.

Where something is printed in the squares the spread tells nothing.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.detection.checkerboard import edge_profiles
from calibgui.engine.detection.checkerboard.corner_template import Placed, crossed, placed
from calibgui.engine.detection.checkerboard.edge_profiles import Profile
from calibgui.engine.detection.checkerboard.verification import WIDEST, goes_on
from calibgui.engine.detection.lattice import MIN_CORNERS, Lattice

_ENOUGH = 64
"""Corners, spread over a lattice, that tell what it is made of: as many as boards have."""
_BULGE = 0.02
"""Greatest median difference of the spread away from the corner and near it, squares."""
_SPREADS, _WITHIN = 0.018, 0.006
"""Greatest median deviation of the spreads in one direction from their median, squares: of what
ends where the lattice does, and of a part of a pattern that goes on in another look."""
_RISING, _STEADY = 0.03, 0.004
"""The same of spreads that rise to one side, and of what departs from a steady rise, squares."""
_DIRECTIONS = 0.06
"""Greatest difference of the two directions' medians, squares."""


def hopeless(lattice: Lattice, image: GreyImage) -> bool:
    """Whether a lattice that may still grow is large enough to tell that it is no board's."""
    return len(lattice) >= MIN_CORNERS and not plausible(lattice, image, grown=False)


def plausible(lattice: Lattice, image: GreyImage, grown: bool = True) -> bool:
    """Whether `lattice`, `grown` as far as it can or not, could be a board's in `image`: see the
    head of this module."""
    corners = placed(lattice)
    corners = corners.under(_areas(corners) > 0).some(_ENOUGH)
    if not len(corners.uv):
        return False
    is_crossing, bare = crossed(corners, image)
    edges = _narrow_edges(corners, image) if is_crossing else []
    if not edges or not bare:
        return bool(edges)
    if any(abs(_median(edge.bulge)) > _BULGE for edge in edges):
        return False
    spreads = np.column_stack([edge.spread for edge in edges])
    within = grown and not alike(spreads, _WITHIN) and goes_on(lattice, image)
    return not within and (alike(spreads) or rising(spreads, corners.uv))


def _areas(corners: Placed) -> Array:
    """(n,) of the squares at the corners, px^2."""
    _, right, down, _ = corners
    return np.asarray(abs(right[:, 0] * down[:, 1] - right[:, 1] * down[:, 0]))


def _narrow_edges(corners: Placed, image: GreyImage) -> list[Profile]:
    """Profiles across the corners' edges in both directions; none if those in one are wide."""
    uv, right, down, dark = corners
    sign, area = np.where(dark, -1.0, 1.0), _areas(corners)
    seen = []
    for along, across in ((right, down), (down, right)):
        size = area / np.linalg.norm(along, axis=1)
        edge = edge_profiles.across_edge(image, uv, along, across, size, sign)
        if np.median(edge.blur / size) > WIDEST:
            return []
        seen.append(edge)
    return seen


def alike(spreads: Array, most: float = _SPREADS) -> bool:
    """Whether those of the spreads (n, 2) squares in two directions that are known are those of one
    print, the median deviation being that at `most`."""
    middles = np.array([_median(along) for along in spreads.T])
    apart = abs(middles[1] - middles[0])
    return _median(abs(spreads - middles)) <= most and bool(apart <= _DIRECTIONS)


def rising(spreads: Array, uv: Array) -> bool:
    """Whether the spreads (n, 2) of corners `uv` (n, 2) px are those of one print that rise
    steadily to one side."""
    steady = spreads.copy()
    place = uv - uv.mean(axis=0)
    for along in steady.T:
        known = np.isfinite(along)
        terms = np.column_stack([np.ones(len(place)), place])
        along -= place @ np.linalg.lstsq(terms[known], along[known])[0][1:]
    return alike(spreads, _RISING) and alike(steady, _STEADY)


def _median(values: Array) -> float:
    """Of those that are known, 0 if none is."""
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else 0.0
