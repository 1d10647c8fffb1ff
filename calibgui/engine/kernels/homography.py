"""The sums of the direct linear transformation, compiled: ``geometry.homography.sum_moments``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.kernels.common import compiled, compiled_part, make_contiguous, run_in_blocks


@compiled_part
def _normalise(points: Array, weight: Array, out: Array, T: Array) -> None:
    """Fill out (2, N) with points (N, 2) moved to zero mean and RMS length sqrt(2), and T (3, 3)
    with the similarity that moves them."""
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
    T[0, 0] = T[1, 1] = scale
    T[0, 2], T[1, 2], T[2, 2] = -scale * x, -scale * y, 1.0


@compiled
def _sum_views(
    source: Array,
    destination: Array,
    weight: Array,
    out: Array,
    to_source: Array,
    to_destination: Array,
) -> None:
    """Fill out (K, 4, 6) with the sums, and the similarities (K, 3, 3)."""
    K, N = weight.shape
    s, d, by = np.empty((2, N)), np.empty((2, N)), np.empty((4, N))
    for view in range(K):
        _normalise(source[view], weight[view], s, to_source[view])
        _normalise(destination[view], weight[view], d, to_destination[view])
        for i in range(N):
            by[0, i] = weight[view, i] * weight[view, i]
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
            sums = (xx, xy, x1, yy, y1, one)
            for j in range(6):
                out[view, row, j] = sums[j]


def sum_moments(source: Array, destination: Array, mask: Array) -> tuple[Array, Array, Array]:
    """Compute ``geometry.homography.sum_moments``."""
    K = len(mask)
    source, destination = make_contiguous(source), make_contiguous(destination)
    mask = make_contiguous(mask)
    out, to_source, to_destination = np.empty((K, 4, 6)), np.zeros((K, 3, 3)), np.zeros((K, 3, 3))

    def run(part: slice) -> None:
        _sum_views(
            source[part], destination[part], mask[part],
            out[part], to_source[part], to_destination[part],
        )  # fmt: skip

    run_in_blocks(K, run)
    return out, to_source, to_destination
