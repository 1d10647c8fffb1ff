"""The search for a grid of circles in an image and its halved copies.

What is darker than around is tried first, then what is brighter, then with the light evened out.
The search ends with a grid that is not seen to go on, or with the part that is seen of a cut one.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GridSize
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.detection.circles.blobs import (
    MIN_DIFFERENCE,
    find_blobs,
    find_faint_difference,
)
from calibgui.engine.detection.circles.continuation import Continuation, find_continuation
from calibgui.engine.detection.circles.grid_labelling import LabelledGrid, label_grid
from calibgui.engine.detection.circles.partial_grid import place_part
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS
from calibgui.engine.errors import NoBoardError
from calibgui.engine.lattices import region_of_interest as region

_MAX_COARSE_SIDE = 1200
"""Longer side of the image in which the grid is looked for first, px."""
_WINDOW_DIVISORS = (4, 16)
"""The image's shorter side over the windows tried: ink is darker than the mean of the window."""
_SHADED_DIVISOR = 8
"""The image's shorter side over the window in which shadows are evened out, at the coarsest size:
that takes a twentieth of the time of the search among what is dark."""
_SMOOTHED_COPIES = 2
"""Number of copies coarser than the coarsest that are searched where nothing was found."""


class CoarseGrid(NamedTuple):
    """A grid as it is found before it is measured."""

    centres: Array
    """(rows, cols, 2) px, NaN where no circle is seen."""
    in_view: int
    """Number of its places that the image shows; all, unless its size is stated."""
    is_part: bool = False
    """True if it is a part of a grid of stated size, which the image cuts."""
    is_placed: bool = True
    """False if that part may have other places."""
    has_strays: bool = False
    """True if single discs lie where the grid may go on."""


def find_grid(
    pattern: Circles,
    image: npt.NDArray[np.uint8],
    grid_size: GridSize | None,
    outline: Array | None,
) -> CoarseGrid:
    """Find a grid, coarsely, in an 8-bit image (h, w).

    Args:
        pattern: symmetric or asymmetric; its diameter is not used.
        image: grey levels.
        grid_size: rows and columns; inferred if None.
        outline: (m, 2) convex outline, px, of the part of the image to search; None for all.

    Raises:
        NoBoardError: if there is none, with what was found instead.
    """
    image, (left, top) = crop_to_outline(image, outline)
    levels = list_levels(image)
    most = (
        CIRCLE_THRESHOLDS.max_blobs if grid_size is None else 2 * grid_size[0] * grid_size[1] + 60
    )
    largest: _FoundGrid | None = None
    part: LabelledGrid | None = None
    others: list[tuple[Search, Array]] = []
    for search in list_searches(levels):
        if largest is not None and _is_needless(search, largest, len(levels), grid_size):
            continue
        points = search.find_blobs(most, is_stated=grid_size is not None)
        others.append((search, points))
        grid = label_grid(points, grid_size, asymmetric=pattern.asymmetric)
        if grid is None:
            continue
        is_stated = grid.is_full and grid.places.shape == grid_size
        at = grid.place_points(points)
        beyond = find_continuation(
            at, search.photograph, asymmetric=pattern.asymmetric, are_bright=search.is_negative
        )
        if beyond.is_seen:
            part = max(part or grid, grid, key=len)
            continue
        found = _FoundGrid(grid, search, beyond)
        if largest is None or is_stated or found.excess > largest.excess:
            largest = found
        if is_stated:
            break
    if largest is not None and grid_size in (None, largest.grid.places.shape):
        centres = (largest.beyond.centres + 0.5) * 2**largest.search.depth - 0.5 + [left, top]
        shown = int(np.count_nonzero(largest.beyond.is_in_view))
        in_view = largest.grid.places.size if grid_size is None else shown
        return CoarseGrid(centres, in_view, has_strays=largest.grid.left_out > 0)
    if grid_size is not None:
        placed = _place_part(others, grid_size, asymmetric=pattern.asymmetric)
        if placed is not None:
            return placed._replace(centres=placed.centres + np.array([left, top]))
    raise _explain_missing_grid(grid_size, largest, part)


def crop_to_outline(
    image: npt.NDArray[np.uint8], outline: Array | None
) -> tuple[npt.NDArray[np.uint8], tuple[int, int]]:
    """Return the part of an image (h, w) about an outline (m, 2), px, and its first column and row;
    the whole image if there is none."""
    if outline is None:
        return image, (0, 0)
    marked = region.enlarge_outline(outline)
    left, top = np.maximum(np.floor(marked.min(axis=0)), 0).astype(int).tolist()
    right, bottom = np.ceil(marked.max(axis=0)).astype(int).tolist()
    return image[top : bottom + 1, left : right + 1], (left, top)


def list_levels(image: npt.NDArray[np.uint8]) -> list[npt.NDArray[np.uint8]]:
    """List an image and its halved copies, down to the size that is searched first."""
    levels = [image]
    while max(levels[-1].shape) > _MAX_COARSE_SIDE:
        levels.append(opencv.halve_image(levels[-1]))
    return levels


def _explain_missing_grid(
    grid_size: GridSize | None, largest: _FoundGrid | None, part: LabelledGrid | None
) -> NoBoardError:
    """Return the error for a missing grid that says what was found instead: a grid of another size,
    or a part of one that goes on."""
    which = "" if grid_size is None else f"{grid_size[0]} x {grid_size[1]} "
    instead = ""
    if largest is not None:
        instead = ", but one of {} x {}".format(*largest.grid.places.shape)
    elif part is not None:
        instead = ", but {} x {} circles of a larger one".format(*part.places.shape)
    return NoBoardError(
        f"No grid of {which}circles was found{instead}.",
        "Almost all of it must be in view, sharp and evenly lit, with white around it."
        + (" Check the numbers of rows and columns." if grid_size else ""),
    )


class Search(NamedTuple):
    """A search for circles."""

    depth: int
    """Number of times that the image was halved."""
    photograph: npt.NDArray[np.uint8]
    """(h, w)"""
    divisor: int
    """The image's shorter side over the width of the window."""
    is_negative: bool = False
    """True if circles that are bright are looked for."""
    is_shaded: bool = False
    """True if shadows are evened out."""
    is_faint: bool = False
    """True if circles are looked for that differ little from the paper."""

    def find_blobs(self, most: int, *, is_stated: bool) -> Array:
        """Find the centres (n, 2) px of at most `most` parts that may be circles, of a grid whose
        size is stated or not: many more sizes would let others pass for the grid."""
        window = max(int(min(self.photograph.shape) / self.divisor), 9)
        difference = MIN_DIFFERENCE
        if self.is_faint:
            difference = find_faint_difference(self.photograph)
            if difference >= MIN_DIFFERENCE:
                return np.zeros((0, 2))
        return find_blobs(
            self.photograph,
            window,
            most,
            are_bright=self.is_negative,
            is_shaded=self.is_shaded,
            difference=difference,
            are_of_any_size=is_stated,
        )


def _place_part(
    searches: list[tuple[Search, Array]], grid_size: GridSize, *, asymmetric: bool
) -> CoarseGrid | None:
    """Place the part of a grid that one of the searches has shown, with its points (n, 2) px: the
    first whose place is certain, or else the first."""
    uncertain: CoarseGrid | None = None
    for search, points in searches:
        placed = place_part(
            points,
            search.photograph,
            grid_size,
            asymmetric=asymmetric,
            are_bright=search.is_negative,
        )
        if placed is not None:
            centres = (placed.centres + 0.5) * 2**search.depth - 0.5
            grid = CoarseGrid(centres, placed.in_view, True, placed.is_certain)
            if placed.is_certain:
                return grid
            uncertain = uncertain or grid
    return uncertain


class _FoundGrid(NamedTuple):
    """A grid that a search has found."""

    grid: LabelledGrid
    search: Search
    beyond: Continuation

    @property
    def excess(self) -> int:
        """Number of its places where a circle is seen, less those where none is: a grid with many
        gaps along its border may be another one, turned."""
        places = self.grid.places.size
        return (
            places
            if self.grid.is_full
            else 2 * int(np.count_nonzero(self.beyond.is_seen_at)) - places
        )


def _is_needless(
    search: Search, found: _FoundGrid, copies: int, grid_size: GridSize | None
) -> bool:
    """Return whether a search would not find more than was `found`, in an image of as many halved
    `copies`: what is rare is looked for where gaps are left, or may be hidden by a shadow."""
    if search.is_faint:
        return True
    if not (search.is_shaded or search.depth >= copies):
        return False
    is_whole = grid_size is None and found.grid.is_full
    is_hidden = search.is_shaded and found.beyond.is_shaded
    return (is_whole and not is_hidden) or search.is_negative != found.search.is_negative


def list_searches(levels: list[npt.NDArray[np.uint8]]) -> Iterator[Search]:
    """List the searches for circles in an image and its halved copies, the coarsest first. Shadows
    need to be evened out rarely and so come last, with copies that are coarser still: there the
    pixels of a screen neither tear the circles apart nor leave specks between them."""
    coarsest = len(levels) - 1
    for depth in reversed(range(len(levels))):
        # What the coarsest level does not show is small, and lies in a small window.
        divisors = _WINDOW_DIVISORS if depth == coarsest else _WINDOW_DIVISORS[-1:]
        for is_negative, divisor in product((False, True), divisors):
            yield Search(depth, levels[depth], divisor, is_negative)
    smoothed = halved = opencv.halve_image(levels[coarsest])
    for depth in range(len(levels), len(levels) + _SMOOTHED_COPIES):
        yield Search(depth, smoothed, _WINDOW_DIVISORS[0])
        yield Search(depth, smoothed, _WINDOW_DIVISORS[0], True)
        smoothed = opencv.halve_image(smoothed)
    yield Search(coarsest, levels[coarsest], _SHADED_DIVISOR, False, True)
    yield Search(coarsest, levels[coarsest], _SHADED_DIVISOR, True, True)
    for depth, image in ((coarsest, levels[coarsest]), (len(levels), halved)):
        yield Search(depth, image, _WINDOW_DIVISORS[0], is_faint=True)
        yield Search(depth, image, _WINDOW_DIVISORS[0], True, is_faint=True)
