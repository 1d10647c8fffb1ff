"""The physical shape of a board: how its points deviate from where the drawing places them.

Printed boards stretch, and flat boards bow. A calibration may take the board as drawn, or estimate
its deviations together with the camera (``calibration/board_shape``) and keep them as a
`BoardShape`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.errors import CalibrationError


class BoardShapeModel(StrEnum):
    """The deviations from the drawing that a calibration estimates."""

    NOMINAL = "nominal"
    """None: the board is as drawn."""
    AFFINE = "affine"
    """An affine distortion of the plane: ratio of the scales, and shear."""
    BOW = "bow"
    """The affine distortion and a bow out of the plane."""
    FREE = "free"
    """Any displacement of every point, in three dimensions."""


@dataclass(frozen=True, slots=True)
class BoardShapePrior:
    """Prior knowledge of a board: standard deviations of its points' positions, mm."""

    in_plane: float
    """Accuracy of the print, mm."""
    out_of_plane: float
    """Flatness of the board, mm."""

    def __post_init__(self) -> None:
        if not (0 < self.in_plane < math.inf and 0 < self.out_of_plane < math.inf):
            raise CalibrationError(
                f"{self.in_plane} and {self.out_of_plane} mm are no standard deviations.",
                "Give two lengths above 0.",
            )


@dataclass(frozen=True, eq=False, slots=True)
class BoardShape:
    """A board's points where they were found to be."""

    model: BoardShapeModel
    """The deviations that were estimated."""
    nominal: Array
    """(n, 2) positions by the drawing, mm."""
    deviation: Array
    """(n, 3) displacements from there, mm, without net motion, turn or scale."""
    sigma: Array
    """(n, 3) one standard deviation, mm; 0 where not estimated."""

    def __post_init__(self) -> None:
        freeze(self, "nominal", "deviation", "sigma")

    @property
    def rms(self) -> float:
        """Root mean square length of the deviations, mm."""
        return float(np.sqrt(np.mean(np.sum(self.deviation**2, axis=1))))
