"""X-junctions, compiled: the peaks and the ring test of ``corners.junctions``.

The peaks are searched row by row in a window of five rows of R, so that nothing of the image's
size is allocated, and only the strongest are kept on the way.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray
from calibgui.engine.kernels.common import bilinear, compiled

_F = np.float32
_QUARTER, _TWO = _F(0.25), _F(2)


@compiled
def _determinant(g, v, row):  # type: ignore[no-untyped-def]
    """Fill row with R of row v of the image g, but for its ends."""
    above, here, below = g[v - 1], g[v], g[v + 1]
    for u in range(1, row.shape[0] - 1):
        twice = _TWO * _F(here[u])
        xx = _F(here[u - 1]) - twice + _F(here[u + 1])
        yy = _F(above[u]) - twice + _F(below[u])
        xy = _F(below[u + 1]) - _F(below[u - 1]) - _F(above[u + 1]) + _F(above[u - 1])
        xy *= _QUARTER
        row[u] = xy * xy - xx * yy


@compiled
def _first(R, v, u):  # type: ignore[no-untyped-def]
    """Whether a peak equals none before it around."""
    here = R[v % 5, u]
    for du in range(-2, 3):
        if R[(v - 2) % 5, u + du] == here or R[(v - 1) % 5, u + du] == here:
            return False
    return R[v % 5, u - 2] != here and R[v % 5, u - 1] != here


@compiled
def _peaks(g, least, v, where, value):  # type: ignore[no-untyped-def]
    """Fill where and value with peaks from row v on; their number and the next row to search."""
    height, width = g.shape
    R = np.empty((5, width), dtype=_F)
    R[:] = -np.inf
    column = np.empty(width, dtype=_F)
    is_peak = np.empty(width, dtype=np.bool_)
    count = 0
    for row in range(max(v - 2, 1), v + 2):
        _determinant(g, row, R[row % 5])
    while v < height - 2 and count + width <= where.shape[0]:
        if v + 2 < height - 1:
            _determinant(g, v + 2, R[(v + 2) % 5])
        else:
            R[(v + 2) % 5] = -np.inf
        r0, r1, r2, r3, r4 = R[0], R[1], R[2], R[3], R[4]
        for u in range(width):
            column[u] = max(max(max(r0[u], r1[u]), max(r2[u], r3[u])), r4[u])
        here, any_peak = R[v % 5], False
        for u in range(2, width - 2):
            around = max(max(column[u - 2], column[u - 1]), max(column[u + 1], column[u + 2]))
            is_peak[u] = here[u] > least and here[u] >= max(around, column[u])
            any_peak |= is_peak[u]
        if any_peak:
            for u in range(2, width - 2):
                if is_peak[u] and _first(R, v, u):
                    where[count], value[count] = v * width + u, here[u]
                    count += 1
        v += 1
    return count, v


def peaks(g: GreyImage, least: float, most: int) -> IntArray:
    """(n,) flat indices of the at most `most` strongest peaks of R, strongest first."""
    where, value = np.empty(0, dtype=np.int64), np.empty(0, dtype=_F)
    more = np.empty(most + g.shape[1], dtype=np.int64)
    its_value = np.empty(len(more), dtype=_F)
    v = 2
    while v < g.shape[0] - 2:
        count, v = _peaks(g, _F(least), v, more, its_value)
        where = np.concatenate([where, more[:count]])
        value = np.concatenate([value, its_value[:count]])
        strongest = np.argsort(-value, kind="stable")[:most]
        where, value = where[strongest], value[strongest]
        if len(value) == most:
            least = max(least, float(value[-1]))
    return where


@compiled
def _newton(g, u, v):  # type: ignore[no-untyped-def]
    """The step from (u, v) towards the point of zero gradient."""
    left, here, right = bilinear(g, u - 1, v), bilinear(g, u, v), bilinear(g, u + 1, v)
    above, below = bilinear(g, u, v - 1), bilinear(g, u, v + 1)
    gu, gv = (right - left) / 2, (below - above) / 2
    xx, yy = right - 2 * here + left, below - 2 * here + above
    xy = bilinear(g, u + 1, v + 1) - bilinear(g, u + 1, v - 1)
    xy = (xy - bilinear(g, u - 1, v + 1) + bilinear(g, u - 1, v - 1)) / 4
    det = xy * xy - xx * yy
    return (yy * gu - xy * gv) / det, (xx * gv - xy * gu) / det


@compiled
def _stationary(g, where, steps, farthest, uv, near):  # type: ignore[no-untyped-def]
    for n in range(where.shape[0]):
        row, col = where[n] // g.shape[1], where[n] % g.shape[1]
        uv[n, 0], uv[n, 1], near[n] = col, row, True
        for _ in range(steps):
            du, dv = _newton(g, uv[n, 0], uv[n, 1])
            u, v = uv[n, 0] + du, uv[n, 1] + dv
            near[n] = max(abs(u - col), abs(v - row)) < farthest
            if not near[n]:
                break
            uv[n, 0], uv[n, 1] = u, v


def stationary(
    g: GreyImage, where: IntArray, steps: int, farthest: float
) -> tuple[Array, BoolArray]:
    """``junctions._stationary``: points of zero gradient (n, 2) after so many Newton steps, and
    which stayed within `farthest` px of their pixels along both axes."""
    uv, near = np.empty((len(where), 2)), np.empty(len(where), dtype=np.bool_)
    _stationary(g, where, steps, farthest, uv, near)
    return uv, near


@compiled
def _ring(g, u, v, circle, floor, limits, found):  # type: ignore[no-untyped-def]
    """One circle around one point; fills found with the angles A, B and the contrast."""
    asymmetry, off_middle, narrowest = limits
    half = circle.shape[0] // 2
    level = np.empty(half + 1)
    low, high, uneven = np.inf, -np.inf, 0.0
    for k in range(half):
        near = bilinear(g, u + circle[k, 0], v + circle[k, 1])
        far = bilinear(g, u + circle[k + half, 0], v + circle[k + half, 1])
        level[k] = (near + far) / 2
        uneven += (near - far) ** 2
        low, high = min(low, level[k]), max(high, level[k])
    contrast, middle = high - low, (low + high) / 2
    if not contrast > floor or np.sqrt(uneven / half) >= asymmetry * contrast:
        return False
    if abs(bilinear(g, u, v) - middle) >= off_middle * contrast:
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
    return falls == 1 and narrowest < found[1] - found[0] < np.pi - narrowest


@compiled
def _rings(g, uv, circles, floor, limits, passed, found):  # type: ignore[no-untyped-def]
    for i in range(uv.shape[0]):
        for k in range(circles.shape[0]):
            passed[i] = _ring(g, uv[i, 0], uv[i, 1], circles[k], floor, limits, found[i])
            if passed[i]:
                break


def rings(
    g: GreyImage, uv: Array, circles: Array, floor: float, limits: tuple[float, float, float]
) -> tuple[BoolArray, Array]:
    """The ring test of points uv (n, 2) on `circles` (k, samples, 2) in turn until one passes.

    Args:
        g: (h, w) grey levels.
        uv: (n, 2) px.
        circles: offsets of the samples, px.
        floor: least contrast, grey levels.
        limits: greatest asymmetry and distance of the centre from the mid level, over the
            contrast, and least angle between the edges, rad.

    Returns:
        Which passed (n,), and (n, 3) the angles A, B and the contrast, for those that did.
    """
    passed, found = np.zeros(len(uv), dtype=np.bool_), np.zeros((len(uv), 3))
    _rings(g, uv, circles, floor, limits, passed, found)
    return passed, found
