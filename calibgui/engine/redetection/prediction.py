"""Where a calibrated camera expects the corners of a board that it sees in part.

A few corners give the view's pose under the camera (resection). With the corners' covariances
C_i, the derivatives P_i of corner i's image by the pose, and tau^2 for what the models of plate
and lens get wrong, the pose has the covariance

    V = (sum_i P_i^T (C_i + tau^2 I)^-1 P_i)^-1,

and corner j, not seen yet, is expected with

    P_j V P_j^T + J_j S J_j^T,

J_j its derivatives by the camera's parameters and S their covariance: wide where the board is
extrapolated far from what was seen of it, or the lens beyond where it was calibrated.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import Observation, Observations, pack
from calibgui.engine.calibration.refinement.normal_equations import residuals
from calibgui.engine.calibration.refinement.resection import posed, solved
from calibgui.engine.calibration.refinement.residuals import Linearised, State, image_residual
from calibgui.engine.calibration.refinement.whitening import weighted
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.models import MODELS
from calibgui.engine.detection.checkerboard.board_priors import curvatures

_DIFFERENCE = 0.05
"""Of places on the plate for derivatives by them, squares."""
_RAYLEIGH = 2 * float(np.log(2))
"""Median of the squared length of two normal deviates."""


@dataclass(frozen=True, eq=False, slots=True)
class Sight:
    """A view's pose under a calibrated camera."""

    calibration: Calibration
    state: State
    """The camera and the one pose."""
    spread: Array
    """V (6, 6), rad and the plate's unit of length."""
    tau2: float
    """Variance of the models' own errors in this view, along each axis, px^2."""
    miss: Array
    """(n, 2) where the corners were seen less where they are expected, px."""
    deviation: Array
    """(n,) its length in standard deviations of one coordinate."""

    def expected(self, xy: Array) -> tuple[Array, Array]:
        """Images of plate points.

        Args:
            xy: (..., 2) in the unit of what was seen.

        Returns:
            Positions (..., 2) px and their covariances (..., 2, 2) px^2, NaN where the camera
            has no image of a point.
        """
        points = xy.reshape(-1, 2)
        line = _linearised(self.calibration, self.state, Observation(np.zeros_like(points), points))
        J, P = line.by_params[0], line.by_pose[0]
        cov = J @ self.calibration.covariance @ np.swapaxes(J, 1, 2)
        cov += P @ self.spread @ np.swapaxes(P, 1, 2)
        return line.residual[0].reshape(xy.shape), cov.reshape(*xy.shape, 2)

    def geometry(self, xy: Array, square: float) -> tuple[Array, Array]:
        """How a board's edges run and bend, by differences over a twentieth of a square.

        Args:
            xy: (n, 2) corners on the plate.
            square: the side of a square.

        Returns:
            As ``Surroundings.geometry``.
        """
        around = _DIFFERENCE * square * np.array([(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)])
        at, right, left, down, up = np.moveaxis(self.expected(xy[:, None] + around)[0], 1, 0)
        first = np.stack([right - left, down - up], axis=1) / (2 * _DIFFERENCE)
        second = np.stack([right + left - 2 * at, down + up - 2 * at], axis=1) / _DIFFERENCE**2
        return first, curvatures(first, second)


def sight(calibration: Calibration, uv: Array, xy: Array, cov: Array) -> Sight:
    """The pose of a view of a flat plate from n corners, of which a few may be wrong.

    Args:
        calibration: of the camera.
        uv: (n, 2) where the corners were found, px.
        xy: (n, 2) on the plate, in any unit of length.
        cov: (n, 2, 2) covariances of uv, px^2.

    Raises:
        CalibrationError: too few corners, or corners that no pose explains.
    """
    camera, seen = calibration.camera, Observation(uv, xy, cov)
    observations = weighted(pack([seen]), calibration.model_error**2)
    state = solved(posed(camera, observations), observations, camera.model, Cost.IMAGE)
    miss, _ = residuals(state, observations, camera.model, Cost.IMAGE)
    square = np.sum(miss[0] ** 2, axis=1)
    own = np.median(square) / _RAYLEIGH - np.median(np.trace(cov, axis1=1, axis2=2)) / 2
    tau2 = max(float(own), calibration.model_error**2)
    inverse = np.linalg.inv(cov + tau2 * np.eye(2))
    P = _linearised(calibration, state, seen).by_pose[0]
    V = np.linalg.inv(np.sum(np.swapaxes(P, 1, 2) @ inverse @ P, axis=0))
    deviation = np.sqrt(np.einsum("na,nab,nb->n", miss[0], inverse, miss[0]))
    return Sight(calibration, state, V, tau2, miss[0], deviation)


def _linearised(calibration: Calibration, state: State, view: Observation) -> Linearised:
    one = Observations(view.uv[None], view.xy[None], np.ones((1, len(view.uv))))
    return image_residual(state, one, MODELS[calibration.camera.model])
