"""From an image to the circles of a board that are listed one by one.

Parts of the image that may be discs are matched to the list (`layout_matching`), and the circles
are then measured as those of grids are (`measurement`). Among origins that cannot be told apart the
one that makes the board upright is taken, or the one nearest to the first of the marked points.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GridSize, Size
from calibgui.engine.boards.listed_circles import ListedCircles
from calibgui.engine.detection.circles.circle_map import fit_circle_map
from calibgui.engine.detection.circles.coarse_search import (
    crop_to_outline,
    list_levels,
    list_searches,
)
from calibgui.engine.detection.circles.layout_matching import LayoutMatch, match_layout
from calibgui.engine.detection.circles.measurement import measure_circles
from calibgui.engine.detection.detector_io import check_grey_levels, list_rejected_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.corners import Corners
from calibgui.engine.geometry.homography import apply_homography, fit_homography
from calibgui.engine.images.reading import stretch_levels
from calibgui.engine.lattices import region_of_interest as region

_UNPLACED = (
    "The picture does not show which of the board's circles these are: it would if it showed more"
    " of the board's border."
)
"""Remark on a part of a board that may have several places."""


def find_listed_circles(
    image: npt.ArrayLike,
    pattern: ListedCircles,
    grid_size: GridSize | None = None,  # noqa: ARG001 - the list tells
    roi: npt.ArrayLike | None = None,
    method: str = "edges",  # noqa: ARG001 - circles have but one
) -> Corners:
    """Locate the circles of a list in an image; see ``find_corners``."""
    grey = check_grey_levels(image)
    if pattern.places is None:
        raise NoBoardError(
            "It is not known where the circles of the board lie.",
            "State the file that lists them.",
        )
    outline = None if roi is None else region.check_outline(roi)
    centres, match = _search(pattern, stretch_levels(grey), outline)
    centres, places = _turn_upright(pattern, centres, outline), np.array(pattern.places)
    seen = np.flatnonzero(np.isfinite(centres[:, 0]))
    fit, circles = measure_circles(
        grey, centres[seen], places[seen], pattern, match.in_view, is_part=True
    )
    good = circles.good
    grid, whole = pattern.grid[seen], np.array(pattern.grid_size) - 1
    corners = np.array([(0, 0), (0, 1), (1, 1), (1, 0)]) * whole
    H = fit_homography(grid.astype(np.float64), circles.uv, np.ones(len(grid)))
    return Corners(
        shape=pattern.grid_size,
        grid=grid[good],
        uv=circles.uv[good],
        estimate=centres[seen][good],
        cov=circles.covariance[good],
        ambiguity=pattern.symmetry(pattern.grid_size),
        roi=apply_homography(H, corners.astype(np.float64)) if outline is None else outline,
        method="ellipses",
        relative=not match.is_certain,
        blur=fit.blur[good],
        contrast=fit.contrast[good],
        residual=fit.residual[good],
        rejected=tuple(list_rejected_corners(fit.uv[~good], "not the image of a circle there")),
        remark="" if match.is_certain else _UNPLACED,
        pattern=ListedCircles(pattern.places, 2 * circles.radius),
    )


def _search(
    pattern: ListedCircles, levels: npt.NDArray[np.uint8], outline: Array | None
) -> tuple[Array, LayoutMatch]:
    """Search an image (h, w) for the circles of the list: the first match whose place is certain,
    or else the first, after where it has the circles (n, 2) px, NaN where none is seen.

    Raises:
        NoBoardError: if there is none.
    """
    image, corner = crop_to_outline(levels, outline)
    n = len(pattern.grid)
    first: tuple[Array, LayoutMatch] | None = None
    for search in list_searches(list_levels(image)):
        points = search.find_blobs(2 * n + 60, is_stated=True)
        size: Size = search.photograph.shape[1], search.photograph.shape[0]
        match = match_layout(points, pattern, size)
        if match is not None:
            at = np.where(match.points[:, None] >= 0, points[match.points], np.nan)
            found = (at + 0.5) * 2**search.depth - 0.5 + np.array(corner), match
            if match.is_certain:
                return found
            first = first or found
    if first is None:
        raise NoBoardError(
            f"The {n} circles of the list were not found.",
            "Almost all of them must be in view, sharp and evenly lit; check that X in the list "
            "points to the right and Y down, as the board is seen from its front.",
        )
    return first


def _turn_upright(pattern: ListedCircles, centres: Array, outline: Array | None) -> Array:
    """Return the centres (n, 2) px in the order of that turn of the board which is upright, among
    those that leave it as it is, or begins nearest to the first of the marked points."""
    places = np.array(pattern.places)
    rated = []
    for _, order in pattern.list_turns():
        at = centres[order]
        seen = np.isfinite(at[:, 0])
        circle_map = fit_circle_map(places[seen], at[seen])
        right = circle_map.differentiate(places[seen])[..., 0].mean(axis=0)
        start = 0.0
        if outline is not None:
            first = np.array([places.min(axis=0)])
            start = float(np.linalg.norm(circle_map.locate(first) - outline[0]))
        rated.append((start, -round(float(right[0] / np.linalg.norm(right)), 6), at))
    return min(rated, key=lambda rate: rate[:2])[2]
