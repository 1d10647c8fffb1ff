"""Grids of circles, symmetric and asymmetric.

In a symmetric grid of M x N circles the one in row m, column n is at X = n, Y = m. In an asymmetric
one every second row is shifted by half the distance of its circles: X = 2 n + m mod 2, Y = m. Its
pitch is the distance of the rows, which is half the distance of neighbours in a row.

Circles have no colours that tell the corners of the grid apart. A symmetric grid is the same after
half a turn, and after a quarter of a turn if M = N. Half a turn of an asymmetric one takes row m to
M - 1 - m and X to 2 N - 1 - X, which is the same grid if M is even; if M is odd its origin is
unique. Reflections are excluded: a printed board is seen from its front only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, GridSize, IntArray
from calibgui.engine.boards.pattern import Pattern, Symmetry
from calibgui.engine.boards.printed_pattern import PrintedDiscs, PrintedPattern
from calibgui.engine.errors import CalibrationError


@dataclass(frozen=True, slots=True)
class Circles:
    """The pattern of a grid of circles.

    Lengths are ratios to the pitch, as in every pattern: circles of 12 mm whose rows are 20 mm
    apart are ``Circles(diameter=12 / 20)``, on a ``Board`` with ``square=20``.
    """

    asymmetric: bool = False
    """True if every second row is shifted by half the distance of its circles."""
    diameter: float | None = None
    """Ratio of the circles' diameter to the pitch, no length; None if it is to be measured in the
    images."""

    def __post_init__(self) -> None:
        if self.diameter is not None and not 0 < self.diameter < 2 * self.half_distance:
            raise CalibrationError(
                f"The circles' diameter is {self.diameter:.4g} of the distance of their rows, and "
                f"must be above 0 and below {2 * self.half_distance:.2f}, where they touch.",
                "Measure both in mm. In Python their ratio is stated, as diameter=12 / 20.",
            )

    @property
    def kind(self) -> str:
        return "asymmetric-circles" if self.asymmetric else "circles"

    @property
    def identifies_points(self) -> bool:
        return False

    @property
    def has_squares(self) -> bool:
        return False

    @property
    def half_distance(self) -> float:
        """Half the distance of the nearest neighbours, pitches: the radius at which they touch."""
        return 0.5**0.5 if self.asymmetric else 0.5

    def list_paper(self) -> Array:
        """List displacements (4, 2) from a circle's centre to paper around it, pitches."""
        if self.asymmetric:
            return np.array([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)])
        return np.array([(0.5, 0.5), (-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)])

    def list_neighbours(self) -> Array:
        """List displacements (2, 2) from a circle to its neighbours on one side, pitches."""
        return np.array([(1.0, 1.0), (1.0, -1.0)]) if self.asymmetric else np.eye(2)

    def locate_points(self, grid: Array) -> Array:
        """See ``Pattern``."""
        row, col = grid[:, 0], grid[:, 1]
        return np.column_stack([2 * col + row % 2 if self.asymmetric else col, row])

    def symmetry(self, grid_size: GridSize) -> Symmetry:
        """See ``Pattern``."""
        rows, cols = grid_size
        if self.asymmetric:
            return Symmetry.NONE if rows % 2 else Symmetry.HALF_TURN
        return Symmetry.QUARTER_TURN if rows == cols else Symmetry.HALF_TURN

    def complete_from(self, seen: Sequence[Pattern]) -> Circles:
        """See ``Pattern``: the diameter is the median of those seen."""
        diameters = [
            pattern.diameter
            for pattern in seen
            if isinstance(pattern, Circles) and pattern.diameter
        ]
        if self.diameter is not None or not diameters:
            return self
        return Circles(self.asymmetric, round(float(np.median(diameters)), 4))

    def draw(self, grid_size: GridSize) -> PrintedPattern:
        """See ``Pattern``."""
        if self.diameter is None:
            raise CalibrationError("The circles' diameter is not known.", "State it.")
        centres = self.locate_points(list_grid_indices(grid_size).astype(np.float64))
        right, bottom = (centres.max(axis=0) + 1).tolist()
        return PrintedDiscs(centres, self.diameter / 2, (-1.0, -1.0, right, bottom))


def list_grid_indices(grid_size: GridSize) -> IntArray:
    """List (row, column) of all points of a grid, (rows x columns, 2), row by row."""
    return np.indices(grid_size).reshape(2, -1).T
