"""The ends of a board: where the image shows that its squares stop.

In front of the line beyond a lattice's last row the squares alternate; behind it they do not, as
they would if corners had been missed. What the image shows there tells

- on which sides a lattice is all of its board, and on which it may be a part (`find_ends`);
- where its board seems to go on (`find_continuing_sides`);
- that it stands alone, as a board does and patterns do not (`stands_alone`);
- which border lines lie beyond the end, by chance (`drop_stray_lines`).

Where the board leaves the image, or something hides it, nothing is told.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.camera.image_circle import ImageCircle
from calibgui.engine.features.corner_template import (
    estimate_contrast,
    estimate_template,
    orient_corners,
)
from calibgui.engine.features.lattice import (
    MAX_GAP,
    Lattice,
    add_border,
    crop_lattice,
    drop_isolated_and_crop,
    estimate_steps,
    is_large_enough,
    predict_places,
)
from calibgui.engine.images.sampling import sample_image
from calibgui.engine.lattices import grid_map
from calibgui.engine.lattices.numbering import Sides, turn_lattice

MIN_FULL_BORDER = 2 / 3
"""Share of a border line's places in the image below which the line is dropped, where the image
shows that the board ends before it, or where all of its corners are worse described than most.
Fixed by "no margin" of `tests.benchmarks.corner_troubles`:
a patterned ground had 3 corners of 5, by chance."""
_MAX_ALTERNATING_PLACES = 1 / 3
"""Share of the places around a lattice that alternate, beyond which the pattern goes on."""
_IMAGE_BORDER = 4.0
"""Width of the image's border in which no corner is expected to be found, px."""
_END_OFFSET_ALONG = 0.25
"""Distance along a line, from the places of the line beyond the board, at which the squares on
either side of a place are sampled, steps ..."""
_END_OFFSET_ACROSS = 0.2
"""... and the distance across, to inside and outside, steps."""
_CUT_END_OFFSET_ACROSS = 0.5
"""The distance to inside where the outermost squares may be cut, steps."""
_MAX_RELATIVE_BEHIND = 0.15
"""Greatest difference behind the end of a board whose outermost squares may be cut, over that
of the squares in front. At the dark edge of a fisheye's image it was 0.2 to 0.5 behind a line
that was no end."""
_MIN_SQUARE_DIFFERENCE = 0.4
"""Least difference of neighbouring squares, over the contrast of the board's corners, where
squares are seen."""
_MIN_END_PLACES = 3
"""Number of places in the image from which on a line can show that the board ends."""
_MIN_ENDING_PLACES = 0.6
"""Share of a line's places in the image that must show the end."""
_INSIDE_SQUARES = np.array([[0.5, 0.3], [0.5, 0.7], [0.3, 0.5], [0.7, 0.5]])
"""Places at which whole squares beside a corner are sampled, apart from their edges, which blur, or
what lies on the corner, may hide: steps along and across."""
_LINES_THAT_PREDICT = MAX_GAP + 2
"""Number of lines of a lattice, the first, on which places and steps in front of it depend."""
_MIN_ENDS = 2
"""Number of sides on which a lattice that stands alone is seen to end."""


def find_ends(lattice: Lattice, image: GreyImage, circle: ImageCircle | None = None) -> Sides:
    """Find the sides of a lattice on which the image shows that the board ends there.

    Where the board leaves the image, or the `circle` that the lens lights of it, or something hides
    it, that is not seen.
    """
    step = _compute_square_difference(lattice, image)
    top, right, bottom, left = (
        _does_end_above(turn_lattice(lattice, k), image, step, circle=circle) for k in range(4)
    )
    return top, right, bottom, left


def is_whole(lattice: Lattice, image: GreyImage) -> bool:
    """Return whether a lattice has no gap and the image shows that the board ends on all sides."""
    return bool(lattice.found.all()) and all(find_ends(lattice, image))


def find_continuing_sides(lattice: Lattice, image: GreyImage) -> Sides:
    """Find the sides of a lattice beyond which a line of squares goes on alternating as its own do,
    though none of its corners were taken: where the board is seen to end, it does not."""
    step = _compute_square_difference(lattice, image)
    top, right, bottom, left = (
        _does_alternate_above(turn_lattice(lattice, k), image, step) for k in range(4)
    )
    return top, right, bottom, left


def stands_alone(lattice: Lattice, image: GreyImage) -> bool:
    """Return whether a lattice is a rectangle, large enough for a board, that the image shows to
    end on all sides where it does not leave the image, at least on two: patterns that go on, or
    fade out, do not. Up to half of its places in the image may be hidden."""
    if not is_large_enough(lattice):
        return False
    lattice = crop_lattice(lattice)
    step = _compute_square_difference(lattice, image)
    ends = 0
    for quarters in range(4):
        end = _find_end_above(turn_lattice(lattice, quarters), image, step)
        if end is False:
            return False
        ends += bool(end)
    if ends < _MIN_ENDS:
        return False
    gaps = np.argwhere(~lattice.found)
    if not len(gaps):
        return True
    uv = grid_map.fit_grid_map(lattice).locate(gaps.astype(np.float64))
    return int(np.count_nonzero(are_in_image(uv, image.shape))) <= len(lattice)


def does_pattern_continue(lattice: Lattice, image: GreyImage) -> bool:
    """Return whether the pattern goes on around a lattice that could not grow there, because its
    corners look otherwise there."""
    uv = add_border(lattice.uv, 1)
    place, (right, down) = predict_places(uv), estimate_steps(uv)
    around = np.isnan(uv[..., 0]) & np.isfinite(place + right + down).all(axis=2)
    around &= are_in_image(place, image.shape)
    dark = lattice.dark ^ (np.argwhere(around).sum(axis=1) % 2 == 1)
    alternate, _ = estimate_template(lattice, image).match_colours(
        image, place[around], right[around], down[around], dark
    )
    limit = _MAX_ALTERNATING_PLACES * len(alternate)
    return bool(np.count_nonzero(alternate) > limit)


def lies_around(lattice: Lattice, other: Lattice) -> bool:
    """Return whether a lattice has gaps and corners on all sides of another in the image."""
    outer, inner = lattice.uv[lattice.found], other.uv[other.found]
    reaches_beyond = (outer.min(axis=0) < inner.min(axis=0)) & (
        outer.max(axis=0) > inner.max(axis=0)
    )
    return not lattice.found.all() and bool(reaches_beyond.all())


def drop_stray_lines(lattice: Lattice, image: GreyImage) -> Lattice:
    """Drop border lines that are not full, one on each side, and what lies beyond an empty line,
    before which the board is seen to end."""
    found = lattice.found
    if not found.size:
        return lattice
    if not (found.any(axis=0).all() and found.any(axis=1).all()):
        lattice = _drop_beyond_ends(lattice, image)
        found = lattice.found
    least = [MIN_FULL_BORDER * count for count in lattice.shape]
    across, along = np.count_nonzero(found, axis=1), np.count_nonzero(found, axis=0)
    if (across[[0, -1]] >= least[1]).all() and (along[[0, -1]] >= least[0]).all():
        return lattice
    step = _compute_square_difference(lattice, image)
    for quarters in range(4):
        turned = turn_lattice(lattice, quarters)
        if not len(turned.uv):
            continue
        if _is_first_row_sparse(turned, image.shape):
            rest = drop_isolated_and_crop(Lattice(turned.uv[1:], not turned.dark))
            if len(rest) and _does_end_above(rest, image, step, may_be_cut=True):
                lattice = turn_lattice(rest, -quarters)
    return lattice


def _drop_beyond_ends(lattice: Lattice, image: GreyImage) -> Lattice:
    """Drop the lesser part of a lattice beyond a line without a corner before which the board is
    seen to end: it is another board's, or what surrounds this one."""
    step = _compute_square_difference(lattice, image)
    for quarters in range(4):
        turned = turn_lattice(lattice, quarters)
        for row in np.flatnonzero(~turned.found.any(axis=1))[::-1] + 1:
            rest = drop_isolated_and_crop(Lattice(turned.uv[row:], turned.dark ^ bool(row % 2)))
            if 2 * len(rest) <= len(lattice):
                continue
            if _does_end_above(rest, image, step):
                lattice = turn_lattice(rest, -quarters)
            break
    return lattice


def _is_first_row_sparse(lattice: Lattice, shape: tuple[int, ...]) -> bool:
    """Return whether so few of the first row's places in an image of `shape` (h, w) are found as
    in no full border. Where enough of all places are, it need not be known where the others lie."""
    least, first_row = MIN_FULL_BORDER, lattice.found[0]
    seen_count = int(np.count_nonzero(first_row))
    if seen_count / len(first_row) >= least:
        return False
    missing = np.argwhere(~lattice.found[:1]).astype(np.float64)
    uv = grid_map.fit_grid_map(lattice).locate(missing)
    in_image = seen_count + int(np.count_nonzero(are_in_image(uv, shape)))
    return not in_image or seen_count / in_image < least


def _does_alternate_above(lattice: Lattice, image: GreyImage, min_difference: float) -> bool:
    """Return whether the squares above the first row, and those behind them, are seen to alternate
    by `min_difference`, evenly filled, as if corners between them had been missed."""
    differences = _measure_differences_above(lattice, image, _INSIDE_SQUARES).min(axis=(0, 1))
    going_on = differences[np.isfinite(differences)] > min_difference
    if len(going_on) < _MIN_END_PLACES:
        return False
    return bool(going_on.mean() > _MIN_ENDING_PLACES)


def _does_end_above(
    lattice: Lattice,
    image: GreyImage,
    min_difference: float,
    *,
    may_be_cut: bool = False,
    circle: ImageCircle | None = None,
) -> bool:
    """Return whether the squares above the first row are seen in full, and no others behind them.

    In front of the next line the grey levels alternate by `min_difference` from square to square;
    behind it they do not, as they would if corners had been missed. The outermost squares of a
    board that is cut too closely do not reach that line: if that `may_be_cut`, their middle counts
    as well. As little may be seen of it in poor light, its squares behind may not alternate at all.
    """
    return bool(
        _find_end_above(lattice, image, min_difference, may_be_cut=may_be_cut, circle=circle)
    )


def _find_end_above(
    lattice: Lattice,
    image: GreyImage,
    min_difference: float,
    *,
    may_be_cut: bool = False,
    circle: ImageCircle | None = None,
) -> bool | None:
    """Find whether the lattice ends above the first row; None if too little of that is in the
    image to tell. The arguments are those of `_does_end_above`."""
    across = (_END_OFFSET_ACROSS, _CUT_END_OFFSET_ACROSS)
    offsets = np.array([[_END_OFFSET_ALONG, each] for each in across])
    (before, middle), (behind, _) = _measure_differences_above(lattice, image, offsets, circle)
    is_seen = np.isfinite(before + behind)
    if np.count_nonzero(is_seen) < _MIN_END_PLACES:
        return None
    before, middle, behind = before[is_seen], middle[is_seen], behind[is_seen]
    ending = np.mean((before > min_difference) & (behind < min_difference))
    if may_be_cut:
        is_even = (abs(behind) < min_difference) & (behind < _MAX_RELATIVE_BEHIND * middle)
        ending = max(ending, np.mean((middle > min_difference) & is_even))
    return bool(ending > _MIN_ENDING_PLACES)


def _measure_differences_above(
    lattice: Lattice, image: GreyImage, offsets: Array, circle: ImageCircle | None = None
) -> Array:
    """Measure by how much squares differ along the line above the first row.

    Args:
        lattice: the lattice.
        image: grey levels.
        offsets: (m, 2) steps along the line, to either side, and across it, off the line, from its
            places to those that are compared.
        circle: what the lens lights of the image, if that is not all of it.

    Returns:
        (2, m, n) grey levels at the n places that are seen, of the squares in front of the line and
        of those behind it, positive as in a board that goes on.
    """
    uv = add_border(lattice.uv[:_LINES_THAT_PREDICT], 1)
    place = predict_places(uv)[0]
    right, down = (step[0] for step in estimate_steps(uv))
    usable = np.isfinite(place + right + down).all(axis=1) & are_in_image(place, image.shape)
    if circle is not None:
        usable &= circle.contains(place - down)
    left_is_dark = lattice.dark ^ (np.arange(len(place)) % 2 == 0)
    sign = np.where(left_is_dark, 1.0, -1.0)[usable]
    return sign * _compare_squares(image, place[usable], right[usable], down[usable], offsets)


@kernels.with_kernel("board_ends", "compare_squares")
def _compare_squares(
    image: GreyImage, place: Array, right: Array, down: Array, offsets: Array
) -> Array:
    """Compare the squares to either side of places on a line.

    Args:
        image: (h, w) grey levels.
        place: (n, 2) px.
        right, down: (n, 2) steps along the line and across it, px.
        offsets: (m, 2) steps along and across to what is compared.

    Returns:
        (2, m, n) grey levels of the square after less those of the one before, in front of the line
        and, the other way round, behind it; NaN where one of them is not in the image.
    """
    along, across = offsets.T[..., None, None]
    right, down = along * right, across * down
    squares = place + np.stack([down, -down])
    at = np.stack([squares + right, squares - right])
    inside = ((at >= 0) & (at <= np.array(image.shape[::-1]) - 1.0)).all(axis=-1)
    levels = np.where(inside, sample_image(image, at), np.nan)
    return np.asarray((levels[0] - levels[1]) * np.array([1.0, -1.0])[:, None, None])


def _compute_square_difference(lattice: Lattice, image: GreyImage) -> float:
    """Compute the least difference between two squares that are seen, grey levels."""
    contrast = estimate_contrast(orient_corners(lattice), image)
    return _MIN_SQUARE_DIFFERENCE * contrast


def are_in_image(uv: Array, shape: tuple[int, ...]) -> BoolArray:
    """Return a mask (...,) of the positions `uv` (..., 2) px that lie in an image of `shape` (h, w)
    and not too near to its border for a corner to be found."""
    border = _IMAGE_BORDER
    limit = np.array(shape[::-1]) - 1.0 - border
    return np.asarray(np.all((uv > border) & (uv < limit), axis=-1))
