"""The forward distortion model of OpenCV, ROS and their relatives (the paper's eq. 12).

With n = (x, y) ideal, r2 = x^2 + y^2 and rho = k1 r2 + k2 r2^2 + k3 r2^3, the measured point is

    xd = x (1 + rho) + 2 p1 x y + p2 (r2 + 2 x^2)
    yd = y (1 + rho) + p1 (r2 + 2 y^2) + 2 p2 x y.

Mind the order: here p1 and p2 are OpenCV's, the other way round than the paper's. Apart
from that and from q the polynomial is that of eq. 10, applied in the opposite direction, so
its derivatives are those of ``lucchese.py`` with p3 = 0.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.model import Mapped
from calibgui.engine.camera.models.lucchese import Lucchese

_FROM_LUCCHESE = [0, 1, 4, 3, 2]
"""Places of k1, k2, p1, p2, k3 among the coefficients of eq. 10 (p1 and p2 exchanged)."""


class BrownConrady:
    """Distortion model with coefficients in OpenCV's order: k1, k2, p1, p2, k3."""

    names = ("k1", "k2", "p1", "p2", "k3")
    powers = (2, 4, 1, 1, 6)
    held = ()
    radius_in_pixels = False

    def distort(self, n: Array, k: Array) -> Mapped:
        """Ideal to measured."""
        return _reordered(Lucchese().correct(n, _eq10(k)))

    def correct(self, d: Array, k: Array) -> Mapped:
        """Measured to ideal, by Newton's method."""
        return _reordered(Lucchese().distort(d, _eq10(k)))


def _eq10(k: Array) -> Array:
    """The coefficients of eq. 10."""
    eq10 = np.zeros(6)
    eq10[_FROM_LUCCHESE] = k
    return eq10


def _reordered(mapped: Mapped) -> Mapped:
    return mapped._replace(by_coefficients=mapped.by_coefficients[..., _FROM_LUCCHESE])
