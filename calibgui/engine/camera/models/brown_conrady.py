"""Brown and Conrady's distortion: the model of OpenCV, ROS, Kalibr and their relatives (eq. 12).

Radial and decentering distortion (Conrady 1919, Brown 1966) take the ideal point to the measured
one, so that projecting is closed-form and undistorting is not. OpenCV calls its five coefficients
k1, k2, p1, p2, k3; Kalibr ("radtan") and many others have the first four. OpenCV's models of more
coefficients are in ``rational.py`` and ``thin_prism.py``.

With n = (x, y) ideal, r2 = x^2 + y^2 and rho = k1 r2 + k2 r2^2 + k3 r2^3, the measured point is

    xd = x (1 + rho) + 2 p1 x y + p2 (r2 + 2 x^2)
    yd = y (1 + rho) + p1 (r2 + 2 y^2) + 2 p2 x y,

and d = (xd + skew yd, yd) (``camera.skew``).

Mind the order: here p1 and p2 are OpenCV's, the other way round than the paper's. Apart
from that and from q the polynomial is that of eq. 10, applied in the opposite direction, so
its derivatives are those of ``lucchese.py`` with p3 = 0.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.models.lucchese import Lucchese
from calibgui.engine.camera.plane import PlanePoints
from calibgui.engine.camera.skew import SkewedLens

_FROM_LUCCHESE = [0, 1, 4, 3, 2]
"""Places of k1, k2, p1, p2, k3 among the coefficients of eq. 10 (p1 and p2 exchanged)."""


class BrownConrady(SkewedLens):
    """The distortion model with coefficients in OpenCV's order: k1, k2, p1, p2, k3, and skew."""

    title = "Brown-Conrady (OpenCV, ROS)"
    names: tuple[str, ...] = ("k1", "k2", "p1", "p2", "k3", "skew")
    powers: tuple[int, ...] = (2, 4, 1, 1, 6, 0)
    asymmetric = ("p1", "p2", "skew")
    closed_form_factor = -1.0

    def distort_unskewed(self, n: Array, k: Array) -> PlanePoints:
        """Map ideal points to measured points without skew."""
        return _reorder_coefficients(Lucchese().correct(n, _convert_to_eq10(k)), len(k))

    def correct_unskewed(self, xy: Array, k: Array) -> PlanePoints:
        """Map measured points without skew to ideal points, by Newton's method."""
        return _reorder_coefficients(Lucchese().distort(xy, _convert_to_eq10(k)), len(k))


class BrownConrady4(BrownConrady):
    """The distortion model without k3: k1, k2, p1, p2, and skew."""

    title = "Brown-Conrady without k3 (Kalibr)"
    names = ("k1", "k2", "p1", "p2", "skew")
    powers = (2, 4, 1, 1, 0)


def _convert_to_eq10(k: Array) -> Array:
    """Return the coefficients of eq. 10, k1, k2, k3, p1, p2, p3, from OpenCV's."""
    eq10 = np.zeros(6)
    eq10[_FROM_LUCCHESE[: len(k)]] = k
    return eq10


def _reorder_coefficients(mapped: PlanePoints, count: int) -> PlanePoints:
    """Return the map with its derivatives by the first `count` of k1, k2, p1, p2, k3."""
    return mapped._replace(by_coefficients=mapped.by_coefficients[..., _FROM_LUCCHESE[:count]])
