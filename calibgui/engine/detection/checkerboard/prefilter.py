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

Where something is printed in the squares the spread tells nothing. Before all that a lattice of
many corners has to fill a part of its rows and columns: through a halftone it winds as through
a board of a thousand corners, most of which are not there.

What these rules expect of edges is a print seen through a good lens. A camera that sharpens to one
side, beats with a screen's pixels or is far out of focus, and marks in the squares, break them on
boards whose every corner is sound. So they do not overrule what no texture shows: a rectangle of
corners, some of which may be hidden, seen to end on all sides that lie in the image
(`stands_alone` of `board_ends`). Of that it is only asked that the lines run straight through it,
not shifted from square to square, and either that its edges are sharp and straight near the
corners and of one print, or that two edges cross at its corners, as those of discs do not in a grid
of circles, and are narrower than waves; if the edges bulge, as marks make them seem to, that they
are sharp, since blur makes discs cross as well.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, GreyImage, compute_lengths, compute_median
from calibgui.engine.detection.checkerboard.board_ends import stands_alone
from calibgui.engine.detection.checkerboard.corner_template import (
    PLAIN_IF_PRINTED,
    OrientedCorners,
    check_crossing,
    is_plain_crossing,
    orient_corners,
)
from calibgui.engine.detection.checkerboard.edge_profiles import (
    EdgeProfiles,
    measure_edge_profiles,
)
from calibgui.engine.detection.checkerboard.thresholds import THRESHOLDS
from calibgui.engine.detection.checkerboard.verification import (
    TOO_BLURRED,
    does_pattern_continue,
)
from calibgui.engine.detection.lattice import Lattice, is_scattered

_NO_CROSSING = "its corners do not look like two crossing edges"
_LIKE_DISCS = "its edges are not straight, like those of discs"
_DOTS_AROUND = "its pattern goes on around it in dots of other sizes"
_LIKE_DOTS = "its squares differ in size like printed dots"
OBJECTIONS_TO_CIRCLES = (_NO_CROSSING, _LIKE_DISCS, _DOTS_AROUND, _LIKE_DOTS)
"""The reasons for which a grid of circles that looks like a checkerboard is refused."""
_MOST = 0.5
"""Share of the spreads that are known if most are."""


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a lattice is no board."""

    shape: tuple[int, int]
    """Rows and columns of the lattice."""
    reason: str
    """The test that it failed, the end of a sentence."""


def is_hopeless(lattice: Lattice, image: GreyImage, plain: float = 0.5) -> bool:
    """Return whether a lattice that may still grow is large enough to tell that it is no board:
    see `find_early_objection`."""
    return bool(find_early_objection(lattice, image, plain))


def find_early_objection(lattice: Lattice, image: GreyImage, plain: float = 0.5) -> str:
    """Find the rule by which a lattice that may still grow is no board's; empty if it could be one,
    or is too small to tell. The arguments are those of `find_objection`."""
    if len(lattice) < THRESHOLDS.prefilter.min_corners_to_tell:
        return ""
    if is_scattered(lattice):
        return "its corners are scattered over far more places"
    return find_objection(lattice, image, is_grown=False, plain=plain)


def is_plausible(
    lattice: Lattice, image: GreyImage, is_grown: bool = True, plain: float = 0.5
) -> bool:
    """Return whether a lattice could be a board's: see `find_objection`."""
    return not find_objection(lattice, image, is_grown, plain)


def find_objection(
    lattice: Lattice, image: GreyImage, is_grown: bool = True, plain: float = 0.5
) -> str:
    """Find the rule by which a lattice is no board's: see the head of this module.

    Args:
        lattice: corners, refined or not.
        image: (h, w) grey levels.
        is_grown: whether the lattice has grown as far as it can, so that a pattern that goes on
            around it counts against it.
        plain: how far from the corners nothing is printed in the squares and on their edges.

    Returns:
        What speaks against it, the end of a sentence; empty if it could be a board's.
    """
    corners = orient_corners(lattice)
    has_area = _compute_areas(corners) > 0
    if not has_area.all():
        corners = corners.select(has_area)
    corners = corners.subsample(THRESHOLDS.prefilter.max_tested_corners)
    if not len(corners.uv):
        return "its squares have no area"
    objection = _judge_edges(lattice, image, corners, is_grown, plain)
    if objection and _is_beyond_doubt(lattice, image, corners, plain):
        return ""
    return objection


def _judge_edges(
    lattice: Lattice, image: GreyImage, corners: OrientedCorners, is_grown: bool, plain: float
) -> str:
    """Find the rule by which the edges at some corners of a lattice are no board's; arguments and
    result as `find_objection`."""
    limits = THRESHOLDS.prefilter
    is_crossing, is_bare = check_crossing(corners, image, plain)
    if not is_crossing:
        return _NO_CROSSING
    edges = _measure_edges(corners, image, plain)
    if _measure_width(edges, corners) > THRESHOLDS.verification.max_edge_blur:
        return TOO_BLURRED
    if not is_bare or plain < 0.5:
        return ""
    if _do_edges_bulge(edges):
        return _LIKE_DISCS
    spreads = _list_spreads(edges)
    deviation = _measure_deviation(spreads)
    is_uneven = deviation > limits.max_spread_inside
    if is_grown and is_uneven and does_pattern_continue(lattice, image):
        return _DOTS_AROUND
    if deviation <= limits.max_spread or rise_steadily(spreads, corners.uv):
        return ""
    return _LIKE_DOTS


def _is_beyond_doubt(
    lattice: Lattice, image: GreyImage, corners: OrientedCorners, plain: float
) -> bool:
    """Return whether a lattice is a board whatever its edges look like away from the corners."""
    if not stands_alone(lattice, image):
        return False
    limits = THRESHOLDS.prefilter
    edges = _measure_edges(corners, image, plain)
    width = _measure_width(edges, corners)
    # Marks in the squares look like a bulge, and blurred discs like crossing edges.
    is_printed = _do_edges_bulge(edges)
    if not is_printed and _measure_unevenness(_list_spreads(edges)) > limits.max_spread_alone:
        return False
    if width <= limits.max_edge_blur_printed:
        near = _measure_edges(corners, image, PLAIN_IF_PRINTED) if is_printed else edges
        height = float(compute_median(np.concatenate(_compute_heights(corners))))
        if not _do_edges_bulge(near) and _is_spread_of_ink(_list_spreads(near), height):
            return True
    max_width = limits.max_edge_blur_printed if is_printed else limits.max_edge_blur_alone
    return width <= max_width and is_plain_crossing(corners, image, is_printed)


def _list_spreads(edges: tuple[EdgeProfiles, EdgeProfiles]) -> Array:
    """List the spread of the dark across the edges in either direction, (n, 2) squares."""
    return np.column_stack([edge.spread for edge in edges])


def _is_spread_of_ink(spreads: Array, height: float) -> bool:
    """Return whether spreads (n, 2) squares, of a typical `height` in px, are known at most
    corners, alike as far as pixels tell, and no greater than that of ink."""
    limits = THRESHOLDS.prefilter
    max_deviation = max(limits.max_spread_inside, limits.spread_error / height)
    return (
        bool(np.isfinite(spreads).mean() > _MOST)
        and max(abs(_compute_known_median(along)) for along in spreads.T) <= limits.max_ink
        and _measure_unevenness(spreads) <= max_deviation
        and have_same_spread(spreads, max_deviation)
    )


def _measure_unevenness(spreads: Array) -> float:
    """Measure the median deviation of spreads (n, 2) squares from the median of their direction, in
    the direction in which it is greater."""
    return max(
        _compute_known_median(abs(along - _compute_known_median(along))) for along in spreads.T
    )


def _do_edges_bulge(edges: tuple[EdgeProfiles, EdgeProfiles]) -> bool:
    """Return whether the dark has spread otherwise away from the corners than near them."""
    limit = THRESHOLDS.prefilter.max_bulge
    return any(abs(_compute_known_median(edge.bulge)) > limit for edge in edges)


def _compute_areas(corners: OrientedCorners) -> Array:
    """Return the areas (n,) of the squares at the corners, px^2."""
    _, right, down, _ = corners
    return np.asarray(abs(right[:, 0] * down[:, 1] - right[:, 1] * down[:, 0]))


def _measure_edges(
    corners: OrientedCorners, image: GreyImage, plain: float
) -> tuple[EdgeProfiles, EdgeProfiles]:
    """Measure profiles across the corners' edges along either direction."""
    uv, right, down, dark = corners
    sign, (over_right, over_down) = np.where(dark, -1.0, 1.0), _compute_heights(corners)
    return (
        measure_edge_profiles(image, uv, right, down, over_right, sign, plain),
        measure_edge_profiles(image, uv, down, right, over_down, sign, plain),
    )


def _measure_width(edges: tuple[EdgeProfiles, EdgeProfiles], corners: OrientedCorners) -> float:
    """Measure the median blur of the edges in the direction in which they are wider, squares."""
    heights = _compute_heights(corners)
    return max(
        float(compute_median(edge.blur / height))
        for edge, height in zip(edges, heights, strict=True)
    )


def _compute_heights(corners: OrientedCorners) -> tuple[Array, Array]:
    """Return the heights (n,) px of the squares over the edges along either direction."""
    area, (_, right, down, _) = _compute_areas(corners), corners
    return area / compute_lengths(right), area / compute_lengths(down)


def have_same_spread(spreads: Array, max_deviation: float) -> bool:
    """Return whether spreads are those of one print.

    Args:
        spreads: (n, 2) spread of the dark across the edges in either direction, squares; NaN where
            it is not known.
        max_deviation: greatest median deviation from the median of their direction, squares.
    """
    return _measure_deviation(spreads) <= max_deviation


def _measure_deviation(spreads: Array) -> float:
    """Measure the median deviation of spreads (n, 2) squares from the median of their direction; it
    is endless where those of both directions differ by more than one print's."""
    middles = np.array([_compute_known_median(along) for along in spreads.T])
    if abs(middles[1] - middles[0]) > THRESHOLDS.prefilter.max_direction_difference:
        return np.inf
    return _compute_known_median(abs(spreads - middles))


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
    return float(compute_median(known)) if len(known) else 0.0
