"""PuzzleBoards: a checkerboard with a dot on every edge between two corners.

The dots, dark or white, tell where on one large pattern a part of it lies: any part of 5 x 5
corners that is read without error is unique, whichever way it is turned (Stelldinger, Schönherr and
Biermann 2024, "PuzzleBoard: A New Camera Calibration Pattern with Position Encoding",
arXiv:2409.20127). A printed board is a part of that pattern. It can be photographed in parts, and
none of its turns looks like another.

Corners are numbered by row and column of the pattern, from 0 to 500 each. With two binary maps A
and B of 3 rows and 167 columns,

    the dot between corners (r, c) and (r + 1, c) is white if A[r mod 3, c mod 167] is 1,
    the dot between corners (r, c) and (r, c + 1) is white if B[c mod 3, r mod 167] is 1.

The square above and left of corner (r, c) is dark if r + c is even. The maps and the numbering are
those of the authors' generator.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import BoolArray, GridSize
from calibgui.engine.boards.checkerboard import draw_squares
from calibgui.engine.boards.coded_pattern import CodedPattern
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.boards.printed_pattern import PrintedPattern, PrintedSquaresAndDots
from calibgui.engine.errors import CalibrationError

CODE_LINES = 501
"""Number of rows, and of columns, of the corners of the whole pattern."""
CODE_ROWS, CODE_COLS = 3, 167
"""Numbers of rows and columns of each of the maps A and B."""
DOT_DIAMETER = 1 / 3
"""Diameter of a dot over the side of a square: the authors'."""


def _unpack_map(rows: Sequence[str]) -> BoolArray:
    """Return a map (3, 167), True for a white dot, from its rows as hexadecimal numbers."""
    bits = [[digit == "1" for digit in f"{int(row, 16):0{CODE_COLS}b}"] for row in rows]
    return np.array(bits, dtype=np.bool_)


MAP_DOWN = _unpack_map(
    [
        "05c3aa91ad8771488fc15fa64aeb87edacdf73d3d1",
        "30fdfe89078982230c0e351dd6ec90d31d47131ea4",
        "20a1d0f5f41242e9b3ad65925997b9c056fad987a3",
    ]
)
"""The map A of dots between a corner and the one below it, True for a white dot."""
MAP_RIGHT = _unpack_map(
    [
        "7d4fc29bc8264fc68ed211cf404e02f96bee96b272",
        "5989acec3512ac160705b0fab6c6792576ce65c719",
        "182a3d4b0c90187a3d95494bf405ad7f11ebb286ff",
    ]
)
"""The map B of dots between a corner and the one right of it, True for a white dot."""


@dataclass(frozen=True, slots=True)
class PuzzleBoard(CodedPattern):
    """The pattern of a PuzzleBoard."""

    origin: GridSize = (0, 0)
    """Row and column, on the whole pattern, of the board's first corner."""

    def __post_init__(self) -> None:
        if not all(0 <= line < CODE_LINES for line in self.origin):
            raise CalibrationError(
                f"The PuzzleBoard pattern has no corner {self.origin[0]} x {self.origin[1]}.",
                f"State the first corner's row and column, each from 0 to {CODE_LINES - 1}.",
            )

    @property
    def kind(self) -> str:
        return "puzzleboard"

    def complete_from(self, seen: Sequence[Pattern]) -> PuzzleBoard:  # noqa: ARG002 - all is known
        """See ``Pattern``."""
        return self

    def read_dots(self, grid_size: GridSize) -> tuple[BoolArray, BoolArray]:
        """Return which dots of a board of rows x columns corners are white.

        Returns:
            (rows, columns - 1) between each corner and the next in its row, and
            (rows - 1, columns) between each corner and the one below.

        Raises:
            CalibrationError: if the pattern ends before the board does.
        """
        ends = [first + lines for first, lines in zip(self.origin, grid_size, strict=True)]
        if max(ends) > CODE_LINES:
            raise CalibrationError(
                f"A PuzzleBoard of {grid_size[0]} x {grid_size[1]} corners from corner "
                f"{self.origin[0]} x {self.origin[1]} leaves the pattern.",
                f"The pattern has {CODE_LINES} x {CODE_LINES} corners: state a smaller origin.",
            )
        row, col = (np.arange(*span) for span in zip(self.origin, ends, strict=True))
        right = MAP_RIGHT[np.ix_(col[:-1] % CODE_ROWS, row % CODE_COLS)].T
        down = MAP_DOWN[np.ix_(row[:-1] % CODE_ROWS, col % CODE_COLS)]
        return right, down

    def draw(self, grid_size: GridSize) -> PrintedPattern:
        """See ``Pattern``."""
        right, down = self.read_dots(grid_size)
        centres = [np.argwhere(np.ones_like(dots))[:, ::-1] for dots in (right, down)]
        return PrintedSquaresAndDots(
            draw_squares(grid_size, first_dark=sum(self.origin) % 2 == 0),
            np.concatenate([centres[0] + (0.5, 0.0), centres[1] + (0.0, 0.5)]),
            DOT_DIAMETER / 2,
            ~np.concatenate([right.ravel(), down.ravel()]),
        )
