"""Links between junctions and the walk along them, compiled: the loops of ``corners.links``.

The junctions nearest to one are looked up in a grid of square cells: cell by cell in rings around
its own, until no cell beyond can hold a nearer one.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, Int32Array, IntArray
from calibgui.engine.kernels.common import bilinear, compiled

_IN_CELL = 2.0
"""Junctions in a cell, on average."""


@compiled
def _sort(uv, lowest, side, start, member):  # type: ignore[no-untyped-def]
    """Fill member with the points by their cell (r, c), each from start[r, c] to start[r, c + 1],
    which leaves the last of each row of start without a cell."""
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


def cells(uv: Array) -> tuple[Array, float, Int32Array, Int32Array]:
    """Points (n, 2) sorted into square cells.

    Returns:
        The cells' origin (2,) and side, px; (rows, cols + 1) where the points of each begin, and
        those of the next, in the numbers (n,) of the points by their cell.
    """
    lowest, highest = uv.min(axis=0), uv.max(axis=0)
    extent = np.maximum(highest - lowest, 1.0)
    side = float(np.sqrt(_IN_CELL * extent.prod() / len(uv)))
    cols, rows = (extent / side).astype(np.int64) + 1
    start, member = np.zeros((rows, cols + 1), np.int32), np.empty(len(uv), np.int32)
    _sort(uv, lowest, side, start, member)
    return lowest, side, start, member


@compiled
def _add(j, squared, near, distance, count):  # type: ignore[no-untyped-def]
    """Insert j into the count nearest so far, in order; how many there are then."""
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


@compiled
def _around(uv, i, lowest, side, start, member, near, distance):  # type: ignore[no-untyped-def]
    """Fill near with the points nearest to point i, nearest first; their number."""
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
                            count = _add(j, du * du + dv * dv, near, distance, count)
        inside = min(
            min(u - col * side, (col + 1) * side - u), min(v - row * side, (row + 1) * side - v)
        )
        if count == most and distance[most - 1] <= (inside + ring * side) ** 2:
            break
    return count


@compiled
def _towards(along, du, dv):  # type: ignore[no-untyped-def]
    """The slot that points most along (du, dv), and the cosine between them."""
    a = along[0, 0] * du + along[0, 1] * dv
    b = along[1, 0] * du + along[1, 1] * dv
    if abs(a) >= abs(b):
        return (0 if a > 0 else 2), abs(a)
    return (1 if b > 0 else 3), abs(b)


@compiled
def _cosine(along, k, other, k_other):  # type: ignore[no-untyped-def]
    """Cosine between slot k of one junction and slot k_other of another."""
    one, two = along[k % 2], other[k_other % 2]
    cosine = one[0] * two[0] + one[1] * two[1]
    return cosine if k // 2 == k_other // 2 else -cosine


@compiled
def _least_step(g, here, du, dv, distance, places, sign):  # type: ignore[no-untyped-def]
    """Least step of the sign across the line from here along (du, dv)."""
    aside = max(0.15 * distance, 1.0)
    least = np.inf
    for s in places:
        u, v = here[0] + s * distance * du, here[1] + s * distance * dv
        step = bilinear(g, u - aside * dv, v + aside * du)
        step -= bilinear(g, u + aside * dv, v - aside * du)
        least = min(least, sign * step)
    return least


@compiled
def _nearest(g, uv, along, contrast, lowest, side, start, member, most, places, limits, ends):  # type: ignore[no-untyped-def]
    straight, parallel, weakest = limits
    near, away = np.empty(most, dtype=np.int64), np.empty(most)
    for i in range(uv.shape[0]):
        count = _around(uv, i, lowest, side, start, member, near, away)
        for m in range(count):
            j, distance = near[m], np.sqrt(away[m])
            if distance == 0:
                continue
            du, dv = (uv[j, 0] - uv[i, 0]) / distance, (uv[j, 1] - uv[i, 1]) / distance
            k, cosine = _towards(along[i], du, dv)
            if ends[i, k] >= 0 or cosine <= straight:
                continue
            k_back, cosine = _towards(along[j], -du, -dv)
            if cosine <= straight or (k + k_back) % 2 == 0:
                continue
            if _cosine(along[i], (k + 1) % 4, along[j], (k_back + 3) % 4) <= parallel:
                continue
            sign = 1.0 if k % 2 == 1 else -1.0
            step = _least_step(g, uv[i], du, dv, distance, places, sign)
            if step > weakest * min(contrast[i], contrast[j]):
                ends[i, k] = 4 * j + k_back


def nearest(
    g: GreyImage,
    uv: Array,
    along: Array,
    contrast: Array,
    most: int,
    places: Array,
    limits: tuple[float, float, float],
) -> Int32Array:
    """``links._nearest``: at each slot (n, 4) the slot of the nearest neighbour that an edge leads
    to, -1 where there is none.

    Args:
        g: (h, w) grey levels.
        uv: (n, 2) junctions, px.
        along: (n, 2, 2) unit vectors along the edges that leave them at slots 0 and 1.
        contrast: (n,) grey levels.
        most: how many of the others, the nearest, an edge may lead to.
        places: where on the way to a neighbour an edge must lie, over the distance.
        limits: least cosine between an edge and the way to the neighbour, and between their
            crossing edges; least step across the way, over the weaker one's contrast.
    """
    ends = np.full((len(uv), 4), -1, dtype=np.int32)
    _nearest(g, uv, along, contrast, *cells(uv), min(most, len(uv) - 1), places, limits, ends)
    return ends


@compiled
def _walk(ends, seeds, steps, nodes, origin, placed):  # type: ignore[no-untyped-def]
    seen = np.zeros(ends.shape[0], dtype=np.bool_)
    count = 0
    for seed in seeds:
        if seen[seed]:
            continue
        seen[seed] = True
        head = count
        nodes[count], origin[count], placed[count] = seed, seed, 0
        count += 1
        while head < count:
            i, turn = nodes[head], placed[head, 2]
            for k in range(4):
                j, back = ends[i, k] // 4, ends[i, k] % 4
                if j < 0 or seen[j]:
                    continue
                seen[j] = True
                direction = (k + turn) % 4
                nodes[count], origin[count] = j, seed
                placed[count, 0] = placed[head, 0] + steps[direction, 0]
                placed[count, 1] = placed[head, 1] + steps[direction, 1]
                placed[count, 2] = (direction + 2 - back) % 4
                count += 1
            head += 1
    return count


def walk(
    ends: Int32Array, seeds: IntArray, steps: IntArray
) -> tuple[Int32Array, Int32Array, Int32Array]:
    """``links._walk``: junctions (m,) in the order of a walk from each of the `seeds` not reached
    before, the seed (m,) of each, and their rows, columns and turns (m, 3)."""
    n = len(ends)
    nodes, origin, placed = np.empty(n, np.int32), np.empty(n, np.int32), np.empty((n, 3), np.int32)
    count = _walk(ends, seeds, steps, nodes, origin, placed)
    return nodes[:count], origin[:count], placed[:count]


@compiled
def _agreeing(ends, nodes, placed, steps, agree):  # type: ignore[no-untyped-def]
    where = np.empty(ends.shape[0], dtype=np.int32)
    for m in range(nodes.shape[0]):
        where[nodes[m]] = m
    for m in range(nodes.shape[0]):
        row, col, turn = placed[m]
        votes = 0
        for k in range(4):
            end = ends[nodes[m], k]
            if end < 0:
                continue
            there = placed[where[end // 4]]
            direction = (k + turn) % 4
            right = there[0] == row + steps[direction, 0] and there[1] == col + steps[direction, 1]
            right &= there[2] == (direction + 2 - end) % 4
            votes += 1 if right else -1
        agree[m] = votes > 0


def agreeing(ends: Int32Array, nodes: Int32Array, placed: Int32Array, steps: IntArray) -> BoolArray:
    """``links._agreeing``: (m,) which of the junctions `nodes` (m,) most of their links place where
    they are, `placed` (m, 3)."""
    agree = np.empty(len(nodes), dtype=np.bool_)
    _agreeing(ends, nodes, placed, steps, agree)
    return agree
