"""The inverse of a lens map, by Newton's method, with derivatives from the implicit function.

To solve F(a, k) = b for a, Newton iterates a <- a - J^-1 (F(a, k) - b), J = dF/da. At the
solution da/db = J^-1 and da/dk = -J^-1 dF/dk.

A polynomial lens map is invertible only out to the fold where det J = 0. Points beyond it,
where the iteration either fails or lands on another branch (det J <= 0), have no inverse
and come back as NaN.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from calibgui.engine.lens.base import Mapped
from calibgui.engine.types import Array

_ITERATIONS = 50
_TOLERANCE = 4e-15
"""Of the last Newton step, relative to 1 + |a|: a few units in the last place."""
_ACCEPTED = 1e-13
"""A residual that is converged to the arithmetic's limit although the step test was not met."""


def invert(forward: Callable[[Array], Mapped], b: Array, start: Array | None) -> Mapped:
    """Solve forward(a) = b for a.

    Args:
        forward: the map, with derivatives.
        b: (..., 2) values to reach, dimensionless.
        start: (..., 2) guess of a; b itself if None.
    """
    target = b.reshape(-1, 2)
    a = np.array(target if start is None else np.broadcast_to(start, b.shape).reshape(-1, 2))
    active = np.flatnonzero(np.isfinite(target).all(axis=1))
    with np.errstate(all="ignore"):  # diverging points overflow; they end as NaN below
        for _ in range(_ITERATIONS):
            mapped = forward(a[active])
            miss = mapped.points - target[active]
            step = _solve(mapped.by_point, miss)
            # Far from the solution a full step can jump over the fold: limit it to its scale.
            length = np.hypot(step[:, 0], step[:, 1])
            limit = 0.5 * (1 + np.hypot(a[active, 0], a[active, 1]))
            step *= np.minimum(1.0, limit / np.maximum(length, 1e-300))[:, None]
            a[active] -= step
            moving = ~(length <= _TOLERANCE * limit) & np.isfinite(length)
            active = active[moving]
            if active.size == 0:
                break
        mapped = forward(a)
        J = mapped.by_point
        miss = np.abs(mapped.points - target).max(axis=1, initial=0.0)
        det = J[:, 0, 0] * J[:, 1, 1] - J[:, 0, 1] * J[:, 1, 0]
        scale = 1 + np.abs(target).max(axis=1, initial=0.0)
        bad = ~((miss <= _ACCEPTED * scale) & (det > 0) & (J[:, 0, 0] + J[:, 1, 1] > 0))
        a[bad] = np.nan
        inverse = np.empty_like(J)
        inverse[:, 0, 0], inverse[:, 1, 1] = J[:, 1, 1] / det, J[:, 0, 0] / det
        inverse[:, 0, 1], inverse[:, 1, 0] = -J[:, 0, 1] / det, -J[:, 1, 0] / det
        inverse[bad] = np.nan
    by_k = -inverse @ mapped.by_coefficients
    count = by_k.shape[-1]
    return Mapped(a.reshape(b.shape), inverse.reshape(*b.shape, 2), by_k.reshape(*b.shape, count))


def _solve(J: Array, miss: Array) -> Array:
    """J^-1 miss for (n, 2, 2) and (n, 2)."""
    det = J[:, 0, 0] * J[:, 1, 1] - J[:, 0, 1] * J[:, 1, 0]
    return np.stack(
        [
            (J[:, 1, 1] * miss[:, 0] - J[:, 0, 1] * miss[:, 1]) / det,
            (J[:, 0, 0] * miss[:, 1] - J[:, 1, 0] * miss[:, 0]) / det,
        ],
        axis=1,
    )
