"""Sums over the squares between edges, compiled: see ``corner_fit.light_gradients``.

Bright and dark quarters are summed apart, without p': the sums with it are their differences.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage, IntArray
from calibgui.engine.kernels.common import compiled, compiled_part, make_contiguous, make_read_only

_COLUMNS = 7
"""Number of columns: 1, p', q, p' q and the residual."""
_HALF_DIAGONAL = 0.5**0.5


@compiled_part
def _average_cell(image: GreyImage, u: int, v: int, k: int) -> float:
    """Average the k x k pixels from (u, v) on."""
    total = 0 * image[v, u]  # bytes are added up faster as integers
    for y in range(v, v + k):
        for x in range(u, u + k):
            total += image[y, x]
    mean: float = total / (k * k)
    return mean


@compiled_part
def _sum_corner(
    image: GreyImage, uv: Array, bands: Array, sign: float, light: Array, k: int, halves: Array
) -> int:
    """Add to halves (2, 4, 4), where p' is -1 and 1, the products of 1, u, v and the residual, one
    below the diagonal each; return the number of cells."""
    height, breadth = image.shape
    t1u, t1v, n1u, n1v, bend1, arm1, width1 = bands[0]
    t2u, t2v, n2u, n2v, bend2, arm2, width2 = bands[1]
    u0, v0 = int(np.rint(uv[0])), int(np.rint(uv[1]))
    reach = max(abs(t1u) * arm1 + abs(t2u) * arm2, abs(t1v) * arm1 + abs(t2v) * arm2)
    far = int(np.ceil(reach / k))
    margin = _HALF_DIAGONAL * k
    count = 0
    for row in range(max(-far, -((v0 - 1) // k)), min(far, (height - 1 - k - v0) // k) + 1):
        v = v0 + row * k
        y = v + (k - 1) / 2 - uv[1]
        for col in range(max(-far, -((u0 - 1) // k)), min(far, (breadth - 1 - k - u0) // k) + 1):
            u = u0 + col * k
            x = u + (k - 1) / 2 - uv[0]
            s1, s2 = t1u * x + t1v * y, t2u * x + t2v * y
            d1 = n1u * x + n1v * y - bend1 / 2 * s1 * s1
            d2 = n2u * x + n2v * y - bend2 / 2 * s2 * s2
            if (
                abs(s1) > arm1
                or abs(s2) > arm2
                or abs(d1) <= width1 + margin
                or abs(d2) <= width2 + margin
            ):
                continue
            p = sign if (d1 > 0) == (d2 > 0) else -sign
            r = _average_cell(image, u, v, k) - light[0] - light[2] * x - light[3] * y
            r -= p * (light[1] + light[4] * x + light[5] * y)
            half = halves[1 if p > 0 else 0]
            half[0, 0] += 1
            half[1, 0] += x
            half[2, 0] += y
            half[3, 0] += r
            half[1, 1] += x * x
            half[2, 1] += x * y
            half[3, 1] += x * r
            half[2, 2] += y * y
            half[3, 2] += y * r
            half[3, 3] += r * r
            count += 1
    return count


@compiled
def _sum_cells(
    image: GreyImage,
    uv: Array,
    bands: Array,
    sign: Array,
    light: Array,
    side: IntArray,
    sums: Array,
    cells: IntArray,
) -> None:
    """Fill sums (n, 7, 7) and cells (n,)."""
    halves = np.empty((2, 4, 4))
    quantity = np.array([0, 0, 1, 2, 1, 2, 3])  # 1, u, v or the residual of each column,
    with_pattern = np.array([0, 1, 0, 0, 1, 1, 0])  # and whether p' is in it
    for i in range(uv.shape[0]):
        halves[:] = 0
        k = int(side[i])
        cells[i] = _sum_corner(image, uv[i], bands[i], sign[i], light[i], k, halves)
        for a in range(_COLUMNS):
            for b in range(_COLUMNS):
                low, high = min(quantity[a], quantity[b]), max(quantity[a], quantity[b])
                dark, bright = halves[0, high, low], halves[1, high, low]
                both = bright - dark if with_pattern[a] != with_pattern[b] else bright + dark
                sums[i, a, b] = both * (k * k)


def sum_cells(
    image: GreyImage, uv: Array, bands: Array, sign: Array, light: Array, side: IntArray
) -> tuple[Array, IntArray]:
    """Compute ``_sum_cells`` of the reference."""
    n = len(uv)
    sums, cells = np.empty((n, _COLUMNS, _COLUMNS)), np.empty(n, np.int64)
    uv, bands, sign, light = (make_contiguous(array) for array in (uv, bands, sign, light))
    _sum_cells(make_read_only(image), uv, bands, sign, light, side, sums, cells)
    return sums, cells
