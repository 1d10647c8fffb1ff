"""The validity of a lens model: the part of the image in which it is one to one.

Polynomials fold: beyond some radius the image of a ray moves back towards the axis. Quotients have
poles, and closed forms end at an angle. A pixel counts as valid if the lens lights it
(``image_circle.py``), the model gives it a ray that is imaged at the pixel again, and neighbouring
pixels have neighbouring rays turning the same way: with the derivatives b_u and b_v of the ray b,
(b_u x b_v) . b > 0.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays, rays_and_slopes
from calibgui.engine.geometry.directions import measure_angles_off_axis

_MAX_RETURN_ERROR = 1e-6
"""Distance, px, within which a pixel must come back from its ray."""


def find_valid_pixels(uv: Array, camera: Camera) -> BoolArray:
    """Return (...) whether pixels (..., 2) are lit, and the camera's model one-to-one there."""
    with np.errstate(all="ignore"):  # a pixel far from any image has no ray
        rays, by_uv = rays_and_slopes(uv, camera)
        back = np.linalg.norm(pixels_from_rays(rays, camera) - uv, axis=-1)
        turning = np.sum(np.cross(by_uv[..., 0], by_uv[..., 1]) * rays, axis=-1)
        return np.asarray((back < _MAX_RETURN_ERROR) & (turning > 0) & camera.lights(uv))


def measure_angles(uv: Array, camera: Camera) -> Array:
    """Return the angles (...), rad, of the rays of pixels (..., 2) off the axis; NaN if none."""
    with np.errstate(all="ignore"):
        rays, _ = rays_and_slopes(uv, camera)
    return measure_angles_off_axis(rays)
