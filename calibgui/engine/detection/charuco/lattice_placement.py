"""The place of a lattice of corners on a stated board, from all of its markers together.

Where the cells of markers are hardly wider than the blur, neither their outlines nor their numbers
can be read one by one, while the corners of the squares are still found. Of all the places that
their lattice may have on the board, in four turns, one has printed in every square what is seen in
it. Seen differences s of neighbouring cells are compared with the printed ones p, less what all
markers have in common, by their correlation in each square,

    r = s.p / (|s| |p|),

whose mean is 0 on a wrong place. The best place is believed if its mean is ahead of the second's by
many times the error that the squares' scatter gives.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, GreyImage, GridSize, IntArray
from calibgui.engine.detection.charuco.marker_cells import measure_cells
from calibgui.engine.detection.charuco.marker_growth import list_differences
from calibgui.engine.detection.charuco.marker_subtraction import Marks
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.lattices.numbering import turn_lattice

_MIN_SQUARES = 5
"""Least number of squares that are read together."""
_MIN_LEAD = 4.0
"""Least lead of the best place over the second, standard errors. On 38 rendered boards with cells
of 1 to 4 px and blurs of 0.5 to 1.6 px it is 4.1 to 33, and 2.9 at most on 1902 boards that are not
theirs."""
_MIN_SHARE_INSIDE = 0.5
"""Least share of a lattice that lies on the board: it may have stray lines."""
_MARGINS = tuple((np.arange(5, 31) / 100).tolist())
"""Margins that are tried, squares: markers of 0.9 to 0.4 of a square."""
_LEAST_NORM = 1e-9
"""Norm of the differences in a square, grey levels, below which nothing is seen in it."""


class MarkedBoard(NamedTuple):
    """A stated board."""

    grid_size: GridSize
    first_dark: bool
    """True if the square above and left of corner (0, 0) is dark."""
    marks: Marks


class _Place(NamedTuple):
    """A place of a lattice on a board."""

    correlation: Array
    """(n,) of what is seen in its squares with the marks that are printed there."""
    lattice: Lattice
    """The lattice, turned."""
    origin: tuple[int, int]
    """Row and column on the board of its first corner."""


def place_by_marks(image: GreyImage, lattice: Lattice, board: MarkedBoard) -> Lattice | None:
    """Place a lattice on a board where all of its marks together say.

    Args:
        image: (h, w) grey levels, the board printed dark on bright.
        lattice: corners of any part of the board, in any turn.
        board: the board.

    Returns:
        The lattice of the whole board with the corners found; None if its place is not clear.
    """
    places = sorted(_list_places(image, lattice, board), key=lambda place: -_rate(place)[0])
    if not places:
        return None
    best = places[0]
    (mean, variance), (other, its) = _rate(best), (0.0, 0.0)
    if len(places) > 1:
        other, its = _rate(places[1])
    if mean - other <= _MIN_LEAD * np.sqrt(variance + its):
        return None
    cells = np.argwhere(best.lattice.found)
    at = cells + best.origin
    inside = ((at >= 0) & (at < board.grid_size)).all(axis=1)
    uv = np.full((*board.grid_size, 2), np.nan)
    uv[tuple(at[inside].T)] = best.lattice.uv[tuple(cells[inside].T)]
    return Lattice(uv, board.first_dark)


def is_too_large(lattice: Lattice, grid_size: GridSize) -> bool:
    """Return whether a lattice has so many squares that most of them would lie beside a board of a
    size, rows and columns of corners, wherever it were placed."""
    whole = len(_list_squares(lattice)[0])
    return (grid_size[0] + 1) * (grid_size[1] + 1) < _MIN_SHARE_INSIDE * whole


def measure_margin(image: GreyImage, placed: Lattice, board: MarkedBoard) -> float:
    """Measure how far the cells of the marks are from the edges of their squares, squares: where
    what is seen in those of a `placed` lattice is most like what is printed."""
    squares, quads = _list_squares(placed)
    number = _number_squares(board)[tuple((squares + 1).T)]
    quads, number = quads[number >= 0], number[number >= 0]

    def rate(margin: float) -> float:
        there = board._replace(marks=board.marks._replace(margin=margin))
        correlation = _correlate_squares(image, quads, there)
        return float(correlation[np.arange(len(number)), number].mean())

    return max(_MARGINS, key=rate)


def _rate(place: _Place) -> tuple[float, float]:
    """Return the mean correlation at a place, and the variance of that mean."""
    r = place.correlation
    return float(r.mean()), float(r.var(ddof=1) / len(r))


def _list_places(image: GreyImage, lattice: Lattice, board: MarkedBoard) -> Iterator[_Place]:
    """List the places on the board that the colours of the squares allow."""
    if is_too_large(lattice, board.grid_size):
        return
    size, numbers = np.array(board.grid_size), _number_squares(board)
    for quarters in range(4):
        turned = turn_lattice(lattice, quarters)
        squares, quads = _list_squares(turned)
        correlation = _correlate_squares(image, quads, board)
        for origin in _list_origins(squares, size, turned.shape):
            if turned.dark ^ bool(origin.sum() % 2) != board.first_dark:
                continue
            at = squares + origin + 1  # the squares of the board begin one before its first corner
            inside = np.flatnonzero(((at >= 0) & (at <= size)).all(axis=1))
            number = numbers[tuple(at[inside].T)]
            marked = number >= 0
            if np.count_nonzero(marked) >= _MIN_SQUARES:
                there = correlation[inside[marked], number[marked]]
                yield _Place(there, turned, (int(origin[0]), int(origin[1])))


def _list_origins(squares: IntArray, size: IntArray, shape: GridSize) -> IntArray:
    """List the places (n, 2) on a board of a `size`, rows and columns, where the first corner of a
    lattice of a `shape` may lie so that most of its squares (m, 2) lie on the board."""
    spare = size - shape
    steps = (np.arange(abs(each) + 1) + min(each, 0) for each in spare.tolist())
    origins = np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 2)
    whole = np.zeros((shape[0] + 1, shape[1] + 1), dtype=np.int64)
    whole[tuple(squares.T + 1)] = 1
    before = whole.cumsum(axis=0).cumsum(axis=1)  # of the squares above and left of each
    (top, left), (bottom, right) = (
        np.clip(each, 0, shape).T for each in (-origins - 1, size - origins)
    )
    count = before[bottom, right] - before[top, right] - before[bottom, left] + before[top, left]
    return np.asarray(origins[count >= _MIN_SHARE_INSIDE * len(squares)])


def _number_squares(board: MarkedBoard) -> IntArray:
    """Return the numbers of the marks in all squares (rows + 1, cols + 1) of a board, -1 where
    there is none."""
    numbers = np.full(np.array(board.grid_size) + 1, -1)
    numbers[tuple((board.marks.squares + 1).T)] = np.arange(len(board.marks.squares))
    return numbers


def _correlate_squares(image: GreyImage, quads: Array, board: MarkedBoard) -> Array:
    """Correlate what is seen in squares (n, 4, 2) px with each of the board's marks, (n, m)."""
    marks = board.marks
    printed = list_differences(marks.cells.astype(np.float64))
    printed -= printed.mean(axis=0)
    printed /= np.maximum(np.linalg.norm(printed, axis=1, keepdims=True), _LEAST_NORM)
    # The cells of a mark are brighter than a dark square, and darker than a bright one.
    sign = 1.0 if board.first_dark ^ bool(marks.squares[0].sum() % 2) else -1.0
    inner = _inset_quads(quads, marks.margin)
    seen = sign * list_differences(measure_cells(image, inner, marks.cells.shape[1]))
    seen /= np.maximum(np.linalg.norm(seen, axis=1, keepdims=True), _LEAST_NORM)
    return np.asarray(seen @ printed.T)


def _list_squares(lattice: Lattice) -> tuple[IntArray, Array]:
    """List row and column (n, 2) of the squares between four corners of a lattice, and these
    corners (n, 4, 2) px, from the upper left one in the sense from u to v."""
    uv = lattice.uv
    quads = np.stack([uv[:-1, :-1], uv[:-1, 1:], uv[1:, 1:], uv[1:, :-1]], axis=2)
    whole = np.isfinite(quads).all(axis=(2, 3))
    return np.argwhere(whole), quads[whole]


def _inset_quads(quads: Array, margin: float) -> Array:
    """Inset quadrilaterals (n, 4, 2) by a margin, sides."""
    a, b = np.abs(np.array([(0, 0), (1, 0), (1, 1), (0, 1)]).T - margin)
    weights = np.column_stack([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b])
    return np.einsum("ij,njk->nik", weights, quads)
