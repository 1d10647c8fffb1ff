"""The corners of an AprilGrid without small dark squares between its tags.

Every tag of the board in view is fitted by its outline (`tag_outlines`): those that were read, and
those that show their number's cells where the others predict them. A tag counts if the fit stays
near, finds a contrast like the others' and leaves no more unexplained than they do, or lies where
they expect it. Of one that a shadow or a reflection crosses, those corners count that lie near
where all that do count expect them; how far they lie from there is put into their covariances.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import (
    Array,
    BoolArray,
    GreyImage,
    IntArray,
    compute_lengths,
    compute_median,
)
from calibgui.engine.boards.april_grid import AprilGrid, TagLayout
from calibgui.engine.corner_fit import verification
from calibgui.engine.corner_fit.verification import MAX_DISPLACEMENT, MAX_RELATIVE_DISPLACEMENT
from calibgui.engine.detection.apriltags.grid_tags import GridTags
from calibgui.engine.detection.apriltags.tag_gap import measure_gap_of_tags
from calibgui.engine.detection.apriltags.tag_ink_spread import (
    SIGMA_OF_MEDIAN,
    measure_corner_moves,
    move_edges_outwards,
)
from calibgui.engine.detection.apriltags.tag_outlines import (
    AROUND,
    TagOutlines,
    fit_tag_outlines,
    follow_shaded_outlines,
)
from calibgui.engine.detection.apriltags.tag_reader import draw_tags, verify_tags
from calibgui.engine.detection.charuco.assembly import FittedCorners
from calibgui.engine.detection.charuco.corners_between_markers import predict_places
from calibgui.engine.detection.charuco.markers import Markers
from calibgui.engine.detection.detector_io import list_rejected_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.corners import RejectedCorner, find_usable_covariances
from calibgui.engine.geometry import homography
from calibgui.engine.images.sampling import make_mesh, sample_image
from calibgui.engine.lattices import board_ends, grid_map

MAX_PLACING_DISTANCE = 1.6
"""Greatest distance of a tag's corners from the middle of the nearest one that was read at which it
is looked for, sides of a tag; that of outlines has the gap in addition."""
_MAX_SQUARE_LEVEL = 0.95
"""Greatest median level in the middle of dark squares, over that of the paper between two tags and
from that of their ink. Sharp it is 0, and 1 of paper; on rendered boards under blurs up to 0.9 of
the gap it was at most 0.87, and at least 1.0 of paper: that is darker between two tags than between
four."""
_MIN_SIGMAS = 4.0
"""Least difference of dark squares from paper, standard deviations of their median level: noise of
25 levels made squares of paper seem darker by 0.07."""
_PATCH = make_mesh(np.array([-1, 0, 1]) / 6, np.array([-1, 0, 1]) / 6).reshape(-1, 2)
"""(9, 2) places whose mean is taken for the level in the middle of a square, the gap or the border,
over the narrower of both: in noise a single place among paper may look darker than the rest."""
_MAX_SHIFT, _MIN_MAX_SHIFT = 1.0, 2.0
"""Greatest distance of a corner from where it was read, widths of the border, or px if that is
more: dark parts end 1 px within the outlines, and blur rounds their corners."""
_MIN_RELATIVE_CONTRAST = 0.1
"""Least contrast of a tag over the median."""
_MAX_RELATIVE_RESIDUAL = 0.05
"""Greatest residual of a tag over its contrast ..."""
_MAX_RESIDUAL_OVER_MEDIAN = 3.0
"""... or over the median residual, whichever is more."""
_SUSPECT_RELATIVE_RESIDUAL = 1.5
"""Residual of a tag over the median, and in contrasts as well, beyond which its corners have to lie
where the others expect them. Of rendered tags in noise it is at most 1.1, under a fisheye 1.5."""


def has_corner_squares(image: GreyImage, tags: Markers[TagLayout], border: float) -> bool:
    """Return whether the small squares between the tags of a board are dark, rather than paper.

    Args:
        image: (h, w) grey levels.
        tags: those that were read.
        border: width of their border, sides of a tag.
    """
    gap = 1 / tags.side - 1
    n = len(tags.corners)
    H = homography.fit_homography(np.broadcast_to(AROUND, (n, 4, 2)), tags.corners, np.ones((n, 4)))
    beyond = 2 * AROUND - 1
    squares = AROUND + gap / 2 * beyond
    middle = np.array([(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)])
    outwards = 2 * middle - 1
    at = np.concatenate([squares, middle + gap / 2 * outwards, middle - border / 2 * outwards])
    at = (at[:, None] + min(border, gap) * _PATCH).reshape(-1, 2)
    levels = sample_image(
        image, homography.apply_homography(H, np.broadcast_to(at, (n, *at.shape)))
    ).reshape(n, 3, 4, len(_PATCH))
    square, paper, ink = np.moveaxis(levels.mean(axis=3), 1, 0)
    paper, ink = np.median(paper, axis=1), np.median(ink, axis=1)
    level = (square - ink[:, None]) / (paper - ink)[:, None]
    # Around the board anything may follow the tags; what lies between two of them is printed.
    between = _find_corners_between(tags.squares)
    seen = level[between] if between.any() else level.ravel()
    usual = float(compute_median(seen))
    deviation = float(compute_median(abs(seen - usual)))
    # Each square is looked at from up to four tags.
    sigma = SIGMA_OF_MEDIAN * deviation / max(len(seen) / 4, 1) ** 0.5
    return usual < min(_MAX_SQUARE_LEVEL, 1 - _MIN_SIGMAS * sigma)


def _find_corners_between(squares: IntArray) -> BoolArray:
    """Return which corners (n, 4) of the tags at `squares` (n, 2) lie within the rows and columns
    of all of them."""
    low, high = squares.min(axis=0), squares.max(axis=0)
    corner = squares[:, None] + AROUND[:, ::-1]
    return np.asarray(((corner > low) & (corner < high + 1)).all(axis=2))


def locate_outlined_corners(
    image: GreyImage,
    levels: GreyImage,
    read: GridTags,
    first: IntArray,
    rows: int,
    gap: float,
) -> tuple[IntArray, FittedCorners, list[RejectedCorner]]:
    """Locate the corners of the tags of a board by their outlines.

    Args:
        image: (h, w) grey levels.
        levels: the same in 8 bits, tags dark on bright.
        read: the print of the tags, and those that were read.
        first: (2,) row and column of tag 0 on the board.
        rows: number of rows of tags.
        gap: between tags, sides of a tag.

    Returns:
        The grid (n, 2) = (row, column) of the corners, their fit, and those that do not count.

    Raises:
        NoBoardError: if too few tags count.
    """
    border = read[0].border / read[0].side
    squares, quads = _list_tags(levels, read, first, rows, gap)
    doubted: list[tuple[FittedCorners, IntArray, Array, Array]] = []
    while True:
        if len(quads) < 2:
            raise NoBoardError(
                "Tags of an AprilGrid were read, but there are no dark squares between them, whose"
                " corners would cross the tags', and too few of the tags have clear outlines.",
                "Take the picture again: sharp, evenly lit, with all of the white around the tags"
                " in view; or print the board with its small dark squares.",
            )
        fit = fit_tag_outlines(image, quads, squares, border, gap)
        good = _find_good_outlines(fit, quads, border)
        corners, grid = _list_corners(fit), _list_grid(squares)
        if good.all():
            good = ~_find_displaced_tags(
                corners, grid, measure_gap_of_tags(squares, fit.corners, gap)
            )
        if good.all():
            break
        bad = np.repeat(~good, 4)
        shaded = follow_shaded_outlines(image, quads[~good], fit.lens_bows[~good], border, gap)
        doubted.append((corners.select(bad), grid[bad], shaded, quads[~good]))
        squares, quads = squares[good], quads[good]
    numbers = read[1].layout.number_squares(squares - first)
    dark = draw_tags(read[0], numbers)
    moves = measure_corner_moves(image, fit, dark, gap)
    corners = corners._replace(
        uv=corners.uv + moves.move.reshape(-1, 2),
        covariance=corners.covariance + moves.covariance.reshape(-1, 2, 2),
    )
    # Where tags were read they are smaller than they are, and the gap between them wider.
    gap = measure_gap_of_tags(squares, corners.uv.reshape(-1, 4, 2), gap)
    all_corners, all_grid = corners, grid
    rejected: list[RejectedCorner] = []
    for unshaded, its_grid, shaded, at in doubted:
        moved = move_edges_outwards(shaded, moves.shift)
        its_corners = unshaded._replace(uv=moved.reshape(-1, 2))
        displacement = _measure_displacements(its_corners.uv, its_grid, corners.uv, grid, gap)
        near = _are_tolerable(its_corners, displacement, border * np.repeat(_measure_sides(at), 4))
        rejected += list_rejected_corners(at.reshape(-1, 2)[~near], "not the outline of a tag")
        all_corners = all_corners.join(its_corners.select(near).widen(displacement[near]))
        all_grid = np.concatenate([all_grid, its_grid[near]])
    return all_grid, all_corners, rejected


def _list_grid(squares: IntArray) -> IntArray:
    """List rows and columns (4 n, 2) of the corners of the tags at `squares` (n, 2)."""
    grid = 2 * squares[:, None] + AROUND[:, ::-1].astype(np.int64)
    return grid.reshape(-1, 2)


def _measure_displacements(
    uv: Array, grid: IntArray, others: Array, their_grid: IntArray, gap: float
) -> Array:
    """Measure how far corners `uv` (n, 2) lie from where the smooth map of `others` (m, 2) expects
    them, (n,) px. Rows and columns of both are given, and the `gap` between tags."""
    pattern = AprilGrid(spacing=gap)
    place, its_place = (
        pattern.locate_points(each.astype(np.float64))[:, ::-1] for each in (their_grid, grid)
    )
    expected = grid_map.fit_cells(np.ascontiguousarray(place), others).locate(its_place)
    return np.asarray(compute_lengths(expected - uv))


def _find_displaced_tags(corners: FittedCorners, grid: IntArray, gap: float) -> BoolArray:
    """Find the tags (n,) of worse fits than most of which a corner lies where the others do not
    expect it: something as bright as the paper may cover a part of their border.

    Args:
        corners: the 4 n corners.
        grid: (4 n, 2) their rows and columns.
        gap: between tags, sides of a tag.
    """
    residuals = np.stack([corners.residual, corners.residual / corners.contrast])
    limit = _SUSPECT_RELATIVE_RESIDUAL * np.median(residuals, axis=1, keepdims=True)
    suspect = np.asarray((residuals > limit).all(axis=0))
    if not suspect.any():
        return np.zeros(len(grid) // 4, dtype=np.bool_)
    sound = corners.select(~suspect)
    off = _measure_displacements(corners.uv, grid, sound.uv, grid[~suspect], gap)
    usual = np.sqrt(np.mean(off[~suspect] ** 2))
    farthest = max(MAX_RELATIVE_DISPLACEMENT * usual, MAX_DISPLACEMENT)
    return np.asarray((suspect & (off > farthest)).reshape(-1, 4).any(axis=1))


def _are_tolerable(corners: FittedCorners, displacement: Array, border: Array) -> BoolArray:
    """Return which corners (n,) of tags whose outlines do not fit are drawn aside by no more than
    corners of checkerboards may be, where a shadow or a reflection crosses an edge; `border` (n,)
    px is the width of the dark along their edges."""
    usable = find_usable_covariances(corners.covariance)
    return np.asarray(usable & (displacement <= verification.limit_fit_shift(border)))


def _measure_sides(quads: Array) -> Array:
    """Measure the shortest sides (n,) of tags (n, 4, 2), px."""
    sides = np.linalg.norm(np.roll(quads, 1, axis=1) - quads, axis=2)
    return np.asarray(sides.min(axis=1))


def _list_tags(
    levels: GreyImage, read: GridTags, first: IntArray, rows: int, gap: float
) -> tuple[IntArray, Array]:
    """List rows and columns (n, 2) of a board's tags, and their corners (n, 4, 2) px."""
    tag_print, tags = read
    numbers = np.arange(rows * tags.layout.cols)
    numbers = numbers[~np.isin(numbers, tags.numbers)]
    if not len(numbers):
        return tags.squares + first, tags.corners
    squares = tags.layout.locate_squares(numbers)
    on_board, wanted = (
        (1 + gap) * which[:, None, ::-1] + AROUND for which in (tags.squares, squares)
    )
    uv, distance = predict_places(wanted.reshape(-1, 2), on_board, tags.corners)
    near = (distance.reshape(-1, 4) < MAX_PLACING_DISTANCE + gap).all(axis=1)
    quads = uv.reshape(-1, 4, 2)
    near &= board_ends.are_in_image(uv, levels.shape).reshape(-1, 4).all(axis=1)
    numbers, squares, quads = numbers[near], squares[near], quads[near]
    seen = verify_tags(levels, quads, tag_print, numbers)
    return (
        np.concatenate([tags.squares, squares[seen]]) + first,
        np.concatenate([tags.corners, quads[seen]]),
    )


def _find_good_outlines(fit: TagOutlines, quads: Array, border: float) -> BoolArray:
    """Return which outlines (n,) count; `quads` (n, 4, 2) px are where they were expected."""
    side = _measure_sides(quads)
    shift = np.linalg.norm(fit.corners - quads, axis=2).max(axis=1)
    contrast = fit.contrast * np.sign(np.median(fit.contrast))
    limit = np.maximum(
        _MAX_RELATIVE_RESIDUAL * contrast, _MAX_RESIDUAL_OVER_MEDIAN * np.median(fit.residual)
    )
    usable = find_usable_covariances(fit.covariance.reshape(-1, 2, 2)).reshape(-1, 4).all(axis=1)
    return np.asarray(
        usable
        & (shift < np.maximum(_MAX_SHIFT * border * side, _MIN_MAX_SHIFT))
        & (contrast > _MIN_RELATIVE_CONTRAST * np.median(contrast))
        & (fit.residual < limit)
    )


def _list_corners(fit: TagOutlines) -> FittedCorners:
    """Return what is known of the corners of the tags, one by one."""
    blur, contrast, residual = (
        np.repeat(values, 4) for values in (fit.blur, abs(fit.contrast), fit.residual)
    )
    return FittedCorners(
        fit.corners.reshape(-1, 2), fit.covariance.reshape(-1, 2, 2), blur, contrast, residual
    )
