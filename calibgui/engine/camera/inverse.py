"""The inverse of a lens map, by Newton's method, with derivatives from the implicit function.

A polynomial lens has no closed-form inverse. To solve F(a, k) = b for a, Newton iterates
a <- a - J^-1 (F(a, k) - b), J = dF/da. At the solution da/db = J^-1 and da/dk = -J^-1 dF/dk.

A polynomial lens map is invertible only out to the fold where det J = 0, and may unfold again
further out. The iteration therefore starts from the inverse of the radial part, which one
table of this curve up to its fold gives for all points; points that have no inverse inside
the fold come back as NaN. A rational curve can end at a pole instead, to which a step goes half of
the way at most, and bend sharply before it: a step that leads farther from b is halved until it
does not (damped Newton).

How closely F can be met is not known beforehand: where numerator and denominator of a rational
curve both come near 0, their rounding is enlarged thousands of times. A solution is therefore told
by its next step, which is short at a solution whatever the rounding, and never beyond a fold.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.plane import PlanePoints

_MAX_ITERATIONS = 50
"""Number of Newton steps, at most."""
_MAX_STEP = 4e-15
"""Length of the last Newton step, relative to 1 + |a|: a few units in the last place."""
_MAX_STANDING_STEP = 1e-7
"""Length of a step, relative to 1 + |a|, up to which a point is a solution although its steps do
not vanish: as steps shrink quadratically, nothing but rounding is left of them."""
_NODES = 1024
"""Number of nodes of the radial table: Newton then starts within 1e-3 of the radius."""


class RadialCurve(NamedTuple):
    """The radial part of a lens map, by which a radius r becomes another."""

    evaluate: Callable[[Array], Array]
    """The curve; its slope at r = 0 is 1."""
    folds: Array
    """Radii at which its slope is 0, ascending."""
    pole: float = np.inf
    """Radius at which it is infinite and ends."""


def make_polynomial_curve(k: Array) -> RadialCurve:
    """Return the curve r (1 + k1 r^2 + k2 r^4 + ...) of coefficients k (m,)."""

    def evaluate(r: Array) -> Array:
        r2 = r * r
        rho = np.zeros_like(r)
        for kj in k[::-1]:
            rho = r2 * (kj + rho)
        return r * (1 + rho)

    slope = np.concatenate([[1.0], np.arange(3, 3 + 2 * len(k), 2) * k])
    return RadialCurve(evaluate, find_radii(slope))


def find_radii(polynomial: Array) -> Array:
    """Return the radii r > 0, ascending, at which 1 + c1 r^2 + c2 r^4 + ... is 0.

    Args:
        polynomial: (m + 1,) 1, c1, c2, ...
    """
    inverse_squares = np.roots(polynomial)  # 1 / r^2: a last coefficient of 0 is no difficulty
    real = inverse_squares[inverse_squares.imag == 0].real
    return np.sort(1 / np.sqrt(real[real > 0]))


def invert_map(
    forward: Callable[[Array], PlanePoints], b: Array, radial: RadialCurve
) -> PlanePoints:
    """Solve forward(a) = b for a, inside the fold or pole around the origin.

    Args:
        forward: the map, with derivatives.
        b: (..., 2) values to reach, dimensionless.
        radial: the map's radial part.

    Returns:
        The points a with their derivatives by b and by the coefficients, NaN without an inverse.
    """
    target = b.reshape(-1, 2)
    a, reach = _invert_radial_part(target, radial)
    accepted, nearest = a.copy(), np.full(len(a), np.inf)
    active = np.flatnonzero(np.isfinite(target).all(axis=1))
    with np.errstate(all="ignore"):  # points without an inverse overflow; they end as NaN below
        for _ in range(_MAX_ITERATIONS):
            mapped = forward(a[active])
            miss = mapped.points - target[active]
            distance = np.hypot(*miss.T)
            farther = (distance > nearest[active])[:, None]
            step = solve_pairs(mapped.by_point, miss)
            step = np.where(farther, (a[active] - accepted[active]) / 2, step)
            accepted[active] = np.where(farther, accepted[active], a[active])
            nearest[active] = np.fmin(nearest[active], distance)
            length = np.hypot(*step.T)
            room = (radial.pole - np.hypot(*a[active].T)) / 2
            a[active] -= step * np.fmin(1.0, room / length)[:, None]
            moving = ~(length <= _MAX_STEP * (1 + np.hypot(*a[active].T))) & np.isfinite(length)
            active = active[moving]
            if active.size == 0:
                break
        mapped = forward(a)
        J = mapped.by_point
        step = solve_pairs(J, mapped.points - target)
        det = J[:, 0, 0] * J[:, 1, 1] - J[:, 0, 1] * J[:, 1, 0]
        radius = np.hypot(*a.T)
        inside = (det > 0) & (J[:, 0, 0] + J[:, 1, 1] > 0) & (radius < reach)
        bad = ~(inside & (np.hypot(*step.T) <= _MAX_STANDING_STEP * (1 + radius)))
        a[bad] = np.nan
        inverse = np.empty_like(J)
        inverse[:, 0, 0], inverse[:, 1, 1] = J[:, 1, 1] / det, J[:, 0, 0] / det
        inverse[:, 0, 1], inverse[:, 1, 0] = -J[:, 0, 1] / det, -J[:, 1, 0] / det
        inverse[bad] = np.nan
    by_k = -inverse @ mapped.by_coefficients
    count = by_k.shape[-1]
    return PlanePoints(
        a.reshape(b.shape), inverse.reshape(*b.shape, 2), by_k.reshape(*b.shape, count)
    )


def _invert_radial_part(target: Array, radial: RadialCurve) -> tuple[Array, float]:
    """Return where the radial part alone is `target` (n, 2), and the radius up to which it holds.

    The points end at 0.9 of the radius of the fold or pole: from inside, Newton's method approaches
    solutions up to the fold steadily, while at the fold it has no slope to follow. The second
    value is the radius midway between the fold and where the map unfolds again: solutions
    further out belong to that other branch.
    """
    folds = radial.folds[radial.folds < radial.pole]
    limit = folds.min(initial=radial.pole)
    radius = np.hypot(*target.T)
    end = np.ones(1)
    farthest = radius.max(initial=0.0, where=np.isfinite(radius))
    while end < limit and radial.evaluate(end) < farthest:
        end *= 2
    r = np.linspace(0.0, min(end[0], 0.9 * limit), _NODES)
    with np.errstate(invalid="ignore"):
        shrink = np.where(radius > 0, np.interp(radius, radial.evaluate(r), r) / radius, 1.0)
        start = target * shrink[:, None]
    return start, float(folds[:2].mean()) if len(folds) > 1 else radial.pole


def solve_pairs(J: Array, miss: Array) -> Array:
    """Return J^-1 miss (n, 2) for J (n, 2, 2) and miss (n, 2), not finite where J is singular."""
    det = J[:, 0, 0] * J[:, 1, 1] - J[:, 0, 1] * J[:, 1, 0]
    solved = [
        J[:, 1, 1] * miss[:, 0] - J[:, 0, 1] * miss[:, 1],
        J[:, 0, 0] * miss[:, 1] - J[:, 1, 0] * miss[:, 0],
    ]
    return np.stack(solved, axis=1) / det[:, None]
