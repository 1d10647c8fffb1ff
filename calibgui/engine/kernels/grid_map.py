"""The radial lens of a grid map, compiled: the loops of ``detection.grid_map``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.kernels.common import (
    compiled,
    compiled_part,
    factor,
    gram,
    make_contiguous,
    substitute,
)


@compiled_part
def _fill_rows(x: Array, u: Array, A: Array, centre: Array, bend: Array, J: Array) -> None:
    """Fill J (15, 2n): how the places of cells vary with the 14 parameters, and what they miss."""
    n = len(x)
    for i in range(n):
        d0, d1 = u[i, 0] - centre[0], u[i, 1] - centre[1]
        r = d0 * d0 + d1 * d1
        v2 = 1 + r * (bend[0] + r * (bend[1] + r * bend[2]))
        slope = 2 * (bend[0] + r * (2 * bend[1] + r * 3 * bend[2]))
        w = A[2, 0] * d0 + A[2, 1] * d1 + A[2, 2] * v2
        c0 = (A[0, 0] * d0 + A[0, 1] * d1 + A[0, 2] * v2) / w
        c1 = (A[1, 0] * d0 + A[1, 1] * d1 + A[1, 2] * v2) / w
        h0, h1 = (A[0, 2] - c0 * A[2, 2]) / w, (A[1, 2] - c1 * A[2, 2]) / w
        a = (A[0, 0] - c0 * A[2, 0]) / w + slope * h0 * d0
        b = (A[0, 1] - c0 * A[2, 1]) / w + slope * h0 * d1
        c = (A[1, 0] - c1 * A[2, 0]) / w + slope * h1 * d0
        d = (A[1, 1] - c1 * A[2, 1]) / w + slope * h1 * d1
        det = a * d - b * c
        for row, p, q in ((i, d / det, -b / det), (n + i, -c / det, a / det)):
            # (p, q) takes a difference of cells to one of places, along u and along v.
            s = -(p * c0 + q * c1)
            J[0, row], J[1, row], J[2, row] = p * d0 / w, p * d1 / w, p * v2 / w
            J[3, row], J[4, row], J[5, row] = q * d0 / w, q * d1 / w, q * v2 / w
            J[6, row], J[7, row], J[8, row] = s * d0 / w, s * d1 / w, s * v2 / w
            J[9, row], J[10, row] = (-1.0, 0.0) if row < n else (0.0, -1.0)
            h = p * h0 + q * h1
            J[11, row], J[12, row], J[13, row] = h * r, h * r * r, h * r * r * r
            J[14, row] = p * (c0 - x[i, 0]) + q * (c1 - x[i, 1])


@compiled
def _refine_lens(
    x: Array, u: Array, A: Array, centre: Array, bend: Array, steps: int, damping: float
) -> None:
    """Move A, centre and bend by Gauss-Newton steps."""
    J, N, g = np.empty((15, 2 * len(x))), np.empty((15, 15)), np.empty(14)
    for _ in range(steps):
        _fill_rows(x, u, A, centre, bend, J)
        gram(J, N)
        trace = 0.0
        for k in range(14):
            trace += N[k, k]
            g[k] = N[14, k]
        for k in range(14):
            N[k, k] += damping * trace
        factor(N[:14, :14])
        substitute(N[:14, :14], g)
        for k in range(9):
            A[k // 3, k % 3] -= g[k]
        for k in range(2):
            centre[k] -= g[9 + k]
        for k in range(3):
            bend[k] -= g[11 + k]


@compiled
def _invert_lens(e: Array, w: Array, bend: Array, steps: int, out: Array) -> None:
    """Fill out (n, 2)."""
    l1, l2, l3 = bend[0], bend[1], bend[2]
    for i in range(len(e)):
        far = np.sqrt(e[i, 0] * e[i, 0] + e[i, 1] * e[i, 1])
        is_beyond = w[i] < 0 and l1 < 0
        if is_beyond:
            far = -far
        root = 1 + np.sqrt(max(1 - 4 * l1 * far * far, 0.0))
        x = root / (2 * l1 * far) if is_beyond else 2 * far / root
        for _ in range(steps):
            r = x * x
            inverse = 1 + r * (l1 + r * (l2 + r * l3))
            slope = 2 * x * (l1 + r * (2 * l2 + r * 3 * l3))
            x -= (x - far * inverse) / (1 - far * slope)
        scale = x / (1.0 if far == 0 else far)
        out[i, 0], out[i, 1] = scale * e[i, 0], scale * e[i, 1]


def refine_lens(
    x: Array, u: Array, A: Array, centre: Array, bend: Array, steps: int, damping: float
) -> tuple[Array, Array, Array]:
    """Compute ``detection.grid_map._refine_parameters``."""
    A, centre, bend = A.copy(), centre.copy(), bend.copy()
    _refine_lens(make_contiguous(x), make_contiguous(u), A, centre, bend, steps, damping)
    return A, centre, bend


def invert_lens(e: Array, w: Array, bend: Array, steps: int) -> Array:
    """Compute ``detection.grid_map._invert_lens``."""
    out = np.empty((len(e), 2))
    _invert_lens(make_contiguous(e), make_contiguous(w), make_contiguous(bend), steps, out)
    return out
