"""The contract of a pattern: what the engine needs to know of anything printed on a board.

A pattern's points are numbered by row and column, whatever is printed there, so that the corners of
a ChArUco board and the circles of a grid are kept, drawn, marked and exported like those of a
checkerboard. Lengths are pitches: the side of a square or the distance of neighbouring rows. A
pattern does not know its size: rows and columns (a ``Board``) come from the user or the images.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from typing import Protocol

from calibgui.engine.arrays import Array, GridSize
from calibgui.engine.boards.printed_pattern import PrintedPattern


class Symmetry(StrEnum):
    """The turns of a board about its normal that leave its pattern unchanged.

    A photograph of a symmetric board does not tell its possible origins apart.
    """

    NONE = "none"
    """No turn: the origin is unique."""
    HALF_TURN = "180"
    """Half a turn: two origins are possible."""
    QUARTER_TURN = "90"
    """Every quarter of a turn: four origins are possible."""


class Pattern(Protocol):
    """The pattern that is printed on a board.

    An implementation is a frozen dataclass. A field that is None is unknown and is to be inferred
    from the images.
    """

    @property
    def kind(self) -> str:
        """The pattern's name in files and on the command line."""

    @property
    def identifies_points(self) -> bool:
        """True if the print tells which point is which. A partial view of such a board then shows
        the least number of rows and columns that the whole may have."""

    @property
    def has_squares(self) -> bool:
        """True if the pattern consists of squares and its points are their corners."""

    def locate_points(self, grid: Array) -> Array:
        """Compute board coordinates (n, 2), pitches, of points (n, 2) = (row, column)."""

    def symmetry(self, grid_size: GridSize) -> Symmetry:
        """The turns that leave a board of rows x columns points unchanged."""

    def complete_from(self, seen: Sequence[Pattern]) -> Pattern:
        """Return the pattern with its unknown fields filled in from `seen`, what each image shows
        by itself; fields that are stated are kept."""

    def draw(self, grid_size: GridSize) -> PrintedPattern:
        """Return the print of a board of rows x columns points.

        Raises:
            CalibrationError: if a field that the print depends on is unknown.
        """
