"""Prediction of the corners of a partly seen board by a calibrated camera.

A few corners give the view's pose under the camera (resection). With the corners' covariances
C_i, the derivatives P_i of corner i's image by the pose, and tau^2 for the errors of the models of
board and lens, the pose has the covariance

    V = (sum_i P_i^T (C_i + tau^2 I)^-1 P_i)^-1,

and corner j, not seen yet, is expected with

    P_j V P_j^T + J_j S J_j^T,

J_j its derivatives by the camera's parameters and S their covariance: wide where the board is
extrapolated far from what was seen of it, or the lens beyond where it was calibrated.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import Observation, Observations, pack_observations
from calibgui.engine.calibration.refinement.residuals import (
    Linearised,
    State,
    compute_image_residuals,
    compute_misses,
)
from calibgui.engine.calibration.refinement.whitening import whiten_observations
from calibgui.engine.calibration.resection import estimate_poses, refine_poses
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.corner_fit.board_priors import compute_curvatures

_DIFFERENCE_STEP = 0.6**0.5 / 2
"""Step on the board with which derivatives by the place are formed, squares. Over arms of length L,
half a square, a curvature kappa and a fourth derivative q move the mean of an edge by
kappa L^2 / 6 + q L^4 / 120, which is what differences over h = sqrt(0.6) L make of both."""
_MEDIAN_SQUARED_LENGTH = 2 * float(np.log(2))
"""Median of the squared length of a 2-D normal deviate of unit variance (Rayleigh)."""


@dataclass(frozen=True, eq=False, slots=True)
class ResectedView:
    """A view with the pose that its corners have under a calibrated camera."""

    calibration: Calibration
    state: State
    """The camera and the one pose."""
    pose_covariance: Array
    """V (6, 6), rad and the board's unit of length."""
    tau2: float
    """Variance of the models' own errors in this view, along each axis, px^2."""
    residuals: Array
    """(n, 2) measured minus predicted corners, px."""
    deviation: Array
    """(n,) length of each residual, in standard deviations of one coordinate."""

    def predict_corners(self, xy: Array) -> tuple[Array, Array]:
        """Predict where the camera images points of the board.

        Args:
            xy: (..., 2) points of the board, in the unit of the corners that were seen.

        Returns:
            Positions (..., 2) px and their covariances (..., 2, 2) px^2, NaN where the camera
            has no image of a point.
        """
        points = xy.reshape(-1, 2)
        linearised = _linearise(
            self.calibration, self.state, Observation(np.zeros_like(points), points)
        )
        J, P = linearised.by_params[0], linearised.by_pose[0]
        cov = J @ self.calibration.covariance @ np.swapaxes(J, 1, 2)
        cov += P @ self.pose_covariance @ np.swapaxes(P, 1, 2)
        return linearised.residual[0].reshape(xy.shape), cov.reshape(*xy.shape, 2)

    def predict_edges(self, xy: Array, square: float) -> tuple[Array, Array]:
        """Predict how the board's edges run and bend; see `differentiate_edges`."""
        return differentiate_edges(lambda points: self.predict_corners(points)[0], xy, square)


def differentiate_edges(
    locate: Callable[[Array], Array], xy: Array, square: float
) -> tuple[Array, Array]:
    """Differentiate how edges run and bend, as a fit that reads them half a square far feels it.

    Args:
        locate: takes points (..., 2) of the board to the image, px.
        xy: (n, 2) corners on the board.
        square: the side of a square, in the same unit.

    Returns:
        (n, 2, 2) steps and (n, 2) curvatures, as the board priors of the detector have them
        (``corner_fit.board_priors``).
    """
    around = _DIFFERENCE_STEP * square * np.array([(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)])
    at, right, left, down, up = np.moveaxis(locate(xy[:, None] + around), 1, 0)
    first = np.stack([right - left, down - up], axis=1) / (2 * _DIFFERENCE_STEP)
    second = np.stack([right + left - 2 * at, down + up - 2 * at], axis=1) / _DIFFERENCE_STEP**2
    return first, compute_curvatures(first, second)


def resect_view(calibration: Calibration, uv: Array, xy: Array, cov: Array) -> ResectedView:
    """Estimate the pose of a view of a flat board from n corners, of which a few may be wrong.

    The models' own variance tau^2 in this view is taken from the median residual, which a few wrong
    corners do not move.

    Args:
        calibration: the calibration of the camera.
        uv: (n, 2) the corners, px.
        xy: (n, 2) the same corners on the board, in any unit of length.
        cov: (n, 2, 2) covariances of uv, px^2.

    Raises:
        CalibrationError: if the corners are too few, or if no pose explains them.
    """
    camera, seen = calibration.camera, Observation(uv, xy, cov)
    observations = whiten_observations(pack_observations([seen]), calibration.model_error**2)
    state = refine_poses(
        estimate_poses(camera, observations), observations, camera.model, Cost.IMAGE
    )
    residuals = compute_misses(state, observations, camera.model, Cost.IMAGE)
    square = np.sum(residuals[0] ** 2, axis=1)
    excess = (
        np.median(square) / _MEDIAN_SQUARED_LENGTH - np.median(np.trace(cov, axis1=1, axis2=2)) / 2
    )
    tau2 = max(float(excess), calibration.model_error**2)
    inverse = np.linalg.inv(cov + tau2 * np.eye(2))
    P = _linearise(calibration, state, seen).by_pose[0]
    V = np.linalg.inv(np.sum(np.swapaxes(P, 1, 2) @ inverse @ P, axis=0))
    deviation = np.sqrt(np.einsum("na,nab,nb->n", residuals[0], inverse, residuals[0]))
    return ResectedView(calibration, state, V, tau2, residuals[0], deviation)


def _linearise(calibration: Calibration, state: State, view: Observation) -> Linearised:
    """Linearise the residuals of one view about a state."""
    observations = Observations(view.uv[None], view.xy[None], np.ones((1, len(view.uv))))
    return compute_image_residuals(state, observations, calibration.camera.model)
