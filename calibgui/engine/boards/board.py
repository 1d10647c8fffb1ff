"""A flat calibration board: its pattern, its size and its pitch."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GridSize
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.errors import CalibrationError


@dataclass(frozen=True, slots=True)
class Board:
    """A flat board: by default a checkerboard with rows x cols inner corners (the paper's M x N).

    The board's frame has its origin at point (0, 0), X along a row (increasing column) and Y down
    the rows, both in mm, so that an upright board seen from its front has R close to identity.

    >>> board = Board(rows=2, cols=3, square=25.0)
    >>> board.grid_size
    (2, 3)
    >>> board.points().tolist()
    [[0.0, 0.0], [25.0, 0.0], [50.0, 0.0], [0.0, 25.0], [25.0, 25.0], [50.0, 25.0]]
    >>> board.points([(1, 2)]).tolist()
    [[50.0, 25.0]]
    """

    rows: int
    """Number of rows of points; inner corners on a checkerboard."""
    cols: int
    """Number of columns of points."""
    square: float
    """The pattern's pitch, mm: the side of a square (the paper's D_o) or the distance of rows."""
    pattern: Pattern = CHECKERBOARD
    """The pattern that is printed on the board."""
    square_sigma: float = 0.0
    """Standard deviation of the pitch, mm, which all squares share: the board's scale. 0 if it
    counts as exact."""

    def __post_init__(self) -> None:
        if not (self.rows >= 1 and self.cols >= 1 and 0 < self.square < math.inf):
            raise CalibrationError(
                f"There is no board of {self.rows} x {self.cols} points {self.square} mm apart.",
                "Count its rows and columns of inner corners, and measure a square in mm.",
            )
        if not 0 <= self.square_sigma < self.square:
            raise CalibrationError(
                f"Squares of {self.square:g} mm cannot be uncertain by {self.square_sigma:g} mm.",
                "State the standard deviation of their side, mm, as in 30 ± 0.02.",
            )

    @property
    def grid_size(self) -> GridSize:
        """Rows and columns."""
        return self.rows, self.cols

    @property
    def scale_sigma(self) -> float:
        """Standard deviation of the board's scale, by which every length is in error, relative."""
        return self.square_sigma / self.square

    def points(self, grid: npt.ArrayLike | None = None) -> Array:
        """Compute board coordinates (n, 2), mm, of points (n, 2) = (row, column).

        Without `grid` those of all points are returned, row by row.
        """
        if grid is None:
            grid = np.indices(self.grid_size).reshape(2, -1).T
        return self.pattern.locate_points(np.asarray(grid, dtype=np.float64)) * self.square
