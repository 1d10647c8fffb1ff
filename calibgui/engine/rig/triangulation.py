"""Points in space from their pixels in the cameras of a rig, with the covariance that they have.

A point X, mm in the rig's frame, is seen by camera c at project(Q_c X + S_c). Of all X that one is
taken whose images lie closest to the measured pixels, each pixel counting with its standard
deviation s (Hartley and Sturm 1997 for two cameras): from the place nearest to all rays, by Gauss
and Newton's steps with the derivatives A_c (2, 3) of the images.

    X's errors by pixels:       N^-1,      N = sum_c A_c^T A_c / s^2,
    by the calibration:         D cov D^T,  D = -N^-1 sum_c A_c^T B_c / s^2,

where B_c are the derivatives by the rig's parameters, whose covariance is that of the calibration:
the same for all points, so that it cancels in the distance of near points and not in their place.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.projection import project, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import (
    compute_inverse_left_jacobian,
    make_cross_matrix,
    rotation_from_vector,
)
from calibgui.engine.rig.records import Rig

_STEPS = 10
"""Number of Gauss and Newton's steps: each doubles the digits of a place that is seen well."""


@dataclass(frozen=True, eq=False, slots=True)
class TriangulatedPoints:
    """Points in the rig's frame; NaN where fewer than two cameras see one."""

    points: Array
    """(n, 3), mm."""
    by_calibration: Array
    """(n, 3, 3) covariance by the errors of the rig, mm^2, which all points share."""
    by_pixels: Array
    """(n, 3, 3) covariance by the errors of the pixels, mm^2."""
    residuals: Array
    """(C, n, 2) measured minus predicted pixels; NaN where a camera does not see the point."""

    def __post_init__(self) -> None:
        freeze(self, "points", "by_calibration", "by_pixels", "residuals")

    @property
    def covariance(self) -> Array:
        """(n, 3, 3) covariance, mm^2."""
        return np.asarray(self.by_calibration + self.by_pixels)

    @property
    def sigma(self) -> Array:
        """(n, 3) standard deviations of X, Y and Z, mm."""
        return np.asarray(np.sqrt(np.diagonal(self.covariance, axis1=1, axis2=2)))

    @property
    def rms(self) -> Array:
        """(n,) root mean square length of each point's residuals, px."""
        squares = np.sum(self.residuals**2, axis=2)
        seen = np.isfinite(squares)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(np.sqrt(np.where(seen, squares, 0).sum(axis=0) / seen.sum(axis=0)))


def triangulate_points(
    rig: Rig, pixels: Mapping[int, Array], sigma: float = 0.0
) -> TriangulatedPoints:
    """Find points in space from their pixels.

    Args:
        rig: the rig.
        pixels: (n, 2) px for each camera, by its number; NaN where it does not see a point.
        sigma: standard deviation of a pixel along each axis, px.

    Raises:
        CalibrationError: if fewer than two cameras are named, one does not exist, or they list
            other numbers of points.
    """
    shapes = {np.shape(uv) for uv in pixels.values()}
    if len(pixels) < 2 or len(shapes) != 1 or not set(pixels) <= set(range(len(rig.cameras))):
        raise CalibrationError(
            "Points are found from their pixels in at least two cameras of the rig.",
            "List the same points for each camera, NaN where it does not see one.",
        )
    uv = np.full((len(rig.cameras), *shapes.pop()), np.nan)
    for c, measured in pixels.items():
        uv[c] = measured
    X = _find_nearest_places(rig, uv)
    for _ in range(_STEPS):
        residual, by_point, _ = _project(rig, X, uv)
        N, g = _sum_normal(by_point, residual)
        with np.errstate(invalid="ignore"):
            X = X + np.linalg.solve(N, g[..., None])[..., 0]
    residual, by_point, by_rig = _project(rig, X, uv)
    inverse = np.linalg.inv(_sum_normal(by_point, residual)[0])
    by_rig[~np.isfinite(residual).all(axis=2)] = 0.0
    pull = np.einsum("cnia,cnip->nap", by_point, by_rig)
    D = -inverse @ pull
    covariance = rig.covariance
    return TriangulatedPoints(
        X,
        D @ covariance @ np.swapaxes(D, 1, 2),
        np.asarray(sigma**2 * inverse, np.float64),
        residual,
    )


def _find_nearest_places(rig: Rig, uv: Array) -> Array:
    """Find (n, 3) the places with the least sum of squared distances from the pixels' rays."""
    A, b = np.zeros((uv.shape[1], 3, 3)), np.zeros((uv.shape[1], 3))
    seen = np.zeros(uv.shape[1], dtype=np.int64)
    for c, (camera, pose) in enumerate(zip(rig.cameras, rig.poses, strict=True)):
        Q = rotation_from_vector(pose.rvec)
        rays = rays_from_pixels(uv[c], camera) @ Q
        across = np.eye(3) - rays[..., None] * rays[:, None]
        here = np.asarray(np.isfinite(rays).all(axis=1), dtype=bool)
        A[here] += across[here]
        b[here] += across[here] @ (-Q.T @ pose.tvec)
        seen += here
    A[seen < 2] = np.nan
    return np.asarray(np.linalg.solve(A, b[..., None])[..., 0])


def _sum_normal(by_point: Array, residual: Array) -> tuple[Array, Array]:
    """Return N (n, 3, 3) and the gradient (n, 3) of the cameras that see each point."""
    seen = np.asarray(np.isfinite(residual).all(axis=2), dtype=bool)
    A, r = np.where(seen[..., None, None], by_point, 0), np.where(seen[..., None], residual, 0)
    N = np.einsum("cnia,cnib->nab", A, A)
    N[seen.sum(axis=0) < 2] = np.nan
    return N, np.einsum("cnia,cni->na", A, r)


def _project(rig: Rig, X: Array, uv: Array) -> tuple[Array, Array, Array]:
    """Return residuals (C, n, 2), and images' derivatives by X (C, n, 2, 3) and the rig's
    parameters (C, n, 2, P)."""
    layout = rig.layout
    residual = np.full(uv.shape, np.nan)
    by_point, by_rig = np.zeros((*uv.shape, 3)), np.zeros((*uv.shape, layout.size))
    for c, (camera, pose) in enumerate(zip(rig.cameras, rig.poses, strict=True)):
        Q = rotation_from_vector(pose.rvec)
        turned = X @ Q.T
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            seen = project(turned + pose.tvec, camera.params, find_model(camera.model))
        residual[c] = uv[c] - seen.points
        by_point[c] = seen.by_ray @ Q
        by_rig[c, ..., layout.camera(c)] = seen.by_params
        J = np.linalg.inv(compute_inverse_left_jacobian(pose.rvec))
        place = layout.pose(c).start
        by_rig[c, ..., place : place + 3] = -seen.by_ray @ make_cross_matrix(turned) @ J
        by_rig[c, ..., place + 3 : place + 6] = seen.by_ray
    return residual, by_point, by_rig
