"""Grids of circles, symmetric and asymmetric.

The grid is found among all parts that may be discs (``blobs.py``, ``dots.py``), coarsely and whole
or not at all. Every circle's ellipse is then fitted to the pixels of its edge (``ellipses.py``),
and the image of the circle's centre follows from the ellipse's (``plate_map.py``), for the diameter
that the ellipses show.

In a symmetric grid of M x N circles the one in row m, column n is at X = n, Y = m. In an asymmetric
one every second row is shifted by half: X = 2 n + m mod 2, Y = m; its pitch is the distance of the
rows, which is half the distance of neighbours in a row.

Circles have no colours to tell their corners apart. A symmetric grid is the same after half a turn,
and after a quarter if M = N. Half a turn of an asymmetric one takes row m to M - 1 - m and X to
2 N - 1 - X, which is the same grid if M is even; if M is odd its origin is unique. Reflections
are excluded: numbering is right-handed in the image. Among origins that cannot be told apart
the one that makes the grid upright is taken, or that nearest to the first of the marked points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, GridSize
from calibgui.engine.boards.pattern import Ambiguity, Pattern
from calibgui.engine.boards.printed_pattern import Discs, Ink
from calibgui.engine.errors import CalibrationError


@dataclass(frozen=True, slots=True)
class Circles:
    """A grid of circles; their diameter is measured in the images if it is None."""

    asymmetric: bool = False
    diameter: float | None = None
    """Over the pitch."""

    def __post_init__(self) -> None:
        if self.diameter is not None and not 0 < self.diameter < 2 * self.reach:
            raise CalibrationError(
                f"Circles of {self.diameter:.2f} of their distance would touch.",
                f"It must be below {2 * self.reach:.2f}: state diameter and distance in mm.",
            )

    @property
    def kind(self) -> str:
        return "asymmetric-circles" if self.asymmetric else "circles"

    @property
    def identified(self) -> bool:
        return False

    @property
    def squared(self) -> bool:
        return False

    @property
    def reach(self) -> float:
        """Half the distance of neighbours, pitches."""
        return 0.5**0.5 if self.asymmetric else 0.5

    def places(self, grid: Array) -> Array:
        """See ``Pattern``."""
        row, col = grid[:, 0], grid[:, 1]
        return np.column_stack([2 * col + row % 2 if self.asymmetric else col, row])

    def ambiguity(self, grid_size: GridSize) -> Ambiguity:
        """See ``Pattern``."""
        rows, cols = grid_size
        if self.asymmetric:
            return Ambiguity.NONE if rows % 2 else Ambiguity.HALF_TURN
        return Ambiguity.QUARTER_TURN if rows == cols else Ambiguity.HALF_TURN

    def completed(self, seen: Sequence[Pattern]) -> Circles:
        """See ``Pattern``."""
        diameters = [one.diameter for one in seen if isinstance(one, Circles) and one.diameter]
        if self.diameter is not None or not diameters:
            return self
        return Circles(self.asymmetric, round(float(np.median(diameters)), 4))

    def ink(self, grid_size: GridSize) -> Ink:
        """See ``Pattern``."""
        if self.diameter is None:
            raise CalibrationError("The circles' diameter is not known.", "State it.")
        centres = self.places(grid_indices(grid_size).astype(np.float64))
        right, bottom = (centres.max(axis=0) + 1).tolist()
        return Discs(centres, self.diameter / 2, (-1.0, -1.0, right, bottom))


def grid_indices(grid_size: GridSize) -> np.ndarray:
    return np.indices(grid_size).reshape(2, -1).T
