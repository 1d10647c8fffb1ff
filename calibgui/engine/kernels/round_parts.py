"""Evenly filled ellipses among the connected parts of a mask, compiled.

The readable reference is in ``detection.circles.blobs``. The mask is never stored: of each row the
runs are kept, neighbouring pixels in it, until the next row has taken over those that it goes on
with. What no run goes on with is complete: it is told at once, and its place in the table of parts
is free again, so that the table has no more places than two rows have runs.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, GreyImage, IntArray
from calibgui.engine.kernels.common import compiled, compiled_part, make_read_only

_Bytes = npt.NDArray[np.unsignedinteger[Any]]
"""Arrays of uint8."""
_Words = npt.NDArray[np.unsignedinteger[Any]]
"""Arrays of uint64 that view the memory of `_Bytes`, eight pixels each."""
_WORD = 8
"""Number of pixels that are skipped at once where no run begins or ends among them."""
_N, _U, _UU, _V, _VV, _UV, _LEFT, _RIGHT, _FIRST, _LAST = range(10)
"""Columns of the table of parts: the sums of 1, u, u^2, v, v^2 and u v over a part's pixels, the
first of its columns and the one after the last, the number of its first pixel row by row, and its
last row."""
_SUMS = 6
"""Number of the sums."""
_TOLD = -1
"""The last row of a part that has been told."""


@compiled_part
def _list_runs(
    upper: GreyImage,
    lower: GreyImage,
    least: int,
    inside: _Bytes,
    changes: _Bytes,
    words: _Words,
    runs: IntArray,
) -> None:
    """Fill `runs` with the number of the runs of a row, and the first column of each and the one
    after its last."""
    for u in range(len(upper)):
        inside[u + 1] = np.int16(upper[u]) - np.int16(lower[u]) >= least
    for u in range(len(changes)):
        changes[u] = inside[u + 1] ^ inside[u]
    ends = 0
    for word in range(len(words)):
        if words[word]:
            for u in range(_WORD * word, _WORD * (word + 1)):
                runs[1 + ends] = u
                ends += changes[u]
    runs[0] = ends // 2


@compiled_part
def _find_root(parent: IntArray, part: int) -> int:
    """Return the part that a part was joined to in the end."""
    while parent[part] != part:
        part = parent[part]
    return part


@compiled_part
def _join(parts: IntArray, parent: IntArray, part: int, other: int) -> None:
    """Join another part to a part."""
    for k in range(_SUMS):
        parts[part, k] += parts[other, k]
    parts[part, _LEFT] = min(parts[part, _LEFT], parts[other, _LEFT])
    parts[part, _RIGHT] = max(parts[part, _RIGHT], parts[other, _RIGHT])
    parts[part, _FIRST] = min(parts[part, _FIRST], parts[other, _FIRST])
    parent[other] = part


@compiled_part
def _add_run(parts: IntArray, sums: IntArray, part: int, begin: int, end: int, v: int) -> None:
    """Add the run of the columns from `begin` to before `end` in row v to a part; `sums` (2, m) are
    those of u and of u^2 over the columns before each."""
    n, along = end - begin, sums[0, end] - sums[0, begin]
    parts[part, _N] += n
    parts[part, _U] += along
    parts[part, _UU] += sums[1, end] - sums[1, begin]
    parts[part, _V] += n * v
    parts[part, _VV] += n * v * v
    parts[part, _UV] += along * v
    parts[part, _LEFT] = min(parts[part, _LEFT], begin)
    parts[part, _RIGHT] = max(parts[part, _RIGHT], end)
    parts[part, _LAST] = v


@compiled_part
def _compute_fill(parts: IntArray, part: int) -> float:
    """Compute a part's area over that of the ellipse of its covariance."""
    n = parts[part, _N]
    u, v = parts[part, _U] / n, parts[part, _V] / n
    # A pixel's own variance is 1/12 along each axis.
    uu, vv = parts[part, _UU] / n - u * u + 1 / 12, parts[part, _VV] / n - v * v + 1 / 12
    uv = parts[part, _UV] / n - u * v
    fill: float = n / (4 * np.pi * np.sqrt(max(uu * vv - uv * uv, 1e-9)))
    return fill


@compiled_part
def _begin_part(parts: IntArray, parent: IntArray, free: IntArray, first: int, begin: int) -> int:
    """Take a free place for a part that begins in a column; return the place."""
    part = free[free[0]]
    free[0] -= 1
    parent[part] = part
    for k in range(_SUMS):
        parts[part, k] = 0
    parts[part, _LEFT] = parts[part, _RIGHT] = begin
    parts[part, _FIRST] = first
    return part


@compiled_part
def _take_row(
    v: int,
    width: int,
    runs: IntArray,
    own: IntArray,
    above: IntArray,
    own_above: IntArray,
    sums: IntArray,
    parts: IntArray,
    parent: IntArray,
    free: IntArray,
    joined: IntArray,
) -> None:
    """Fill `own` with the part of each of the runs of a row, and `joined` with parts that became
    others' in it; the first number of each list is how many follow."""
    joined[0], k, count, count_above = 0, 0, runs[0], above[0]
    for i in range(count):
        begin, end = runs[1 + 2 * i], runs[2 + 2 * i]
        while k < count_above and above[2 + 2 * k] <= begin:
            k += 1
        if k < count_above and above[1 + 2 * k] < end:
            part = _find_root(parent, own_above[k])
            while k + 1 < count_above and above[3 + 2 * k] < end:
                k += 1
                other = _find_root(parent, own_above[k])
                if other != part:
                    _join(parts, parent, part, other)
                    joined[0] += 1
                    joined[joined[0]] = other
        else:
            part = _begin_part(parts, parent, free, v * width + begin, begin)
        _add_run(parts, sums, part, begin, end, v)
        own[i] = part
    for i in range(count):
        own[i] = _find_root(parent, own[i])


@compiled
def _find_round_parts(
    upper: GreyImage,
    lower: GreyImage,
    least: int,
    least_area: float,
    most_area: float,
    least_share: float,
    least_fill: float,
    most_fill: float,
    out: Array,
) -> int:
    """Fill `out` (n, 5) with the parts, and the number of the first pixel of each; return how many
    they are."""
    height, width = upper.shape
    padded = _WORD * (width // _WORD + 1)
    inside, changes = np.zeros(padded + 1, dtype=np.uint8), np.zeros(padded, dtype=np.uint8)
    words = changes.view(np.uint64)
    sums = np.zeros((2, padded + 1), dtype=np.int64)
    for u in range(padded):
        sums[0, u + 1], sums[1, u + 1] = sums[0, u] + u, sums[1, u] + u * u
    parts = np.zeros((width + 3, _LAST + 1), dtype=np.int64)
    parent, free, joined = np.arange(len(parts)), np.arange(len(parts)), np.zeros_like(sums[0])
    free[0] = len(free) - 1
    runs, own = np.zeros((2, padded + 2), dtype=np.int64), np.zeros((2, padded), dtype=np.int64)
    count = 0
    for v in range(height + 1):
        now, before = v % 2, 1 - v % 2
        runs[now, 0] = 0
        if v < height:
            _list_runs(upper[v], lower[v], least, inside, changes, words, runs[now])
        _take_row(
            v, width, runs[now], own[now], runs[before], own[before], sums, parts, parent, free,
            joined,
        )  # fmt: skip
        for i in range(runs[before, 0]):
            part = own[before, i]
            if parent[part] != part or parts[part, _LAST] == v or parts[part, _LAST] == _TOLD:
                continue
            parts[part, _LAST] = _TOLD
            free[0] += 1
            free[free[0]] = part
            area = parts[part, _N]
            rows = v - parts[part, _FIRST] // width
            box = rows * (parts[part, _RIGHT] - parts[part, _LEFT])
            if not (least_area <= area < most_area and area > least_share * box):
                continue
            fill = _compute_fill(parts, part)
            if least_fill < fill < most_fill:
                out[count, 0], out[count, 1] = parts[part, _U] / area, parts[part, _V] / area
                out[count, 2], out[count, 3], out[count, 4] = area, fill, parts[part, _FIRST]
                count += 1
        for i in range(joined[0]):
            free[0] += 1
            free[free[0]] = joined[1 + i]
    return count


def find_round_parts(
    upper: GreyImage,
    lower: GreyImage,
    least: int,
    area: tuple[float, float],
    least_share: float,
    fill: tuple[float, float],
) -> Array:
    """Compute ``detection.circles.blobs._find_round_parts``."""
    out = np.empty((int(upper.size / area[0]) + 1, 5))
    count = _find_round_parts(
        make_read_only(upper), make_read_only(lower), least, float(area[0]), float(area[1]),
        least_share, *fill, out,
    )  # fmt: skip
    found = out[:count]
    return np.asarray(found[np.argsort(found[:, 4]), :4])
