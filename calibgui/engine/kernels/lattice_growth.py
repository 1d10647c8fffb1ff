"""A lattice grown among circles, and its borders, compiled.

The readable references are in ``detection.circles``: ``lattice_growth`` and ``grid_labelling``.

The lattice is a square table of points, in which a place is one number. If the lattice comes near
its end, all is done again in a larger one.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels.common import compiled, compiled_part, make_contiguous

_REACH = 4
"""Number of places that the table has beyond the lattice: three of them predict a fourth."""
_ROOM = 24
"""Number of places beyond the first ones that the table has."""
_FREE, _LISTED = -1, -2
"""Values of the table where no point is: in general, and where one may be."""
_MOST = 10
"""Number of predictions that a place may have."""


@compiled_part
def _predict(table: IntArray, at: int, width: int, uv: Array, expected: Array) -> int:
    """Fill `expected` (3,) with the mean of what a place's neighbours predict for its point, u and
    v, and the length of the shortest step; return the number of predictions."""
    count, u, v, shortest = 0, 0.0, 0.0, np.inf
    for along in (width, -width, 1, -1):
        first, second = table[at + along], table[at + 2 * along]
        if first >= 0 and second >= 0:
            du, dv = uv[first, 0] - uv[second, 0], uv[first, 1] - uv[second, 1]
            third = table[at + 3 * along]
            if third >= 0:
                u += 3 * du + uv[third, 0]
                v += 3 * dv + uv[third, 1]
            else:
                u += uv[first, 0] + du
                v += uv[first, 1] + dv
            shortest = min(shortest, np.sqrt(du * du + dv * dv))
            count += 1
    for along in (width, 1):
        first, second = table[at + along], table[at - along]
        if first >= 0 and second >= 0:
            du, dv = uv[second, 0] - uv[first, 0], uv[second, 1] - uv[first, 1]
            u += uv[first, 0] + du / 2
            v += uv[first, 1] + dv / 2
            shortest = min(shortest, np.sqrt(du * du + dv * dv) / 2)
            count += 1
    for along in (width, -width):
        for across in (1, -1):
            first, second, both = table[at + along], table[at + across], table[at + along + across]
            if first >= 0 and second >= 0 and both >= 0:
                du, dv = uv[first, 0] - uv[both, 0], uv[first, 1] - uv[both, 1]
                u += du + uv[second, 0]
                v += dv + uv[second, 1]
                shortest = min(shortest, np.sqrt(du * du + dv * dv))
                du, dv = uv[second, 0] - uv[both, 0], uv[second, 1] - uv[both, 1]
                shortest = min(shortest, np.sqrt(du * du + dv * dv))
                count += 1
    expected[0], expected[1], expected[2] = u / max(count, 1), v / max(count, 1), shortest
    return count


@compiled_part
def _find_nearest(uv: Array, u: float, v: float, within: float) -> int:
    """Return the number of the point nearest to (u, v), -1 if none is nearer than `within`."""
    nearest, least = -1, within * within
    for k in range(uv.shape[0]):
        du, dv = uv[k, 0] - u, uv[k, 1] - v
        square = du * du + dv * dv
        if square < least:
            nearest, least = k, square
    return nearest


@compiled_part
def _list_beside(table: IntArray, at: int, width: int, beside: IntArray, count: int) -> int:
    """List the free places around one among the `count` of `beside`, in order; return their
    number."""
    for step in (width, -width, 1, -1):
        place = at + step
        if table[place] == _FREE:
            table[place] = _LISTED
            k = count
            while k > 0 and beside[k - 1] > place:
                beside[k] = beside[k - 1]
                k -= 1
            beside[k] = place
            count += 1
    return count


@compiled
def _grow(
    uv: Array, max_error: float, width: int, table: IntArray, order: IntArray, count: int
) -> int:
    """Fill `table` (width * width,) with points, and `order` (n,) with their places, of which
    `count` are there; return their number, or -1 if the table is too small."""
    taken = np.zeros(len(uv), dtype=np.bool_)
    for k in range(count):
        taken[table[order[k]]] = True
    beside, sure = np.empty((2, 4 * len(uv)), dtype=np.int64)
    expected = np.empty((4 * len(uv), 3))
    begin = listed = 0
    while begin < count:
        for k in range(begin, count):
            row, col = order[k] // width, order[k] % width
            if min(row, col) < _REACH or max(row, col) >= width - _REACH:
                return -1
            listed = _list_beside(table, order[k], width, beside, listed)
        begin = count
        for k in range(listed):
            sure[k] = _predict(table, beside[k], width, uv, expected[k])
        for most in range(_MOST, 0, -1):
            for k in range(listed):
                if sure[k] != most:
                    continue
                within = max_error * expected[k, 2]
                point = _find_nearest(uv, expected[k, 0], expected[k, 1], within)
                table[beside[k]] = _FREE
                if point >= 0 and not taken[point]:
                    taken[point] = True
                    table[beside[k]] = point
                    order[count] = beside[k]
                    count += 1
        unpredicted = 0
        for k in range(listed):
            if sure[k] == 0:
                beside[unpredicted] = beside[k]
                unpredicted += 1
        listed = unpredicted
    return count


def grow(
    places: IntArray, chosen: IntArray, points: Array, max_error: float
) -> tuple[IntArray, IntArray]:
    """Compute ``detection.circles.lattice_growth._grow``."""
    uv, order = make_contiguous(points), np.empty(len(points), dtype=np.int64)
    count, room = -1, int(abs(places).max()) + _ROOM
    while count < 0:
        width = 2 * room + 1
        table = np.full(width * width, _FREE)
        order[: len(places)] = (places + room) @ [width, 1]
        table[order[: len(places)]] = chosen
        count = _grow(uv, max_error, width, table, order, len(places))
        room *= 2
    placed = order[:count]
    return np.column_stack(np.divmod(placed, width)) - width // 2, table[placed]


@compiled
def _drop_borders(
    taken: IntArray, counts: IntArray, full: float, min_share: float, out: IntArray
) -> int:
    """Fill `out` (k, 4) with the first and the last line of either axis, emptying the lines of
    `taken` that are dropped; return the number k. `counts` (2, n) are those of the places taken in
    the lines of either axis."""
    for count in range(len(out)):
        box = out[count]
        for axis in range(2):
            first, last = 0, taken.shape[axis] - 1
            while first <= last and counts[axis, first] == 0:
                first += 1
            while first <= last and counts[axis, last] == 0:
                last -= 1
            box[2 * axis], box[2 * axis + 1] = first, last
        if box[0] > box[1]:
            return count
        least, end = np.inf, 0
        for k in (0, 2, 1, 3):
            axis = k // 2
            other = 2 - 2 * axis
            share = counts[axis, box[k]] / ((box[other + 1] - box[other] + 1) * full)
            if share < least:
                least, end = share, k
        if least >= min_share:
            return count + 1
        axis, line = end // 2, box[end]
        for k in range(taken.shape[1 - axis]):
            i, j = (line, k) if axis == 0 else (k, line)
            counts[1 - axis, k] -= taken[i, j]
            taken[i, j] = 0
        counts[axis, line] = 0
    return len(out)


def drop_borders(xy: IntArray, places_per_circle: int, min_share: float) -> IntArray:
    """Compute ``detection.circles.grid_labelling._drop_borders``."""
    first = xy.min(axis=0)
    taken = np.zeros(xy.max(axis=0) - first + 1, dtype=np.int64)
    taken[tuple((xy - first).T)] = 1
    counts = np.zeros((2, max(taken.shape)), dtype=np.int64)
    for axis in range(2):
        counts[axis, : taken.shape[axis]] = taken.sum(axis=1 - axis)
    lines = np.empty((sum(taken.shape), 4), dtype=np.int64)
    count = _drop_borders(taken, counts, 1 / places_per_circle, min_share, lines)
    return np.asarray(lines[:count].reshape(-1, 2, 2).transpose(0, 2, 1) + first)
