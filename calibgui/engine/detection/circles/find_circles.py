"""From an image to the centres of a grid of circles.

The grid is found coarsely among all parts that may be discs (`blobs`, `grid_labelling`), with gaps
where a few circles are covered or cut off by the image's border, and its circles are then measured
(`measurement`). Numbering is right-handed in the image; among origins that cannot be told apart the
one that makes the grid upright is taken, or the one nearest to the first of the marked points. A
symmetric grid turned by a quarter is another one with rows and columns exchanged: unless its size
is stated, the fewer lines are its rows in every image.

Boards of robot cells mark the origin, or the axes, by circles of another size. Such marks are
circles like the others, and tell turns of the grid apart: of the numberings that remain that one is
taken by which they come first, row by row, whatever the picture or the user's points say.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GridSize, IntArray
from calibgui.engine.boards.circle_grid import Circles, list_grid_indices
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.detection.circles.circle_map import fit_circle_map
from calibgui.engine.detection.circles.coarse_search import find_grid
from calibgui.engine.detection.circles.continuation import find_continuation
from calibgui.engine.detection.circles.measurement import (
    VerifiedCircles,
    distrust,
    measure_circles,
)
from calibgui.engine.detection.detector_io import check_grey_levels, list_rejected_corners
from calibgui.engine.features.corners import Corners
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.images.reading import stretch_levels
from calibgui.engine.lattices import region_of_interest as region

_OPEN = (
    "The picture ends before the next row or column of circles would be seen: state the numbers of"
    " rows and columns if the grid has more."
)
"""Remark on a grid whose end is not seen."""
_BESIDE = (
    "Single discs lie where the next row or column would be: state the numbers of rows and columns"
    " if these are circles of the grid."
)
"""Remark on a grid that may have lines of which almost all circles are covered."""
_UNSEEN = (
    "No circle of a row or column at the grid's border is seen well: which of the rows and columns"
    " are seen is not certain."
)
"""Remark on a grid with gaps whose extent rests on circles that are not trusted."""
_UNPLACED = (
    "The picture does not show which of the board's rows and columns of circles these are: it would"
    " if it showed paper beyond the grid's end on two sides that meet."
)
"""Remark on a part of a grid that may have several places."""


def find_circles(
    image: npt.ArrayLike,
    pattern: Circles,
    grid_size: GridSize | None = None,
    roi: npt.ArrayLike | None = None,
    method: str = "edges",  # noqa: ARG001 - circles have but one
) -> Corners:
    """Locate the circles of a grid in an image; see ``find_corners``."""
    grey = check_grey_levels(image)
    outline = None if roi is None else region.check_outline(roi)
    levels = stretch_levels(grey)
    coarse_grid = find_grid(pattern, levels, grid_size, outline)
    coarse = coarse_grid.centres
    is_counted = grid_size is None and outline is None
    grid_size = coarse.shape[0], coarse.shape[1]
    grid = list_grid_indices(grid_size)
    all_xy = pattern.locate_points(grid.astype(np.float64))
    estimate = _number_circles(pattern, coarse, all_xy, outline)
    is_seen = np.isfinite(estimate[:, 0])
    estimate, xy = estimate[is_seen], all_xy[is_seen]
    fit, verified = measure_circles(
        grey, estimate, xy, pattern, coarse_grid.in_view, is_part=coarse_grid.is_part
    )
    order, ambiguity = _number_by_marks(verified, grid_size, pattern.symmetry(grid_size))
    places, is_good = grid[is_seen], verified.good[order]
    good = order[is_good]
    whole = np.full((*grid_size, 2), np.nan)
    whole[tuple(places.T)] = verified.uv[order]
    doubts = []
    if is_counted:
        beyond = find_continuation(
            coarse, levels, asymmetric=pattern.asymmetric, are_bright=fit.are_bright
        )
        doubts += [_OPEN] * beyond.is_open + [_BESIDE] * (
            coarse_grid.has_strays and beyond.has_discs
        )
    is_border_trusted = np.all(np.ptp(places[is_good], axis=0) + 1 == grid_size)
    if not (is_seen.all() or coarse_grid.is_part or is_border_trusted):
        doubts.append(_UNSEEN)
    if not coarse_grid.is_placed:
        doubts.append(_UNPLACED)
    return Corners(
        shape=grid_size,
        grid=places[is_good],
        uv=verified.uv[good],
        estimate=estimate[good],
        cov=verified.covariance[good],
        ambiguity=ambiguity,
        roi=region.find_outline(Lattice(whole, dark=True)) if outline is None else outline,
        method="ellipses",
        relative=bool(doubts),
        blur=fit.blur[good],
        contrast=fit.contrast[good],
        residual=fit.residual[good],
        rejected=tuple(
            list_rejected_corners(fit.uv[~verified.good], "not the image of a circle there")
        ),
        remark=" ".join(doubts),
        pattern=Circles(pattern.asymmetric, 2 * verified.radius),
    )


def _number_circles(pattern: Circles, centres: Array, xy: Array, outline: Array | None) -> Array:
    """Number the centres (rows, cols, 2) px as the pattern does, among its turns that look alike.

    How well a map fits tells no others apart: a bend along three rows is a shift of the middle one.

    Returns:
        (n, 2) px, the centre of each of the pattern's points `xy` (n, 2), NaN where none is seen.
    """
    grid_size = centres.shape[0], centres.shape[1]
    rated = []
    for order in _list_turns(grid_size, pattern.symmetry(grid_size)):
        uv = centres.reshape(-1, 2)[order]
        is_seen = np.isfinite(uv[:, 0])
        circle_map = fit_circle_map(xy[is_seen], uv[is_seen])
        J = circle_map.differentiate(xy[is_seen])
        if not (np.isfinite(J).all() and (np.linalg.det(J) > 0).all()):
            continue
        right = J[..., 0].mean(axis=0)
        start = 0.0
        if outline is not None:
            start = float(np.linalg.norm(circle_map.locate(xy[:1]) - outline[0]))
        rated.append((start, -round(float(right[0] / np.linalg.norm(right)), 6), uv))
    if not rated:
        raise distrust("its circles do not lie on a smooth grid")
    return min(rated, key=lambda rate: rate[:2])[2]


def _list_turns(grid_size: GridSize, symmetry: Symmetry) -> list[IntArray]:
    """List the places (n,) of a grid in the order of each numbering that its symmetry allows."""
    places = np.arange(grid_size[0] * grid_size[1]).reshape(grid_size)
    step = {Symmetry.NONE: 4, Symmetry.HALF_TURN: 2, Symmetry.QUARTER_TURN: 1}[symmetry]
    return [np.rot90(places, quarters).ravel() for quarters in range(0, 4, step)]


def _number_by_marks(
    circles: VerifiedCircles, grid_size: GridSize, symmetry: Symmetry
) -> tuple[IntArray, Symmetry]:
    """Choose among the turns of a symmetric grid by its marks.

    A circle that was rejected or is not seen might be a mark: then nothing is chosen.

    Returns:
        The circles (n,) in the order of their numbering, and the turns that the marks leave open.
    """
    if np.count_nonzero(circles.good) < grid_size[0] * grid_size[1]:
        return np.arange(len(circles.good)), symmetry
    orders = _list_turns(grid_size, symmetry)
    marks = [tuple(np.flatnonzero(circles.are_marks[order]).tolist()) for order in orders]
    least = min(marks)
    open_turns = {1: Symmetry.NONE, 2: Symmetry.HALF_TURN, 4: Symmetry.QUARTER_TURN}[
        marks.count(least)
    ]
    return orders[marks.index(least)], open_turns
