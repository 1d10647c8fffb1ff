"""The part of a grid of stated size that is seen in an image that cuts it is placed on the grid.

Along each direction the part is placed if it has as many lines as the grid, or if the grid is seen
to end on one side of it, with nothing but paper where the next line would have its circles, and the
image to end on the other. What is covered is no such end: the part may then have several places, as
one that the image cuts on two sides has. It is counted in one of them and said to be relative. All
places of a lattice are alike on a flat board, and a camera that is calibrated from it is the same.

Lines that the image should show are not put down to what covers them: then the size that was stated
is as likely to be wrong. Points are taken by places in pitches here, so that the columns of an
asymmetric grid have circles in every second row.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, BoolArray, GridSize, IntArray
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.detection.circles.continuation import Continuation, look_around
from calibgui.engine.detection.circles.grid_labelling import find_lattice, list_boxes
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS


class PlacedPart(NamedTuple):
    """A part of a grid in one of the places that it may have."""

    centres: Array
    """(rows, cols, 2) px, of the whole grid; NaN where no circle is seen."""
    in_view: int
    """Number of its places that the image shows."""
    is_certain: bool
    """True if it has no other place."""


class _Part(NamedTuple):
    """A part of a grid before it is placed."""

    xy: IntArray
    """(n, 2) its places, pitches from its first column and row."""
    seen: Continuation

    @property
    def are_circles(self) -> BoolArray:
        """(n,) True where a circle was found, or is seen."""
        return np.isfinite(self.seen.centres[:, 0])


def place_part(
    points: Array,
    image: npt.NDArray[np.uint8],
    grid_size: GridSize,
    *,
    asymmetric: bool,
    are_bright: bool,
) -> PlacedPart | None:
    """Place the part of a grid that is found among points (n, 2) px of an image (h, w); None if no
    part is found, or none that the image cuts."""
    lattice = find_lattice(points)
    if lattice is None or len(lattice.points) < CIRCLE_THRESHOLDS.min_grid_circles:
        return None
    per_circle = 2 if asymmetric else 1
    shape = np.array([grid_size[1] * per_circle, grid_size[0]])
    symmetry = Circles(asymmetric).symmetry(grid_size)
    found: dict[bytes, tuple[Array, _Part]] = {}
    for box in list_boxes(lattice, asymmetric=asymmetric):
        is_large = min(box.shape) >= CIRCLE_THRESHOLDS.min_grid_lines
        is_joined = _is_joined(box >= 0, asymmetric=asymmetric)
        if not (is_large and is_joined) or (np.array(box.shape[::-1]) > shape).any():
            continue
        corner = np.argwhere(box >= 0)[0]
        xy = np.argwhere((np.indices(box.shape).sum(axis=0) - corner.sum()) % per_circle == 0)
        index = box[tuple(xy.T)]
        uv = np.where((index >= 0)[:, None], points[index], np.nan)
        part = _Part(
            xy[:, ::-1],
            look_around(xy[:, ::-1], uv, image, asymmetric=asymmetric, are_bright=are_bright),
        )
        for start in _list_starts(part, shape):
            x, y = (part.xy + start).T
            if (x[0] + y[0]) % per_circle:
                continue
            centres = np.full((*grid_size, 2), np.nan)
            centres[y, x // per_circle] = part.seen.centres
            found[_describe(centres, symmetry)] = centres, part
    # One that leaves circles out is none, though what covers the right one may leave no other.
    circles = [int(np.count_nonzero(part.are_circles)) for _, part in found.values()]
    likely = [each for each, n in zip(found.values(), circles, strict=True) if n == max(circles)]
    for centres, part in likely:
        if _is_filled(part):
            shown = np.count_nonzero(part.seen.is_in_view | part.are_circles)
            return PlacedPart(centres, int(shown), len(likely) == 1)
    return None


def _is_joined(known: BoolArray, *, asymmetric: bool) -> bool:
    """Return whether most circles of a part, known (h, w) True, have the next ones beside them."""
    pairs = ((known[1:], known[:-1]), (known[:, 1:], known[:, :-1]))
    if asymmetric:
        pairs = ((known[1:, 1:], known[:-1, :-1]), (known[1:, :-1], known[:-1, 1:]))
    most = CIRCLE_THRESHOLDS.min_border_share * np.count_nonzero(known)
    return all(np.count_nonzero(a & b) > most for a, b in pairs)


def _is_filled(part: _Part) -> bool:
    """Return whether circles are seen in almost all places that the image shows, also of those on
    each border: what is more is no line of the grid."""
    gaps = part.seen.is_in_view & ~part.are_circles
    low, high = part.xy.min(axis=0), part.xy.max(axis=0)
    borders = np.concatenate([part.xy == low, part.xy == high], axis=1).T
    return all(
        np.count_nonzero(gaps[of])
        <= CIRCLE_THRESHOLDS.max_rejected_share * np.count_nonzero(part.seen.is_in_view[of])
        for of in (np.ones(len(gaps), dtype=bool), *borders)
    )


def _list_starts(part: _Part, shape: IntArray) -> Iterator[IntArray]:
    """List the places (2,), pitches, of a grid of as many columns and rows as `shape` (2,) says, at
    which a part of it may begin; none if the image shows it to go on."""
    if part.seen.is_seen:
        return
    starts = []
    for axis, size in enumerate(part.xy.max(axis=0) + 1):
        sides = np.s_[2 * (1 - axis) : 2 * (1 - axis) + 2]
        missing = int(shape[axis] - size)
        if missing and not any(part.seen.leaves[sides]):
            return
        begins, ends = part.seen.ends[sides]
        starts.append(
            [k for k in range(missing + 1) if not ((k and begins) or (missing - k and ends))]
        )
    yield from map(np.array, product(*starts))


def _describe(centres: Array, symmetry: Symmetry) -> bytes:
    """Describe a grid (rows, cols, 2) px alike in all turns that look alike."""
    step = {Symmetry.NONE: 4, Symmetry.HALF_TURN: 2, Symmetry.QUARTER_TURN: 1}[symmetry]
    return min(np.rot90(centres, k).round(2).tobytes() for k in range(0, 4, step))
