"""Targets, and what images show of them."""

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
    """A flat target: by default a checkerboard with rows x cols inner corners (the paper's M x N).

    Plate frame: origin at point (0, 0), X along a row (increasing column), Y down the
    rows, both in mm, so that an upright board seen from its front has R close to identity.
    """

    rows: int
    cols: int
    square: float
    """The pattern's pitch, mm: the side of a square (the paper's D_o)."""
    pattern: Pattern = CHECKERBOARD
    """What is printed, and how it is found."""

    def __post_init__(self) -> None:
        if not (self.rows >= 1 and self.cols >= 1 and 0 < self.square < math.inf):
            raise CalibrationError(
                f"There is no target of {self.rows} x {self.cols} points {self.square} mm apart.",
                "Count its rows and columns of inner corners, and measure a square in mm.",
            )

    @property
    def grid_size(self) -> GridSize:
        """Rows and columns."""
        return self.rows, self.cols

    def points(self, grid: npt.ArrayLike | None = None) -> Array:
        """(n, 2) plate coordinates, mm, of points (n, 2) = (row, column); all by default."""
        if grid is None:
            grid = np.indices(self.grid_size).reshape(2, -1).T
        return self.pattern.places(np.asarray(grid, dtype=np.float64)) * self.square
