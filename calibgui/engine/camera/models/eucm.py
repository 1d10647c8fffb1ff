"""The extended unified camera model: closed-form both ways (Khomutenko, Garcia, Martinet 2016).

Kalibr (eucm-none), Basalt and COLMAP use it, for lenses of up to 180 degrees and more. With
R^2 = X^2 + Y^2

    d = (X, Y) / D,    D = alpha w + (1 - alpha) Z,    w = sqrt(beta R^2 + Z^2),

    dD/d(X, Y) = alpha beta (X, Y) / w,    dD/dZ = alpha Z / w + 1 - alpha,
    dD/dalpha = w - Z,                     dD/dbeta = alpha R^2 / (2 w).

Back, with s = |d|^2, the ray is along (d, m):

    m = (1 - beta alpha^2 s) / (alpha sqrt(1 - (2 alpha - 1) beta s) + 1 - alpha).

Its derivatives are found from those of d (``camera.tangent``). alpha = 0 is the pinhole.

Limits (Usenko et al. 2018): a ray is imaged if

    Z > -q w,    q = alpha / (1 - alpha) for alpha <= 0.5, otherwise (1 - alpha) / alpha.

There D is 0 or, for alpha > 0.5, the map folds: all points lie within (2 alpha - 1) beta s < 1.
beta must be positive.

Khomutenko, B., Garcia, G., Martinet, P. (2016). An enhanced unified camera model. IEEE RA-L 1.
Usenko, V., Demmel, N., Cremers, D. (2018). The double sphere camera model. 3DV.
"""

from __future__ import annotations

from types import MappingProxyType

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import Lens, LensProjection, LensUnprojection, Trials
from calibgui.engine.camera.tangent import invert_projection


class ExtendedUnified(Lens):
    """The extended unified model with the coefficients alpha, beta."""

    title = "Extended unified, EUCM (Kalibr, Basalt)"
    names = ("alpha", "beta")
    powers = (0, 0)
    defaults = (0.5, 1.0)
    held_at_start = ("beta",)  # the unified model's, which it begins as
    conversion_starts = Trials("alpha", (0.0, 0.5))
    least_at_start = MappingProxyType({"alpha": 0.1})  # beta does nothing at alpha = 0

    def project(self, rays: Array, k: Array) -> LensProjection:
        """Map rays to image points."""
        alpha, beta = k
        xy, Z = rays[..., :2], rays[..., 2]
        R2 = np.sum(xy * xy, axis=-1)
        w = np.sqrt(abs(beta) * R2 + Z * Z)
        q = alpha / (1 - alpha) if alpha <= 0.5 else (1 - alpha) / alpha
        D = alpha * w + (1 - alpha) * Z
        visible = (Z > -q * w) & (D > 0) & (beta > 0)
        D, w = np.where(visible, D, np.nan), np.where(visible, w, np.nan)
        d = xy / D[..., None]
        by_ray = np.empty((*xy.shape, 3))
        by_ray[..., :2] = (-alpha * beta / w)[..., None, None] * (d[..., None] * xy[..., None, :])
        by_ray[..., 0, 0] += 1
        by_ray[..., 1, 1] += 1
        by_ray[..., 2] = -(alpha * Z / w + 1 - alpha)[..., None] * d
        by_ray /= D[..., None, None]
        of_depth = np.stack([w - Z, alpha * R2 / (2 * w)], axis=-1) / -D[..., None]
        return LensProjection(d, by_ray, d[..., None] * of_depth[..., None, :])

    def unproject(self, d: Array, k: Array) -> LensUnprojection:
        """Map image points to rays of length 1."""
        m = lift(d, *k)
        rays = np.concatenate([d, m[..., None]], axis=-1)
        rays /= np.sqrt(np.sum(rays * rays, axis=-1, keepdims=True))
        return invert_projection(rays, self.project(rays, k))


def lift(d: Array, alpha: float, beta: float) -> Array:
    """Return (...) the height m of the direction (d, m); NaN where the model has none."""
    s = np.sum(d * d, axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        below = alpha * np.sqrt(1 - (2 * alpha - 1) * beta * s) + 1 - alpha
        return np.where(below > 0, (1 - beta * alpha * alpha * s) / below, np.nan)
