"""The cosines' equation: one view's pose, aspect ratio and focal lengths (paper 3.5).

With D = r33 + tZ the backward homography of an isotropic metric plate is (eq. 21, both plate
axes in units of fx)

    alpha1j = r1j / D      alpha2j = r r2j / D      gammaj = r3j / (fx D),     r = fy / fx,

so that theta = atan2(alpha12, alpha11) and, with eta1 = atan(alpha21 / alpha22) and
eta2 = atan2(gamma2, gamma1) (eq. 24),

    tan(theta + eta1) = sin(phi) tan(omega)      tan(theta - eta2) = tan(omega) / sin(phi),

whose product and quotient give omega and phi up to their signs (eq. 25). From
det A = r cos(phi) cos(omega) / D^2 and alpha11 = cos(theta) cos(phi) / D follows the
cosines' equation (eq. 27),

    g(r) = det A cos(phi) cos^2(theta) - r alpha11^2 cos(omega) = 0,

linear in r because no angle depends on r. The paper's own grid, equal in pixels along x'
and y' (`literal`), replaces alpha12, alpha21 and gamma2 by r alpha12, alpha21 / r and
r gamma2 in the angles, and g(r) = det A cos(phi) cos^2(theta) - alpha11^2 cos(omega) then
has its root at r only if fy = fx holds; it is kept for figures 4 and 5.

Near fronto-parallel views and views tilted about one axis leave omega and phi undetermined:
the square roots turn imaginary with the noise, or 0 / 0. Every function then returns NaN, and
no result of the engine depends on a single view's value.
"""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.geometry.rotations import paper_rotation

_SEARCH = np.linspace(0.5, 2.0, 1501)
"""Aspect ratios among which the zero of g(r) closest to 1 is sought."""


_LEAST = 1e-6
"""Tilt about either axis, rad, below which eq. 25 divides rounding errors by each other."""


class ViewGeometry(NamedTuple):
    """What backward homographies (..., 3, 3) say of pose and focal lengths (eq. 25, 28)."""

    omega: Array
    phi: Array
    theta: Array
    t: Array
    """(..., 3) normalised translation."""
    aspect: Array
    fx: Array
    fy: Array


def _normalised(backward: Array, r: Array, literal: bool) -> tuple[Array, ...]:
    """alpha11, alpha12, alpha21, alpha22, gamma1, gamma2 with the grid's anisotropy taken out."""
    s = r if literal else np.ones_like(r)
    (a11, a12, _), (a21, a22, _), (g1, g2, _) = np.moveaxis(backward, (-2, -1), (0, 1))
    return a11 + 0 * s, s * a12, a21 / s, a22 + 0 * s, g1 + 0 * s, s * g2


def _angles(backward: Array, r: Array, literal: bool) -> tuple[Array, Array, Array]:
    """|omega|, |phi| and theta (eq. 25), NaN where the view leaves them open."""
    a11, a12, a21, a22, g1, g2 = _normalised(backward, r, literal)
    theta = np.arctan2(a12, a11)
    with np.errstate(invalid="ignore", divide="ignore"):
        first = np.tan(theta + np.arctan(a21 / a22))
        second = np.tan(theta - np.arctan2(g2, g1))
        omega = np.arctan(np.sqrt(first * second))
        phi = np.arcsin(np.sqrt(first / second))
    defined = np.minimum(omega, phi) > _LEAST
    return np.where(defined, omega, np.nan), np.where(defined, phi, np.nan), theta


def cosines_equation(backward: Array, r: Array, literal: bool = False) -> Array:
    """g(r) of eq. 27.

    Args:
        backward: (3, 3) backward homography in the paper's frame, principal point at zero.
        r: (n,) aspect ratios.
        literal: the paper's grid, equal in pixels along both axes, instead of the metric plate.

    Returns:
        (n,) NaN where the angles are undefined.
    """
    omega, phi, theta = _angles(backward, r, literal)
    determinant = backward[0, 0] * backward[1, 1] - backward[0, 1] * backward[1, 0]
    weight = np.ones_like(r) if literal else r
    return determinant * np.cos(phi) * np.cos(theta) ** 2 - weight * backward[0, 0] ** 2 * np.cos(
        omega
    )


def aspect_ratio(backward: Array, literal: bool = False) -> Array:
    """(...) the root of the cosines' equation; NaN if the angles are undefined.

    Closed-form on the metric plate; on the literal grid the zero closest to 1 in [0.5, 2].
    """
    if literal:
        flat = backward.reshape(-1, 3, 3)
        return np.array([_searched(H) for H in flat]).reshape(backward.shape[:-2])
    omega, phi, theta = _angles(backward, np.ones(backward.shape[:-2]), literal)
    cosines = np.cos(phi) * np.cos(theta) ** 2 / np.cos(omega)
    return np.asarray(np.linalg.det(backward[..., :2, :2]) * cosines / backward[..., 0, 0] ** 2)


def _searched(backward: Array) -> float:
    """The zero of g(r) on the literal grid that is closest to 1; NaN if there is none."""

    def g(r: float) -> float:
        return float(cosines_equation(backward, np.array([r]), literal=True)[0])

    values = cosines_equation(backward, _SEARCH, literal=True)
    with np.errstate(invalid="ignore"):
        changes = np.flatnonzero(values[:-1] * values[1:] <= 0)
    roots = [float(scipy.optimize.brentq(g, _SEARCH[i], _SEARCH[i + 1])) for i in changes]
    return min(roots, key=lambda r: abs(r - 1), default=float("nan"))


def view_geometry(backward: Array, literal: bool = False) -> ViewGeometry:
    """Angles with their signs, normalised translation and focal lengths of views (eq. 25, 28).

    Args:
        backward: (..., 3, 3) backward homographies in the paper's frame, principal point at
            zero, from reference coordinates in units that make the plate's sides alike.
        literal: as for `cosines_equation`.

    Returns:
        All NaN where a view does not determine its aspect ratio. Of the four combinations
        of signs the one whose homography is closest to the given one is taken.
    """
    r = aspect_ratio(backward, literal)
    omega, phi, theta = _angles(backward, r, literal)
    theta = np.where(np.isfinite(omega), theta, np.nan)
    signs = np.array(list(product((1.0, -1.0), repeat=2))).reshape(4, 2, *[1] * r.ndim)
    with np.errstate(invalid="ignore", divide="ignore"):
        miss, candidates = _with_angles(
            backward, r, literal, signs[:, 0] * omega, signs[:, 1] * phi, theta
        )
    chosen = np.argmin(np.where(np.isnan(miss), np.inf, miss), axis=0)
    return ViewGeometry(*(_taken(value, chosen) for value in candidates))


def _taken(values: Array, chosen: IntArray) -> Array:
    """Of values (4, ..., m) those numbered by `chosen` (...)."""
    index = chosen.reshape(1, *chosen.shape, *[1] * (values.ndim - 1 - chosen.ndim))
    return np.take_along_axis(values, index, axis=0)[0]


def _with_angles(
    backward: Array, r: Array, literal: bool, omega: Array, phi: Array, theta: Array
) -> tuple[Array, ViewGeometry]:
    """The views' geometry under given angles (eq. 28), and how badly it explains them."""
    a11, a12, a21, a22, g1, g2 = _normalised(backward, r, literal)
    R = np.moveaxis(paper_rotation(omega, phi, theta), (-2, -1), (0, 1))
    D = R[0, 0] / a11
    # Eq. 28 takes fx from gamma1 alone, which can vanish; its length is the stabler choice.
    fx = np.hypot(R[2, 0], R[2, 1]) / (np.hypot(g1, g2) * D)
    t = np.stack(
        [
            backward[..., 0, 2] * D / fx - R[0, 2],
            backward[..., 1, 2] * D / (r * fx) - R[1, 2],
            D - R[2, 2],
        ],
        axis=-1,
    )
    s = np.ones_like(r) if literal else r
    given = a11 + 0 * D, a12 + 0 * D, a21 / s, a22 / s, g1 * fx, g2 * fx
    implied = (R[i, j] / D for i in range(3) for j in range(2))
    miss = sum((a - b) ** 2 for a, b in zip(given, implied, strict=True))
    theta, aspect = theta + 0 * D, r + 0 * D
    return np.asarray(miss), ViewGeometry(omega, phi, theta, t, aspect, fx, aspect * fx)
