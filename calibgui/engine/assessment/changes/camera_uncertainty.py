"""A camera's pixels are uncertain, beside a rotation that makes up for part of that.

An error dc of the camera moves the pixels of directions by q_c dc, and a rotation w of the camera
by q_p B w (``uncertainty/projection_uncertainty.py``). As ``comparison.py`` brings two cameras
together over the part of the image that corners cover, w is what makes the rest smallest there,

    w = -(sum (q_p B)^T q_p B)^-1 sum (q_p B)^T q_c dc = W dc,      J = q_c + q_p B W,
    cov(q) = J cov(c) J^T,

which is the error of the calibration as a camera: whoever uses it finds its pose anew. Where the
projection of points that are fixed to the boards is asked for, w is the mean rotation of the views,
which is uncertain by itself. Through a lens of 5 degrees tilted boards tell a turn of the camera
from a shift poorly: of 8 sets of 14 views, with corners good to 0.05 px, that made a pixel
uncertain by 1.4 px where the estimated camera differed from the true one by 0.32 px rms, and this
says 0.32. Of usual lenses the one was 0.10 to 0.15, the other 0.05 to 0.08, the truth 0.03 to 0.06.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.assessment.changes.comparison import find_covered_pixels
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import find_free_parameters
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.uncertainty.projection_uncertainty import (
    ProjectionUncertainty,
    compute_sensitivity,
    make_map_grid,
)


def estimate_camera_uncertainty(
    calibration: Calibration, views: Sequence[Observation]
) -> ProjectionUncertainty:
    """Estimate how far the pixels of directions are uncertain, beside a rotation of the camera.

    Args:
        calibration: the calibration.
        views: the views that it was made from.
    """
    return split_camera_uncertainty(calibration, views)[0]


def split_camera_uncertainty(
    calibration: Calibration, views: Sequence[Observation]
) -> tuple[ProjectionUncertainty, ProjectionUncertainty]:
    """Estimate the same, and the part of it that the corners' noise alone explains."""
    camera, free = calibration.camera, find_free_parameters(calibration)
    u, v = make_map_grid(camera.size)
    uv = make_mesh(u, v)
    by_params, by_turn = _differentiate(camera, free, uv)
    J = by_params + by_turn @ _fit_turn(by_params, by_turn, find_covered_pixels(uv, views))
    total, by_noise = (
        ProjectionUncertainty(
            camera.size, np.inf, u, v, J @ covariance[np.ix_(free, free)] @ np.swapaxes(J, -1, -2)
        )
        for covariance in (calibration.covariance, calibration.noise_covariance)
    )
    return total, by_noise


def find_compensating_turn(camera: Camera, free: IntArray, views: Sequence[Observation]) -> Array:
    """Find W (3, P), the rotation, rad per unit of the free parameters, that makes up for most of
    an error of the camera where the corners of views cover the image."""
    uv = make_mesh(*make_map_grid(camera.size))
    return _fit_turn(*_differentiate(camera, free, uv), find_covered_pixels(uv, views))


def _differentiate(camera: Camera, free: IntArray, uv: Array) -> tuple[Array, Array]:
    """Differentiate pixels (m, n, 2) by the free parameters, and by a rotation of the camera."""
    by_params, by_motion = compute_sensitivity(camera, uv, np.inf)
    return by_params[..., free], by_motion[..., :3]


def _fit_turn(by_params: Array, by_turn: Array, is_covered: BoolArray) -> Array:
    """Fit W (3, P) to the derivatives of pixels (m, n) of which some are covered."""
    known = is_covered & np.isfinite(by_params).all(axis=(-2, -1))
    P = by_params.shape[-1]
    turn = np.linalg.lstsq(by_turn[known].reshape(-1, 3), by_params[known].reshape(-1, P))[0]
    return np.asarray(-turn, np.float64)
