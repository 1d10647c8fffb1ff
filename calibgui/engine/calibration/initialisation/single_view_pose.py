"""The cosines' equation: one view's pose, aspect ratio and focal lengths (paper 3.5).

A single tilted view of a plane determines more than its pose: the paper's equation in the cosines
of the tilt gives the pixels' aspect ratio, and with it both focal lengths. It is fragile, and here
a diagnosis in the table of Stage I.

With D = r33 + tZ the backward homography of an isotropic metric plane is (eq. 21, both of
its axes in units of fx)

    alpha1j = r1j / D      alpha2j = r r2j / D      gammaj = r3j / (fx D),     r = fy / fx,

so that theta = atan2(alpha12, alpha11) and, with eta1 = atan(alpha21 / alpha22) and
eta2 = atan2(gamma2, gamma1) (eq. 24),

    tan(theta + eta1) = sin(phi) tan(omega)      tan(theta - eta2) = tan(omega) / sin(phi),

whose product and quotient give omega and phi up to their signs (eq. 25). From
det A = r cos(phi) cos(omega) / D^2 and alpha11 = cos(theta) cos(phi) / D follows the
cosines' equation (eq. 27),

    g(r) = det A cos(phi) cos^2(theta) - r alpha11^2 cos(omega) = 0,

linear in r because no angle depends on r. The paper's own grid, equal in pixels along x'
and y' (`on_paper_grid`), replaces alpha12, alpha21 and gamma2 by r alpha12, alpha21 / r and
r gamma2 in the angles, and g(r) = det A cos(phi) cos^2(theta) - alpha11^2 cos(omega) then
has its root at r only if fy = fx holds; it is kept for figures 4 and 5.

Near fronto-parallel views and views tilted about one axis leave omega and phi undetermined:
the square roots turn imaginary with the noise, or 0 / 0. Every function then returns NaN, and
no result of the engine depends on a single view's value.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.geometry.rotations import rotation_from_paper_angles

_ASPECT_RATIOS = np.linspace(0.5, 2.0, 1501)
"""Aspect ratios between which the zero of g(r) closest to 1 is searched for on the paper's grid."""
_MIN_TILT = 1e-6
"""Tilt about either axis, rad, below which eq. 25 divides rounding errors by each other."""
_ROUNDING = 1e-14
"""Value of g(r), relative to its terms, that is zero but for rounding errors."""


class ViewGeometry(NamedTuple):
    """Pose and focal lengths from backward homographies (..., 3, 3) (eq. 25, 28)."""

    omega: Array
    phi: Array
    theta: Array
    t: Array
    """(..., 3) normalised translation."""
    aspect: Array
    fx: Array
    fy: Array


def _normalise_coefficients(backward: Array, r: Array, on_paper_grid: bool) -> tuple[Array, ...]:
    """Return alpha11, alpha12, alpha21, alpha22, gamma1, gamma2 without the grid's anisotropy."""
    s = r if on_paper_grid else np.ones_like(r)
    (a11, a12, _), (a21, a22, _), (g1, g2, _) = np.moveaxis(backward, (-2, -1), (0, 1))
    return a11 + 0 * s, s * a12, a21 / s, a22 + 0 * s, g1 + 0 * s, s * g2


def _compute_angles(backward: Array, r: Array, on_paper_grid: bool) -> tuple[Array, Array, Array]:
    """Return |omega|, |phi| and theta (eq. 25), NaN where the view does not determine them."""
    a11, a12, a21, a22, g1, g2 = _normalise_coefficients(backward, r, on_paper_grid)
    theta = np.arctan2(a12, a11)
    with np.errstate(invalid="ignore", divide="ignore"):
        first = np.tan(theta + np.arctan(a21 / a22))
        second = np.tan(theta - np.arctan2(g2, g1))
        omega = np.arctan(np.sqrt(first * second))
        phi = np.arcsin(np.sqrt(first / second))
    defined = np.minimum(omega, phi) > _MIN_TILT
    return np.where(defined, omega, np.nan), np.where(defined, phi, np.nan), theta


def evaluate_cosines_equation(backward: Array, r: Array, on_paper_grid: bool = False) -> Array:
    """Evaluate g(r) of eq. 27.

    Args:
        backward: (3, 3) backward homography in the paper's frame, principal point at zero.
        r: (n,) aspect ratios.
        on_paper_grid: true for the paper's grid, equal in pixels along both axes, false for the
            metric plane.

    Returns:
        (n,) NaN where the angles are undefined.
    """
    omega, phi, theta = _compute_angles(backward, r, on_paper_grid)
    determinant = backward[0, 0] * backward[1, 1] - backward[0, 1] * backward[1, 0]
    weight = np.ones_like(r) if on_paper_grid else r
    return determinant * np.cos(phi) * np.cos(theta) ** 2 - weight * backward[0, 0] ** 2 * np.cos(
        omega
    )


def solve_aspect_ratio(backward: Array, on_paper_grid: bool = False) -> Array:
    """Return (...) the root of the cosines' equation; NaN if the angles are undefined.

    It has a closed form on the metric plane; on the paper's grid it is the zero closest to 1 in
    [0.5, 2].

    Args:
        backward: (..., 3, 3) as for `evaluate_cosines_equation`.
        on_paper_grid: as for `evaluate_cosines_equation`.
    """
    if on_paper_grid:
        flat = backward.reshape(-1, 3, 3)
        return np.array([_search_aspect_ratio(H) for H in flat]).reshape(backward.shape[:-2])
    omega, phi, theta = _compute_angles(backward, np.ones(backward.shape[:-2]), on_paper_grid)
    cosines = np.cos(phi) * np.cos(theta) ** 2 / np.cos(omega)
    return np.asarray(np.linalg.det(backward[..., :2, :2]) * cosines / backward[..., 0, 0] ** 2)


def _search_aspect_ratio(backward: Array) -> float:
    """Return the zero of g(r) on the paper's grid that is closest to 1; NaN if there is none."""

    def g(r: float) -> float:
        return float(evaluate_cosines_equation(backward, np.array([r]), on_paper_grid=True)[0])

    values = evaluate_cosines_equation(backward, _ASPECT_RATIOS, on_paper_grid=True)
    with np.errstate(invalid="ignore"):
        changes = np.flatnonzero(values[:-1] * values[1:] <= 0)
    roots = [
        float(scipy.optimize.brentq(g, _ASPECT_RATIOS[i], _ASPECT_RATIOS[i + 1])) for i in changes
    ]
    roots += _search_root_pairs(g, values, _ROUNDING * float(backward[0, 0]) ** 2)
    return min(roots, key=lambda r: abs(r - 1), default=float("nan"))


def _search_root_pairs(g: Callable[[float], float], values: Array, rounding: float) -> list[float]:
    """Return the zeros of g that lie in pairs between neighbouring nodes of the search.

    Such a pair changes no sign from node to node: it shows as a smallest |g| at a node. If the two
    coincide, rounding errors can keep g from reaching 0.

    Args:
        g: the function.
        values: its values at `_ASPECT_RATIOS`.
        rounding: the size of |g| that is 0 but for rounding errors.
    """
    before, here, after = values[:-2], values[1:-1], values[2:]
    with np.errstate(invalid="ignore"):
        is_same_sign = (before * here > 0) & (here * after > 0)
        is_smallest = (np.abs(here) <= np.abs(before)) & (np.abs(here) <= np.abs(after))
    roots: list[float] = []
    for i in np.flatnonzero(is_same_sign & is_smallest):
        low, high, sign = _ASPECT_RATIOS[i], _ASPECT_RATIOS[i + 2], np.sign(here[i])
        least = scipy.optimize.minimize_scalar(
            lambda r, sign=sign: sign * g(r), bounds=(low, high), options={"xatol": 1e-12}
        )
        if least.fun < 0:
            roots += [float(scipy.optimize.brentq(g, end, least.x)) for end in (low, high)]
        elif least.fun <= rounding:
            roots.append(float(least.x))
    return roots


def estimate_view_geometry(backward: Array, on_paper_grid: bool = False) -> ViewGeometry:
    """Estimate angles with their signs, normalised translation and focal lengths (eq. 25, 28).

    Args:
        backward: (..., 3, 3) backward homographies in the paper's frame, principal point at
            zero, from reference coordinates in units that are the same along both of the plane's
            axes.
        on_paper_grid: as for `evaluate_cosines_equation`.

    Returns:
        All NaN where a view does not determine its aspect ratio. Of the four combinations
        of signs the one whose homography is closest to the given one is taken.
    """
    r = solve_aspect_ratio(backward, on_paper_grid)
    omega, phi, theta = _compute_angles(backward, r, on_paper_grid)
    theta = np.where(np.isfinite(omega), theta, np.nan)
    signs = np.array(list(product((1.0, -1.0), repeat=2))).reshape(4, 2, *[1] * r.ndim)
    with np.errstate(invalid="ignore", divide="ignore"):
        miss, candidates = _evaluate_angles(
            backward, r, on_paper_grid, signs[:, 0] * omega, signs[:, 1] * phi, theta
        )
    chosen = np.argmin(np.where(np.isnan(miss), np.inf, miss), axis=0)
    return ViewGeometry(*(_take_chosen(value, chosen) for value in candidates))


def _take_chosen(values: Array, chosen: IntArray) -> Array:
    """Return those of the values (4, ..., m) that are numbered by `chosen` (...)."""
    index = chosen.reshape(1, *chosen.shape, *[1] * (values.ndim - 1 - chosen.ndim))
    return np.take_along_axis(values, index, axis=0)[0]


def _evaluate_angles(
    backward: Array, r: Array, on_paper_grid: bool, omega: Array, phi: Array, theta: Array
) -> tuple[Array, ViewGeometry]:
    """Return how badly given angles explain the views, and the geometry under them (eq. 28)."""
    a11, a12, a21, a22, g1, g2 = _normalise_coefficients(backward, r, on_paper_grid)
    R = np.moveaxis(rotation_from_paper_angles(omega, phi, theta), (-2, -1), (0, 1))
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
    s = np.ones_like(r) if on_paper_grid else r
    given = a11 + 0 * D, a12 + 0 * D, a21 / s, a22 / s, g1 * fx, g2 * fx
    implied = (R[i, j] / D for i in range(3) for j in range(2))
    miss = sum((a - b) ** 2 for a, b in zip(given, implied, strict=True))
    theta, aspect = theta + 0 * D, r + 0 * D
    return np.asarray(miss), ViewGeometry(omega, phi, theta, t, aspect, fx, aspect * fx)
