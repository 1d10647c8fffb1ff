"""Does a grid of circles go on beyond the lines that were read?

A part of a grid must not pass for the whole: its circles would get other numbers from picture to
picture. The lines read say where the next ones would be, under any lens. A disc is seen there where
the middle differs from all four places around that would be paper. The image is asked, not what was
taken for discs: a search that missed a line has missed it there.

Points are taken by the lattice of nearest neighbours, along the diagonals of an asymmetric grid:
there both patterns have their discs in the places and paper in the middle of the cells.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, BoolArray, IntArray, compute_median
from calibgui.engine.boards.circle_grid import Circles, list_grid_indices
from calibgui.engine.detection.circles.blobs import FOG_SHARE
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS
from calibgui.engine.features.lattice import estimate_steps, predict_places
from calibgui.engine.images.sampling import sample_image

_CELL_MIDDLES = np.array([(0.5, 0.5), (0.5, -0.5), (-0.5, 0.5), (-0.5, -0.5)])
"""(4, 2) paper around a disc, steps of the lattice."""

_SHADE = 0.5
"""Least light of paper that lies in no shadow, over that of the grid."""
_MAX_PAPER_DIFFERENCE = 0.06
"""Greatest difference of a place from paper beside it, over the contrast, both of logarithms."""


class Continuation(NamedTuple):
    """The places of a grid, and of the lines that would be next, as an image shows them."""

    centres: Array
    """(rows, cols, 2) px, of the grid's circles, also of those that were not known and are seen;
    NaN where there is none. This and what follows has one axis where it was asked by place."""
    is_seen_at: BoolArray
    """(rows, cols) True where a circle is seen."""
    is_in_view: BoolArray
    """(rows, cols) True where the image shows the place."""

    goes_on: tuple[bool, ...]
    """(4,) True if there are circles where the line before the first row, after the last row,
    before the first and after the last column would be, in most of its places in the image."""
    is_open: bool
    """True if one of them would lie outside of the image."""
    has_discs: bool
    """True if there is a circle in a place of one of them; the others may be covered."""
    is_shaded: bool
    """True if it is less than half as bright beside one of them as on the grid: a shadow's edge may
    pass through the line's circles and hide them."""
    ends: tuple[bool, ...]
    """(4,) True if there is nothing but paper where one of these would be, and most of it is in the
    image."""
    leaves: tuple[bool, ...]
    """(4,) True if the image does not show most of that line."""

    @property
    def is_seen(self) -> bool:
        """True if the grid is seen to go on."""
        return any(self.goes_on)


class _Cells(NamedTuple):
    """The places of a grid and those around it, on the lattice of nearest neighbours."""

    first: IntArray
    """(2,) the first of them."""
    at: Array
    """(m, n, 2) where they are, or would be, px."""
    known: BoolArray
    """(m, n) True where a disc is known."""
    levels: Array
    """(m, n, 5) grey levels of the place and of paper around it; NaN where not in the image."""
    are_discs: BoolArray
    """(m, n) True where a disc is seen."""
    are_surrounded: BoolArray
    """(m, n) True where all the paper around is in the image: beyond a grid's end a bright ground
    looks like bright discs as long as only what lies towards the grid is asked."""


def find_continuation(
    centres: Array, image: npt.NDArray[np.uint8], *, asymmetric: bool, are_bright: bool = False
) -> Continuation:
    """Find out whether an image (h, w) shows a grid to go on, or to end, on all sides, and what is
    seen in its gaps.

    Args:
        centres: (rows, cols, 2) px, good to a tenth of their distance; NaN where none is known.
        image: grey levels.
        asymmetric: True if every second row is shifted by half.
        are_bright: True if the discs are brighter than the paper.
    """
    grid_size = centres.shape[:2]
    xy = (
        Circles(asymmetric)
        .locate_points(list_grid_indices(grid_size).astype(np.float64))
        .astype(np.int64)
    )
    seen = look_around(
        xy, centres.reshape(-1, 2), image, asymmetric=asymmetric, are_bright=are_bright
    )
    return seen._replace(
        centres=seen.centres.reshape(centres.shape),
        is_seen_at=seen.is_seen_at.reshape(grid_size),
        is_in_view=seen.is_in_view.reshape(grid_size),
    )


def look_around(
    xy: IntArray,
    uv: Array,
    image: npt.NDArray[np.uint8],
    *,
    asymmetric: bool,
    are_bright: bool = False,
) -> Continuation:
    """Do so for the n places `xy` (n, 2), pitches, of a rectangle of a grid, with the known centres
    `uv` (n, 2) px, by place; see `find_continuation`. An asymmetric grid has columns of every
    second row here."""
    places = _find_lattice_places(xy, asymmetric=asymmetric)
    cells = _look_at_cells(places, uv, image, are_bright=are_bright)
    is_sampled = np.isfinite(cells.levels[..., 0])
    beyond = ~cells.known & is_sampled & (cells.are_surrounded | ~cells.are_discs)
    is_disc = cells.are_discs[beyond]
    light = compute_median(_compute_medians(cells.levels[cells.known & is_sampled, 1:]))
    paper = np.nanmin(cells.levels[beyond, 1:], axis=1)
    lines = _find_lines(
        np.argwhere(beyond) + cells.first - places[0], xy - xy[0], asymmetric=asymmetric
    )
    of_grid = tuple((places - cells.first).T)
    is_seen = cells.are_discs[of_grid]
    is_plain = _find_plain(cells)[beyond]
    lengths = np.repeat(np.ptp(xy, axis=0) + 1, 2) / (2 if asymmetric else 1)
    in_view = [bool(2 * np.count_nonzero(line) > n) for line, n in zip(lines, lengths, strict=True)]
    return Continuation(
        np.where(np.isfinite(uv), uv, np.where(is_seen[:, None], cells.at[of_grid], np.nan)),
        is_seen,
        is_sampled[of_grid],
        tuple(bool(2 * np.count_nonzero(is_disc[line]) > np.count_nonzero(line)) for line in lines),
        not all(line.any() for line in lines),
        any(is_disc[line].any() for line in lines),
        any(compute_median(paper[line]) < _SHADE * light for line in lines if line.any()),
        tuple(
            shown and bool(is_plain[line].all()) for shown, line in zip(in_view, lines, strict=True)
        ),
        tuple(not shown for shown in in_view),
    )


def _find_plain(cells: _Cells) -> BoolArray:
    """Find the places (m, n) True that are as bright as all paper around a disc beside them."""
    fog = FOG_SHARE * max(float(np.nanmax(cells.levels)), 1.0)
    scale = np.log1p(cells.levels / fog)
    around = np.full((*scale.shape[:2], 4), np.nan)
    around[cells.known] = scale[cells.known, 1:]
    is_told = cells.known & np.isfinite(cells.levels[..., 0])
    contrast = compute_median(abs(_compute_medians(around[is_told]) - scale[is_told, 0]))
    beside = np.stack([np.roll(around, step, axis) for step in (1, -1) for axis in (0, 1)], axis=2)
    off = abs(beside - scale[..., :1, None])
    # What covers the place may reach to some of the paper around the disc beside it.
    most = np.where(np.isfinite(off), off, -np.inf).max(axis=3)
    least = np.where(most >= 0, most, np.inf).min(axis=2)
    return np.asarray(least < _MAX_PAPER_DIFFERENCE * contrast)


def _compute_medians(levels: Array) -> Array:
    """Compute the median (n,) of those of each row of `levels` (n, m) that are no NaN: as NumPy's
    nanmedian, in a sixth of the time."""
    ordered, count = np.sort(levels, axis=1), np.count_nonzero(np.isfinite(levels), axis=1)
    middle = np.column_stack([(count - 1) // 2, count // 2])
    return np.asarray(np.take_along_axis(ordered, middle, axis=1).mean(axis=1))


def _look_at_cells(
    places: IntArray, centres: Array, image: npt.NDArray[np.uint8], *, are_bright: bool
) -> _Cells:
    """Look for discs in places (n, 2) of the lattice and around them, of which `centres` (n, 2) px
    are known; see `find_continuation`."""
    first = places.min(axis=0) - 1
    uv = np.full((*(places.max(axis=0) - first + 2), 2), np.nan)
    uv[tuple((places - first).T)] = centres
    known = np.isfinite(uv[..., 0])
    at = predict_places(uv)
    levels = _sample_cells(at, estimate_steps(uv), image)
    are_discs = np.zeros(known.shape, dtype=bool)
    # A shadow leaves discs less contrast, but as much in the logarithm.
    fog = FOG_SHARE * max(float(np.nanmax(levels)), 1.0)
    for scale in (levels, np.log1p(levels / fog)):
        seen = -scale if are_bright else scale
        difference = np.fmin.reduce(seen[..., 1:], axis=2) - seen[..., 0]
        limit = CIRCLE_THRESHOLDS.min_relative_contrast * np.nanmedian(difference[known])
        are_discs |= difference > limit
    return _Cells(first, at, known, levels, are_discs, np.asarray(np.isfinite(levels).all(axis=2)))


def _find_lattice_places(xy: IntArray, *, asymmetric: bool) -> IntArray:
    """Find the places (n, 2) on the lattice of nearest neighbours of places (n, 2), pitches."""
    x, y = xy.T
    if not asymmetric:
        return np.column_stack([y, x])
    return np.column_stack([x + y, y - x]) // 2


def _find_lines(places: IntArray, xy: IntArray, *, asymmetric: bool) -> tuple[BoolArray, ...]:
    """Find which places (n, 2) of the lattice are of the line beyond the first row, the last row,
    the first and the last column of the grid's places `xy` (m, 2), from its first: masks (n,)."""
    y, x = places.T
    if asymmetric:
        y, x = places.sum(axis=1), places[:, 0] - places[:, 1]
    (left, top), (right, bottom) = xy.min(axis=0), xy.max(axis=0)
    return y < top, y > bottom, x < left, x > right


def _sample_cells(at: Array, steps: tuple[Array, Array], image: npt.NDArray[np.uint8]) -> Array:
    """Sample an image at places (rows, cols, 2) px and in the cells' middles around, grey levels
    (rows, cols, 5); NaN where not in the image, or where the place or most of them are not."""
    right, down = steps
    paper = at[..., None, :] + (
        _CELL_MIDDLES[:, :1] * right[..., None, :] + _CELL_MIDDLES[:, 1:] * down[..., None, :]
    )
    points = np.concatenate([at[..., None, :], paper], axis=2)
    last = np.array(image.shape[::-1]) - 1.0
    inside = np.all((points >= 0) & (points <= last), axis=3)
    inside &= inside[..., :1] & (np.count_nonzero(inside[..., 1:], axis=2, keepdims=True) >= 2)
    levels = np.full(inside.shape, np.nan)
    levels[inside] = sample_image(image, points[inside])
    return levels
