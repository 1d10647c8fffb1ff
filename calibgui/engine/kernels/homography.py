"""The direct linear transformation, compiled: ``geometry.homography.fit_homographies``.

The symbols are that module's. Sums of s s^T by a weight are symmetric (3, 3) matrices.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.kernels.common import (
    compiled,
    compiled_part,
    factor,
    find_least_eigenvector,
    make_contiguous,
    run_in_blocks,
    substitute,
)


@compiled_part
def _normalise(points: Array, weight: Array, out: Array) -> tuple[float, float, float]:
    """Fill out (2, N) with points (N, 2) moved to zero mean and RMS length sqrt(2); return the mean
    and the factor."""
    N = weight.shape[0]
    total = x = y = 0.0
    for i in range(N):
        total += weight[i]
        x += weight[i] * points[i, 0]
        y += weight[i] * points[i, 1]
    x, y, square = x / total, y / total, 0.0
    for i in range(N):
        dx, dy = points[i, 0] - x, points[i, 1] - y
        square += weight[i] * weight[i] * (dx * dx + dy * dy)
    scale = np.sqrt(2 * total / max(square, 1e-300))
    for i in range(N):
        out[0, i] = scale * (points[i, 0] - x)
        out[1, i] = scale * (points[i, 1] - y)
    return x, y, scale


@compiled_part
def _sum_moments(s: Array, d: Array, weight: Array, by: Array, sums: Array) -> None:
    """Fill sums (4, 3, 3) with the sums of s s^T by 1, u, v and u^2 + v^2; by (4, N) is work
    space."""
    N = weight.shape[0]
    for i in range(N):
        by[0, i] = weight[i] * weight[i]
        by[1, i], by[2, i] = by[0, i] * d[0, i], by[0, i] * d[1, i]
        by[3, i] = by[1, i] * d[0, i] + by[2, i] * d[1, i]
    for row in range(4):
        xx = xy = x1 = yy = y1 = one = 0.0
        for i in range(N):
            w, x, y = by[row, i], s[0, i], s[1, i]
            wx, wy = w * x, w * y
            xx += wx * x
            xy += wx * y
            yy += wy * y
            x1 += wx
            y1 += wy
            one += w
        S = sums[row]
        S[0, 0], S[1, 1], S[2, 2] = xx, yy, one
        S[0, 1] = S[1, 0] = xy
        S[0, 2] = S[2, 0] = x1
        S[1, 2] = S[2, 1] = y1


@compiled
def _fit_views(source: Array, destination: Array, weight: Array, out: Array) -> None:
    """Fill out (K, 3, 3) with the homographies."""
    K, N = weight.shape
    s, d, by = np.empty((2, N)), np.empty((2, N)), np.empty((4, N))
    sums, parts = np.empty((4, 3, 3)), np.empty((2, 3, 3))
    V, H = np.empty((3, 3)), np.empty((3, 3))
    for view in range(K):
        x, y, to_source = _normalise(source[view], weight[view], s)
        u, v, to_destination = _normalise(destination[view], weight[view], d)
        _sum_moments(s, d, weight[view], by, sums)
        S, A = sums[0], sums[3]
        ridge = 1e-15 * S[2, 2]
        for i in range(3):
            S[i, i] += ridge
        factor(S)
        for part in range(2):
            Su = sums[1 + part]
            for j in range(3):
                for i in range(3):
                    parts[part, j, i] = Su[i, j]
                substitute(S, parts[part, j])
            for i in range(3):
                for j in range(3):
                    for k in range(3):
                        A[i, j] -= Su[i, k] * parts[part, j, k]
        least = find_least_eigenvector(A, V)
        for i in range(3):
            H[2, i] = V[i, least]
            H[0, i] = H[1, i] = 0.0
        for part in range(2):
            for i in range(3):
                for j in range(3):
                    H[part, i] += parts[part, j, i] * H[2, j]
        for i in range(3):
            h0, h1 = H[i, 0] * to_source, H[i, 1] * to_source
            H[i, 0], H[i, 1], H[i, 2] = h0, h1, H[i, 2] - h0 * x - h1 * y
        last = H[2, 2]
        for j in range(3):
            third = H[2, j] / last
            out[view, 0, j] = H[0, j] / (to_destination * last) + u * third
            out[view, 1, j] = H[1, j] / (to_destination * last) + v * third
            out[view, 2, j] = third


def fit_homographies(source: Array, destination: Array, mask: Array) -> Array:
    """Compute ``geometry.homography.fit_homographies``."""
    source, destination = make_contiguous(source), make_contiguous(destination)
    mask, out = make_contiguous(mask), np.empty((len(mask), 3, 3))

    def run(part: slice) -> None:
        _fit_views(source[part], destination[part], mask[part], out[part])

    run_in_blocks(len(mask), run)
    return out
