"""Stage I, compiled: ``calibration.initialisation.stage_one.minimise_registration``.

The derivation and the symbols are that module's; A = 1/P.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.kernels.common import (
    compiled,
    compiled_part,
    gram,
    make_contiguous,
    run_in_blocks,
)

_COLUMNS = np.array([[0, 1, 2, 3, 5, 7, 9, 10, 11], [0, 1, 2, 4, 6, 8, 9, 10, 11]])
"""Places in z_r of the unknowns on which xi1 depends, and xi2, and last the residual's place."""


@compiled_part
def _linearise(z: Array, row: int, x: Array, goal: Array, weight: Array, J: Array) -> None:
    """Fill J (9, N) with weighted derivatives of xi1 (row 0) or xi2 by the unknowns on which it
    depends, and residuals."""
    xp, yp, k1, a11, a21, a12, a22, d1, d2, c1, c2 = z
    a1, a2, d = (a11, a12, d1) if row == 0 else (a21, a22, d2)
    # Rows by name, so that the compiler sees what it can vectorise.
    x1, x2, goals = x[0], x[1], goal[row]
    J0, J1, J2, J3, J4, J5, J6, J7, J8 = J[0], J[1], J[2], J[3], J[4], J[5], J[6], J[7], J[8]
    for i in range(weight.shape[0]):
        dx, dy = x1[i] - xp, x2[i] - yp
        r2 = dx * dx + dy * dy
        psi1, psi2 = x1[i] + k1 * r2 * dx, x2[i] + k1 * r2 * dy
        A = 1 / (c1 * (psi1 - xp) + c2 * (psi2 - yp) + 1)
        w = weight[i] * A
        px, py, cross = -k1 * (r2 + 2 * dx * dx), -k1 * (r2 + 2 * dy * dy), -2 * k1 * dx * dy
        xi = (a1 * psi1 + a2 * psi2 + d) * A
        b1, b2 = a1 - xi * c1, a2 - xi * c2
        J0[i] = w * (b1 * px + b2 * cross + xi * c1)
        J1[i] = w * (b1 * cross + b2 * py + xi * c2)
        J2[i] = w * r2 * (b1 * dx + b2 * dy)
        J3[i] = w * psi1
        J4[i] = w * psi2
        J5[i] = w
        J6[i] = -w * xi * (psi1 - xp)
        J7[i] = -w * xi * (psi2 - yp)
        J8[i] = weight[i] * (xi - goals[i])


@compiled_part
def _sum_products(
    z: Array, x: Array, goal: Array, weight: Array, J: Array, part: Array, out: Array
) -> None:
    """Fill out (12, 12) with the products of the columns [J r] of a view; J (9, N) and part (9, 9)
    are work space."""
    out[:] = 0.0
    for row in range(2):
        places = _COLUMNS[row]
        _linearise(z, row, x, goal, weight, J)
        gram(J, part)
        for i in range(9):
            for j in range(9):
                out[places[i], places[j]] += part[i, j]


@compiled_part
def _solve_step(products: Array, damping: float, L: Array, step: Array) -> float:
    """Fill step (11,) by Cholesky's factorisation L; return the decrease that it predicts."""
    n = step.shape[0]
    for i in range(n):
        for j in range(i + 1):
            s = products[i, j]
            if i == j:
                s += damping * s + 1e-14
            for k in range(j):
                s -= L[i, k] * L[j, k]
            L[i, j] = np.sqrt(s) if i == j else s / L[j, j]
    for i in range(n):
        s = -products[i, n]
        for k in range(i):
            s -= L[i, k] * step[k]
        step[i] = s / L[i, i]
    for i in range(n - 1, -1, -1):
        s = step[i]
        for k in range(i + 1, n):
            s -= L[k, i] * step[k]
        step[i] = s / L[i, i]
    decrease = 0.0
    for i in range(n):
        decrease -= step[i] * products[i, n]
    return decrease


@compiled
def _minimise_views(
    x: Array,
    goal: Array,
    weight: Array,
    max_iterations: int,
    tolerance: float,
    max_damping: float,
    z: Array,
    products: Array,
    iterations: IntArray,
    converged: BoolArray,
) -> None:
    """Minimise the cost of one view after another, from z (K, 11)."""
    K, N = weight.shape
    J, part, new, L = np.empty((9, N)), np.empty((9, 9)), np.empty((12, 12)), np.empty((11, 11))
    step, trial = np.empty(11), np.empty(11)
    for view in range(K):
        damping, cost = 1e-3, np.inf
        for i in range(11):
            trial[i] = z[view, i]
        for count in range(max_iterations + 1):
            _sum_products(trial, x[view], goal[view], weight[view], J, part, new)
            iterations[view] = count
            if new[11, 11] < cost:
                cost = new[11, 11]
                for i in range(12):
                    for j in range(12):
                        products[view, i, j] = new[i, j]
                for i in range(11):
                    z[view, i] = trial[i]
                damping = max(damping / 10, 1e-12) if count else damping
            else:
                damping *= 10
            if not damping <= max_damping:
                break
            decrease = _solve_step(products[view], damping, L, step)
            if decrease <= tolerance * cost + 1e-28:
                converged[view] = True
                break
            for i in range(11):
                trial[i] = z[view, i] + step[i]


def minimise_registration(
    z: Array,
    x: Array,
    goal: Array,
    mask: Array,
    max_iterations: int,
    tolerance: float,
    max_damping: float,
) -> tuple[Array, Array, IntArray, BoolArray]:
    """Compute ``calibration.initialisation.stage_one.minimise_registration``."""
    K = len(z)
    x, goal = make_contiguous(np.swapaxes(x, 1, 2)), make_contiguous(np.swapaxes(goal, 1, 2))
    weight = make_contiguous(mask)
    z, products = z.copy(), np.full((K, 12, 12), np.nan)
    iterations, converged = np.zeros(K, dtype=np.int64), np.zeros(K, dtype=np.bool_)

    def run(part: slice) -> None:
        _minimise_views(
            x[part], goal[part], weight[part], max_iterations, tolerance, max_damping,
            z[part], products[part], iterations[part], converged[part],
        )  # fmt: skip

    run_in_blocks(K, run)
    return z, products, iterations, converged
