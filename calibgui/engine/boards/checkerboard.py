"""What the engine asks of a pattern, and the checkerboard, the first of them.

A pattern's points are counted by row and column, whatever is printed there, so that corners of
a ChArUco board and circles of a grid are kept, drawn, marked and exported like a checkerboard's.
A pattern does not know its size: rows and columns (a ``Board``) come from the user or the images.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, GridSize
from calibgui.engine.boards.pattern import Ambiguity, Pattern
from calibgui.engine.boards.printed_pattern import Ink, Raster


@dataclass(frozen=True, slots=True)
class Checkerboard:
    """Squares; its points are the corners where four meet. Square (-1, -1) is dark."""

    @property
    def kind(self) -> str:
        return "checkerboard"

    @property
    def identified(self) -> bool:
        return False

    @property
    def squared(self) -> bool:
        return True

    def places(self, grid: Array) -> Array:
        """See ``Pattern``."""
        return grid[:, ::-1]

    def ambiguity(self, grid_size: GridSize) -> Ambiguity:
        """See ``Pattern``."""
        return checkerboard_ambiguity(grid_size)

    def completed(self, seen: Sequence[Pattern]) -> Pattern:  # noqa: ARG002 - nothing is open
        """See ``Pattern``."""
        return self

    def ink(self, grid_size: GridSize) -> Ink:
        """See ``Pattern``."""
        return squares(grid_size, first_dark=True)


def checkerboard_ambiguity(grid_size: GridSize) -> Ambiguity:
    """Turns of the board that leave its pattern unchanged."""
    rows, cols = grid_size
    if (rows + cols) % 2:
        return Ambiguity.NONE
    if rows == cols and rows % 2 == 0:
        return Ambiguity.QUARTER_TURN
    return Ambiguity.HALF_TURN


def squares(grid_size: GridSize, *, first_dark: bool) -> Raster:
    """The squares around rows x cols inner corners."""
    rows, cols = grid_size
    dark = np.indices((rows + 1, cols + 1)).sum(axis=0) % 2 == (0 if first_dark else 1)
    return Raster(np.arange(-1.0, cols + 1), np.arange(-1.0, rows + 1), dark)


CHECKERBOARD = Checkerboard()
