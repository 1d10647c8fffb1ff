"""The numbering of corners: which is which (appendix A without lines), and the board's origin.

The paper sorts the corners along straight lines between the four clicked ones, within a
threshold, which a barrel-distorted board leaves. The walk along the graph of neighbours
(`neighbour_graph`) orders them by neighbourhood instead; left to decide is which of the lattice's
four corners is the origin.

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
from calibgui.engine.boards.checkerboard import checkerboard_symmetry
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.features.lattice import Lattice

Sides = tuple[bool, bool, bool, bool]
"""A flag for each side of a lattice: above the first row, right of the last column, below the last
row, left of the first column."""


@dataclass(frozen=True, eq=False, slots=True)
class Numbering:
    """A lattice turned and shifted onto a board."""

    lattice: Lattice
    """The lattice, turned by quarters."""
    quarters: int
    """Number of quarters: see `turn_lattice`."""
    grid_size: GridSize
    """Rows and columns of the board."""
    offset: tuple[int, int]
    """Row and column on the board of the lattice's first place."""

    @property
    def dark(self) -> bool:
        """True if the board's first square is dark."""
        return self.lattice.dark ^ bool(sum(self.offset) % 2)


def turn_lattice(lattice: Lattice, quarters: int) -> Lattice:
    """Turn a lattice by quarters counter-clockwise, so that another of its corners is the first."""
    rows, cols = lattice.shape
    square = [(0, 0), (0, cols), (rows, cols), (rows, 0)][quarters % 4]
    # As `np.rot90`, which takes several times as long.
    uv = lattice.uv.swapaxes(0, 1) if quarters % 2 else lattice.uv
    down, right = [(1, 1), (-1, 1), (-1, -1), (1, -1)][quarters % 4]
    return Lattice(uv[::down, ::right], lattice.dark ^ bool(sum(square) % 2))


def list_numberings(
    lattice: Lattice, grid_size: GridSize | None, ends: Sides = (False, False, False, False)
) -> list[Numbering]:
    """List all ways to put a lattice on the board that its colours allow, the preferred first.

    A dark first square is required where one of the board's origins must have it and preferred
    elsewhere; then the more upright board, then the smaller offset.

    Args:
        lattice: corners found.
        grid_size: rows and columns of the board that they are part of; if None the lattice is the
            board, with at least as many columns as rows.
        ends: the sides on which the lattice ends with the board.
    """
    ranked: list[tuple[tuple[bool, float, float, int, int], Numbering]] = []
    for quarters in range(4):
        turned = turn_lattice(lattice, quarters)
        rows, cols = turned.shape
        if grid_size is None and rows > cols:
            continue
        size = grid_size or turned.shape
        cosine, sine = _measure_direction(turned)
        top, right, bottom, left = ends[quarters:] + ends[:quarters]
        for row in _list_offsets(size[0] - rows, top, bottom):
            for col in _list_offsets(size[1] - cols, left, right):
                numbering = Numbering(turned, quarters, size, (row, col))
                rank = (not numbering.dark, -cosine, -sine, row, col)
                ranked.append((rank, numbering))
    ranked.sort(key=lambda pair: pair[0])
    is_unique = bool(ranked) and sum(ranked[0][1].grid_size) % 2 == 1
    return [numbering for _, numbering in ranked if numbering.dark or not is_unique]


def _list_offsets(unseen: int, shows_first: bool, shows_last: bool) -> list[int]:
    """List the lines at which a part may start that leaves `unseen` lines of the board out and
    shows its first or its last line."""
    return [
        k
        for k in range(unseen + 1)
        if not (shows_first and k > 0) and not (shows_last and k < unseen)
    ]


def is_relative(numberings: list[Numbering]) -> bool:
    """Return whether more than a turn that the board's pattern hides is open between numberings."""
    hidden = {Symmetry.NONE: 1, Symmetry.HALF_TURN: 2, Symmetry.QUARTER_TURN: 4}
    alike = [each for each in numberings if each.dark == numberings[0].dark]
    return len(alike) > hidden[checkerboard_symmetry(numberings[0].grid_size)]


def place_corners(numbering: Numbering) -> tuple[IntArray, Array, IntArray]:
    """Place the corners of a numbered lattice on the board.

    Returns:
        Grid indices (n, 2) = (row, col), positions (n, 2) px, and the place (n,) of each among the
        corners of the lattice before it was turned.
    """
    found = numbering.lattice.found
    before = np.rot90(found, -numbering.quarters)
    count = np.cumsum(before).reshape(before.shape) - 1
    order = np.rot90(count, numbering.quarters)[found]
    return np.argwhere(found) + np.array(numbering.offset), numbering.lattice.uv[found], order


def _measure_direction(lattice: Lattice) -> tuple[float, float]:
    """Return the cosine and the sine of the angle from the image's u axis to the direction in which
    the columns grow, rounded so that ties remain ties."""
    cells = np.argwhere(lattice.found)
    uv = lattice.uv[cells[:, 0], cells[:, 1]]
    along = (cells[:, 1] - cells[:, 1].mean()) @ (uv - uv.mean(axis=0))
    cosine, sine = np.round(along / max(float(np.linalg.norm(along)), 1e-12), 6)
    return float(cosine), float(sine)
