"""Stage I's normal equations, compiled: ``stage_one.registration`` and its products.

With A = 1/P, the registered point xi and the derivatives of ``stage_one.py``.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.kernels.common import compiled, gram, in_blocks
from calibgui.engine.types import Array, IntArray


@compiled
def _registration(z, x, goal, weight, J):  # type: ignore[no-untyped-def]
    """Rows of J (12, 2N): weighted derivatives of xi1 (first N) and xi2 by z_r, and residuals."""
    xp, yp, k1, a11, a21, a12, a22, d1, d2, c1, c2 = z
    N = weight.shape[0]
    for i in range(N):
        dx, dy = x[0, i] - xp, x[1, i] - yp
        r2 = dx * dx + dy * dy
        psi1, psi2 = x[0, i] + k1 * r2 * dx, x[1, i] + k1 * r2 * dy
        A = 1 / (c1 * (psi1 - xp) + c2 * (psi2 - yp) + 1)
        w = weight[i] * A
        px, py, cross = -k1 * (r2 + 2 * dx * dx), -k1 * (r2 + 2 * dy * dy), -2 * k1 * dx * dy
        for row in range(2):
            a1, a2, d = (a11, a12, d1) if row == 0 else (a21, a22, d2)
            xi = (a1 * psi1 + a2 * psi2 + d) * A
            b1, b2 = a1 - xi * c1, a2 - xi * c2
            j = i + row * N
            J[0, j] = w * (b1 * px + b2 * cross + xi * c1)
            J[1, j] = w * (b1 * cross + b2 * py + xi * c2)
            J[2, j] = w * r2 * (b1 * dx + b2 * dy)
            J[9, j] = -w * xi * (psi1 - xp)
            J[10, j] = -w * xi * (psi2 - yp)
            J[11, j] = weight[i] * (xi - goal[row, i])
        J[3, i] = J[4, N + i] = w * psi1
        J[5, i] = J[6, N + i] = w * psi2
        J[7, i] = J[8, N + i] = w


@compiled
def _views(z, which, x, goal, weight, out):  # type: ignore[no-untyped-def]
    """Fill out (k, 12, 12) for the views `which` (k,)."""
    J = np.zeros((12, 2 * weight.shape[1]))
    for k in range(which.shape[0]):
        view = which[k]
        _registration(z[k], x[view], goal[view], weight[view], J)
        gram(J, out[k])


def products(z: Array, which: IntArray, x: Array, goal: Array, weight: Array) -> Array:
    """(k, 12, 12) products of the columns [J r] of some views.

    Args:
        z: (k, 11) their unknowns z_r.
        which: (k,) their numbers.
        x: (K, 2, N) measured corners of all views.
        goal: (K, 2, N) corners on the reference plane.
        weight: (K, N) what residuals are multiplied with.
    """
    out = np.empty((len(z), 12, 12))

    def run(part: slice) -> None:
        _views(z[part], which[part], x, goal, weight, out[part])

    in_blocks(len(z), run)
    return out
