"""An image of a checkerboard without the markers or tags in its squares: that of a plain one.

Their cells are known once their numbers and the corners around them are (`blurred_print`). Blurred,
they would draw the corners of small squares aside. Where squares are large enough for what is plain
of them to tell the corners, these are located by that, without the errors of what is subtracted.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import (
    Array,
    BoolArray,
    GreyImage,
    IntArray,
    compute_lengths,
    compute_median,
)
from calibgui.engine.corner_fit.x_corner_fit import XCornerFit, fit_x_corners, replace_fits
from calibgui.engine.detection.blurred_print import add_blurred_cells, subtract_change
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.geometry import homography
from calibgui.engine.lattices import grid_map

_MAX_SHARP_BLUR = 1 / 3
"""Greatest blur over what is plain beside an edge at which marks disturb no corner: they begin 3
standard deviations away."""
_MIN_REMOVALS, _MAX_REMOVALS, _CONVERGED_MOVE = 2, 8, 0.1
"""Least and largest number of times that marks are removed as the corners were fitted last, and the
median move of these after which that ends, standard deviations. Twice does under little blur; where
it is 0.7 of what is plain, corners of rendered boards were 0.12 px off then, and are 0.03 px off
after eight."""
_MOVE_LEFT = 1.5
"""Sum of the moves that further removals would make, over the last move: each is some 0.6 of that
before it."""
_MOVE_ERROR = 0.2
"""Error of what marks have drawn a corner aside by, over that: their blur and contrast are known to
so much."""
_MAX_EXTENT = 3.0
"""Greatest extent of a square with a mark, in the largest distance of corners found: beyond them
nothing bounds where squares are expected."""
_PARTS = 3
"""Number of parts of a cell along either side: seen from aside it is not square."""
_SQUARE = np.array([(0, 0), (0, 1), (1, 1), (1, 0)])
"""(4, 2) row and column of a square's corners."""


class Marks(NamedTuple):
    """The markers or tags that are printed in n squares of a board."""

    squares: IntArray
    """(n, 2) row and column of the inner corner that is the upper left one of the square; one less
    than the first or the last on squares along the border."""
    cells: BoolArray
    """(n, s, s) the cells of a mark, True where they have the other colour than the square."""
    margin: float
    """Distance of the cells from the edges of the square, squares."""


def fit_without_marks(
    image: GreyImage, lattice: Lattice, marks: Marks, bare_reach: float
) -> tuple[XCornerFit, GreyImage]:
    """Fit the edge model at all corners, without the marks where these are blurred.

    Args:
        image: (h, w) grey levels.
        lattice: the corners, in the lattice of the whole board.
        marks: those of the whole board.
        bare_reach: how far from its edges a square is of one colour, squares.

    Returns:
        The fit, and the image without the marks; as it is if no corner is disturbed.
    """
    fit = fit_x_corners(image, lattice, bare_reach)
    nearest = bare_reach * lattice.spacing()[lattice.found]
    disturbed = ~(compute_median(fit.blur) <= _MAX_SHARP_BLUR * nearest)
    if not disturbed.any():
        return fit, image
    drawn = fit.uv
    for count in range(1, _MAX_REMOVALS + 1):
        before = fit.uv
        bare = remove_marks(image, lattice, fit, marks)
        without = fit_x_corners(bare, lattice, are_marks_removed=True)
        fit = replace_fits(fit, without, np.ones(len(disturbed), np.bool_), disturbed)
        move = compute_lengths(fit.uv - before)
        sigma = np.sqrt(np.einsum("nii->n", fit.covariance) / 2)
        is_small = compute_median(move) < _CONVERGED_MOVE * compute_median(sigma)
        if count >= _MIN_REMOVALS and is_small:
            break
    moved = _MOVE_ERROR * compute_lengths(fit.uv - drawn)
    return fit.widen(np.hypot(moved, _MOVE_LEFT * move)), bare


def remove_marks(image: GreyImage, lattice: Lattice, fit: XCornerFit, marks: Marks) -> GreyImage:
    """Return an image without the marks beside the corners found.

    Args:
        image: (h, w) grey levels.
        lattice: the corners, in the lattice of the whole board.
        fit: the edge model at these.
        marks: those of the whole board.
    """
    rows, cols = lattice.shape
    values = np.full((rows + 2, cols + 2, 3), np.nan)  # a line around, without corners
    values[1:-1, 1:-1][lattice.found] = np.column_stack([fit.uv, fit.contrast])
    around = marks.squares[:, None] + _SQUARE
    seen = values[tuple(np.moveaxis(around + 1, -1, 0))]
    expected = grid_map.fit_grid_map(lattice).locate(around.reshape(-1, 2).astype(np.float64))
    quads = np.where(np.isfinite(seen[..., :2]), seen[..., :2], expected.reshape(-1, 4, 2))
    farthest = _MAX_EXTENT * np.nanmax(lattice.spacing())
    beside = np.isfinite(seen[..., 0]).any(axis=1)
    beside &= (np.ptp(quads, axis=1) < farthest).all(axis=1)
    if not beside.any():
        return image
    seen, quads = seen[beside], quads[beside]
    contrast = np.nanmean(seen[..., 2], axis=1)
    blur = np.full(len(contrast), np.median(fit.blur))  # one corner's takes up what disturbs it
    unit = np.broadcast_to(_SQUARE.astype(np.float64), quads.shape)
    H = homography.fit_homography(unit, quads, np.ones(quads.shape[:2]))
    cells, areas = _divide_cells(marks.cells[beside], marks.margin)
    at, scale = _map_with_area(H, cells)
    # Corners that blur puts in wrong places may cross over: the map between them has a horizon.
    whole = (np.ptp(at, axis=1) < farthest).all(axis=1)
    if not whole.any():
        return image
    at, scale, areas, contrast, blur = (each[whole] for each in (at, scale, areas, contrast, blur))
    beside[beside] = whole
    is_dark = lattice.dark ^ (marks.squares[beside].sum(axis=1) % 2 == 1)
    change = np.zeros(image.shape)
    add_blurred_cells(change, at, scale * areas, np.where(is_dark, contrast, -contrast), blur)
    return subtract_change(image, change)


def _divide_cells(cells: BoolArray, margin: float) -> tuple[Array, Array]:
    """Divide the cells (n, s, s) that have the other colour into parts.

    Returns:
        The middles (n, k, 2) of the parts as row and column, and their areas (n, k), 0 where a mark
        has fewer, all in squares.
    """
    parts = np.kron(cells, np.ones((1, _PARTS, _PARTS), np.bool_))
    side = (1 - 2 * margin) / parts.shape[1]
    flat = parts.reshape(len(parts), -1)
    most = int(flat.sum(axis=1).max())
    chosen = np.argsort(~flat, axis=1, kind="stable")[:, :most]  # the parts of a mark first
    places = np.stack(np.divmod(chosen, parts.shape[2]), axis=-1)
    areas = side**2 * np.take_along_axis(flat, chosen, axis=1)
    return margin + (places + 0.5) * side, areas


def _map_with_area(H: Array, points: Array) -> tuple[Array, Array]:
    """Map points (n, k, 2) by homographies (n, 3, 3), and return the areas (n, k) that a unit of
    area has there."""
    depth = points @ H[:, 2, :2, None] + H[:, None, 2, 2:]
    area = abs(np.linalg.det(H))[:, None] / abs(depth[..., 0]) ** 3
    return homography.apply_homography(H, points), area
