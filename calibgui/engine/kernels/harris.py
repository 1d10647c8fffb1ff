"""Harris' score around corners, compiled: see ``features.harris``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage, IntArray
from calibgui.engine.kernels.common import compiled, compiled_part, make_read_only


@compiled_part
def _cut_tile(image: GreyImage, left: int, top: int, grey: Array) -> None:
    """Fill grey with the pixels from (left, top) on, the border replicated."""
    height, width = image.shape
    side = grey.shape[0]
    if 0 <= left <= width - side and 0 <= top <= height - side:
        for j in range(side):
            row = image[top + j, left:]
            for i in range(side):
                grey[j, i] = row[i]
        return
    for j in range(side):
        row = image[min(max(top + j, 0), height - 1)]
        for i in range(side):
            grey[j, i] = row[min(max(left + i, 0), width - 1)]


@compiled_part
def _add_row(grey: Array, j: int, weights: Array, sums: Array, products: Array) -> None:
    """Add the products of the slopes in row j of a tile, under each weight, to the sums."""
    side = grey.shape[0]
    before, after = max(j - 1, 0), min(j + 1, side - 1)
    here, above, below = grey[j], grey[before], grey[after]
    uu, vv, uv = products[:side], products[side : 2 * side], products[2 * side :]
    step = 1 / (after - before)
    uu[0], uu[side - 1] = here[1] - here[0], here[side - 1] - here[side - 2]
    for i in range(1, side - 1):
        uu[i] = (here[i + 1] - here[i - 1]) / 2
    for i in range(side):
        gu, gv = uu[i], (below[i] - above[i]) * step
        uu[i], vv[i], uv[i] = gu * gu, gv * gv, gu * gv
    for k in range(weights.shape[0]):
        w, total = weights[k, j], sums[k]
        for i in range(3 * side):
            total[i] += w * products[i]


@compiled
def _fill_scores(
    image: GreyImage, origin: IntArray, weights: Array, sensitivity: float, out: Array
) -> None:
    """Fill out (n, k, k) with scores."""
    tried, side = weights.shape[1:]
    grey, products = np.empty((side, side)), np.empty(3 * side)
    sums = np.empty((tried, 3 * side))
    for n in range(origin.shape[0]):
        _cut_tile(image, origin[n, 0], origin[n, 1], grey)
        sums[:] = 0
        for j in range(side):
            _add_row(grey, j, weights[n], sums, products)
        for kv in range(tried):
            for ku in range(tried):
                uu = vv = uv = 0.0
                for i in range(side):
                    w = weights[n, ku, i]
                    uu += w * sums[kv, i]
                    vv += w * sums[kv, side + i]
                    uv += w * sums[kv, 2 * side + i]
                out[n, kv, ku] = uu * vv - uv * uv - sensitivity * (uu + vv) ** 2


def score_positions(image: GreyImage, uv: Array, weights: Array, sensitivity: float) -> Array:
    """Compute ``_score_positions`` of the reference."""
    out = np.empty((len(uv), weights.shape[1], weights.shape[1]))
    origin = np.rint(uv).astype(np.int64) - weights.shape[2] // 2
    _fill_scores(make_read_only(image), origin, weights, sensitivity, out)
    return out
