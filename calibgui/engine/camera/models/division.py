"""The division model: one coefficient, closed-form both ways (Fitzgibbon 2001).

It is what minimal solvers and COLMAP's SIMPLE_DIVISION use. An image point d is seen along

    (d, 1 + k1 s),    s = |d|^2.

A ray (X, Y, Z) with R^2 = X^2 + Y^2 has the point d = t (X, Y), where k1 R^2 t^2 - Z t + 1 = 0;
its smaller root is

    t = 2 / (Z + w) = (Z - w) / (2 k1 R^2),    w = sqrt(Z^2 - 4 k1 R^2).

The first form is used for Z >= 0 and the second, which loses no digits there, for Z < 0. With
Z - w = 2 k1 R^2 t the derivatives are

    dt/d(X, Y) = 2 k1 t^2 (X, Y) / w,    dt/dZ = -t / w,    dt/dk1 = R^2 t^2 / w,

and those of the ray follow (``camera.tangent``).

Limits: for k1 < 0 the model sees all but the direction straight behind. For k1 > 0 it folds at
s = 1 / k1, where w = 0; it has no ray from there on, and no point for rays beyond.

Fitzgibbon, A. (2001). Simultaneous linear estimation of multiple view geometry and lens
distortion. CVPR.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import Lens, LensProjection, LensUnprojection
from calibgui.engine.camera.tangent import invert_projection


class Division(Lens):
    """The division model with the coefficient k1."""

    title = "Division, one coefficient (COLMAP)"
    names = ("k1",)
    powers = (2,)

    def project(self, rays: Array, k: Array) -> LensProjection:
        """Map rays to image points."""
        xy, Z = rays[..., :2], rays[..., 2]
        R2 = np.sum(xy * xy, axis=-1)
        with np.errstate(all="ignore"):  # rays without a point
            w = np.sqrt(Z * Z - 4 * k[0] * R2)
            t = np.where(Z >= 0, 2 / (Z + w), (Z - w) / (2 * k[0] * R2))
            # For k1 > 0 rays that point backward meet a branch of their own, with t < 0.
            t = np.where((t > 0) & (w > 0) & np.isfinite(t), t, np.nan)
            by_k = (R2 * t * t / w)[..., None, None] * xy[..., None]
            by_ray = np.empty((*xy.shape, 3))
            by_ray[..., :2] = (2 * k[0] * t * t / w)[..., None, None] * (
                xy[..., :, None] * xy[..., None, :]
            )
            by_ray[..., 0, 0] += t
            by_ray[..., 1, 1] += t
            by_ray[..., 2] = (-t / w)[..., None] * xy
        return LensProjection(t[..., None] * xy, by_ray, by_k)

    def unproject(self, d: Array, k: Array) -> LensUnprojection:
        """Map image points to rays of length 1."""
        m = 1 + k[0] * np.sum(d * d, axis=-1, keepdims=True)
        rays = np.concatenate([d, np.where(m < 2, m, np.nan)], axis=-1)
        rays /= np.sqrt(np.sum(rays * rays, axis=-1, keepdims=True))
        return invert_projection(rays, self.project(rays, k))
