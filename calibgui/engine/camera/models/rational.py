"""The rational model of OpenCV: Brown and Conrady's, its radial part a quotient of polynomials.

It is OpenCV's CALIB_RATIONAL_MODEL (after Claus and Fitzgibbon 2005, who divide polynomials for
wide lenses): a quotient follows the image of a wide lens, which hardly grows any more far out,
where a polynomial folds.

With n = (x, y) ideal, s = x^2 + y^2 and

    N = 1 + k1 s + k2 s^2 + k3 s^3,    D = 1 + k4 s + k5 s^2 + k6 s^3,    g = N / D,
    lx = 2 p1 x y + p2 (s + 2 x^2),    ly = p1 (s + 2 y^2) + 2 p2 x y,

the measured point is (xd, yd) = g (x, y) + (lx, ly), and d = (xd + skew yd, yd)
(``camera.skew``). With N', D' and g' = (N' - g D') / D the derivatives by s,

    dxd/dx = g + 2 x^2 g' + 2 p1 y + 6 p2 x      dxd/dy = 2 x y g' + 2 p1 x + 2 p2 y
    dyd/dx = 2 x y g' + 2 p1 x + 2 p2 y          dyd/dy = g + 2 y^2 g' + 6 p1 y + 2 p2 x
    d/dk1..3 = s^j (x, y) / D                    d/dk4..6 = -s^j g (x, y) / D
    d/dp1 = (2 x y, s + 2 y^2)                   d/dp2 = (s + 2 x^2, 2 x y).

The radial part r g has the slope g + 2 s g' = (N D + 2 s (N' D - N D')) / D^2: it folds where the
numerator is 0, and ends at the pole where D is 0 for the first time. There is no image beyond the
pole. N and D trade with each other where the image does not reach far out: their coefficients are
then badly determined together, while the quotient is well determined.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import polynomial

from calibgui.engine.arrays import Array
from calibgui.engine.camera.inverse import RadialCurve, find_radii, invert_map
from calibgui.engine.camera.plane import PlanePoints
from calibgui.engine.camera.skew import SkewedLens


class Rational(SkewedLens):
    """The model with coefficients in OpenCV's order: k1, k2, p1, p2, k3, k4, k5, k6, and skew."""

    title = "Rational (OpenCV)"
    names: tuple[str, ...] = ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "skew")
    powers: tuple[int, ...] = (2, 4, 1, 1, 6, 2, 4, 6, 0)
    asymmetric: tuple[str, ...] = ("p1", "p2", "skew")

    def distort_unskewed(self, n: Array, k: Array) -> PlanePoints:
        """Map ideal points to measured points without skew; NaN from the pole on."""
        x, y = n[..., 0], n[..., 1]
        p1, p2 = k[2:4]
        N, D = _get_quotient(k)
        xx, yy, xy = x * x, y * y, x * y
        s = xx + yy
        below_pole = np.where(s < _find_pole(D) ** 2, s, np.nan)
        denominator = polynomial.polyval(below_pole, D)
        g = polynomial.polyval(s, N) / denominator
        slope = polynomial.polyval(s, polynomial.polyder(N))
        slope = (slope - g * polynomial.polyval(s, polynomial.polyder(D))) / denominator
        by_p1 = np.stack([2 * xy, s + 2 * yy], axis=-1)
        by_p2 = np.stack([s + 2 * xx, 2 * xy], axis=-1)

        by_point = np.empty((*n.shape, 2))
        by_point[..., 0, 0] = g + 2 * xx * slope + 2 * p1 * y + 6 * p2 * x
        by_point[..., 1, 1] = g + 2 * yy * slope + 6 * p1 * y + 2 * p2 * x
        by_point[..., 0, 1] = by_point[..., 1, 0] = 2 * (xy * slope + p1 * x + p2 * y)

        scaled = n / denominator[..., None]
        by_k = np.empty((*n.shape, 8))
        for power, (above, below) in enumerate(((0, 5), (1, 6), (4, 7)), start=1):
            by_k[..., above] = s[..., None] ** power * scaled
            by_k[..., below] = -g[..., None] * by_k[..., above]
        by_k[..., 2], by_k[..., 3] = by_p1, by_p2
        return PlanePoints(g[..., None] * n + p1 * by_p1 + p2 * by_p2, by_point, by_k)

    def correct_unskewed(self, xy: Array, k: Array) -> PlanePoints:
        """Map measured points without skew to ideal points, by Newton's method."""
        return invert_map(lambda n: self.distort_unskewed(n, k), xy, _make_curve(*_get_quotient(k)))


def _get_quotient(k: Array) -> tuple[Array, Array]:
    """Return the coefficients (4,) of N and D, ascending, for k1, k2, p1, p2, k3, k4, k5, k6."""
    return np.array([1.0, k[0], k[1], k[4]]), np.array([1.0, k[5], k[6], k[7]])


def _find_pole(D: Array) -> float:
    """Return the least radius at which D is 0; infinity if there is none."""
    return float(find_radii(D).min(initial=np.inf))


def _make_curve(N: Array, D: Array) -> RadialCurve:
    """Return the radial part r N / D."""

    def evaluate(r: Array) -> Array:
        return r * polynomial.polyval(r * r, N) / polynomial.polyval(r * r, D)

    bend = np.convolve(polynomial.polyder(N), D) - np.convolve(N, polynomial.polyder(D))
    slope = np.convolve(N, D) + 2 * np.append(0.0, bend)
    return RadialCurve(evaluate, find_radii(slope), _find_pole(D))
