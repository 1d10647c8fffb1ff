"""The corners of an AprilGrid without small dark squares between its tags.

Every tag of the board in view is fitted by its outline (`tag_outlines`): those that were read, and
those that can be read where the others predict them. A tag counts if the fit stays near, finds the
contrast of the others and leaves no more unexplained than they do.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray
from calibgui.engine.boards.april_grid import TagLayout
from calibgui.engine.detection.apriltags.grid_tags import GridTags
from calibgui.engine.detection.apriltags.tag_outlines import AROUND, TagOutlines, fit_tag_outlines
from calibgui.engine.detection.apriltags.tag_reader import TagReader
from calibgui.engine.detection.charuco.assembly import FittedCorners
from calibgui.engine.detection.charuco.corners_between_markers import predict_places
from calibgui.engine.detection.charuco.markers import Markers
from calibgui.engine.detection.checkerboard import verification
from calibgui.engine.detection.corners import RejectedCorner, find_usable_covariances
from calibgui.engine.detection.detector_io import list_rejected_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.geometry import homography
from calibgui.engine.images.sampling import sample_image

_MAX_PLACING_DISTANCE = 1.6
"""Greatest distance of a tag's corners from the middle of the nearest one that was read at which it
is looked for, sides of a tag, less the gap: that of its neighbours."""
_MIN_SINE = 0.2
"""Least sine of the angle at a tag's corners."""
_MAX_SHIFT, _MIN_MAX_SHIFT = 1.0, 2.0
"""Greatest distance of a corner from where it was read, widths of the border, or px if that is
more: dark parts end 1 px within the outlines, and blur rounds their corners."""
_MIN_RELATIVE_CONTRAST = 0.3
"""Least contrast of a tag over the median."""
_MAX_RELATIVE_RESIDUAL = 0.05
"""Greatest residual of a tag over its contrast ..."""
_MAX_RESIDUAL_OVER_MEDIAN = 3.0
"""... or over the median residual, whichever is more."""


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
    levels = sample_image(
        image, homography.apply_homography(H, np.broadcast_to(at, (n, *at.shape)))
    ).reshape(n, 3, 4)
    square, paper, ink = np.moveaxis(levels, 1, 0)
    middle_level = (np.median(paper, axis=1) + np.median(ink, axis=1))[:, None] / 2
    is_dark_ink = np.asarray((ink < paper).all(axis=1))
    dark = np.equal(square < middle_level, is_dark_ink[:, None])
    # Around the board anything may follow the tags; what lies between two of them is printed.
    between = _find_corners_between(tags.squares)
    return bool(np.mean(dark[between] if between.any() else dark) > 0.5)


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
    kept = _are_measurable(quads, image)
    rejected = list_rejected_corners(quads[~kept].reshape(-1, 2), "not whole in the image")
    squares, quads = squares[kept], quads[kept]
    while True:
        if len(quads) < 2:
            raise NoBoardError(
                "Tags of an AprilGrid were read, but there are no dark squares between them, whose"
                " corners would cross the tags', and too few of the tags have clear outlines.",
                "Take the picture again: sharp, evenly lit, with all of the white around the tags"
                " in view; or print the board with its small dark squares.",
            )
        grid = 2 * squares[:, None] + AROUND[:, ::-1].astype(np.int64)
        fit = fit_tag_outlines(image, quads, squares, border, gap)
        good = _find_good_outlines(fit, quads, border)
        if good.all():
            return grid.reshape(-1, 2), _list_corners(fit), rejected
        rejected += list_rejected_corners(quads[~good].reshape(-1, 2), "not the outline of a tag")
        squares, quads = squares[good], quads[good]


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
    near = (distance.reshape(-1, 4) < _MAX_PLACING_DISTANCE + gap).all(axis=1)
    quads = uv.reshape(-1, 4, 2)
    near &= verification.are_in_image(uv, levels.shape).reshape(-1, 4).all(axis=1)
    numbers, squares, quads = numbers[near], squares[near], quads[near]
    more = TagReader(levels, quads).read(tag_print)
    seen = more.which[(more.numbers == numbers[more.which]) & (more.turns == 0)]
    return (
        np.concatenate([tags.squares, squares[seen]]) + first,
        np.concatenate([tags.corners, quads[seen]]),
    )


def _are_measurable(quads: Array, image: GreyImage) -> BoolArray:
    """Return which quadrilaterals (n, 4, 2) px are convex and whole in the image (h, w)."""
    along = np.roll(quads, -1, axis=1) - quads
    along /= np.linalg.norm(along, axis=2, keepdims=True) + 1e-12
    behind = np.roll(along, 1, axis=1)
    sine = behind[..., 0] * along[..., 1] - behind[..., 1] * along[..., 0]
    whole = verification.are_in_image(quads.reshape(-1, 2), image.shape).reshape(-1, 4)
    return np.asarray(((sine > _MIN_SINE) & whole).all(axis=1))


def _find_good_outlines(fit: TagOutlines, quads: Array, border: float) -> BoolArray:
    """Return which outlines (n,) count; `quads` (n, 4, 2) px are where they were expected."""
    side = np.linalg.norm(np.roll(quads, 1, axis=1) - quads, axis=2).min(axis=1)
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
