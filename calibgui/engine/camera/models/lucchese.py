"""The paper's correction model (eq. 9-11), in dimensionless coordinates.

It takes the measured point to the ideal one, so that undistorting is closed-form and projecting is
not: an inverse Brown-Conrady model, with one more coefficient p3.

With d = (x, y), r2 = x^2 + y^2 and

    rho = k1 r2 + k2 r2^2 + k3 r2^3                          radial
    lx  = p1 (r2 + 2 x^2) + 2 p2 x y                         decentering
    ly  = 2 p1 x y + p2 (r2 + 2 y^2)
    q   = 1 + p3 r2

the ideal point is

    psi1 = x + x rho + q lx,    psi2 = y + y rho + q ly.

Derivatives (appendix E, where the principal point is an unknown; here it enters through d):
with rho' = d rho / d r2 = k1 + 2 k2 r2 + 3 k3 r2^2,

    d psi1/dx = 1 + rho + 2 x^2 rho' + 2 x p3 lx + q (6 p1 x + 2 p2 y)
    d psi1/dy =           2 x y rho' + 2 y p3 lx + q (2 p1 y + 2 p2 x)
    d psi2/dx =           2 x y rho' + 2 x p3 ly + q (2 p1 y + 2 p2 x)
    d psi2/dy = 1 + rho + 2 y^2 rho' + 2 y p3 ly + q (2 p1 x + 6 p2 y)

    d psi/dkj = r2^j (x, y)      d psi/dp3 = r2 (lx, ly)
    d psi/dp1 = q (r2 + 2 x^2, 2 x y)      d psi/dp2 = q (2 x y, r2 + 2 y^2)

Measuring the radius in dimensionless instead of pixel units keeps the distortion radial in
the scene where pixels are not square; for fx = fy it is the paper's model. `radius_in_pixels`
gives the printed one, in units of fx along both axes.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.inverse import invert_map, make_polynomial_curve
from calibgui.engine.camera.plane import PlaneLens, PlanePoints


class Lucchese(PlaneLens):
    """The correction model with coefficients k1, k2, k3, p1, p2, p3."""

    names = ("k1", "k2", "k3", "p1", "p2", "p3")
    powers = (2, 4, 6, 1, 1, 2)
    asymmetric = ("p1", "p2", "p3")
    odd_along = (("p1",), ("p2",))
    closed_form_factor = 1.0

    def __init__(self, radius_in_pixels: bool = False) -> None:
        """Choose the unit of the radius: fx along both axes if `radius_in_pixels`, as printed."""
        self.radius_in_pixels = radius_in_pixels
        self.title = f"Lucchese (inverse Brown-Conrady{', as printed' if radius_in_pixels else ''})"
        # p3 multiplies p1 and p2 and is rarely determined. The paper frees it all the same.
        self.held = () if radius_in_pixels else ("p3",)

    def correct(self, d: Array, k: Array) -> PlanePoints:
        """Map measured to ideal points, eq. 9."""
        k1, k2, k3, p1, p2, p3 = k
        x, y = d[..., 0], d[..., 1]
        xx, yy, xy = x * x, y * y, x * y
        r2 = xx + yy
        rho = r2 * (k1 + r2 * (k2 + r2 * k3))
        slope = k1 + r2 * (2 * k2 + r2 * 3 * k3)
        lx = p1 * (r2 + 2 * xx) + 2 * p2 * xy
        ly = 2 * p1 * xy + p2 * (r2 + 2 * yy)
        q = 1 + p3 * r2

        points = np.stack([x + x * rho + q * lx, y + y * rho + q * ly], axis=-1)

        by_point = np.empty((*d.shape, 2))
        cross = 2 * xy * slope + 2 * q * (p1 * y + p2 * x)
        by_point[..., 0, 0] = (
            1 + rho + 2 * xx * slope + 2 * x * p3 * lx + q * (6 * p1 * x + 2 * p2 * y)
        )
        by_point[..., 0, 1] = cross + 2 * y * p3 * lx
        by_point[..., 1, 0] = cross + 2 * x * p3 * ly
        by_point[..., 1, 1] = (
            1 + rho + 2 * yy * slope + 2 * y * p3 * ly + q * (2 * p1 * x + 6 * p2 * y)
        )

        by_k = np.empty((*d.shape, 6))
        power = r2[..., None] * d
        for j in range(3):
            by_k[..., j] = power
            power = power * r2[..., None]
        by_k[..., 0, 3] = q * (r2 + 2 * xx)
        by_k[..., 1, 3] = by_k[..., 0, 4] = 2 * q * xy
        by_k[..., 1, 4] = q * (r2 + 2 * yy)
        by_k[..., 0, 5] = r2 * lx
        by_k[..., 1, 5] = r2 * ly
        return PlanePoints(points, by_point, by_k)

    def distort(self, n: Array, k: Array) -> PlanePoints:
        """Map ideal to measured points, the inverse of eq. 9, by Newton's method."""
        if not k.any():  # the identity: to first order in k its inverse does the opposite
            points, by_point, by_k = self.correct(n, k)
            return PlanePoints(points, by_point, -by_k)
        return invert_map(lambda d: self.correct(d, k), n, make_polynomial_curve(k[:3]))
