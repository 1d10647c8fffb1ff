"""Rays seen from a point below the centre of the unit sphere, and back.

The unified models project a ray onto the unit sphere and look at the sphere from the point
(0, 0, -xi): the ray r = (X, Y, Z) becomes (X, Y, zeta),

    zeta = Z + xi |r|,    d zeta/dr = (0, 0, 1) + xi r / |r|,    d zeta/d xi = |r|.

Back, the line from that point along v = (v1, v2, m), s = v1^2 + v2^2, meets the far side of the
sphere at the ray

    lambda v - (0, 0, xi),    lambda = (m xi + sqrt(m^2 + (1 - xi^2) s)) / (m^2 + s).

Limits: for xi > 1 the point lies outside of the sphere, and sees its far side only, the rays with
|r| + xi Z > 0; lines that miss the sphere have no ray.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import LensProjection


def shift_rays(rays: Array, xi: float) -> tuple[Array, Array]:
    """Return rays (..., 3) as the shifted point sees them, and their lengths (...) before.

    zeta and the length are NaN where the ray's point on the sphere lies on the near side.
    """
    length = np.sqrt(np.sum(rays * rays, axis=-1))
    Z = rays[..., 2]
    length = np.where(length + xi * Z > 0, length, np.nan)
    zeta = Z + xi * length
    return np.concatenate([rays[..., :2], zeta[..., None]], axis=-1), length


def unshift_rays(v: Array, xi: float) -> Array:
    """Return the rays (..., 3) of length 1 that the shifted point sees along v (..., 3)."""
    m = v[..., 2]
    s = np.sum(v[..., :2] * v[..., :2], axis=-1)
    with np.errstate(invalid="ignore"):
        along = (m * xi + np.sqrt(m * m + (1 - xi * xi) * s)) / (m * m + s)
    along = np.where(along > 0, along, np.nan)
    return along[..., None] * v - np.array([0.0, 0.0, xi])


def differentiate_shift(
    imaged: LensProjection, rays: Array, length: Array, xi: float
) -> LensProjection:
    """Return image points of shifted rays with derivatives by the rays before.

    Args:
        imaged: the image points, with derivatives by the shifted rays.
        rays: (..., 3) before the shift.
        length: (...) their lengths.
        xi: the shift.

    Returns:
        The same points; the derivative by xi stands before those by the other coefficients.
    """
    by_zeta = imaged.by_ray[..., 2]
    by_ray = by_zeta[..., None] * (xi * rays / length[..., None])[..., None, :] + imaged.by_ray
    by_xi = (by_zeta * length[..., None])[..., None]
    by_k = np.concatenate([by_xi, imaged.by_coefficients], axis=-1)
    return LensProjection(imaged.points, by_ray, by_k)
