"""What the engine asks of a pattern, and the checkerboard, the first of them.

A pattern's points are counted by row and column, whatever is printed there, so that corners of
a ChArUco board and circles of a grid are kept, drawn, marked and exported like a checkerboard's.
A pattern does not know its size: rows and columns (a ``Board``) come from the user or the images.

Targets, and what images show of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from typing import Protocol

from calibgui.engine.arrays import Array, GridSize
from calibgui.engine.boards.printed_pattern import Ink


class Pattern(Protocol):
    """What is printed on a target. An implementation is a frozen dataclass; a field that is None
    is to be found out from the images."""

    @property
    def kind(self) -> str:
        """Its name in files and on the command line."""

    @property
    def identified(self) -> bool:
        """Whether a point says which one it is: then a part of the board shows at least how many
        rows and columns the whole has."""

    @property
    def squared(self) -> bool:
        """Whether it is printed in squares, the points being their corners."""

    def places(self, grid: Array) -> Array:
        """(n, 2) plate coordinates of points (n, 2) = (row, column), pitches."""

    def ambiguity(self, grid_size: GridSize) -> Ambiguity:
        """Turns that leave the pattern of a board unchanged."""

    def completed(self, seen: Sequence[Pattern]) -> Pattern:
        """The pattern with what it leaves open as the images show it, each by itself."""

    def ink(self, grid_size: GridSize) -> Ink:
        """What is printed. Raises CalibrationError if something of it is still open."""


class Ambiguity(StrEnum):
    """Turns of the board that its pattern does not tell apart."""

    NONE = "none"
    HALF_TURN = "180"
    QUARTER_TURN = "90"
