"""Which corner is which: appendix A without lines, and the board's origin.

The paper sorts the corners along straight lines between the four clicked ones, within a
threshold, which a barrel-distorted board leaves. The lattice walk (`lattice.py`) orders them by
neighbourhood instead; left to decide is which of the lattice's four corners is the origin.

A numbering is kept right-handed in the image (columns to the right of rows, as on an upright
board seen from its front) and may still be turned by quarters. With M rows and N columns of
inner corners the board has (M + 1) x (N + 1) squares, and the square at index (i, j) is dark if
i + j is even, given a dark first one. The far end (M, N) then is dark as well exactly if M + N
is even: only an odd sum makes "the corner whose outer square is dark" unique. For an even sum a
half turn cannot be seen, and for M = N also a quarter turn, (0, N) being dark, if N is even.
Among indistinguishable origins the one that makes the board upright in the image is taken.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, GridSize, IntArray
from calibgui.engine.boards.checkerboard import checkerboard_ambiguity
from calibgui.engine.boards.pattern import Ambiguity
from calibgui.engine.detection.lattice import Lattice

Sides = tuple[bool, bool, bool, bool]
"""Above the first row, right of the last column, below the last row, left of the first column."""


@dataclass(frozen=True, eq=False, slots=True)
class Numbering:
    """A lattice turned and shifted onto a board."""

    lattice: Lattice
    """Turned by quarters."""
    quarters: int
    """How many: see `turned`."""
    grid_size: GridSize
    offset: tuple[int, int]
    """Row and column on the board of the lattice's first place."""

    @property
    def dark(self) -> bool:
        """Whether the board's first square is."""
        return self.lattice.dark ^ bool(sum(self.offset) % 2)


def turned(lattice: Lattice, quarters: int) -> Lattice:
    """`lattice` numbered from another of its four corners."""
    rows, cols = lattice.shape
    square = [(0, 0), (0, cols), (rows, cols), (rows, 0)][quarters % 4]
    return Lattice(np.rot90(lattice.uv, quarters), lattice.dark ^ bool(sum(square) % 2))


def numberings(
    lattice: Lattice, grid_size: GridSize | None, ends: Sides = (False, False, False, False)
) -> list[Numbering]:
    """All ways to put `lattice` on the board that its colours allow, the preferred first.

    Without a `board` the lattice is the board, with at least as many columns as rows. A dark
    first square is required where one of the board's origins must have it and preferred
    elsewhere; then the more upright board, then the smaller offset.

    Args:
        lattice: what was found.
        board: that it is part of.
        ends: the sides on which the lattice ends with the board.
    """
    ways: list[tuple[tuple[bool, float, float, int, int], Numbering]] = []
    for quarters in range(4):
        turn = turned(lattice, quarters)
        rows, cols = turn.shape
        if grid_size is None and rows > cols:
            continue
        size = grid_size or turn.shape
        cosine, sine = _upright(turn)
        top, right, bottom, left = ends[quarters:] + ends[:quarters]
        for row in _offsets(size[0] - rows, top, bottom):
            for col in _offsets(size[1] - cols, left, right):
                way = Numbering(turn, quarters, size, (row, col))
                ways.append(((not way.dark, -cosine, -sine, row, col), way))
    ways.sort(key=lambda way: way[0])
    unique_origin = bool(ways) and sum(ways[0][1].grid_size) % 2 == 1
    return [way for _, way in ways if way.dark or not unique_origin]


def _offsets(room: int, first: bool, last: bool) -> list[int]:
    """Where a part may start that leaves `room` lines and shows the board's first or last one."""
    return [k for k in range(room + 1) if not (first and k > 0) and not (last and k < room)]


def relative(ways: list[Numbering]) -> bool:
    """Whether more than a turn that the board's pattern hides is open between the numberings."""
    hidden = {Ambiguity.NONE: 1, Ambiguity.HALF_TURN: 2, Ambiguity.QUARTER_TURN: 4}
    alike = [way for way in ways if way.dark == ways[0].dark]
    return len(alike) > hidden[checkerboard_ambiguity(ways[0].grid_size)]


def place(numbering: Numbering) -> tuple[IntArray, Array, IntArray]:
    """Grid indices (n, 2) = (row, col) and positions (n, 2) px of the numbered corners, and the
    place (n,) of each among the corners of the lattice before it was turned."""
    found = numbering.lattice.found
    before = np.rot90(found, -numbering.quarters)
    count = np.cumsum(before).reshape(before.shape) - 1
    order = np.rot90(count, numbering.quarters)[found]
    return np.argwhere(found) + np.array(numbering.offset), numbering.lattice.uv[found], order


def _upright(lattice: Lattice) -> tuple[float, float]:
    """Cosine and sine from the image's u axis to the direction in which the columns grow."""
    cells = np.argwhere(lattice.found)
    uv = lattice.uv[cells[:, 0], cells[:, 1]]
    along = (cells[:, 1] - cells[:, 1].mean()) @ (uv - uv.mean(axis=0))
    cosine, sine = np.round(along / max(float(np.linalg.norm(along)), 1e-12), 6)
    return float(cosine), float(sine)
