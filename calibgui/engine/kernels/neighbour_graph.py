"""The graph of neighbours, compiled: the loops of ``lattices.neighbour_graph``.

The junctions nearest to one are looked up in a grid of square cells: cell by cell in rings around
its own, until no cell beyond can hold a nearer one.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, Int32Array, IntArray
from calibgui.engine.kernels.common import bilinear, compiled, compiled_part

_JUNCTIONS_PER_CELL = 2.0
"""Number of junctions in a cell, on average."""
_SIDE_OFFSET, _MIN_SIDE_OFFSET = 0.15, 1.0
"""Distance of the samples on either side of an edge, as in the reference, and the least, px."""


@compiled
def _sort_into_cells(
    uv: Array, lowest: Array, side: float, start: Int32Array, member: Int32Array
) -> None:
    """Fill `member` with the points by their cell (r, c), each from start[r, c] to start[r, c + 1],
    which leaves the last entry of each row of start without a cell."""
    n, cols = uv.shape[0], start.shape[1]
    flat = start.reshape(-1)
    for i in range(n):
        r, c = int((uv[i, 1] - lowest[1]) / side), int((uv[i, 0] - lowest[0]) / side)
        flat[r * cols + c] += 1
    total = 0
    for cell in range(flat.shape[0]):
        total += flat[cell]
        flat[cell] = total
    for i in range(n - 1, -1, -1):
        r, c = int((uv[i, 1] - lowest[1]) / side), int((uv[i, 0] - lowest[0]) / side)
        flat[r * cols + c] -= 1
        member[flat[r * cols + c]] = i


def sort_points(uv: Array) -> tuple[Array, float, Int32Array, Int32Array]:
    """Sort points (n, 2) into square cells.

    Returns:
        The cells' origin (2,) and side, px; (rows, cols + 1) where the points of each begin, and
        those of the next, in the numbers (n,) of the points by their cell.
    """
    lowest, highest = uv.min(axis=0), uv.max(axis=0)
    extent = np.maximum(highest - lowest, 1.0)
    side = float(np.sqrt(_JUNCTIONS_PER_CELL * extent.prod() / len(uv)))
    cols, rows = (extent / side).astype(np.int64) + 1
    start, member = np.zeros((rows, cols + 1), np.int32), np.empty(len(uv), np.int32)
    _sort_into_cells(uv, lowest, side, start, member)
    return lowest, side, start, member


@compiled_part
def _insert(j: int, squared: float, near: IntArray, distance: Array, count: int) -> int:
    """Insert j into the `count` nearest so far, in order, and return how many there are then."""
    most = near.shape[0]
    if count == most:
        if squared >= distance[most - 1]:
            return count
        count -= 1
    k = count
    while k > 0 and distance[k - 1] > squared:
        near[k], distance[k] = near[k - 1], distance[k - 1]
        k -= 1
    near[k], distance[k] = j, squared
    return count + 1


@compiled_part
def _find_nearest(
    uv: Array,
    i: int,
    lowest: Array,
    side: float,
    start: Int32Array,
    member: Int32Array,
    near: IntArray,
    distance: Array,
) -> int:
    """Fill `near` with the points nearest to point i, nearest first, and `distance` with their
    squared distances; return their number."""
    rows, cols = start.shape[0], start.shape[1] - 1
    u, v = uv[i, 0] - lowest[0], uv[i, 1] - lowest[1]
    row, col = int(v / side), int(u / side)
    count, most = 0, near.shape[0]
    for ring in range(max(rows, cols)):
        for r in range(max(row - ring, 0), min(row + ring + 1, rows)):
            step = 1 if abs(r - row) == ring else 2 * ring
            for c in range(col - ring, col + ring + 1, step):
                if 0 <= c < cols:
                    for m in range(start[r, c], start[r, c + 1]):
                        j = member[m]
                        if j != i:
                            du, dv = uv[j, 0] - uv[i, 0], uv[j, 1] - uv[i, 1]
                            count = _insert(j, du * du + dv * dv, near, distance, count)
        inside = min(
            min(u - col * side, (col + 1) * side - u), min(v - row * side, (row + 1) * side - v)
        )
        if count == most and distance[most - 1] <= (inside + ring * side) ** 2:
            break
    return count


@compiled_part
def _choose_slot(along: Array, du: float, dv: float) -> tuple[int, float]:
    """Choose the slot that points most along (du, dv); return it and the cosine between them."""
    a = along[0, 0] * du + along[0, 1] * dv
    b = along[1, 0] * du + along[1, 1] * dv
    if abs(a) >= abs(b):
        return (0 if a > 0 else 2), abs(a)
    return (1 if b > 0 else 3), abs(b)


@compiled_part
def _compute_cosine(along: Array, k: int, other: Array, k_other: int) -> float:
    """Compute the cosine between slot k of one junction and slot k_other of another."""
    a, b = along[k % 2], other[k_other % 2]
    cosine = a[0] * b[0] + a[1] * b[1]
    return cosine if k // 2 == k_other // 2 else -cosine


@compiled_part
def _shows_edge(
    g: GreyImage,
    here: Array,
    du: float,
    dv: float,
    distance: float,
    places: Array,
    sign: float,
    least: float,
) -> bool:
    """Return whether the step across the line from `here` along (du, dv) has the given sign and is
    more than `least` at all places; between points of a texture it mostly fails at the first."""
    aside = max(_SIDE_OFFSET * distance, _MIN_SIDE_OFFSET)
    for s in places:
        u, v = here[0] + s * distance * du, here[1] + s * distance * dv
        step = bilinear(g, u - aside * dv, v + aside * du)
        step -= bilinear(g, u + aside * dv, v - aside * du)
        if not sign * step > least:
            return False
    return True


@compiled
def _choose_neighbours(
    g: GreyImage,
    uv: Array,
    along: Array,
    contrast: Array,
    lowest: Array,
    side: float,
    start: Int32Array,
    member: Int32Array,
    max_neighbours: int,
    places: Array,
    limits: tuple[float, float, float],
    ends: Int32Array,
) -> None:
    """Fill `ends` with the result of `choose_neighbours`, the points being sorted into cells."""
    min_along, min_parallel, min_edge_step = limits
    near, away = np.empty(max_neighbours, dtype=np.int64), np.empty(max_neighbours)
    for i in range(uv.shape[0]):
        here, mine = uv[i], along[i]
        count = _find_nearest(uv, i, lowest, side, start, member, near, away)
        for m in range(count):
            j, distance = near[m], np.sqrt(away[m])
            if distance == 0:
                continue
            du, dv = (uv[j, 0] - here[0]) / distance, (uv[j, 1] - here[1]) / distance
            k, cosine = _choose_slot(mine, du, dv)
            if ends[i, k] >= 0 or cosine <= min_along:
                continue
            other = along[j]
            k_back, cosine = _choose_slot(other, -du, -dv)
            if cosine <= min_along or (k + k_back) % 2 == 0:
                continue
            if _compute_cosine(mine, (k + 1) % 4, other, (k_back + 3) % 4) <= min_parallel:
                continue
            sign = 1.0 if k % 2 == 1 else -1.0
            least = min_edge_step * min(contrast[i], contrast[j])
            if _shows_edge(g, here, du, dv, distance, places, sign, least):
                ends[i, k] = 4 * j + k_back


def choose_neighbours(
    smooth: GreyImage,
    uv: Array,
    along: Array,
    contrast: Array,
    max_neighbours: int,
    places: Array,
    limits: tuple[float, float, float],
) -> Int32Array:
    """Compute ``lattices.neighbour_graph._choose_neighbours``."""
    ends = np.full((len(uv), 4), -1, dtype=np.int32)
    count = min(max_neighbours, len(uv) - 1)
    _choose_neighbours(smooth, uv, along, contrast, *sort_points(uv), count, places, limits, ends)
    return ends


@compiled
def _fill_closing_edges(ends: Int32Array, closing: BoolArray) -> None:
    """Fill closing (n, 4) with the result of `find_closing_edges`."""
    for i in range(ends.shape[0]):
        for k in range(4):
            for side in (1, 3):
                j, slot, steps = i, k, 0
                while steps < 4 and ends[j, slot] >= 0:
                    j, slot = ends[j, slot] // 4, (ends[j, slot] + side) % 4
                    steps += 1
                closing[i, k] |= steps == 4 and j == i and slot == k


def find_closing_edges(ends: Int32Array) -> BoolArray:
    """Compute ``lattices.neighbour_graph._find_closing_edges``."""
    closing = np.zeros(ends.shape, dtype=np.bool_)
    _fill_closing_edges(ends, closing)
    return closing


@compiled
def _fill_blocks(ends: Int32Array, closing: BoolArray, member: IntArray, size: IntArray) -> None:
    """Fill size (n,), of zeros, with the result of `measure_blocks`; member (n,) is overwritten."""
    for seed in range(ends.shape[0]):
        if size[seed]:
            continue
        member[0], size[seed], head, count = seed, 1, 0, 1
        while head < count:
            i = member[head]
            head += 1
            for k in range(4):
                j = ends[i, k] // 4
                if closing[i, k] and not size[j]:
                    member[count], size[j] = j, 1
                    count += 1
        for m in range(count):
            size[member[m]] = count


def measure_blocks(ends: Int32Array, closing: BoolArray) -> IntArray:
    """Compute ``lattices.neighbour_graph._measure_blocks``."""
    size = np.zeros(len(ends), dtype=np.int64)
    _fill_blocks(ends, closing, np.empty_like(size), size)
    return size


@compiled
def _walk_graph(
    ends: Int32Array,
    closing: BoolArray,
    is_apart: BoolArray,
    seeds: IntArray,
    directions: IntArray,
    nodes: Int32Array,
    origin: Int32Array,
    placed: Int32Array,
) -> int:
    """Fill nodes, origin and placed with the results of `walk_graph`; return their number."""
    seen = np.zeros(ends.shape[0], dtype=np.bool_)
    waiting = np.empty((ends.size, 2), dtype=np.int32)  # edges: where they leave, and their slots
    count = 0
    for seed in seeds:
        if seen[seed]:
            continue
        seen[seed] = True
        head, first, last = count, 0, 0
        nodes[count], origin[count], placed[count] = seed, seed, 0
        count += 1
        while head < count or first < last:
            is_waiting = head == count
            if is_waiting:
                here, begin, end = waiting[first, 0], waiting[first, 1], waiting[first, 1] + 1
                first += 1
            else:
                here, begin, end = head, 0, 4
                head += 1
            i, turn = nodes[here], placed[here, 2]
            for k in range(begin, end):
                j, back = ends[i, k] // 4, ends[i, k] % 4
                if j < 0 or seen[j] or (is_apart[j] and not closing[i, k]):
                    continue
                if not (closing[i, k] or is_waiting):
                    waiting[last, 0], waiting[last, 1] = here, k
                    last += 1
                    continue
                seen[j] = True
                direction = (k + turn) % 4
                nodes[count], origin[count] = j, seed
                placed[count, 0] = placed[here, 0] + directions[direction, 0]
                placed[count, 1] = placed[here, 1] + directions[direction, 1]
                placed[count, 2] = (direction + 2 - back) % 4
                count += 1
    return count


def walk_graph(
    ends: Int32Array,
    closing: BoolArray,
    is_apart: BoolArray,
    seeds: IntArray,
    directions: IntArray,
) -> tuple[Int32Array, Int32Array, Int32Array]:
    """Compute ``lattices.neighbour_graph._walk_graph``."""
    n = len(ends)
    nodes, origin, placed = np.empty(n, np.int32), np.empty(n, np.int32), np.empty((n, 3), np.int32)
    count = _walk_graph(ends, closing, is_apart, seeds, directions, nodes, origin, placed)
    return nodes[:count], origin[:count], placed[:count]
