"""The step of a fit of crossing edges, compiled: see ``corner_fit.x_corner_step``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, IntArray, compute_median
from calibgui.engine.kernels.common import (
    compiled,
    compiled_allocating_part,
    compiled_part,
    factor,
    make_contiguous,
    substitute,
)

_NEGLIGIBLE = 1e-24
"""Square of a column's part perpendicular to the other, over the other's, that rounding makes."""


@compiled_allocating_part
def _fill_blur_difference(x: Array, out: Array) -> None:
    """Fill out (n,) with ``estimate_blur_difference`` at the unknowns x (n, 9).

    What the board shows is the projection of the squares' differences on the two columns of
    by_corner, the smaller of which is made perpendicular to the larger one; it counts for nothing
    where the edges tell the two apart no better than rounding does."""
    n = x.shape[0]
    columns, squares = np.empty((2, n)), np.empty(n)
    for i in range(n):
        # n_i^T D n_i = -D_uu cos 2 theta_i - D_uv sin 2 theta_i
        columns[0, i] = np.cos(2 * x[i, 3]) - np.cos(2 * x[i, 2])
        columns[1, i] = np.sin(2 * x[i, 3]) - np.sin(2 * x[i, 2])
        squares[i] = x[i, 4] * x[i, 4] - x[i, 5] * x[i, 5]
    products = np.zeros(2)
    for k in range(2):
        for i in range(n):
            products[k] += columns[k, i] * columns[k, i]
    first = 0 if products[0] >= products[1] else 1
    large, small = columns[first], columns[1 - first]
    shared = along = 0.0
    for i in range(n):
        shared += large[i] * small[i]
        along += large[i] * squares[i]
    size = max(products[first], 1e-300)
    rest = across = 0.0
    for i in range(n):
        small[i] -= shared / size * large[i]
        rest += small[i] * small[i]
        across += small[i] * squares[i]
    is_told_apart = rest > _NEGLIGIBLE * size
    for i in range(n):
        shown = along / size * large[i]
        if is_told_apart:
            shown += across / rest * small[i]
        out[i] = shown / (x[i, 4] + x[i, 5])


@compiled_part
def _limit(step: float, least: float, most: float) -> float:
    """Limit a step; NaN stays."""
    return least if step < least else most if step > most else step


@compiled
def _step(
    x: Array,
    products: Array,
    order: IntArray,
    typical: float,
    damping: float,
    least_entry: float,
    rho_sigma: float,
    blur_difference_sigma: float,
    max_rho: float,
    min_blur: float,
    stepped: Array,
    inverse: Array,
    square: Array,
) -> None:
    """Fill stepped (n, m), inverse (n, 2, 2) and square (n,); typical is the median of the mean
    squares of the residuals."""
    m = x.shape[1]
    L, g, step = np.empty((m, m)), np.empty(m), np.empty(m)
    expected = np.empty(x.shape[0])
    _fill_blur_difference(x, expected)
    for i in range(x.shape[0]):
        # c stands last, and unknown k in place k - 2.
        for j in range(m):
            row = order[(j + 2) % m]
            g[j] = products[i, row, order[m]]
            for k in range(m):
                L[j, k] = products[i, row, order[(k + 2) % m]]
        total, count = products[i, order[m], order[m]], max(products[i, 6, 6], 1.0)
        s1, s2, rho = x[i, 4], x[i, 5], x[i, 8]
        weight = total / count / rho_sigma**2
        L[6, 6] += weight
        g[6] -= weight * (np.cos(x[i, 2] - x[i, 3]) + rho)
        weight = typical / (blur_difference_sigma**2 * (s1 * s1 + s2 * s2) / 2)
        lack = expected[i] - (s1 - s2)
        L[2, 2], L[3, 3] = L[2, 2] + weight, L[3, 3] + weight
        L[2, 3], L[3, 2] = L[2, 3] - weight, L[3, 2] - weight
        g[2], g[3] = g[2] + weight * lack, g[3] - weight * lack
        largest = 1e-300
        for k in range(m):
            largest = max(largest, L[k, k])
        for k in range(m):
            L[k, k] += damping * max(L[k, k], least_entry * largest)
            step[k] = g[k]
        factor(L)
        substitute(L, step)
        # The last part of the inverse follows from the last factors alone.
        a, b, shared = L[m - 2, m - 2], L[m - 1, m - 1], L[m - 1, m - 2]
        inverse[i, 0, 0], inverse[i, 1, 1] = 1 / a + shared * shared / b, 1 / b
        inverse[i, 0, 1] = inverse[i, 1, 0] = -shared / b
        for k in range(m):
            total -= step[k] * g[k]
        square[i] = (0.0 if total < 0 else total) / max(count - m, 1.0)
        for k in range(2):
            step[m - 2 + k] = _limit(step[m - 2 + k], -1.0, 1.0)
            step[k] = _limit(step[k], -0.1, 0.1)
            s = x[i, 4 + k]
            step[2 + k] = _limit(step[2 + k], max(-s / 3, min_blur - s), s / 2)
        step[6] = _limit(step[6], -max_rho - rho, max_rho - rho)
        for k in range(m):
            stepped[i, (k + 2) % m] = x[i, (k + 2) % m] + step[k]


def step_unknowns(
    unknowns: Array,
    products: Array,
    order: IntArray,
    damping: float,
    least_entry: float,
    rho_sigma: float,
    blur_difference_sigma: float,
    max_rho: float,
    min_blur: float,
) -> tuple[Array, Array, Array]:
    """Compute ``_step_unknowns`` of the reference."""
    n, m = unknowns.shape
    count = np.maximum(products[:, 6, 6], 1.0)
    typical = float(compute_median(products[:, order[m], order[m]] / count))
    limits = damping, least_entry, rho_sigma, blur_difference_sigma, max_rho, min_blur
    stepped, inverse, square = np.empty((n, m)), np.empty((n, 2, 2)), np.empty(n)
    _step(
        make_contiguous(unknowns),
        make_contiguous(products),
        order,
        typical,
        *limits,
        stepped,
        inverse,
        square,
    )
    return stepped, inverse, square
