"""Could a lattice be a board's? The edges at some of its corners tell, before any are fitted.

Textures hold many lattices, and to grow, refine and fit them would take long. What alternates like
a board's squares is told from them where the edges cross (`corner_template`), and by profiles
across the edges near that (`edge_profiles`). In squares,

- they are narrow: the crests of waves cross likewise, but across a sine the blur would be 0.25;
- they are straight: the dark has spread as far near the corner as away from it, while discs bulge;
- they are of one print: the dark has spread alike across all that run in one direction, and much
  the same across the others, where a camera may sharpen otherwise. The dots of a printed picture
  grow with its tone; where stripes are shifted the edges along them stand where they should, those
  across them do not. Tone may change slowly, and a part of the picture then pass for one print: but
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

That squares differ in size is a witness only: those of a board that is cut by hand or seen by a
thermal camera do. A picture in dots is taken for a board of any size, but hardly for the stated
one, which therefore overrules it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, GreyImage, GridSize, compute_lengths, compute_median
from calibgui.engine.features.corner_template import (
    BARE_REACH_IF_PRINTED,
    OrientedCorners,
    check_crossing,
    is_plain_crossing,
    orient_corners,
)
from calibgui.engine.features.edge_profiles import EdgeProfiles, measure_edge_profiles
from calibgui.engine.features.lattice import Lattice, is_scattered
from calibgui.engine.lattices.board_ends import does_pattern_continue, stands_alone

MIN_CORNERS_TO_TELL = 12
"""Number of corners from which on a lattice that may still grow is tested."""
_MAX_TESTED_CORNERS = 64
"""Number of corners, spread over the lattice, whose edges are measured: as many as boards
have."""
_MAX_BULGE = 0.02
"""Greatest median difference of the edge's place away from the corner and near it, squares:
edges of boards stay below 0.01, those of discs exceed 0.05. Fixed by the "discs"."""
MAX_SPREAD = 0.018
"""Greatest median deviation of the spreads in one direction from their median, squares, where
the pattern ends with the lattice. Fixed by the "halftone" and the "stripes" ..."""
_MAX_SPREAD_INSIDE = 0.006
"""... and where the pattern goes on around the lattice in another look, squares. Fixed by the
"halftone"."""
MAX_EDGE_BLUR_ALONE = 0.23
"""Greatest median blur of the edges of a lattice that stands alone, as no waves do,
squares ..."""
_MAX_EDGE_BLUR_PRINTED = 0.1
"""... and where its edges seem to bulge: those of discs blurred more cross in a point."""
_MAX_SPREAD_ALONE = 0.06
"""Greatest median deviation of the spreads in either direction of a lattice that stands alone,
squares: moire and halos cause 0.04, rows that are shifted by a fifth of a square 0.1."""
_SPREAD_ERROR = 0.1
"""Deviation of spreads that is not told from the error of measuring them, px: in squares of 8
to 16 px, noisy, filtered or compressed, that is up to 0.1."""
_MAX_INK = 0.1
"""Greatest median spread of the ink of such a lattice, squares."""
_MAX_DIRECTION_DIFFERENCE = 0.06
"""Greatest difference of the median spreads in the two directions, squares: cameras sharpen
rows otherwise than columns. Fixed by the "stripes"."""
MAX_EDGE_BLUR = 0.18
"""Greatest median blur of a board's edges, squares: that of a sine wave would be 0.25. Fixed by
the "waves"."""
TOO_BLURRED = "its edges are too blurred or too ragged for a board's"
"""What speaks against a lattice of wide edges."""
_NO_CROSSING = "its corners do not look like two crossing edges"
_LIKE_DISCS = "its edges are not straight, like those of discs"
_DOTS_AROUND = "its pattern goes on around it in dots of other sizes"
LIKE_DOTS = "its squares differ in size like printed dots"
"""Reason to refuse a lattice whose size is not stated."""
OBJECTIONS_TO_CIRCLES = (_NO_CROSSING, _LIKE_DISCS, _DOTS_AROUND)
"""The reasons for which a grid of circles that looks like a checkerboard is refused."""
_MOST = 0.5
"""Share of the spreads that are known if most are."""


@dataclass(frozen=True, slots=True)
class Refusal:
    """The reasons why a lattice is no board."""

    shape: tuple[int, int]
    """Rows and columns of the lattice."""
    reason: str
    """The test that it failed, the end of a sentence."""


def is_hopeless(
    lattice: Lattice,
    image: GreyImage,
    bare_reach: float = 0.5,
    grid_size: GridSize | None = None,
) -> bool:
    """Return whether a lattice that may still grow is large enough to tell that it is no board:
    see `find_early_objection`."""
    return bool(find_early_objection(lattice, image, bare_reach, grid_size))


def find_early_objection(
    lattice: Lattice,
    image: GreyImage,
    bare_reach: float = 0.5,
    grid_size: GridSize | None = None,
) -> str:
    """Find the rule by which a lattice that may still grow is no board's; empty if it could be one,
    or is too small to tell. The arguments are those of `find_objection`."""
    if len(lattice) < MIN_CORNERS_TO_TELL:
        return ""
    if is_scattered(lattice):
        return "its corners are scattered over far more places"
    return find_objection(lattice, image, False, bare_reach, grid_size)


def is_plausible(
    lattice: Lattice, image: GreyImage, is_grown: bool = True, bare_reach: float = 0.5
) -> bool:
    """Return whether a lattice could be a board's: see `find_objection`."""
    return not find_objection(lattice, image, is_grown, bare_reach)


def find_objection(
    lattice: Lattice,
    image: GreyImage,
    is_grown: bool = True,
    bare_reach: float = 0.5,
    grid_size: GridSize | None = None,
) -> str:
    """Find the rule by which a lattice is no board's: see the head of this module.

    Args:
        lattice: corners, refined or not.
        image: (h, w) grey levels.
        is_grown: whether the lattice has grown as far as it can, so that a pattern that goes on
            around it counts against it.
        bare_reach: how far from the corners nothing is printed in the squares and on their edges.
        grid_size: rows and columns of the board, if stated.

    Returns:
        What speaks against it, the end of a sentence; empty if it could be a board's.
    """
    corners = orient_corners(lattice)
    has_area = _compute_areas(corners) > 0
    if not has_area.all():
        corners = corners.select(has_area)
    corners = corners.subsample(_MAX_TESTED_CORNERS)
    if not len(corners.uv):
        return "its squares have no area"
    objection = _judge_edges(lattice, image, corners, is_grown, bare_reach)
    if objection == LIKE_DOTS and _may_be_stated(lattice, grid_size, is_grown):
        return ""
    if objection and _is_beyond_doubt(lattice, image, corners, bare_reach):
        return ""
    return objection


def _judge_edges(
    lattice: Lattice, image: GreyImage, corners: OrientedCorners, is_grown: bool, bare_reach: float
) -> str:
    """Find the rule by which the edges at some corners of a lattice are no board's; arguments and
    result as `find_objection`."""
    is_crossing, is_bare = check_crossing(corners, image, bare_reach)
    if not is_crossing:
        return _NO_CROSSING
    edges = _measure_edges(corners, image, bare_reach)
    if _measure_width(edges, corners) > MAX_EDGE_BLUR:
        return TOO_BLURRED
    if not is_bare or bare_reach < 0.5:
        return ""
    if _do_edges_bulge(edges):
        return _LIKE_DISCS
    spreads = _list_spreads(edges)
    deviation = _measure_deviation(spreads)
    is_uneven = deviation > _MAX_SPREAD_INSIDE
    if is_grown and is_uneven and does_pattern_continue(lattice, image):
        return _DOTS_AROUND
    return "" if deviation <= MAX_SPREAD else LIKE_DOTS


def _may_be_stated(lattice: Lattice, grid_size: GridSize | None, is_grown: bool) -> bool:
    """Return whether a lattice has the stated size, or may grow to it."""
    if grid_size is None:
        return False
    pairs = zip(sorted(lattice.shape), sorted(grid_size), strict=True)
    return all(have == want or (have < want and not is_grown) for have, want in pairs)


def _is_beyond_doubt(
    lattice: Lattice, image: GreyImage, corners: OrientedCorners, bare_reach: float
) -> bool:
    """Return whether a lattice is a board whatever its edges look like away from the corners."""
    if not stands_alone(lattice, image):
        return False
    edges = _measure_edges(corners, image, bare_reach)
    width = _measure_width(edges, corners)
    # Marks in the squares look like a bulge, and blurred discs like crossing edges.
    is_printed = _do_edges_bulge(edges)
    if not is_printed and _measure_unevenness(_list_spreads(edges)) > _MAX_SPREAD_ALONE:
        return False
    if width <= _MAX_EDGE_BLUR_PRINTED:
        near = _measure_edges(corners, image, BARE_REACH_IF_PRINTED) if is_printed else edges
        height = float(compute_median(np.concatenate(_compute_heights(corners))))
        if not _do_edges_bulge(near) and _is_spread_of_ink(_list_spreads(near), height):
            return True
    max_width = _MAX_EDGE_BLUR_PRINTED if is_printed else MAX_EDGE_BLUR_ALONE
    return width <= max_width and is_plain_crossing(corners, image, is_printed)


def _list_spreads(edges: tuple[EdgeProfiles, EdgeProfiles]) -> Array:
    """List the spread of the dark across the edges in either direction, (n, 2) squares."""
    return np.column_stack([edge.spread for edge in edges])


def _is_spread_of_ink(spreads: Array, height: float) -> bool:
    """Return whether spreads (n, 2) squares, of a typical `height` in px, are known at most
    corners, alike as far as pixels tell, and no greater than that of ink."""
    max_deviation = max(_MAX_SPREAD_INSIDE, _SPREAD_ERROR / height)
    return (
        bool(np.isfinite(spreads).mean() > _MOST)
        and max(abs(_compute_known_median(along)) for along in spreads.T) <= _MAX_INK
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
    limit = _MAX_BULGE
    return any(abs(_compute_known_median(edge.bulge)) > limit for edge in edges)


def _compute_areas(corners: OrientedCorners) -> Array:
    """Return the areas (n,) of the squares at the corners, px^2."""
    _, right, down, _ = corners
    return np.asarray(abs(right[:, 0] * down[:, 1] - right[:, 1] * down[:, 0]))


def _measure_edges(
    corners: OrientedCorners, image: GreyImage, bare_reach: float
) -> tuple[EdgeProfiles, EdgeProfiles]:
    """Measure profiles across the corners' edges along either direction."""
    uv, right, down, dark = corners
    sign, (over_right, over_down) = np.where(dark, -1.0, 1.0), _compute_heights(corners)
    return (
        measure_edge_profiles(image, uv, right, down, over_right, sign, bare_reach),
        measure_edge_profiles(image, uv, down, right, over_down, sign, bare_reach),
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
    if abs(middles[1] - middles[0]) > _MAX_DIRECTION_DIFFERENCE:
        return np.inf
    return _compute_known_median(abs(spreads - middles))


def _compute_known_median(values: Array) -> float:
    """Return the median of the values that are known, 0 if none is."""
    known = values[np.isfinite(values)]
    return float(compute_median(known)) if len(known) else 0.0
