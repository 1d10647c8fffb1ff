"""The markers of a ChArUco board: which of them are the board's, and their squares on it.

The markers lie in the white squares and are numbered row by row. On a board of C squares a row,
with the colours given, number k thus tells its square, p_k = (column, row). What is
unknown - the dictionary, C, the colours, the side rho of a marker over that of a square - shows in
pairs of neighbours: with the affine frame A_i of marker i (its two sides, px) and centres c,

    m_ij = ((A_i + A_j) / 2)^-1 (c_j - c_i)

is the displacement from i to j in sides of a marker, and on the right board rho m_ij = p_j - p_i.
The frame of either marker alone would be off by half of what a tilt or a fisheye changes from one
to the next. Only neighbours up to two squares away are compared, so that no lens matters, and
others only if these agree with several layouts. The layout that the most pairs agree with is taken;
the largest set of markers that such pairs connect is the board. A marker that was misread, or is of
another board, agrees with nothing.

On a board with an odd number of squares a row the colours only shift the markers by a square along
their rows, and pairs tell them apart only where a row ends. A part of a board may thus agree with
both colours; the corners beside its markers then decide.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Generic, Protocol, TypeVar

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, Int32Array, IntArray
from calibgui.engine.detection.charuco.thresholds import CHARUCO_THRESHOLDS


class SquareLayout(Protocol):
    """An order of markers on a board; equal layouts are the same."""

    def locate_squares(self, numbers: IntArray) -> IntArray:
        """Return row and column (n, 2) of the squares that hold the markers `numbers` (n,)."""


Layout = TypeVar("Layout", bound=SquareLayout)


@dataclass(frozen=True, eq=False, slots=True)
class Markers(Generic[Layout]):
    """Markers that lie on one board."""

    layout: Layout
    squares: IntArray
    """(n, 2) row and column of the square of each."""
    numbers: IntArray
    """(n,) numbers in the dictionary."""
    corners: Array
    """(n, 4, 2) px, clockwise from the upper left."""
    side: float
    """rho, side of a marker over that of a square."""

    def select(self, index: IntArray) -> Markers[Layout]:
        """Select markers by their indices (m,)."""
        return replace(
            self,
            squares=self.squares[index],
            numbers=self.numbers[index],
            corners=self.corners[index],
        )

    def join(self, other: Markers[Layout]) -> Markers[Layout]:
        """Return these markers and then others on the same layout."""
        return replace(
            self,
            squares=np.concatenate([self.squares, other.squares]),
            numbers=np.concatenate([self.numbers, other.numbers]),
            corners=np.concatenate([self.corners, other.corners]),
        )

    @property
    def board_corners(self) -> Array:
        """(n, 4, 2) the corners on the board, squares from inner corner (0, 0)."""
        corner = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
        return (self.squares[:, ::-1] - 0.5)[:, None] + self.side / 2 * corner


def identify_board(
    numbers: IntArray,
    corners: Array,
    allowed: Collection[Layout],
    known: Collection[Layout],
    least: int = CHARUCO_THRESHOLDS.min_markers,
) -> list[Markers[Layout]]:
    """Find the largest set of markers that agree on a board.

    Args:
        numbers: (n,) as read.
        corners: (n, 4, 2) px.
        allowed: layouts that the board may have.
        known: all layouts of such boards, with which those allowed are compared.
        least: number of markers that have to agree.

    Returns:
        The markers on each of the layouts that as many pairs agree with, usually one; none if too
        few agree, or more on a layout that is not allowed.
    """
    if len(numbers) < least:
        return []
    candidates = [*{**dict.fromkeys(known), **dict.fromkeys(allowed)}]
    for distance in CHARUCO_THRESHOLDS.max_marker_distances:
        i, j, displacement = _measure_displacements(corners, distance)
        located = [layout.locate_squares(numbers) for layout in candidates]
        squares = np.array(located, dtype=np.int32)  # many steps, which are small
        step = (squares.take(j, axis=1) - squares.take(i, axis=1))[..., ::-1]
        agree, sides = _find_agreeing_pairs(step, displacement, distance)
        count = agree.sum(axis=1)
        if not count.any():
            return []
        kept = np.flatnonzero(count == count.max())
        candidates = [candidates[k] for k in kept]
        if len(candidates) == 1:
            break
    sets = dict(zip(candidates, zip(agree[kept], sides[kept], strict=True), strict=True))
    boards = []
    for layout in (layout for layout in allowed if layout in sets):
        agreeing, side = sets[layout]
        part = _select_largest_part(numbers, i[agreeing], j[agreeing])
        if len(part) >= least:
            on_board = layout.locate_squares(numbers[part])
            boards.append(Markers(layout, on_board, numbers[part], corners[part], float(side)))
    return boards


def are_some_near(corners: Array) -> bool:
    """Return whether two of the markers (n, 4, 2) px are alike in size and so near to each other
    that they may be compared on a board."""
    return len(_measure_displacements(corners, CHARUCO_THRESHOLDS.max_marker_distances[-1])[0]) > 0


def drop_repeated(numbers: IntArray, corners: Array) -> tuple[IntArray, Array]:
    """Drop all but the first of the markers of one number at one place; numbers (n,), corners
    (n, 4, 2) px."""
    centre = corners.mean(axis=1)
    side = np.linalg.norm(corners[:, 0] - corners[:, 1], axis=1)
    near = np.asarray(np.linalg.norm(centre - centre[:, None], axis=2) < side[:, None] / 2)
    same = near & (np.subtract.outer(numbers, numbers) == 0)
    first = np.flatnonzero(~np.tril(same, -1).any(axis=1))
    return numbers[first], corners[first]


def _select_largest_part(numbers: IntArray, i: IntArray, j: IntArray) -> IntArray:
    """Select the indices of the largest set of markers that pairs i, j (p,) connect, without those
    whose number was read twice in it."""
    part, before = np.arange(len(numbers)), None
    while before is None or (part != before).any():  # the least index spreads over its set
        before, part = part, part[part]
        np.minimum.at(part, i, part[j])
        np.minimum.at(part, j, part[i])
    largest = np.flatnonzero(part == np.bincount(part).argmax())
    times_read = Counter(numbers[largest].tolist())
    return largest[[times_read[k] == 1 for k in numbers[largest].tolist()]]


def _measure_displacements(corners: Array, max_distance: int) -> tuple[IntArray, IntArray, Array]:
    """Measure m_ij (p, 2) of pairs i, j (p,) of markers (n, 4, 2) px that may be at most
    `max_distance` squares apart."""
    right = (corners[:, 1] + corners[:, 2] - corners[:, 0] - corners[:, 3]) / 2
    down = (corners[:, 2] + corners[:, 3] - corners[:, 0] - corners[:, 1]) / 2
    A = np.stack([right, down], axis=2)
    apart = corners.mean(axis=1) - corners.mean(axis=1)[:, None]
    m = (_invert_frames(A)[:, None] @ apart[..., None])[..., 0]
    near = np.abs(m).max(axis=2) < max_distance / CHARUCO_THRESHOLDS.min_marker_side
    i, j = np.nonzero(np.triu(near & near.T, 1))
    between = _invert_frames((A[i] + A[j]) / 2)
    return i, j, (between @ apart[i, j, :, None])[..., 0]


def _invert_frames(A: Array) -> Array:
    """Invert affine frames (n, 2, 2) px; from one without area everything is far."""
    has_area = abs(np.linalg.det(A)) >= 1.0
    return np.linalg.inv(np.where(has_area[:, None, None], A, 1e-9 * np.eye(2)))


def _find_agreeing_pairs(
    step: Int32Array, displacement: Array, max_distance: int
) -> tuple[BoolArray, Array]:
    """Find the pairs (k, p) whose displacements (p, 2) are `step` (k, p, 2) squares, at most
    `max_distance`, on each of k layouts, and the sides rho (k,) that they agree on."""
    limits = CHARUCO_THRESHOLDS
    distance = np.maximum(abs(step[..., 0]), abs(step[..., 1]))
    agree = np.zeros(distance.shape, dtype=np.bool_)
    layout, pair = np.nonzero((distance > 0) & (distance <= max_distance))
    step, seen, distance = step[layout, pair], displacement[pair], distance[layout, pair]
    sides = np.sum(step * seen, axis=1) / np.sum(seen**2, axis=1)
    likely = (sides > limits.min_marker_side) & (sides < 1)
    side = _compute_medians(sides[likely], layout[likely], len(agree))
    off = np.linalg.norm(side[layout, None] * seen - step, axis=1)
    agree[layout, pair] = off < limits.max_pair_disagreement * distance
    return agree, side


def _compute_medians(values: Array, group: IntArray, count: int) -> Array:
    """Compute the medians (count,) of the values (n,) of groups (n,); 0 for a group of none."""
    order = np.lexsort([values, group])
    size = np.bincount(group, minlength=count)
    first = np.cumsum(size) - size
    medians = np.zeros(count)
    filled = size > 0
    low, high = (first + (size - 1) // 2)[filled], (first + size // 2)[filled]
    medians[filled] = (values[order[low]] + values[order[high]]) / 2
    return medians
