"""Distorting and undistorting points, and the displacement between the two (figure 8).

The ideal image is a pinhole's: a ray in front of the camera falls on c + f n, n = (X/Z, Y/Z), with
the camera's own f and c or those of another camera matrix; rays at 90 degrees and beyond have no
ideal point. With psi of eq. 9 in pixels, the corrective displacement of eq. 10 at a measured pixel
is

    (d1, d2) = (c + f n) - uv,      J = d(d1, d2)/d uv = diag(f) dn/duv - I,

and the net displacement of figure 8 is d = sqrt(d1^2 + d2^2), of gradient J^T (d1, d2) / d.
Its radial part is that of the model with the coefficients at 0 that make it asymmetric, its
decentering part the rest: q l in eq. 10.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import assert_never

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.plane import plane_from_rays
from calibgui.engine.camera.projection import pixels_from_rays, rays_and_slopes, rays_from_pixels
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector

_MAX_RETURN_ERROR = 1e-6
"""Distance, px, within which a pixel must come back from its ray; beyond it the lens has folded
and the pixel has no ideal point of its own."""
_MIN_COSINE = np.cos(np.deg2rad(80.0))
"""Cosine of the angle off the axis from which on no displacement is computed: towards 90 degrees it
grows without bounds."""


def undistort_points(points: npt.ArrayLike, camera: Camera, matrix: Array | None = None) -> Array:
    """Map measured to ideal pixels, in the array frame.

    Args:
        points: (..., 2) measured pixels.
        camera: the camera that measured them.
        matrix: (3, 3) camera matrix of the ideal image; the camera's own if None.

    Returns:
        (..., 2) NaN where the lens has no ideal point, or the same one for two measured points.

    Examples:
        >>> from calibgui.engine.camera import Camera, distort_points, undistort_points
        >>> params = [600, 600, 320, 240, -0.25, 0.1, 0, 0, 0]
        >>> camera = Camera((640, 480), params, "brown-conrady")
        >>> ideal = undistort_points([[320, 240], [600, 400]], camera)
        >>> ideal.round(2)
        array([[320.  , 240.  ],
               [621.95, 412.54]])
        >>> distort_points(ideal, camera).round(6)
        array([[320., 240.],
               [600., 400.]])
    """
    uv = np.asarray(points, dtype=np.float64)
    with np.errstate(over="ignore", invalid="ignore"):  # a pixel far from any image has no ray
        rays = rays_from_pixels(uv, camera)
    back = pixels_from_rays(rays, camera)
    n, _ = plane_from_rays(rays)
    n[~(np.abs(back - uv).max(axis=-1, initial=0.0) < _MAX_RETURN_ERROR)] = np.nan
    K = camera.matrix if matrix is None else matrix
    return np.asarray(n @ K[:2, :2].T + K[:2, 2])


def distort_points(points: npt.ArrayLike, camera: Camera, matrix: Array | None = None) -> Array:
    """Map ideal to measured pixels (..., 2): the inverse of `undistort_points`.

    The result is converged to 1e-9 px, and NaN where no measured pixel sees the point.

    Args:
        points: (..., 2) ideal pixels.
        camera: the camera that measures them.
        matrix: (3, 3) camera matrix of the ideal image; the camera's own if None.
    """
    K = camera.matrix if matrix is None else matrix
    ideal = np.asarray(points, dtype=np.float64) - K[:2, 2]
    n = ideal @ np.linalg.inv(K[:2, :2]).T
    return pixels_from_rays(np.concatenate([n, np.ones_like(n[..., :1])], axis=-1), camera)


def project_points(xy: npt.ArrayLike, camera: Camera, pose: Pose) -> Array:
    """Return measured pixels (..., 2) of board points (..., 2) mm; NaN where the lens sees none.

    Examples:
        >>> from calibgui.engine.camera import Camera, project_points
        >>> from calibgui.engine.geometry import Pose
        >>> camera = Camera((640, 480), [600, 600, 320, 240, 0, 0, 0, 0, 0], "brown-conrady")
        >>> board = [[0, 0], [25, 0], [0, 25]]  # mm
        >>> project_points(board, camera, Pose([0, 0, 0], [0, 0, 500]))
        array([[320., 240.],
               [350., 240.],
               [320., 270.]])
    """
    points = np.asarray(xy, dtype=np.float64)
    return pixels_from_rays(points @ rotation_from_vector(pose.rvec)[:, :2].T + pose.tvec, camera)


class DisplacementPart(StrEnum):
    """A part of the corrective displacement (figure 8, a to c)."""

    COMPLETE = "complete"
    RADIAL = "radial"
    DECENTERING = "decentering"


@dataclass(frozen=True, eq=False, slots=True)
class Displacement:
    """The corrective displacement at measured pixels."""

    vector: Array
    """(..., 2) d1, d2, px; added to a measured pixel it gives the ideal one."""
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


def compute_displacement(
    uv: npt.ArrayLike, camera: Camera, part: DisplacementPart = DisplacementPart.COMPLETE
) -> Displacement:
    """Compute the corrective displacement at measured pixels `uv` (..., 2), or a part of it.

    It is NaN where the lens has no ray, and from 80 degrees off the axis on.
    """
    points = np.asarray(uv, dtype=np.float64)
    complete = _compute_correction(points, camera)
    if part is DisplacementPart.COMPLETE:
        return complete
    radial = _compute_correction(points, _keep_radial_part(camera))
    match part:
        case DisplacementPart.RADIAL:
            return radial
        case DisplacementPart.DECENTERING:
            others = complete.vector - radial.vector
            return Displacement(others, complete.by_pixel - radial.by_pixel)
        case _:
            assert_never(part)


def _compute_correction(uv: Array, camera: Camera) -> Displacement:
    rays, by_uv = rays_and_slopes(uv, camera)
    rays = np.where(rays[..., 2:] > _MIN_COSINE, rays, np.nan)
    n, by_ray = plane_from_rays(rays)
    f, c = camera.focal, camera.centre
    return Displacement(c + f * n - uv, f[:, None] * (by_ray @ by_uv) - np.eye(2))


def _keep_radial_part(camera: Camera) -> Camera:
    """Return the camera with the coefficients at 0 that make its lens asymmetric."""
    lens = find_model(camera.model)
    radial = [name not in lens.asymmetric for name in lens.names]
    params = np.concatenate([camera.params[:4], np.where(radial, camera.coefficients, 0.0)])
    return Camera(camera.size, params, camera.model)
