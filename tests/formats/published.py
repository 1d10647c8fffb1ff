"""Projections as they are published, coded anew for formats whose programs are not at hand.

Each takes points (n, 3) and returns image points (n, 2) before focal lengths and centre.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array


def pinhole(X: Array) -> Array:
    return X[:, :2] / X[:, 2:]


def radtan(m: Array, k1: float, k2: float, p1: float, p2: float) -> Array:
    """Kalibr's RadialTangentialDistortion of points m (n, 2), after Bouguet's toolbox."""
    x, y = m.T
    mx2, my2, mxy = x * x, y * y, x * y
    rho2 = mx2 + my2
    radial = k1 * rho2 + k2 * rho2 * rho2
    return np.column_stack(
        [
            x + x * radial + 2 * p1 * mxy + p2 * (rho2 + 2 * mx2),
            y + y * radial + 2 * p2 * mxy + p1 * (rho2 + 2 * my2),
        ]
    )


def radtan8(X: Array, k: dict[str, float]) -> Array:
    """OpenCV's rational model, as in Basalt's pinhole-radtan8."""
    x, y = pinhole(X).T
    r2 = x * x + y * y
    cdist = (1 + r2 * (k["k1"] + r2 * (k["k2"] + r2 * k["k3"]))) / (
        1 + r2 * (k["k4"] + r2 * (k["k5"] + r2 * k["k6"]))
    )
    dx = 2 * k["p1"] * x * y + k["p2"] * (r2 + 2 * x * x)
    dy = 2 * k["p2"] * x * y + k["p1"] * (r2 + 2 * y * y)
    return np.column_stack([x * cdist + dx, y * cdist + dy])


def equidistant(X: Array, k1: float, k2: float, k3: float, k4: float) -> Array:
    """Kannala and Brandt's even polynomial of the angle (equidistant, kb4)."""
    r = np.hypot(X[:, 0], X[:, 1])
    theta = np.arctan2(r, X[:, 2])
    rho = theta + k1 * theta**3 + k2 * theta**5 + k3 * theta**7 + k4 * theta**9
    return X[:, :2] * np.where(r > 0, rho / np.where(r > 0, r, 1), 0)[:, None]


def omni(X: Array, xi: float) -> Array:
    """Mei's projection on the normalised plane, before distortion."""
    return X[:, :2] / (X[:, 2] + xi * np.linalg.norm(X, axis=1))[:, None]


def eucm(X: Array, alpha: float, beta: float) -> Array:
    """Khomutenko's extended unified camera."""
    x, y, z = X.T
    rho = np.sqrt(beta * (x * x + y * y) + z * z)
    return X[:, :2] / (alpha * rho + (1 - alpha) * z)[:, None]


def double_sphere(X: Array, xi: float, alpha: float) -> Array:
    """Usenko's double sphere camera."""
    x, y, z = X.T
    d1 = np.sqrt(x * x + y * y + z * z)
    d2 = np.sqrt(x * x + y * y + (xi * d1 + z) ** 2)
    return X[:, :2] / (alpha * d2 + (1 - alpha) * (xi * d1 + z))[:, None]
