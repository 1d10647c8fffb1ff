"""The detector of AprilGrids: the tags tell which corner is which.

1. The tags are read and placed on the board (`grid_tags`); what is not stated of family, border,
   order and size shows in them.
2. The corners of all tags are predicted from the nearest ones that were read, and moved to their
   saddle points.
   Where no small black squares touch the tags, their corners follow from the outlines of the tags
   instead (`outlined_corners`).
3. A corner has to look like the others, to lie where the map of all corners expects it, and to be
   described by two crossing edges. Around it a border of the tag, a part of the gap and the small
   black square are plain: nothing beyond them is looked at.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, BoolArray, GreyImage, GridSize, IntArray, compute_median
from calibgui.engine.boards.april_grid import MAX_GAP_BETWEEN_SQUARES, AprilGrid, TagLayout
from calibgui.engine.corner_fit import verification, x_corner_fit
from calibgui.engine.corner_fit.board_priors import ScatteredPriors
from calibgui.engine.corner_fit.robust_fit import fit_robustly
from calibgui.engine.corner_fit.x_corner_fit import XCornerFit
from calibgui.engine.detection.apriltags.grid_tags import (
    GridTagFinder,
    GridTags,
    find_grid_tags,
)
from calibgui.engine.detection.apriltags.outlined_corners import (
    MAX_PLACING_DISTANCE,
    has_corner_squares,
    locate_outlined_corners,
)
from calibgui.engine.detection.apriltags.tag_gap import (
    explain_wide_gap,
    fit_gap,
    measure_gap,
    measure_gap_of_tags,
)
from calibgui.engine.detection.charuco.assembly import FittedCorners, assemble_corners
from calibgui.engine.detection.charuco.corners_between_markers import (
    predict_places,
    require_enough_corners,
)
from calibgui.engine.detection.charuco.markers import Markers
from calibgui.engine.detection.detector_io import (
    check_grey_levels,
    convert_for_reading,
    invert_levels,
    list_rejected_corners,
)
from calibgui.engine.errors import NoBoardError, UnknownPartError
from calibgui.engine.features import saddle
from calibgui.engine.features.corner_template import OrientedCorners, estimate_template_of
from calibgui.engine.features.corners import Corners, RejectedCorner
from calibgui.engine.features.lattice import MAX_DEVIATION, Lattice
from calibgui.engine.lattices import board_ends, grid_map
from calibgui.engine.lattices import region_of_interest as region

_MIN_MAPPED_CORNERS = 4
"""Number of corners up to which none is left out of their map: it follows any four."""
_MAX_SPACING_DIFFERENCE = 0.05
"""Greatest difference of the measured gap from the stated one, sides of a tag."""
_MAX_BLUR = 1 / 3
"""Greatest median blur, gaps between tags: at more, corners of rendered boards were up to 0.8 px
rms off."""
_FELT_BLUR = 0.24
"""Blur, gaps, from which on what lies across the gap draws corners aside: by 0.03 blurs at 0.27 and
by 0.1 at 1/3, on rendered boards with and without small squares."""
_MAX_SHIFT = 1 / 3
"""Greatest distance of a corner from where it is predicted, sides of the plain square around it."""


def find_april_grid(
    image: npt.ArrayLike,
    pattern: AprilGrid,
    grid_size: GridSize | None = None,
    roi: npt.ArrayLike | None = None,
    method: str = "edges",
) -> Corners:
    """Locate the corners of the tags of an AprilGrid in an image; see ``find_corners``."""
    grey = check_grey_levels(image)
    outline = None if roi is None else region.check_outline(roi)
    searched = None if outline is None else region.enlarge_outline(outline)
    levels = convert_for_reading(grey)
    finder = GridTagFinder(levels, searched)
    negative = GridTagFinder(levels, searched, finder)
    grid_tags = find_grid_tags([finder, negative], pattern, grid_size)
    if grid_tags is None:
        if pattern == AprilGrid() and grid_size is None:
            raise _describe_nothing()  # there is no board whatever were stated
        raise _explain_missing_board(levels, grid_size, finder)
    read, which = grid_tags
    return _locate_corners(grey, levels, read, which == 1, pattern, grid_size, outline, method)


def _explain_missing_board(
    levels: GreyImage, grid_size: GridSize | None, finder: GridTagFinder
) -> NoBoardError:
    """Return the error that says what an image, in 8 bits, shows instead of the stated board."""
    grid_tags = find_grid_tags([finder], AprilGrid(), None)
    if grid_tags is None:
        return _describe_nothing()
    tag_print, tags = grid_tags[0]
    cols, rows = tags.layout.cols, _count_rows(tags.squares)
    order = "top row down" if tags.layout.from_top else "bottom row up"
    first = int(tags.numbers.min())
    order += f", with no number below {first}" if first else ""
    order += f", each tag turned by {90 * tag_print.turn} degrees" if tag_print.turn else ""
    has_squares = has_corner_squares(levels, tags, tag_print.border / tag_print.side)
    stated = "" if grid_size is None else f", not {grid_size[0]} x {grid_size[1]} corners"
    return NoBoardError(
        f"This is an AprilGrid of {tag_print.family} with borders of {tag_print.border} cells,"
        f" numbered from the {order}, of at least {rows} rows and exactly {cols} columns of tags,"
        f" two corners each{stated}, {'with' if has_squares else 'without'} dark squares between"
        " the tags.",
        "State the board like this, the number of its first tag if that is not 0, or leave out what"
        " can be read.",
    )


def _describe_nothing() -> NoBoardError:
    """Return the error that says that an image shows no AprilGrid."""
    return NoBoardError(
        "No AprilGrid was found.",
        "Take the picture again: two rows of tags or more in view, sharp, evenly lit and near"
        " enough to be read.",
    )


def _count_rows(squares: IntArray) -> int:
    """Return the least number of rows of tags of a board that shows those at `squares` (n, 2)."""
    return int(np.abs(squares[:, 0]).max()) + 1


def _locate_corners(
    grey: GreyImage,
    levels: GreyImage,
    read: GridTags,
    is_inverted: bool,
    stated: AprilGrid,
    grid_size: GridSize | None,
    outline: Array | None,
    method: str,
) -> Corners:
    """Locate the corners of a board whose tags were read in `levels`, the image in 8 bits."""
    if stated.first_tag is None and (first := _tell_first_tag(read[1], grid_size, grey, outline)):
        read = read[0], _number_from(read[1], first)
    tag_print, tags = read
    rows, cols = _count_rows(tags.squares), tags.layout.cols
    if grid_size is not None:
        if 2 * rows > grid_size[0]:
            raise _explain_missing_board(levels, grid_size, GridTagFinder(levels, None))
        rows = grid_size[0] // 2
    start = np.array([0 if tags.layout.from_top else rows - 1, 0])
    on_board = tags.squares + start
    gap = min(1 / tags.side - 1, 1.0)  # as measured
    size = 2 * rows, 2 * cols
    border = tag_print.border / tag_print.side
    has_squares = has_corner_squares(grey, tags, border)
    if stated.corner_squares not in (None, has_squares):
        raise _explain_missing_board(levels, grid_size, GridTagFinder(levels, None))
    fit: XCornerFit | FittedCorners | None = None
    if has_squares:
        lattice = _predict_corners(grey, tags.corners, on_board, size, gap, is_inverted)
        lattice = _refine_corners(grey, lattice, gap, border)
        gap = measure_gap(lattice.uv, gap)
        if gap > MAX_GAP_BETWEEN_SQUARES:
            raise explain_wide_gap()
        unit = 2 * min(border, gap / 2)
        lattice, rejected = _verify_corners(grey, lattice, gap, unit)
        if method == "edges":
            lattice, fit, failing = _fit_corners(grey, lattice, gap, unit)
            rejected += failing
    else:
        dark_tags = invert_levels(levels) if is_inverted else levels
        gap = measure_gap_of_tags(on_board, tags.corners, gap)
        uv, fit, rejected = _fit_outlines(grey, dark_tags, read, size, start, gap)
        lattice = Lattice(uv, dark=not is_inverted)
        gap = measure_gap(lattice.uv, gap)
    require_enough_corners(lattice)
    if fit is not None:
        fit = fit.widen(_estimate_pull_across_gaps(lattice, fit, gap))
    uv = lattice.uv[lattice.found] if fit is None else fit.uv
    gap = fit_gap(np.argwhere(lattice.found), uv, gap)
    if stated.spacing is not None and abs(gap - stated.spacing) > _MAX_SPACING_DIFFERENCE:
        raise NoBoardError(
            f"The gap between the tags is {gap:.3f} of their side, not {stated.spacing:g}.",
            "State gap and side as measured, or leave the gap out.",
        )
    measured = AprilGrid(
        tag_print.family,
        round(gap, 5),
        tag_print.border,
        tags.layout.from_top,
        has_squares,
        tags.layout.first or stated.first_tag,
        tag_print.turn or stated.tag_turn,
    )
    return assemble_corners(grey, lattice, fit, outline, rejected, measured)


def _tell_first_tag(
    tags: Markers[TagLayout], grid_size: GridSize | None, grey: GreyImage, outline: Array | None
) -> int:
    """Tell the number of the first tag of a board from tags that were read as if it were 0.

    It is another one if as many rows are seen as the board has, and higher ones than it would have;
    or, of a board of any size, if the image shows that there are no tags before those read, which
    otherwise were hidden: more rows of them than are seen.
    """
    row = np.abs(tags.squares[:, 0])
    lowest, seen = int(row.min()), int(np.ptp(row)) + 1
    if grid_size is not None:
        is_other = 2 * (lowest + seen) > grid_size[0] == 2 * seen
    else:
        beside = tags.squares[row == lowest] + [-1 if tags.layout.from_top else 1, 0]
        missing = replace(tags, squares=beside)
        uv, _ = predict_places(
            missing.board_corners.reshape(-1, 2), tags.board_corners, tags.corners
        )
        is_bare = outline is None and bool(board_ends.are_in_image(uv, grey.shape).all())
        is_other = is_bare and lowest >= seen
    return lowest * tags.layout.cols if is_other else 0


def _number_from(tags: Markers[TagLayout], first: int) -> Markers[TagLayout]:
    """Return tags on a board whose first one has the number `first`."""
    layout = tags.layout._replace(first=first)
    return replace(tags, layout=layout, squares=layout.locate_squares(tags.numbers))


def _estimate_pull_across_gaps(
    lattice: Lattice, fit: XCornerFit | FittedCorners, gap: float
) -> Array:
    """Estimate how far (n,) px corners are drawn aside by what is blurred into them from across the
    `gap` between tags.

    Raises:
        UnknownPartError: the tags are blurred into each other.
    """
    steps, _ = ScatteredPriors(_locate_places(lattice, gap), gap).estimate_geometry(fit.uv)
    blurs = fit.blur / np.sqrt(np.abs(np.linalg.det(steps)))
    if compute_median(blurs) > _MAX_BLUR:
        raise UnknownPartError(
            "The gaps between the tags are so narrow in this image, and so blurred, that the"
            " tags' corners cannot be told from each other.",
            "Take the picture again: sharper, or nearer to the board.",
        )
    return np.maximum(blurs - _FELT_BLUR, 0.0) * fit.blur


def _fit_outlines(
    grey: GreyImage,
    levels: GreyImage,
    read: GridTags,
    grid_size: GridSize,
    first: IntArray,
    gap: float,
) -> tuple[Array, FittedCorners, list[RejectedCorner]]:
    """Fit the outlines of the tags, leaving out the corners that do not lie where the others expect
    them.

    Args:
        grey: (h, w) grey levels.
        levels: the same in 8 bits, tags dark on bright.
        read: the tags that were read.
        grid_size: rows and columns of corners.
        first: (2,) row and column of tag 0 on the board.
        gap: between tags, sides of a tag.

    Returns:
        The corners (rows, cols, 2) px, NaN where there is none, their fit, and those left out.
    """
    grid, fit, rejected = locate_outlined_corners(grey, levels, read, first, grid_size[0] // 2, gap)
    order = np.lexsort(grid.T[::-1])
    grid, fit = grid[order], fit.select(order)
    places = AprilGrid(spacing=gap).locate_points(grid.astype(np.float64))
    steps, _ = ScatteredPriors(places, 2 * gap).estimate_geometry(fit.uv)
    length = np.linalg.norm(steps, axis=2).min(axis=1)
    good = _find_regular_corners(places, fit.uv, length, np.ones(len(grid), dtype=np.bool_))
    rejected += list_rejected_corners(fit.uv[~good], "off place")
    uv = np.full((*grid_size, 2), np.nan)
    uv[tuple(grid[good].T)] = fit.uv[good]
    return uv, fit.select(np.flatnonzero(good)), rejected


def _locate_places(lattice: Lattice, gap: float) -> Array:
    """Return (X, Y) (n, 2) on the board of the corners of a lattice, sides of a tag."""
    return AprilGrid(spacing=gap).locate_points(np.argwhere(lattice.found).astype(np.float64))


def _predict_corners(
    image: GreyImage,
    corners: Array,
    squares: IntArray,
    grid_size: GridSize,
    gap: float,
    is_inverted: bool,
) -> Lattice:
    """Place the corners of all tags where the nearest ones that were read predict them.

    Args:
        image: (h, w) grey levels; corners outside of it are left out.
        corners: (n, 4, 2) px, of the tags that were read.
        squares: (n, 2) rows and columns of these.
        grid_size: rows and columns of corners.
        gap: between tags, sides of a tag.
        is_inverted: True if the tags are bright on dark.
    """
    grid = np.indices(grid_size).reshape(2, -1).T.astype(np.float64)
    places = AprilGrid(spacing=gap).locate_points(grid)
    around = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    on_board = (1 + gap) * squares[:, None, ::-1] + around
    uv, distance = predict_places(places, on_board, corners)
    is_expected = (distance < MAX_PLACING_DISTANCE) & board_ends.are_in_image(uv, image.shape)
    uv[~is_expected] = np.nan
    uv = uv.reshape(*grid_size, 2)
    for (row, col), quad in zip(squares.tolist(), corners, strict=True):
        block = uv[2 * row : 2 * row + 2, 2 * col : 2 * col + 2]
        block[...] = quad[[0, 1, 3, 2]].reshape(2, 2, 2)
    return Lattice(uv, dark=not is_inverted)


def _refine_corners(image: GreyImage, predicted: Lattice, gap: float, border: float) -> Lattice:
    """Move corners to their saddle points, those that have none where they are predicted from where
    the map of the others expects them; those that have none there either are left out."""
    found, start = predicted.found, predicted.uv[predicted.found]
    places = _locate_places(predicted, gap)
    steps, _ = ScatteredPriors(places, 2 * min(border, gap / 2)).estimate_geometry(start)
    length = np.linalg.norm(steps, axis=2).min(axis=1)
    uv, good = saddle.refine_saddles(
        image, start, saddle.choose_weight_sigma(length), _MAX_SHIFT * length
    )
    if _MIN_MAPPED_CORNERS < np.count_nonzero(good) < len(good):
        good = _find_regular_corners(places, uv, length, good)
        expected = grid_map.fit_cells(places[good][:, ::-1], uv[good]).locate(places[:, ::-1])
        lost = np.flatnonzero(~good & board_ends.are_in_image(expected, image.shape))
        uv[lost], good[lost] = saddle.refine_saddles(
            image,
            expected[lost],
            saddle.choose_weight_sigma(length[lost]),
            _MAX_SHIFT * length[lost],
        )
    refined = predicted.uv.copy()
    refined[found] = np.where(good[:, None], uv, np.nan)
    lattice = Lattice(refined, predicted.dark)
    require_enough_corners(lattice)
    return lattice


def _verify_corners(
    image: GreyImage, lattice: Lattice, gap: float, unit: float
) -> tuple[Lattice, list[RejectedCorner]]:
    """Verify that corners look like the others and lie where the map of all expects them.

    Returns:
        The corners that pass, and those that do not.
    """
    found = lattice.found
    places, uv = _locate_places(lattice, gap), lattice.uv[found]
    steps, _ = ScatteredPriors(places, unit).estimate_geometry(uv)
    parity = np.argwhere(found).sum(axis=1) % 2 == 1
    corners = OrientedCorners(uv, steps[:, 0], steps[:, 1], lattice.dark ^ parity)
    good, _ = estimate_template_of(corners, image).match(image, *corners)
    length = np.linalg.norm(steps, axis=2).min(axis=1)
    good &= _find_regular_corners(places, uv, length, good)
    rejected = list_rejected_corners(uv[~good], "off place or colours")
    found[found] = good
    lattice = lattice.select(found)
    require_enough_corners(lattice)
    return lattice, rejected


def _find_regular_corners(places: Array, uv: Array, length: Array, good: BoolArray) -> BoolArray:
    """Find the corners that lie where the map of all good ones expects them.

    The worst is left out and the map fitted again until all are near.

    Args:
        places: (n, 2) on the board.
        uv: (n, 2) px.
        length: (n,) px, side of the plain square around each.
        good: (n,) those that may be.
    """
    good = good.copy()
    while np.count_nonzero(good) > _MIN_MAPPED_CORNERS:
        expected = grid_map.fit_cells(places[good][:, ::-1], uv[good]).locate(places[:, ::-1])
        off = np.linalg.norm(uv - expected, axis=1) / length
        worst = int(np.argmax(np.where(good, off, 0.0)))
        if off[worst] <= MAX_DEVIATION:
            break
        good[worst] = False
    return good


def _fit_corners(
    image: GreyImage, lattice: Lattice, gap: float, unit: float
) -> tuple[Lattice, XCornerFit, list[RejectedCorner]]:
    """Fit the model of two crossing edges, leaving out the corners that it does not describe.

    Returns:
        The corners that the model describes, their fit, and the others.

    Raises:
        NoBoardError: if too few corners are left.
    """
    rejected: list[RejectedCorner] = []
    while True:
        require_enough_corners(lattice)
        found, uv = lattice.found, lattice.uv[lattice.found]
        fit, displacement = fit_robustly(
            lattice,
            lambda part: _fit_all_corners(image, part, gap, unit),
            lambda part: _locate_places(part, gap)[:, ::-1] / unit,
        )
        described = verification.find_described_corners(fit, lattice, displacement)
        near = verification.find_tolerable_displacements(displacement, lattice)
        good = described & near
        if good.all():
            return lattice, fit.widen(displacement), rejected
        rejected += list_rejected_corners(uv[~described], "not two crossing edges")
        rejected += list_rejected_corners(uv[described & ~near], verification.DRAWN_ASIDE)
        found[found] = good
        lattice = lattice.select(found)


def _fit_all_corners(
    image: GreyImage, lattice: Lattice, gap: float, unit: float
) -> tuple[XCornerFit, BoolArray]:
    """Fit the model at all corners, see `FitCorners`."""
    priors = ScatteredPriors(_locate_places(lattice, gap), unit)
    fit = x_corner_fit.fit_x_corners(image, lattice, priors=priors)
    return fit, verification.find_suspect_corners(fit.board_residual)
