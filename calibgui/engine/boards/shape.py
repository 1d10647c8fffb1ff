"""The shape of a target."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.errors import CalibrationError


class BoardShapeModel(StrEnum):
    """How the target may deviate from its nominal shape."""

    NOMINAL = "nominal"
    AFFINE = "affine"
    BOW = "bow"
    FREE = "free"


@dataclass(frozen=True, slots=True)
class BoardShapePrior:
    """What is known of a plate beforehand: standard deviations of its corners' places, mm."""

    in_plane: float
    """Accuracy of the print."""
    out_of_plane: float
    """Flatness."""

    def __post_init__(self) -> None:
        if not (0 < self.in_plane < math.inf and 0 < self.out_of_plane < math.inf):
            raise CalibrationError(
                f"{self.in_plane} and {self.out_of_plane} mm are no standard deviations.",
                "Give two lengths above 0.",
            )


@dataclass(frozen=True, eq=False, slots=True)
class BoardShape:
    """A target with its corners where they were found to be."""

    model: BoardShapeModel
    nominal: Array
    """(n, 2) places by the drawing, mm."""
    deviation: Array
    """(n, 3) from there, mm, without net motion, turn or scale."""
    sigma: Array
    """(n, 3) one standard deviation, mm; 0 where not estimated."""

    def __post_init__(self) -> None:
        freeze(self, "nominal", "deviation", "sigma")

    @property
    def rms(self) -> float:
        """Root mean square length of the deviations, mm."""
        return float(np.sqrt(np.mean(np.sum(self.deviation**2, axis=1))))
