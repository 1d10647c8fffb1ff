"""Projection uncertainty: how far a pixel is uncertain at which the camera sees a given point.

An error of the intrinsics is partly undone by one of the poses: a camera whose centre is 1 px
off, turned to look 1 px aside, images the world as before. What a user suffers from is the
rest. The views tell how the camera moved: the error of view k's pose, a motion (w, t)_k of
camera space, says where board k believes a point to be, and their mean

    m = (1/K) sum_k (w, t)_k = A dc + e,       A = (1/K) sum_k A_k,  cov(e) = (1/K^2) sum_k own_k

(``fisher_information.py``) is the motion implied by the calibration's error: the "mean-pcam"
method of mrcal (its documentation, "Projection uncertainty"). A point p, fixed to the boards, is
then imaged at q = project(p + w x p + t), and

    dq = q_c dc + q_p (w x p + t) = [q_c + q_p B A] dc + q_p B e,     B = [-[p]x  I],
    cov(q) = J cov(c) J^T + sigma^2 q_p B cov(e) (q_p B)^T,           J = q_c + q_p B A.

p is on the pixel's ray at the given distance from the camera. At infinity, where shifts do
not matter, p is the ray's direction and t is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray, Size, freeze
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import find_free_parameters
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.projection import project, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import make_cross_matrix
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.uncertainty.fisher_information import FisherInformation, compute_information

MAP_STEPS = 40
"""Number of steps of a map along the image's longer side."""


@dataclass(frozen=True, eq=False, slots=True)
class ProjectionUncertainty:
    """One standard deviation of where points of the scene are imaged, over the whole image."""

    size: Size
    """Width and height of the image, px."""
    distance: float
    """Distance of the points from the camera, mm; infinite for directions."""
    u: Array
    """(n,) columns of the map, px."""
    v: Array
    """(m,) rows of the map, px."""
    covariance: Array
    """(m, n, 2, 2) covariance of the pixel, px^2; NaN where the lens has no ray."""

    def __post_init__(self) -> None:
        freeze(self, "u", "v", "covariance")

    @property
    def worst_direction(self) -> Array:
        """(m, n) standard deviation in the direction where it is largest, px."""
        return compute_worst_sigma(self.covariance)

    @property
    def rms(self) -> Array:
        """(m, n) root mean square of the standard deviations in all directions, px."""
        return np.asarray(np.sqrt(np.trace(self.covariance, axis1=-2, axis2=-1) / 2))

    @property
    def centre(self) -> float:
        """`worst_direction` at the image's centre, px."""
        return float(self.worst_direction[len(self.v) // 2, len(self.u) // 2])

    @property
    def median(self) -> float:
        """Median of `worst_direction` over the image, px."""
        return float(np.nanmedian(self.worst_direction))

    @property
    def worst(self) -> float:
        """Largest `worst_direction` in the image, px."""
        return float(np.nanmax(self.worst_direction))

    def region(self, limit: float) -> BoolArray:
        """Return (m, n) where `worst_direction` is at most `limit` px."""
        return np.asarray(self.worst_direction <= limit)

    def fraction(self, limit: float) -> float:
        """Return the fraction of the image where `worst_direction` is at most `limit` px."""
        return float(self.region(limit).mean())


def estimate_projection_uncertainty(
    calibration: Calibration, views: Sequence[Observation], distance: float = np.inf
) -> ProjectionUncertainty:
    """Estimate the uncertainty of projection over the whole image.

    It covers the errors that the calibration's covariance covers: the corners' noise and, where
    it was estimated, the board's shape and the views' disagreement. It does not cover a lens that
    the model cannot follow.

    Args:
        calibration: the calibration.
        views: the views that it was made from.
        distance: distance of the points from the camera, mm; infinite for directions.

    Raises:
        CalibrationError: if the distance is not positive.

    Example:
        >>> import numpy as np
        >>> from calibgui.engine.boards import Board
        >>> from calibgui.engine.calibration import Observation, calibrate
        >>> from calibgui.engine.camera import Camera, project_points
        >>> from calibgui.engine.geometry import Pose
        >>> from calibgui.engine.uncertainty import estimate_projection_uncertainty
        >>> board = Board(6, 8, 25.0)
        >>> camera = Camera((640, 480), [600.0, 600.0, 320.0, 240.0, 0, 0, 0, 0, 0, 0])
        >>> rng, views = np.random.default_rng(1), []
        >>> for tilt in ([0.5, 0, 0], [-0.5, 0, 0], [0, 0.5, 0], [0, -0.5, 0], [0.3, 0.3, 0.2]):
        ...     uv = project_points(board.points(), camera, Pose(tilt, [-90.0, -60.0, 400.0]))
        ...     views.append(Observation(uv + rng.normal(0, 0.1, uv.shape), board.points()))
        >>> calibration = calibrate(views, camera.size)
        >>> uncertainty = estimate_projection_uncertainty(calibration, views)
        >>> 0.01 < uncertainty.centre < uncertainty.worst
        True
    """
    u, v = make_map_grid(calibration.camera.size)
    uv = make_mesh(u, v)
    free = find_free_parameters(calibration)
    spread = compute_projection_covariance(
        calibration.camera,
        free,
        calibration.covariance[np.ix_(free, free)],
        compute_information(calibration, views),
        calibration.noise,
        uv,
        distance,
    )
    return ProjectionUncertainty(calibration.camera.size, distance, u, v, spread)


def compute_projection_covariance(
    camera: Camera,
    free: IntArray,
    covariance: Array,
    views: FisherInformation,
    noise: float,
    uv: Array,
    distance: float = np.inf,
) -> Array:
    """Compute the covariance (..., 2, 2) of where the camera sees the points behind pixels, px^2.

    Args:
        camera: the camera.
        free: (P,) indices of its estimated parameters.
        covariance: (P, P) covariance of these parameters.
        views: information of the views that determined them.
        noise: standard deviation of one residual coordinate.
        uv: (..., 2) pixels.
        distance: distance of the points from the camera, mm; infinite for directions.

    Raises:
        CalibrationError: if the distance is not positive.
    """
    if not distance > 0:
        raise CalibrationError(
            f"A distance of {distance:g} mm is not in front of the camera.",
            "Give a positive distance, or none for points far away.",
        )
    by_params, by_motion = compute_sensitivity(camera, uv, distance)
    e = noise**2 * views.pose_covariance.sum(axis=0) / len(views.pose_covariance) ** 2
    return propagate_covariance(
        by_params[..., free], by_motion, covariance, views.motion_by_camera.mean(axis=0), e
    )


def propagate_covariance(
    by_params: Array, by_motion: Array, covariance: Array, A: Array, e: Array
) -> Array:
    """Return cov(q) (..., 2, 2) from q_c (..., 2, P), q_p B (..., 2, 6), cov(c), A and cov(e)."""
    J = by_params + by_motion @ A
    return np.asarray(
        J @ covariance @ np.swapaxes(J, -1, -2) + by_motion @ e @ np.swapaxes(by_motion, -1, -2)
    )


def compute_sensitivity(camera: Camera, uv: Array, distance: float) -> tuple[Array, Array]:
    """Compute q_c (..., 2, P) and q_p B (..., 2, 6) of the image of the point behind a pixel.

    They are its derivatives by all of the camera's parameters, px, and by a motion (w, t) of
    camera space, rad and mm.
    """
    p = back_project_pixels(uv, camera, distance)
    _, by_params, by_motion = project_moved_points(p, camera)
    if not np.isfinite(distance):
        by_motion[..., 3:] = 0.0
    return by_params, by_motion


def back_project_pixels(uv: Array, camera: Camera, distance: float) -> Array:
    """Return points (..., 3) at a distance, mm, on the rays of pixels; directions at infinity.

    They are NaN where the lens lights no pixel.
    """
    rays = np.where(camera.lights(uv)[..., None], rays_from_pixels(uv, camera), np.nan)
    return rays * distance if np.isfinite(distance) else rays


def project_moved_points(p: Array, camera: Camera) -> tuple[Array, Array, Array]:
    """Project points (..., 3), mm, and return their pixels q (..., 2), q_c and q_p B.

    Points that the lens does not see have NaN.
    """
    q, by_point, by_params = project(p, camera.params, find_model(camera.model))
    return q, by_params, np.concatenate([-by_point @ make_cross_matrix(p), by_point], axis=-1)


def make_map_grid(size: Size) -> tuple[Array, Array]:
    """Return columns and rows, px, of a map from the first pixel to the last, with the centre."""
    longer = max(size)
    u, v = (np.linspace(0.0, n - 1.0, 2 * round(MAP_STEPS * n / longer / 2) + 1) for n in size)
    return u, v


def compute_worst_sigma(covariance: Array) -> Array:
    """Return the square root (...) of the larger eigenvalue of covariances (..., 2, 2).

    It is h + sqrt(d^2 + b^2), with the half trace h and the half difference d of the diagonal,
    which keeps NaN where it is.
    """
    a, b, c = covariance[..., 0, 0], covariance[..., 0, 1], covariance[..., 1, 1]
    return np.asarray(np.sqrt((a + c) / 2 + np.hypot((a - c) / 2, b)))
