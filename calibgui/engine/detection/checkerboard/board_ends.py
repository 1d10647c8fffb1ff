"""The ends of a board: where the image shows that its squares stop.

In front of the line beyond a lattice's last row the squares alternate; behind it they do not, as
they would if corners had been missed. What the image shows there tells

- on which sides a lattice is all of its board, and on which it may be a part (`find_ends`);
- where its board seems to go on (`find_continuing_sides`);
- that it stands alone, as a board does and patterns do not (`stands_alone`);
- which border lines lie beyond the end, by chance (`drop_stray_lines`);
- that it may be a floor or a cloth on which a board lies (`may_surround_a_board`).

Where the board leaves the image, or something hides it, nothing is told. The limits are in
`thresholds`.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.checkerboard.corner_template import estimate_contrast, orient_corners
from calibgui.engine.detection.checkerboard.numbering import Sides, turn_lattice
from calibgui.engine.detection.checkerboard.thresholds import THRESHOLDS
from calibgui.engine.detection.lattice import (
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

_INSIDE_SQUARES = np.array([[0.5, 0.3], [0.5, 0.7], [0.3, 0.5], [0.7, 0.5]])
"""Places at which whole squares beside a corner are sampled, apart from their edges, which blur, or
what lies on the corner, may hide: steps along and across."""
_LINES_THAT_PREDICT = MAX_GAP + 2
"""Number of lines of a lattice, the first, on which places and steps in front of it depend."""
_MIN_ENDS = 2
"""Number of sides on which a lattice that stands alone is seen to end."""


def find_ends(lattice: Lattice, image: GreyImage) -> Sides:
    """Find the sides of a lattice on which the image shows that the board ends there.

    Where the board leaves the image, or something hides it, that is not seen.
    """
    step = _compute_square_difference(lattice, image)
    top, right, bottom, left = (
        _does_end_above(turn_lattice(lattice, k), image, step) for k in range(4)
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


def may_surround_a_board(lattice: Lattice, image: GreyImage) -> bool:
    """Return whether a lattice goes on to all sides, and something that may be a board lies on it:
    if it has smaller squares, only the finer levels show it."""
    return not lattice.found.all() and not any(find_ends(lattice, image))


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
    limits = THRESHOLDS.verification
    found = lattice.found
    if not found.size:
        return lattice
    if not (found.any(axis=0).all() and found.any(axis=1).all()):
        lattice = _drop_beyond_ends(lattice, image)
        found = lattice.found
    least = [limits.min_full_border * count for count in lattice.shape]
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
    least, first = THRESHOLDS.verification.min_full_border, lattice.found[0]
    found = int(np.count_nonzero(first))
    if found / len(first) >= least:
        return False
    missing = np.argwhere(~lattice.found[:1]).astype(np.float64)
    uv = grid_map.fit_grid_map(lattice).locate(missing)
    in_image = found + int(np.count_nonzero(are_in_image(uv, shape)))
    return not in_image or found / in_image < least


def _does_alternate_above(lattice: Lattice, image: GreyImage, min_difference: float) -> bool:
    """Return whether the squares above the first row, and those behind them, are seen to alternate
    by `min_difference`, evenly filled, as if corners between them had been missed."""
    differences = _measure_differences_above(lattice, image, _INSIDE_SQUARES).min(axis=(0, 1))
    going_on = differences[np.isfinite(differences)] > min_difference
    limits = THRESHOLDS.verification
    if len(going_on) < limits.min_end_places:
        return False
    return bool(going_on.mean() > limits.min_ending_places)


def _does_end_above(
    lattice: Lattice, image: GreyImage, min_difference: float, *, may_be_cut: bool = False
) -> bool:
    """Return whether the squares above the first row are seen in full, and no others behind them.

    In front of the next line the grey levels alternate by `min_difference` from square to square;
    behind it they do not, as they would if corners had been missed. The outermost squares of a
    board that is cut too closely do not reach that line: if that `may_be_cut`, their middle counts
    as well. As little may be seen of it in poor light, its squares behind may not alternate at all.
    """
    return bool(_find_end_above(lattice, image, min_difference, may_be_cut=may_be_cut))


def _find_end_above(
    lattice: Lattice, image: GreyImage, min_difference: float, *, may_be_cut: bool = False
) -> bool | None:
    """Find whether the lattice ends above the first row; None if too little of that is in the
    image to tell. The arguments are those of `_does_end_above`."""
    limits = THRESHOLDS.verification
    across = (limits.end_offset_across, limits.cut_end_offset_across)
    offsets = np.array([[limits.end_offset_along, each] for each in across])
    (before, middle), (behind, _) = _measure_differences_above(lattice, image, offsets)
    seen = np.isfinite(before + behind)
    if np.count_nonzero(seen) < limits.min_end_places:
        return None
    before, middle, behind = before[seen], middle[seen], behind[seen]
    ending = np.mean((before > min_difference) & (behind < min_difference))
    if may_be_cut:
        is_even = (abs(behind) < min_difference) & (behind < limits.max_relative_behind * middle)
        ending = max(ending, np.mean((middle > min_difference) & is_even))
    return bool(ending > limits.min_ending_places)


def _measure_differences_above(lattice: Lattice, image: GreyImage, offsets: Array) -> Array:
    """Measure by how much squares differ along the line above the first row.

    Args:
        lattice: the lattice.
        image: grey levels.
        offsets: (m, 2) steps along the line, to either side, and across it, off the line, from its
            places to those that are compared.

    Returns:
        (2, m, n) grey levels at the n places in the image, of the squares in front of the line and
        of those behind it, positive as in a board that goes on.
    """
    uv = add_border(lattice.uv[:_LINES_THAT_PREDICT], 1)
    place = predict_places(uv)[0]
    right, down = (step[0] for step in estimate_steps(uv))
    usable = np.isfinite(place + right + down).all(axis=1) & are_in_image(place, image.shape)
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
    return THRESHOLDS.verification.min_square_difference * contrast


def are_in_image(uv: Array, shape: tuple[int, ...]) -> BoolArray:
    """Return a mask (...,) of the positions `uv` (..., 2) px that lie in an image of `shape` (h, w)
    and not too near to its border for a corner to be found."""
    border = THRESHOLDS.verification.image_border
    limit = np.array(shape[::-1]) - 1.0 - border
    return np.asarray(np.all((uv > border) & (uv < limit), axis=-1))
