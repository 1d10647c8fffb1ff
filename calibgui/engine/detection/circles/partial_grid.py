"""Which part of a symmetric grid of stated size is seen in an image that cuts it?

Along each direction the part is placed if it has as many lines as the grid, or if the grid is seen
to end on one side of it: there is nothing but paper where the next line would have its circles.
What is covered or lies outside of the image is no such end, and a place that is not certain is
none. Parts of asymmetric grids look too much alike in other turns, once something covers circles.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GridSize
from calibgui.engine.detection.circles.continuation import Continuation, find_continuation
from calibgui.engine.detection.circles.grid_labelling import find_lattice, list_boxes
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS
from calibgui.engine.errors import NoBoardError


class _Part(NamedTuple):
    """A part of a grid."""

    seen: Continuation
    starts: list[tuple[int, int]]
    """The rows and columns of the grid at which it may begin."""

    def place(self, grid_size: GridSize) -> Array:
        """Return the circles (rows, cols, 2) px of the whole grid if the part has the first place
        that it may have; NaN where no circle is seen."""
        centres = np.full((*grid_size, 2), np.nan)
        (row, col), (rows, cols, _) = self.starts[0], self.seen.centres.shape
        centres[row : row + rows, col : col + cols] = self.seen.centres
        return centres

    @property
    def circles(self) -> int:
        """Number of its circles that are seen."""
        return int(np.count_nonzero(self.seen.is_seen_at))

    @property
    def in_view(self) -> int:
        """Number of its places that the image shows."""
        return int(np.count_nonzero(self.seen.is_in_view | np.isfinite(self.seen.centres[..., 0])))


def place_part(
    points: Array, image: npt.NDArray[np.uint8], grid_size: GridSize, *, are_bright: bool
) -> tuple[Array, int] | None:
    """Place the part of a grid that is found among points (n, 2) px of an image (h, w).

    Returns:
        (rows, cols, 2) px of the whole grid, NaN where no circle is seen, and the number of its
        places that the image shows; None if no part is found.

    Raises:
        NoBoardError: if the part may have several places.
    """
    lattice = find_lattice(points)
    if lattice is None or len(lattice.points) < CIRCLE_THRESHOLDS.min_grid_circles:
        return None
    parts: list[_Part] = []
    for box in list_boxes(lattice):
        rows, cols = box.shape
        is_large = min(rows, cols) >= CIRCLE_THRESHOLDS.min_grid_lines
        is_dense = np.mean(box >= 0) > CIRCLE_THRESHOLDS.min_border_share
        if not (is_large and is_dense) or rows > grid_size[0] or cols > grid_size[1]:
            continue
        known = np.where((box >= 0)[..., None], points[box], np.nan)
        seen = find_continuation(known, image, asymmetric=False, are_bright=are_bright)
        starts = list(_list_starts((rows, cols), grid_size, seen))
        if starts:
            parts.append(_Part(seen, starts))
    # One that leaves circles out is none, though what covers the right one may leave no other.
    most = max((part.circles for part in parts), default=0)
    likely = [part for part in parts if part.circles == most]
    if not any(_is_filled(part.seen) for part in likely):
        return None
    if all(len(part.starts) == 1 for part in likely):
        placed = [part.place(grid_size) for part in likely]
        if len(set(map(_describe, placed))) == 1:
            return placed[0], likely[0].in_view
    raise NoBoardError(
        "The picture shows {} circles of a grid of {} x {}, but not which of them.".format(
            most, *grid_size
        ),
        "Show the whole grid, or paper beyond its end on two sides that meet, or leave the picture"
        " out.",
    )


def _is_filled(seen: Continuation) -> bool:
    """Return whether circles are seen in almost all places that the image shows, also of those on
    each border: what is more is no line of the grid."""
    gaps = seen.is_in_view & ~seen.is_seen_at
    return all(
        np.count_nonzero(gaps[part])
        <= CIRCLE_THRESHOLDS.max_rejected_share * np.count_nonzero(seen.is_in_view[part])
        for part in (np.s_[:], np.s_[0], np.s_[-1], np.s_[:, 0], np.s_[:, -1])
    )


def _list_starts(
    size: GridSize, grid_size: GridSize, seen: Continuation
) -> Iterator[tuple[int, int]]:
    """List the rows and columns of a grid at which a part of `size` of it may begin."""
    rows, cols = (
        [
            k
            for k in range(grid_size[axis] - size[axis] + 1)
            if _may_lie(k, seen, 2 * axis)
            and _may_lie(grid_size[axis] - size[axis] - k, seen, 2 * axis + 1)
        ]
        for axis in (0, 1)
    )
    return product(rows, cols)


def _may_lie(lines: int, seen: Continuation, side: int) -> bool:
    """Return whether the grid may have that many lines beyond one of the part's four sides."""
    return not (seen.ends[side] if lines else seen.goes_on[side])


def _describe(centres: Array) -> bytes:
    """Describe a grid (rows, cols, 2) px alike in all turns that look alike."""
    step = 1 if len(centres) == len(centres[0]) else 2
    return min(np.rot90(centres, k).round(2).tobytes() for k in range(0, 4, step))
