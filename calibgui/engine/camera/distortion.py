"""Points between measured and ideal images, and the displacement between them (figure 8).

The ideal image is a pinhole's: a ray n = (X/Z, Y/Z) falls on c + f n, with the camera's own
f and c or those of another camera matrix. With psi of eq. 9 in pixels, the corrective
displacement of eq. 10 at a measured pixel is

    (d1, d2) = (c + f n) - uv,      J = d(d1, d2)/d uv = diag(f) dn/duv - I,

and the net displacement of figure 8 is d = sqrt(d1^2 + d2^2), of gradient J^T (d1, d2) / d.
Its radial part is that of the model with all but the radial coefficients at 0, its decentering
part the rest: q l in eq. 10.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import MODELS
from calibgui.engine.camera.projection import pixels, rays, rays_with_slope
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation

_SAME = 1e-6
"""Distance, px, within which a pixel must come back from its ray."""


def undistort_points(points: npt.ArrayLike, camera: Camera, matrix: Array | None = None) -> Array:
    """Ideal pixels (..., 2) of measured ones, in the array frame.

    Args:
        points: (..., 2) measured pixels.
        camera: that measured them.
        matrix: (3, 3) camera matrix of the ideal image; the camera's own if None.

    Returns:
        NaN where the lens has no ideal point, or the same one for two measured points.
    """
    uv = np.asarray(points, dtype=np.float64)
    with np.errstate(over="ignore", invalid="ignore"):  # a pixel far from any image has no ray
        n = rays(uv, camera)
    back = pixels(n, camera)
    n[~(np.abs(back - uv).max(axis=-1, initial=0.0) < _SAME)] = np.nan
    K = camera.matrix if matrix is None else matrix
    return np.asarray(n @ K[:2, :2].T + K[:2, 2])


def distort_points(points: npt.ArrayLike, camera: Camera, matrix: Array | None = None) -> Array:
    """Measured pixels (..., 2) of ideal ones: the inverse of `undistort_points`.

    Converged to 1e-9 px; NaN where no measured pixel sees the point.
    """
    K = camera.matrix if matrix is None else matrix
    ideal = np.asarray(points, dtype=np.float64) - K[:2, 2]
    return pixels(ideal @ np.linalg.inv(K[:2, :2]).T, camera)


def project_points(xy: npt.ArrayLike, camera: Camera, pose: Pose) -> Array:
    """Measured pixels (..., 2) of plate points (..., 2) mm; NaN behind the camera."""
    points = np.asarray(xy, dtype=np.float64)
    point = points @ rotation(pose.rvec)[:, :2].T + pose.tvec
    depth = np.where(point[..., 2:] > 0, point[..., 2:], np.nan)
    return pixels(point[..., :2] / depth, camera)


class Part(StrEnum):
    """Of the corrective displacement (figure 8, a to c)."""

    COMPLETE = "complete"
    RADIAL = "radial"
    DECENTERING = "decentering"


@dataclass(frozen=True, eq=False, slots=True)
class Displacement:
    """The corrective displacement at measured pixels."""

    vector: Array
    """(..., 2) d1, d2, px: added to a measured pixel it gives the ideal one."""
    by_pixel: Array
    """(..., 2, 2) its derivative J by the measured pixel."""

    @property
    def length(self) -> Array:
        """(...) the net displacement d, px."""
        return np.asarray(np.linalg.norm(self.vector, axis=-1))

    @property
    def gradient(self) -> Array:
        """(..., 2) gradient of d, px per px; 0 where d is 0, and d has none."""
        length = self.length[..., None]
        direction = np.divide(self.vector, length, where=length > 0, out=np.zeros_like(self.vector))
        return np.asarray((direction[..., None, :] @ self.by_pixel)[..., 0, :])


def displacement(uv: npt.ArrayLike, camera: Camera, part: Part = Part.COMPLETE) -> Displacement:
    """The corrective displacement at measured pixels `uv` (..., 2), or a part of it."""
    points = np.asarray(uv, dtype=np.float64)
    complete = _correction(points, camera)
    if part is Part.COMPLETE:
        return complete
    radial = _correction(points, _only_radial(camera))
    if part is Part.RADIAL:
        return radial
    return Displacement(complete.vector - radial.vector, complete.by_pixel - radial.by_pixel)


def _correction(uv: Array, camera: Camera) -> Displacement:
    n, by_uv = rays_with_slope(uv, camera)
    f, c = camera.focal, camera.centre
    return Displacement(c + f * n - uv, f[:, None] * by_uv - np.eye(2))


def _only_radial(camera: Camera) -> Camera:
    radial = [name.startswith("k") for name in MODELS[camera.model].names]
    params = np.concatenate([camera.params[:4], np.where(radial, camera.coefficients, 0.0)])
    return Camera(camera.size, params, camera.model)
