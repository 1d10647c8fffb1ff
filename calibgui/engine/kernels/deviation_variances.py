"""The variances of a board's deviations by expectation-maximisation, compiled.

The readable reference is ``calibration.board_shape.deviation_variances.find_stiffness``.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels.common import (
    compiled,
    compiled_allocating_part,
    factor,
    find_least_eigenvector,
    substitute,
)


class Information(Protocol):
    """The fields of ``calibration.board_shape.deviation_variances.Information``."""

    @property
    def kind(self) -> IntArray: ...
    @property
    def others(self) -> Array: ...
    @property
    def beside(self) -> Array: ...
    @property
    def rough(self) -> tuple[Array, Array]: ...


class VariancePrior(Protocol):
    """The fields of ``calibration.board_shape.deviation_variances.VariancePrior``."""

    @property
    def expected(self) -> Array: ...
    @property
    def freedom(self) -> float: ...


class Noise(Protocol):
    """The fields of ``calibration.board_shape.deviation_variances.Noise``."""

    @property
    def cost(self) -> float: ...
    @property
    def freedom(self) -> float: ...
    @property
    def otherwise(self) -> float: ...


@compiled_allocating_part
def _follow_others(diagonal: Array, below: Array, stiffness: float, X: Array) -> float:
    """Turn X (m, c) into M^-1 X, M the stiffened tridiagonal matrix; return the trace of M^-1."""
    m, c = X.shape
    down, up, trace = np.empty(m), np.empty(m), 0.0
    for i in range(m):
        down[i] = diagonal[i] + stiffness
        if i:
            ratio = below[i - 1] / down[i - 1]
            down[i] -= ratio * below[i - 1]
            for j in range(c):
                X[i, j] -= ratio * X[i - 1, j]
    for i in range(m - 1, -1, -1):
        up[i] = diagonal[i] + stiffness
        off = below[i] if i < m - 1 else 0.0
        if i < m - 1:
            up[i] -= off * off / up[i + 1]
        # Eliminated from both ends, a coefficient is left with what it has in the inverse.
        trace += 1 / (down[i] + up[i] - diagonal[i] - stiffness)
        for j in range(c):
            X[i, j] = (X[i, j] - (off * X[i + 1, j] if i < m - 1 else 0.0)) / down[i]
    return trace


@compiled_allocating_part
def _solve_stiffened(
    kind: IntArray,
    N: Array,
    gradient: Array,
    beside: Array,
    X: Array,
    diagonal: Array,
    below: Array,
    stiffness: Array,
    squares: Array,
    inverses: Array,
) -> float:
    """Add to squares and inverses (3,); return the decrease of the cost.

    N is a copy of ``Information.others``, whose last row is the gradient, and X one of `beside`.
    """
    m, n = len(beside), len(kind)
    column, q = np.empty(n), np.empty(n)
    inverses[2] += _follow_others(diagonal, below, stiffness[2], X)
    for r in range(m):
        for i in range(n + 1):
            for j in range(n + 1):
                N[i, j] -= beside[r, i] * X[r, j]
    for i in range(n):
        N[i, i] += stiffness[kind[i]]
        q[i] = -N[i, n]
    factor(N)  # of which the last row and column, those of the gradient, are not used
    substitute(N, q)
    gained = 0.0
    for i in range(n):
        squares[kind[i]] += q[i] * q[i]
        gained -= gradient[i] * q[i]
    for r in range(m):
        rough = -X[r, n]
        for i in range(n):
            rough -= X[r, i] * q[i]
        squares[2] += rough * rough
        gained -= beside[r, n] * rough
    for i in range(n):
        for j in range(n):
            column[j] = 1.0 if j == i else 0.0
        substitute(N, column)
        inverses[kind[i]] += column[i]
        for r in range(m):
            along = 0.0
            for j in range(n):
                along += X[r, j] * column[j]
            inverses[2] += along * X[r, i]
    return gained


@compiled_allocating_part
def _mix_last_steps(points: Array, changes: Array, last: int, min_ratio: float, out: Array) -> None:
    """Fill out (3,) with what Anderson's mixing takes off the point after step `last`.

    Changes (n, 3) and the points before them (n, 3) are those of the last steps. With C the
    differences of changes, the weights are the shortest least squares solution of C^T w = change,
    w = C (C^T C)^+ change.
    """
    C, move = np.empty((3, 3)), np.empty((3, 3))
    gram, V, y = np.zeros((3, 3)), np.empty((3, 3)), np.zeros(3)
    for r in range(last):
        for i in range(3):
            C[r, i] = changes[r + 1, i] - changes[r, i]
            move[r, i] = points[r + 1, i] - points[r, i] + C[r, i]
    for r in range(last):
        for i in range(3):
            for j in range(3):
                gram[i, j] += C[r, i] * C[r, j]
    find_least_eigenvector(gram, V)
    largest = max(gram[0, 0], gram[1, 1], gram[2, 2])
    for k in range(3):
        if gram[k, k] > min_ratio * min_ratio * largest:
            along = 0.0
            for i in range(3):
                along += V[i, k] * changes[last, i]
            for i in range(3):
                y[i] += V[i, k] * along / gram[k, k]
    for i in range(3):
        out[i] = 0.0
    for r in range(last):
        weight = C[r, 0] * y[0] + C[r, 1] * y[1] + C[r, 2] * y[2]
        for i in range(3):
            out[i] += weight * move[r, i]


@compiled
def _find_stiffness(
    kind: IntArray,
    others: Array,
    beside: Array,
    diagonal: Array,
    below: Array,
    expected: Array,
    nu: float,
    noise: tuple[float, float, float],
    least: float,
    limits: tuple[int, float, float, float],
    x: Array,
) -> float:
    """Turn x (3,) from the logarithms to start from into those found; return sigma^2 there."""
    cost, freedom, otherwise = noise
    max_steps, max_change, max_mixing, min_ratio = limits
    m, n = len(beside), len(kind)
    N, X = np.empty((n + 1, n + 1)), np.empty((m, n + 1))
    points, changes, counts = np.empty((4, 3)), np.empty((4, 3)), np.zeros(3)
    stiffness, squares, inverses, taken = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for i in range(n):
        counts[kind[i]] += 1
    counts[2] += m
    last, sigma2 = -1, otherwise
    for _ in range(max_steps):
        for i in range(n + 1):
            for j in range(n + 1):
                N[i, j] = others[i, j]
            for r in range(m):
                X[r, i] = beside[r, i]
        known = float(n + m)
        for i in range(3):
            stiffness[i], squares[i], inverses[i] = np.exp(x[i]), 0.0, 0.0
        gained = _solve_stiffened(
            kind, N, others[n], beside, X, diagonal, below, stiffness, squares, inverses
        )
        for i in range(3):
            known -= stiffness[i] * inverses[i]
        left = freedom - known
        sigma2 = (cost - gained) / left if left > 0 else 0.0
        if not sigma2 > 0:
            sigma2 = otherwise
        if last == 3:  # the oldest step gives way
            for r in range(3):
                for i in range(3):
                    points[r, i], changes[r, i] = points[r + 1, i], changes[r + 1, i]
        else:
            last += 1
        largest = 0.0
        for i in range(3):
            found = squares[i] + sigma2 * inverses[i]
            variance = expected[i] + (found - counts[i] * expected[i]) / (nu + counts[i])
            points[last, i] = x[i]
            changes[last, i] = np.log(max(sigma2 / variance, least)) - x[i]
            largest = max(largest, abs(changes[last, i]))
        if largest < max_change:
            break
        for i in range(3):
            taken[i] = 0.0
        if last > 0:
            _mix_last_steps(points, changes, last, min_ratio, taken)
        for i in range(3):
            x[i] += changes[last, i] - min(max(taken[i], -max_mixing), max_mixing)
    for i in range(3):
        x[i] = points[last, i]
    return sigma2


def find_stiffness(
    information: Information,
    prior: VariancePrior,
    noise: Noise,
    least: float,
    limits: tuple[int, float, float, float],
) -> tuple[Array, float]:
    """Compute ``calibration.board_shape.deviation_variances.find_stiffness``."""
    sigma2 = noise.cost / noise.freedom if noise.freedom > 0 else 0.0
    if not sigma2 > 0:
        sigma2 = noise.otherwise
    x = np.log(np.fmax(sigma2 / prior.expected, least))
    sigma2 = _find_stiffness(
        information.kind, information.others, information.beside, *information.rough,
        prior.expected, float(prior.freedom),
        (float(noise.cost), float(noise.freedom), float(noise.otherwise)),
        least, limits, x,
    )  # fmt: skip
    return x, sigma2
