"""Could a lattice be a board's? The edges at some of its corners tell, before any are fitted.

Textures hold many lattices, and to grow, refine and fit them would take long. What alternates like
a board's squares is told from them where the edges cross (`corner_template`), and by profiles
across the edges near that (`edge_profiles`). In squares,

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
from calibgui.engine.detection.checkerboard.corner_template import (
    OrientedCorners,
    check_crossing,
    orient_corners,
)
from calibgui.engine.detection.checkerboard.edge_profiles import EdgeProfiles
from calibgui.engine.detection.checkerboard.thresholds import THRESHOLDS
from calibgui.engine.detection.checkerboard.verification import does_pattern_continue
from calibgui.engine.detection.lattice import MIN_CORNERS, Lattice


def is_hopeless(lattice: Lattice, image: GreyImage, plain: float = 0.5) -> bool:
    """Return whether a lattice that may still grow is large enough to tell that it is no board;
    `plain` as in `is_plausible`."""
    enough = len(lattice) >= MIN_CORNERS
    return enough and not is_plausible(lattice, image, is_grown=False, plain=plain)


def is_plausible(
    lattice: Lattice, image: GreyImage, is_grown: bool = True, plain: float = 0.5
) -> bool:
    """Return whether a lattice could be a board's: see the head of this module.

    Args:
        lattice: corners, refined or not.
        image: (h, w) grey levels.
        is_grown: whether the lattice has grown as far as it can, so that a pattern that goes on
            around it counts against it.
        plain: how far from the corners nothing is printed in the squares and on their edges.
    """
    limits = THRESHOLDS.prefilter
    corners = orient_corners(lattice)
    corners = corners.select(_compute_areas(corners) > 0).subsample(limits.max_tested_corners)
    if not len(corners.uv):
        return False
    is_crossing, is_bare = check_crossing(corners, image)
    edges = _measure_narrow_edges(corners, image, plain) if is_crossing else []
    if not edges or not is_bare or plain < 0.5:
        return bool(edges)
    if any(abs(_compute_known_median(edge.bulge)) > limits.max_bulge for edge in edges):
        return False
    spreads = np.column_stack([edge.spread for edge in edges])
    is_uneven = not have_same_spread(spreads, limits.max_spread_inside)
    if is_grown and is_uneven and does_pattern_continue(lattice, image):
        return False
    return have_same_spread(spreads, limits.max_spread) or rise_steadily(spreads, corners.uv)


def _compute_areas(corners: OrientedCorners) -> Array:
    """Return the areas (n,) of the squares at the corners, px^2."""
    _, right, down, _ = corners
    return np.asarray(abs(right[:, 0] * down[:, 1] - right[:, 1] * down[:, 0]))


def _measure_narrow_edges(
    corners: OrientedCorners, image: GreyImage, plain: float
) -> list[EdgeProfiles]:
    """Measure profiles across the corners' edges in both directions; return none if those in one
    are wider than a board's."""
    uv, right, down, dark = corners
    sign, area = np.where(dark, -1.0, 1.0), _compute_areas(corners)
    profiles = []
    for along, across in ((right, down), (down, right)):
        size = area / np.linalg.norm(along, axis=1)
        edge = edge_profiles.measure_edge_profiles(image, uv, along, across, size, sign, plain)
        if np.median(edge.blur / size) > THRESHOLDS.verification.max_edge_blur:
            return []
        profiles.append(edge)
    return profiles


def have_same_spread(spreads: Array, max_deviation: float) -> bool:
    """Return whether spreads are those of one print.

    Args:
        spreads: (n, 2) spread of the dark across the edges in either direction, squares; NaN where
            it is not known.
        max_deviation: greatest median deviation from the median of their direction, squares.
    """
    middles = np.array([_compute_known_median(along) for along in spreads.T])
    difference = abs(middles[1] - middles[0])
    return _compute_known_median(abs(spreads - middles)) <= max_deviation and bool(
        difference <= THRESHOLDS.prefilter.max_direction_difference
    )


def rise_steadily(spreads: Array, uv: Array) -> bool:
    """Return whether the spreads (n, 2) squares of corners `uv` (n, 2) px are those of one print
    and rise steadily to one side of the image."""
    limits = THRESHOLDS.prefilter
    levelled = spreads.copy()
    place = uv - uv.mean(axis=0)
    for along in levelled.T:
        known = np.isfinite(along)
        terms = np.column_stack([np.ones(len(place)), place])
        along -= place @ np.linalg.lstsq(terms[known], along[known])[0][1:]
    return have_same_spread(spreads, limits.max_rising_spread) and have_same_spread(
        levelled, limits.max_unsteady_spread
    )


def _compute_known_median(values: Array) -> float:
    """Return the median of the values that are known, 0 if none is."""
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else 0.0
