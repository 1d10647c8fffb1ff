"""The physical shape of a board: how its points deviate from where the drawing places them.

Printed boards stretch, and flat boards bow. A calibration may take the board as drawn, or estimate
its deviations together with the camera (``calibration/board_shape``) and keep them as a
`BoardShape`, with what is known of their errors.

Errors. A corner's own error hardly moves a camera that is calibrated with the shape: it averages
out over the corners. What moves it is what the corners' errors have in common, which is smooth. So
the covariance of all corners' errors, (3n, 3n), is kept as

    C = Phi S Phi^T + diag(rest^2),

where Phi holds, for each axis, the m = 36 products of Legendre polynomials L_i(x) L_j(y) of degree
i + j <= 7, x and y from -1 to 1 across the board, and S (3m, 3m) is the covariance of the errors'
projection on them, Phi^+ C Phi^+T. `rest` makes the standard deviation of each corner what it is. S
has the same size for every board, and whoever reads it needs the places of the corners alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.errors import CalibrationError

_SMOOTH_DEGREE = 7
"""Degree of the polynomials of errors that the corners have in common; a camera's map has no terms
beyond it (``calibration/board_shape/uncertainty.py``)."""
ERROR_COEFFICIENTS = 3 * (_SMOOTH_DEGREE + 1) * (_SMOOTH_DEGREE + 2) // 2
"""Number 3m of the coefficients of these errors."""


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
    covariance: Array | None = None
    """(3m, 3m) covariance S, mm^2, of the coefficients of the errors that the corners have in
    common, by polynomial and axis; None if it is not known, as in older files."""
    views: tuple[str, ...] = ()
    """Digests of the views that the shape was estimated from (``calibration.observations``)."""

    def __post_init__(self) -> None:
        freeze(self, "nominal", "deviation", "sigma", "covariance")

    @property
    def rms(self) -> float:
        """Root mean square length of the deviations, mm."""
        return float(np.sqrt(np.mean(np.sum(self.deviation**2, axis=1))))

    def factor_errors(self) -> tuple[Array, Array]:
        """Return F (n, 3, 3m) and `rest` (n, 3), mm, where F F^T + diag(rest^2) is the covariance
        of the errors. If it is not known, the corners' errors count as independent."""
        n = len(self.nominal)
        if self.covariance is None:
            return np.zeros((n, 3, 0)), self.sigma
        values, vectors = np.linalg.eigh(self.covariance)
        root = (vectors * np.sqrt(np.maximum(values, 0.0))).reshape(-1, 3, len(values))
        F = np.einsum("nj,jar->nar", make_smooth_basis(self.nominal), root)
        return F, np.sqrt(np.maximum(self.sigma**2 - np.sum(F**2, axis=2), 0.0))

    def scale_errors(self, ratio: float) -> BoardShape:
        """Return the shape with the covariance of its errors multiplied by a ratio."""
        covariance = None if self.covariance is None else ratio * self.covariance
        return replace(self, sigma=math.sqrt(ratio) * self.sigma, covariance=covariance)

    def add_errors(self, columns: Array) -> BoardShape:
        """Return the shape with further errors, of covariance E E^T for columns E (n, 3, r), mm."""
        fitted = np.einsum("jn,nar->jar", np.linalg.pinv(make_smooth_basis(self.nominal)), columns)
        smooth = fitted.reshape(-1, columns.shape[2])
        return replace(
            self,
            sigma=np.sqrt(self.sigma**2 + np.sum(columns**2, axis=2)),
            covariance=None if self.covariance is None else self.covariance + smooth @ smooth.T,
        )


def make_smooth_basis(nominal: Array) -> Array:
    """Make the polynomials (n, m) in which corners (n, 2) of a board have errors in common."""
    low, high = nominal.min(axis=0), nominal.max(axis=0)
    x, y = ((2 * nominal - low - high) / np.maximum(high - low, np.finfo(float).tiny)).T
    products = np.polynomial.legendre.legvander2d(x, y, [_SMOOTH_DEGREE, _SMOOTH_DEGREE])
    degrees = np.add.outer(np.arange(_SMOOTH_DEGREE + 1), np.arange(_SMOOTH_DEGREE + 1)).ravel()
    return np.ascontiguousarray(products[:, degrees <= _SMOOTH_DEGREE])


def project_covariance(nominal: Array, covariance: Array) -> Array:
    """Project the covariance (3n, 3n) of all corners' errors, mm^2, on the polynomials: S (3m, 3m).

    Args:
        nominal: (n, 2) the corners by the drawing, mm.
        covariance: the covariance, corner by corner and axis by axis.
    """
    fit = np.kron(np.linalg.pinv(make_smooth_basis(nominal)), np.eye(3))
    return np.asarray(fit @ covariance @ fit.T)
