"""A camera of any lens model fitted to pixels and their rays.

A start is found in whatever model finds one easily; the model that is wanted then follows its
rays. The pixels u of the rays r fix its parameters in the least-squares sense,

    min over f, c, k of  sum |c + f project(r, k) - u|^2,

by Levenberg-Marquardt (1963) from the model's plainest lens. Rays and pixels alike leave some
coefficients of rich models almost open, such as numerator and denominator of the rational model;
a weak pull towards the plainest lens then keeps them where their neighbours are. The coefficients
that make a lens asymmetric stay as they are: a start has none.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.projection import Projected, project

_MAX_ITERATIONS = 60
"""Number of steps, accepted or not, at most."""
_MIN_DECREASE, _MIN_DECREASE_PX2 = 1e-4, 1e-4
"""Decrease of the mean squared miss in a step, relative to it and px^2, below which the fit has
converged."""
_PULL = 1e-3
"""Weight of a coefficient's square against the mean square of what it moves, per ray."""
_MIN_PART_SEEN = 0.5
"""Least share of the rays that a lens must image for a fit to be worth anything."""


def fit_lens(rays: Array, uv: Array, start: Array, lens: Lens, free: IntArray) -> Array:
    """Fit a camera's parameters to pixels and their rays.

    Args:
        rays: (n, 3) rays of any length.
        uv: (n, 2) their pixels, px.
        start: (P,) parameters to begin from; those that are not free keep their values.
        lens: the lens model.
        free: indices of the parameters that may change.

    Returns:
        (P,) parameters. They are the start's if none may change, or if its lens images less than
        half of the rays.
    """
    free = free[[i < 4 or lens.names[i - 4] not in lens.asymmetric for i in free.tolist()]]
    if not len(free):
        return start
    weight = np.full(len(free), _PULL**2 * len(uv))
    weight[free < 4] = 0.0
    params, damping = start.copy(), 1e-4

    def evaluate(params: Array) -> tuple[float, Projected]:
        """Return the mean squared miss, px^2, with rays that have no image at their worst."""
        seen = project(rays, params, lens)
        miss = np.sum((seen.points - uv) ** 2, axis=1)
        good = np.isfinite(miss)
        if good.mean() < _MIN_PART_SEEN:
            return np.inf, seen
        return float(np.where(good, miss, 4 * np.nanmax(miss, initial=1.0)).mean()), seen

    with np.errstate(all="ignore"):
        cost, seen = evaluate(params)
        for _ in range(_MAX_ITERATIONS if np.isfinite(cost) else 0):
            residual = seen.points - uv
            good = np.isfinite(residual).all(axis=1)
            J = seen.by_params[good][..., free].reshape(-1, len(free))
            scale = np.maximum(np.einsum("ij,ij->j", J, J) / len(J), 1e-30)
            A = J.T @ J + np.diag(weight * scale)
            g = J.T @ residual[good].ravel()
            g += weight * scale * (params[free] - start[free])
            step = np.linalg.solve(A + damping * np.diag(np.diag(A) + 1e-30), -g)
            trial = params.copy()
            trial[free] += step
            lower, there = evaluate(trial) if (trial[:2] > 0).all() else (np.inf, seen)
            if not lower < cost:
                damping *= 10
                if damping > 1e8:
                    break
                continue
            converged = cost - lower < _MIN_DECREASE * cost + _MIN_DECREASE_PX2
            params, cost, seen, damping = trial, lower, there, damping / 10
            if converged:
                break
    return params
