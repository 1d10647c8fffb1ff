"""X-junctions, compiled: the loops of ``lattices.x_junctions``.

The peaks are searched row by row in a window of five rows of R, so that nothing of the image's
size is allocated, and only the strongest are kept on the way. Hence most blocks of a row hold no
value that could be one of these, which is quickly seen; in the others the pixels that are more than
the four beside are listed first, and those alone compared with all around.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import (
    Array,
    BoolArray,
    FloatImage,
    GreyImage,
    Int32Array,
    IntArray,
)
from calibgui.engine.kernels.common import bilinear, compiled, compiled_part

_F = np.float32
_QUARTER, _TWO = _F(0.25), _F(2)
_BLOCK = 128
"""Number of pixels of a block of a row."""


@compiled_part
def _compute_determinants(g: GreyImage, v: int, row: FloatImage) -> None:
    """Fill `row` with R of row v of the image g, but for its ends."""
    above, here, below = g[v - 1], g[v], g[v + 1]
    for u in range(1, row.shape[0] - 1):
        twice = _TWO * _F(here[u])
        xx = _F(here[u - 1]) - twice + _F(here[u + 1])
        yy = _F(above[u]) - twice + _F(below[u])
        xy = _F(below[u + 1]) - _F(below[u - 1]) - _F(above[u + 1]) + _F(above[u - 1])
        xy *= _QUARTER
        row[u] = xy * xy - xx * yy


@compiled_part
def _compute_blocks(
    g: GreyImage, v: int, least: np.float32, row: FloatImage, exceeds: BoolArray
) -> None:
    """Fill `row` with R of row v of the image g, and `exceeds` with whether any of that is more
    than `least`, block by block."""
    _compute_determinants(g, v, row)
    for k in range(exceeds.shape[0]):
        block = row[k * _BLOCK : (k + 1) * _BLOCK]
        count = np.int32(0)  # in place of a flag, which the compiler does not vectorise
        for u in range(block.shape[0]):
            count += np.int32(block[u] > least)
        exceeds[k] = count > 0


@compiled_part
def _list_maxima(
    R: FloatImage,
    v: int,
    block: int,
    least: np.float32,
    passes: BoolArray,
    columns: Int32Array,
) -> int:
    """Fill `columns` with those of a block where row v of R is more than `least` and none of the
    four values beside is more, or before it as much; return their number."""
    above, here, below = R[(v - 1) % 5], R[v % 5], R[(v + 1) % 5]
    begin = max(block * _BLOCK, 2)
    width = min((block + 1) * _BLOCK, here.shape[0] - 2) - begin
    # One loop that the compiler vectorises, and one without a branch that it could not foresee.
    for k in range(width):
        u = begin + k
        value = here[u]
        is_more = (value > least) & (value > here[u - 1]) & (value >= here[u + 1])
        passes[k] = is_more & (value > above[u]) & (value >= below[u])
    count = 0
    for k in range(width):
        columns[count] = begin + k
        count += int(passes[k])
    return count


@compiled_part
def _is_peak(R: FloatImage, v: int, u: int) -> bool:
    """Return whether none of the 24 values around the one at (u, v) is more, and none before it as
    much."""
    here, row = R[v % 5, u], R[v % 5]
    if not (row[u - 1] < here and row[u + 1] <= here):
        return False
    if not (row[u - 2] < here and row[u + 2] <= here):
        return False
    for dv in range(1, 3):
        before, after = R[(v - dv) % 5], R[(v + dv) % 5]
        for du in range(-2, 3):
            if not (before[u + du] < here and after[u + du] <= here):
                return False
    return True


@compiled
def _scan_rows(
    g: GreyImage, least: np.float32, v: int, where: IntArray, value: FloatImage
) -> tuple[int, int]:
    """Fill `where` and `value` with the peaks from row v on, until they are full.

    Returns:
        The number of peaks and the next row to search.
    """
    height, width = g.shape
    R = np.empty((5, width), dtype=_F)
    R[:] = -np.inf
    exceeds = np.zeros((5, -(-width // _BLOCK)), dtype=np.bool_)
    passes, columns = np.empty(_BLOCK, dtype=np.bool_), np.empty(_BLOCK, dtype=np.int32)
    count = 0
    for row in range(max(v - 2, 1), v + 2):
        _compute_blocks(g, row, least, R[row % 5], exceeds[row % 5])
    while v < height - 2 and count + width <= where.shape[0]:
        if v + 2 < height - 1:
            _compute_blocks(g, v + 2, least, R[(v + 2) % 5], exceeds[(v + 2) % 5])
        else:
            R[(v + 2) % 5] = -np.inf
        here = R[v % 5]
        for k in range(exceeds.shape[1]):
            if exceeds[v % 5, k]:
                for m in range(_list_maxima(R, v, k, least, passes, columns)):
                    u = columns[m]
                    if _is_peak(R, v, u):
                        where[count], value[count] = v * width + u, here[u]
                        count += 1
        v += 1
    return count, v


def find_peaks(smooth: GreyImage, min_determinant: float, max_count: int) -> IntArray:
    """Compute ``lattices.x_junctions._find_peaks``."""
    where, value = np.empty(0, dtype=np.int64), np.empty(0, dtype=_F)
    more = np.empty(max_count + smooth.shape[1], dtype=np.int64)
    more_values = np.empty(len(more), dtype=_F)
    v, least = 2, min_determinant
    while v < smooth.shape[0] - 2:
        count, v = _scan_rows(smooth, np.float32(least), v, more, more_values)
        where = np.concatenate([where, more[:count]])
        value = np.concatenate([value, more_values[:count]])
        if len(value) >= max_count:
            least = float(np.partition(value, -max_count)[-max_count])
            strong = value >= least
            where, value = where[strong], value[strong]
    return where[np.argsort(-value, kind="stable")[:max_count]]


@compiled_part
def _compute_newton_step(g: GreyImage, u: float, v: float) -> tuple[float, float]:
    """Compute the step from (u, v) towards the point of zero gradient."""
    left, here, right = bilinear(g, u - 1, v), bilinear(g, u, v), bilinear(g, u + 1, v)
    above, below = bilinear(g, u, v - 1), bilinear(g, u, v + 1)
    gu, gv = (right - left) / 2, (below - above) / 2
    xx, yy = right - 2 * here + left, below - 2 * here + above
    xy = bilinear(g, u + 1, v + 1) - bilinear(g, u + 1, v - 1)
    xy = (xy - bilinear(g, u - 1, v + 1) + bilinear(g, u - 1, v - 1)) / 4
    det = xy * xy - xx * yy
    return (yy * gu - xy * gv) / det, (xx * gv - xy * gu) / det


@compiled
def _refine_stationary(
    g: GreyImage, where: IntArray, steps: int, max_shift: float, uv: Array, near: BoolArray
) -> None:
    """Fill uv and near with the results of `refine_stationary`."""
    for n in range(where.shape[0]):
        row, col = where[n] // g.shape[1], where[n] % g.shape[1]
        uv[n, 0], uv[n, 1], near[n] = col, row, True
        for _ in range(steps):
            du, dv = _compute_newton_step(g, uv[n, 0], uv[n, 1])
            u, v = uv[n, 0] + du, uv[n, 1] + dv
            near[n] = max(abs(u - col), abs(v - row)) < max_shift
            if not near[n]:
                break
            uv[n, 0], uv[n, 1] = u, v


def refine_stationary(
    smooth: GreyImage, pixels: IntArray, steps: int, max_shift: float
) -> tuple[Array, BoolArray]:
    """Compute ``lattices.x_junctions._refine_stationary``."""
    uv, is_near = np.empty((len(pixels), 2)), np.empty(len(pixels), dtype=np.bool_)
    _refine_stationary(smooth, pixels, steps, max_shift, uv, is_near)
    return uv, is_near


@compiled_part
def _check_circle(
    g: GreyImage,
    u: float,
    v: float,
    circle: Array,
    min_contrast: float,
    limits: tuple[float, float, float],
    level: Array,
    found: Array,
) -> bool:
    """Test one point on one circle; fill `found` with the angles A, B and the contrast, and `level`
    with the means of opposite samples, the first once more at the end."""
    max_asymmetry, max_off_middle, min_angle = limits
    half = circle.shape[0] // 2
    low, high, uneven = np.inf, -np.inf, 0.0
    for k in range(half):
        near = bilinear(g, u + circle[k, 0], v + circle[k, 1])
        far = bilinear(g, u + circle[k + half, 0], v + circle[k + half, 1])
        level[k] = (near + far) / 2
        uneven += (near - far) ** 2
        low, high = min(low, level[k]), max(high, level[k])
    contrast, middle = high - low, (low + high) / 2
    if not contrast > min_contrast or np.sqrt(uneven / half) >= max_asymmetry * contrast:
        return False
    if abs(bilinear(g, u, v) - middle) >= max_off_middle * contrast:
        return False
    level[half] = level[0]
    falls = 0
    for k in range(half):
        a, b = level[k] - middle, level[k + 1] - middle
        if a > 0 and b <= 0:
            falls += 1
            found[0] = (k + a / (a - b)) * np.pi / half
        elif a <= 0 and b > 0:
            found[1] = (k + a / (a - b)) * np.pi / half
    if found[1] < found[0]:
        found[1] += np.pi
    found[2] = contrast
    return falls == 1 and min_angle < found[1] - found[0] < np.pi - min_angle


@compiled
def _check_circles(
    g: GreyImage,
    uv: Array,
    circles: Array,
    min_contrast: float,
    limits: tuple[float, float, float],
    passed: BoolArray,
    rings: Array,
) -> None:
    """Fill passed and rings with the results of `check_circles`."""
    level = np.empty(circles.shape[1] // 2 + 1)
    for i in range(uv.shape[0]):
        u, v, ring = uv[i, 0], uv[i, 1], rings[i]
        for k in range(circles.shape[0]):
            passed[i] = _check_circle(g, u, v, circles[k], min_contrast, limits, level, ring)
            if passed[i]:
                break


def check_circles(
    smooth: GreyImage,
    uv: Array,
    circles: Array,
    min_contrast: float,
    limits: tuple[float, float, float],
) -> tuple[BoolArray, Array]:
    """Compute ``lattices.x_junctions._check_circles``."""
    passed, rings = np.zeros(len(uv), dtype=np.bool_), np.zeros((len(uv), 3))
    _check_circles(smooth, uv, circles, min_contrast, limits, passed, rings)
    return passed, rings
