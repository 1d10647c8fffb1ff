"""The markers of a ChArUco board: which of them are the board's, and how the board counts them.

The markers lie in the white squares and are numbered row by row. On a board of C squares a row,
with the colours given, number k thus says in which square it lies, p_k = (column, row). What is
unknown - the dictionary, C, the colours, the side rho of a marker over that of a square - shows in
pairs of neighbours: with the affine frame A_i of marker i (its two sides, px) and centres c,

    m_ij = A_i^-1 (c_j - c_i)

is the way from i to j in sides of a marker, and on the right board rho m_ij = p_j - p_i. Only
neighbours up to two squares away are compared, so that no lens matters. The board that the most
pairs agree with is taken, if no other does as well; the largest set of markers that hang together
by such pairs is it. A marker that was misread, or is of another board, agrees with nothing.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.boards.charuco import LAYOUTS, Layout

_NEAR = 2
"""Markers at most so many squares apart along each axis are compared."""
_SMALLEST = 0.2
"""Least side of a marker, squares."""
_AGREE = 0.25
"""Greatest difference of a pair's two distances, over the larger one's number of squares."""
MIN_MARKERS = 3


@dataclass(frozen=True, eq=False, slots=True)
class Markers:
    """Markers that lie on one board."""

    layout: Layout
    squares: IntArray
    """(n, 2) row and column of the square of each."""
    numbers: IntArray
    """(n,)"""
    corners: Array
    """(n, 4, 2) px, clockwise from the upper left."""
    side: float
    """rho, of a marker over that of a square."""

    @property
    def places(self) -> Array:
        """(n, 4, 2) the corners on the plate, squares from inner corner (0, 0)."""
        corner = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
        return (self.squares[:, ::-1] - 0.5)[:, None] + self.side / 2 * corner


def on_board(numbers: IntArray, corners: Array, allowed: Collection[Layout]) -> Markers | None:
    """The largest set of markers that agree on a board.

    Args:
        numbers: (n,) as read.
        corners: (n, 4, 2) px.
        allowed: layouts that the board may have.

    Returns:
        None if fewer than `MIN_MARKERS` agree, or more pairs on a layout that is not allowed, or
        as many on another that is.
    """
    if len(numbers) < MIN_MARKERS:
        return None
    i, j, way = _ways(corners)
    sets: dict[Layout, tuple[BoolArray, float]] = {}
    for layout in {**dict.fromkeys(LAYOUTS), **dict.fromkeys(allowed)}:
        squares = layout.squares(numbers)
        sets[layout] = _agreeing((squares[j] - squares[i])[:, ::-1], way)
    most = max(agree.sum() for agree, _ in sets.values())
    best = [layout for layout in allowed if sets[layout][0].sum() == most]
    if most < MIN_MARKERS - 1 or len(best) != 1:
        return None
    (layout,) = best
    agree, side = sets[layout]
    ends = i[agree], j[agree]
    links = scipy.sparse.coo_array((np.ones(int(most)), ends), shape=(len(numbers),) * 2)
    part = scipy.sparse.csgraph.connected_components(links, directed=False)[1]
    largest = np.flatnonzero(part == np.bincount(part).argmax())
    read = Counter(numbers[largest].tolist())
    kept = largest[[read[k] == 1 for k in numbers[largest].tolist()]]
    if len(kept) < MIN_MARKERS:
        return None
    return Markers(layout, layout.squares(numbers[kept]), numbers[kept], corners[kept], side)


def _ways(corners: Array) -> tuple[IntArray, IntArray, Array]:
    """Pairs i, j (p,) of markers not far from each other, and m_ij (p, 2)."""
    right = (corners[:, 1] + corners[:, 2] - corners[:, 0] - corners[:, 3]) / 2
    down = (corners[:, 2] + corners[:, 3] - corners[:, 0] - corners[:, 1]) / 2
    A = np.stack([right, down], axis=2)
    A[abs(np.linalg.det(A)) < 1.0] = 1e-9 * np.eye(2)  # without area: everything is far from it
    centre = corners.mean(axis=1)
    m = (np.linalg.inv(A)[:, None] @ (centre - centre[:, None])[..., None])[..., 0]
    near = np.abs(m).max(axis=2) < _NEAR / _SMALLEST
    i, j = np.nonzero(near & near.T & ~np.eye(len(m), dtype=np.bool_))
    return i, j, m[i, j]


def _agreeing(step: IntArray, way: Array) -> tuple[BoolArray, float]:
    """Which pairs (p,) lie `step` (p, 2) squares apart, and the side rho that most agree on."""
    distance = np.abs(step).max(axis=1)
    near = (distance > 0) & (distance <= _NEAR)
    sides = np.sum(step * way, axis=1)[near] / np.sum(way[near] ** 2, axis=1)
    sides = sides[(sides > _SMALLEST) & (sides < 1)]
    if not len(sides):
        return np.zeros_like(near), 0.0
    side = float(np.median(sides))
    off = np.linalg.norm(side * way - step, axis=1)
    return np.asarray(near & (off < _AGREE * distance)), side
