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

from calibgui.engine.corners.lattice import Lattice
from calibgui.engine.types import Ambiguity, Array, IntArray

Board = tuple[int, int]
"""Rows and columns of inner corners."""


@dataclass(frozen=True, eq=False, slots=True)
class Numbering:
    """A lattice turned and shifted onto a board."""

    lattice: Lattice
    """Turned by quarters."""
    board: Board
    offset: tuple[int, int]
    """Row and column on the board of the lattice's first place."""


def turned(lattice: Lattice, quarters: int) -> Lattice:
    """`lattice` numbered from another of its four corners."""
    rows, cols = lattice.shape
    square = [(0, 0), (0, cols), (rows, cols), (rows, 0)][quarters % 4]
    return Lattice(np.rot90(lattice.uv, quarters), lattice.dark ^ bool(sum(square) % 2))


def ambiguity(board: Board) -> Ambiguity:
    """Turns of the board that leave its pattern unchanged."""
    rows, cols = board
    if (rows + cols) % 2:
        return Ambiguity.NONE
    if rows == cols and rows % 2 == 0:
        return Ambiguity.QUARTER_TURN
    return Ambiguity.HALF_TURN


def numberings(lattice: Lattice, board: Board | None) -> list[Numbering]:
    """All ways to put `lattice` on the board that its colours allow, the preferred first.

    Without a `board` the lattice is the board, with at least as many columns as rows. A dark
    first square is required where one of the board's origins must have it and preferred
    elsewhere; then the more upright board, then the smaller offset.
    """
    ways: list[tuple[tuple[bool, float, float, int, int], Numbering]] = []
    for quarters in range(4):
        turn = turned(lattice, quarters)
        rows, cols = turn.shape
        if board is None and rows > cols:
            continue
        size = board or turn.shape
        cosine, sine = _upright(turn)
        for row in range(size[0] - rows + 1):
            for col in range(size[1] - cols + 1):
                dark = turn.dark ^ bool((row + col) % 2)
                key = (not dark, -cosine, -sine, row, col)
                ways.append((key, Numbering(turn, size, (row, col))))
    ways.sort(key=lambda way: way[0])
    unique_origin = bool(ways) and sum(ways[0][1].board) % 2 == 1
    return [way for key, way in ways if not (unique_origin and key[0])]


def place(numbering: Numbering) -> tuple[IntArray, Array]:
    """Grid indices (n, 2) = (row, col) and positions (n, 2) px of the numbered corners."""
    cells = np.argwhere(numbering.lattice.found)
    uv = numbering.lattice.uv[cells[:, 0], cells[:, 1]]
    return cells + np.array(numbering.offset), uv


def _upright(lattice: Lattice) -> tuple[float, float]:
    """Cosine and sine from the image's u axis to the direction in which the columns grow."""
    cells = np.argwhere(lattice.found)
    uv = lattice.uv[cells[:, 0], cells[:, 1]]
    along = (cells[:, 1] - cells[:, 1].mean()) @ (uv - uv.mean(axis=0))
    cosine, sine = np.round(along / max(float(np.linalg.norm(along)), 1e-12), 6)
    return float(cosine), float(sine)
