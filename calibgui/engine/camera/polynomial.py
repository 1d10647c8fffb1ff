"""Brown's polynomial with any number of radial coefficients: radial and decentering terms.

With b = (x, y), r2 = x^2 + y^2 and rho = k1 r2 + k2 r2^2 + ...,

    d1 = x (1 + rho) + 2 p1 x y + p2 (r2 + 2 x^2)
    d2 = y (1 + rho) + p1 (r2 + 2 y^2) + 2 p2 x y,

p1 and p2 in OpenCV's order. With rho' = d rho / d r2 = k1 + 2 k2 r2 + ... the derivatives are

    d d1/dx = 1 + rho + 2 x^2 rho' + 2 p1 y + 6 p2 x
    d d1/dy = d d2/dx = 2 x y rho' + 2 p1 x + 2 p2 y
    d d2/dy = 1 + rho + 2 y^2 rho' + 6 p1 y + 2 p2 x

    d d/dkj = r2^j (x, y),   d d/dp1 = (2 x y, r2 + 2 y^2),   d d/dp2 = (r2 + 2 x^2, 2 x y).

Lenses of wide views apply it to a point b that stands for the ray and exists behind 90 degrees.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.plane import PlanePoints


def apply_polynomial(b: Array, radial: Array, decentering: Array) -> PlanePoints:
    """Apply the polynomial to points b (..., 2).

    Args:
        b: the points.
        radial: (J,) k1, k2, ...
        decentering: (2,) p1, p2.

    Returns:
        The points d, with their derivatives by b and by k1, k2, ..., p1, p2.
    """
    p1, p2 = decentering
    x, y = b[..., 0], b[..., 1]
    xx, yy, xy = x * x, y * y, x * y
    r2 = xx + yy
    rho, slope = np.zeros_like(r2), np.zeros_like(r2)
    for k in radial[::-1]:
        slope = rho + r2 * slope
        rho = k + r2 * rho
    slope = rho + r2 * slope
    stretch = 1 + r2 * rho
    g0, g1, g2 = r2 + 2 * xx, 2 * xy, r2 + 2 * yy

    points = np.stack([x * stretch + p1 * g1 + p2 * g0, y * stretch + p1 * g2 + p2 * g1], axis=-1)

    by_point = np.empty((*b.shape, 2))
    by_point[..., 0, 0] = stretch + 2 * xx * slope + 2 * p1 * y + 6 * p2 * x
    by_point[..., 0, 1] = by_point[..., 1, 0] = 2 * (xy * slope + p1 * x + p2 * y)
    by_point[..., 1, 1] = stretch + 2 * yy * slope + 6 * p1 * y + 2 * p2 * x

    by_k = np.empty((*b.shape, len(radial) + 2))
    power = b
    for j in range(len(radial)):
        power = power * r2[..., None]
        by_k[..., j] = power
    by_k[..., 0, -2], by_k[..., 1, -2] = g1, g2
    by_k[..., 0, -1], by_k[..., 1, -1] = g0, g1
    return PlanePoints(points, by_point, by_k)
