"""Mei's model: the unified camera with Brown's distortion (Mei and Rives 2007).

Kalibr (omni-radtan), OpenCV's contributed module omnidir, camodocal and VINS use it. With

    n = (X, Y) / (Z + xi |r|)

the image point is d = n + Brown's radial and decentering terms of n with k1, k2, p1, p2
(``camera.polynomial``). Here fx and fy are the paper's gamma.

The derivatives are those of the polynomial and of n (``camera.shifted_sphere``). Back, n is found
by Newton's method (``camera.inverse``), and from it the ray in closed form.

Limits: Z + xi |r| > 0 and, for xi > 1, |r| + xi Z > 0. Where the polynomial folds there is no ray
from the fold on.

Mei, C., Rives, P. (2007). Single view point omnidirectional camera calibration from planar
grids. ICRA.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.inverse import invert_map, make_polynomial_curve
from calibgui.engine.camera.model import Lens, LensProjection, LensUnprojection, Trials
from calibgui.engine.camera.polynomial import apply_polynomial
from calibgui.engine.camera.shifted_sphere import differentiate_shift, shift_rays, unshift_rays
from calibgui.engine.camera.tangent import invert_projection


class Mei(Lens):
    """Mei's model with the coefficients xi, k1, k2, p1, p2."""

    title = "Mei (Kalibr omni, OpenCV omnidir)"
    names = ("xi", "k1", "k2", "p1", "p2")
    powers = (0, 2, 4, 1, 1)
    asymmetric = ("p1", "p2")
    defaults = (1.0, 0.0, 0.0, 0.0, 0.0)
    valley = Trials(
        "xi", (0.1, 0.3, 0.5, 0.7, 0.9, 1.2, 1.6, 2.2, 3.0)
    )  # k1, k2 do nearly the same
    conversion_starts = Trials("xi", (0.0, 0.5, 1.0, 2.0))

    def project(self, rays: Array, k: Array) -> LensProjection:
        """Map rays to image points."""
        shifted, length = shift_rays(rays, k[0])
        zeta = np.where(shifted[..., 2:] > 0, shifted[..., 2:], np.nan)
        n = shifted[..., :2] / zeta
        d, by_n, by_k = apply_polynomial(n, k[1:3], k[3:])
        by_xy = by_n / zeta[..., None]
        by_zeta = -(by_xy[..., 0] * n[..., :1] + by_xy[..., 1] * n[..., 1:])
        by_shifted = np.concatenate([by_xy, by_zeta[..., None]], axis=-1)
        return differentiate_shift(LensProjection(d, by_shifted, by_k), rays, length, k[0])

    def unproject(self, d: Array, k: Array) -> LensUnprojection:
        """Map image points to rays of length 1, by Newton's method."""
        radial = make_polynomial_curve(k[1:3])
        n = invert_map(lambda n: apply_polynomial(n, k[1:3], k[3:]), d, radial).points
        rays = unshift_rays(np.concatenate([n, np.ones_like(n[..., :1])], axis=-1), k[0])
        return invert_projection(rays, self.project(rays, k))
