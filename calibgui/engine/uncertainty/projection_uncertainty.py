"""Projection uncertainty: how far a pixel is uncertain at which the camera sees a given point.

An error of the intrinsics is partly undone by one of the poses: a camera whose centre is 1 px
off, turned to look 1 px aside, images the world as before. What a user suffers from is the
rest. The views tell how the camera moved: the error of view k's pose, a motion (w, t)_k of
camera space, says where plate k believes a point to be, and their mean

    m = (1/K) sum_k (w, t)_k = A dc + e,       A = (1/K) sum_k A_k,  cov(e) = (1/K^2) sum_k own_k

(``information.py``) is the motion implied by the calibration's error: mrcal's "mean-pcam"
method. A point p, fixed to the plates, is then imaged at q = project(p + w x p + t), and

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
from calibgui.engine.calibration.problem import free_parameters
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import MODELS
from calibgui.engine.camera.projection import project, rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import cross_matrix
from calibgui.engine.images.sampling import mesh
from calibgui.engine.uncertainty.fisher_information import Information, information

GRID = 40
"""Steps of a map along the image's longer side."""


@dataclass(frozen=True, eq=False, slots=True)
class ProjectionUncertainty:
    """One standard deviation of where points of the scene are imaged, over the whole image."""

    size: Size
    distance: float
    """Of the points from the camera, mm; infinite for directions."""
    u: Array
    """(n,) columns of the map, px."""
    v: Array
    """(m,) rows of the map, px."""
    covariance: Array
    """(m, n, 2, 2) of the pixel, px^2; NaN where the lens has no ray."""

    def __post_init__(self) -> None:
        freeze(self, "u", "v", "covariance")

    @property
    def worst_direction(self) -> Array:
        """(m, n) standard deviation in the direction where it is largest, px."""
        return worst_direction(self.covariance)

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
        """(m, n) where `worst_direction` is at most `limit` px."""
        return np.asarray(self.worst_direction <= limit)

    def fraction(self, limit: float) -> float:
        """Fraction of the image where `worst_direction` is at most `limit` px."""
        return float(self.region(limit).mean())


def estimate_projection_uncertainty(
    calibration: Calibration, views: Sequence[Observation], distance: float = np.inf
) -> ProjectionUncertainty:
    """The uncertainty of projection over the whole image.

    Args:
        calibration: of the camera.
        views: that it was made from.
        distance: of the points seen from the camera, mm; infinite for directions.

    Raises:
        CalibrationError: if the distance is not positive.
    """
    u, v = grid(calibration.camera.size)
    uv = mesh(u, v)
    free = free_parameters(calibration)
    spread = projection_covariance(
        calibration.camera,
        free,
        calibration.covariance[np.ix_(free, free)],
        information(calibration, views),
        calibration.noise,
        uv,
        distance,
    )
    return ProjectionUncertainty(calibration.camera.size, distance, u, v, spread)


def projection_covariance(
    camera: Camera,
    free: IntArray,
    covariance: Array,
    views: Information,
    noise: float,
    uv: Array,
    distance: float = np.inf,
) -> Array:
    """(..., 2, 2) covariance of where the camera sees the points behind pixels, px^2.

    Args:
        camera: the camera.
        free: (P,) indices of its estimated parameters.
        covariance: (P, P) of these.
        views: that determined them.
        noise: standard deviation of one residual coordinate.
        uv: (..., 2) pixels.
        distance: of the points from the camera, mm; infinite for directions.
    """
    if not distance > 0:
        raise CalibrationError(
            f"A distance of {distance:g} mm is not in front of the camera.",
            "Give a positive distance, or none for points far away.",
        )
    by_params, by_motion = sensitivity(camera, uv, distance)
    e = noise**2 * views.own.sum(axis=0) / len(views.own) ** 2
    return propagated(by_params[..., free], by_motion, covariance, views.answer.mean(axis=0), e)


def propagated(by_params: Array, by_motion: Array, covariance: Array, A: Array, e: Array) -> Array:
    """(..., 2, 2) cov(q) from q_c (..., 2, P), q_p B (..., 2, 6), cov(c), A and cov(e)."""
    J = by_params + by_motion @ A
    return np.asarray(
        J @ covariance @ np.swapaxes(J, -1, -2) + by_motion @ e @ np.swapaxes(by_motion, -1, -2)
    )


def sensitivity(camera: Camera, uv: Array, distance: float) -> tuple[Array, Array]:
    """Derivatives q_c (..., 2, P) and q_p B (..., 2, 6) of the image of the point behind a pixel.

    The first by all of the camera's parameters, px; the second by a motion (w, t), rad and mm,
    of camera space.
    """
    p = points_behind(uv, camera, distance)
    _, by_params, by_motion = imaged(p, camera)
    if not np.isfinite(distance):
        by_motion[..., 3:] = 0.0
    return by_params, by_motion


def points_behind(uv: Array, camera: Camera, distance: float) -> Array:
    """(..., 3) points at a distance, mm, on the rays of pixels; unit directions at infinity."""
    n = rays(uv, camera)
    ray = np.concatenate([n, np.ones((*n.shape[:-1], 1))], axis=-1)
    ray /= np.linalg.norm(ray, axis=-1, keepdims=True)
    return ray * distance if np.isfinite(distance) else ray


def imaged(p: Array, camera: Camera) -> tuple[Array, Array, Array]:
    """The image q (..., 2) of points (..., 3) in front of the camera, q_c and q_p B."""
    Z = np.where(p[..., 2:] > 0, p[..., 2:], np.nan)
    n = p[..., :2] / Z
    q, by_ray, by_params = project(n, camera.params, MODELS[camera.model])
    by_point = np.concatenate([by_ray, -by_ray @ n[..., None]], axis=-1) / Z[..., None]
    return q, by_params, np.concatenate([-by_point @ cross_matrix(p), by_point], axis=-1)


def grid(size: Size) -> tuple[Array, Array]:
    """Columns and rows, px, of a map from the first pixel to the last, centre included."""
    longer = max(size)
    u, v = (np.linspace(0.0, n - 1.0, 2 * round(GRID * n / longer / 2) + 1) for n in size)
    return u, v


def worst_direction(covariance: Array) -> Array:
    """(...) square root of the larger eigenvalue of covariances (..., 2, 2).

    Through the half trace h and the half difference of the diagonal, h + sqrt(d^2 + b^2), which
    keeps NaN where it is.
    """
    a, b, c = covariance[..., 0, 0], covariance[..., 0, 1], covariance[..., 1, 1]
    return np.asarray(np.sqrt((a + c) / 2 + np.hypot((a - c) / 2, b)))
