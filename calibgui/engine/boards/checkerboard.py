"""Checkerboards: dark and white squares that alternate, without any marks.

The points are the inner corners, where four squares meet. The square at (row, column) = (-1, -1),
above and left of corner (0, 0), is dark. A turn of the board must bring dark squares onto dark
ones. If the numbers of inner rows and columns are one even and one odd, no turn does; otherwise
half a turn does, and if they are equal and even a quarter of a turn does as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, GridSize
from calibgui.engine.boards.pattern import Pattern, Symmetry
from calibgui.engine.boards.printed_pattern import PrintedPattern, PrintedRectangles


@dataclass(frozen=True, slots=True)
class Checkerboard:
    """The pattern of a checkerboard; its pitch is the side of a square."""

    @property
    def kind(self) -> str:
        return "checkerboard"

    @property
    def identifies_points(self) -> bool:
        return False

    @property
    def has_squares(self) -> bool:
        return True

    def locate_points(self, grid: Array) -> Array:
        """See ``Pattern``."""
        return grid[:, ::-1]

    def symmetry(self, grid_size: GridSize) -> Symmetry:
        """See ``Pattern``."""
        return checkerboard_symmetry(grid_size)

    def complete_from(self, seen: Sequence[Pattern]) -> Pattern:  # noqa: ARG002 - nothing is unknown
        """See ``Pattern``."""
        return self

    def draw(self, grid_size: GridSize) -> PrintedPattern:
        """See ``Pattern``."""
        return draw_squares(grid_size, first_dark=True)


def checkerboard_symmetry(grid_size: GridSize) -> Symmetry:
    """The turns that leave a checkerboard of rows x columns inner corners unchanged.

    >>> checkerboard_symmetry((6, 9)).name, checkerboard_symmetry((5, 5)).name
    ('NONE', 'HALF_TURN')
    """
    rows, cols = grid_size
    if (rows + cols) % 2:
        return Symmetry.NONE
    if rows == cols and rows % 2 == 0:
        return Symmetry.QUARTER_TURN
    return Symmetry.HALF_TURN


def draw_squares(grid_size: GridSize, *, first_dark: bool) -> PrintedRectangles:
    """Return the squares around rows x columns inner corners.

    Args:
        grid_size: rows and columns of inner corners.
        first_dark: True if the square above and left of corner (0, 0) is dark.
    """
    rows, cols = grid_size
    dark = np.indices((rows + 1, cols + 1)).sum(axis=0) % 2 == (0 if first_dark else 1)
    return PrintedRectangles(np.arange(-1.0, cols + 1), np.arange(-1.0, rows + 1), dark)


CHECKERBOARD = Checkerboard()
"""The one checkerboard pattern: it has no fields."""
