"""Links between junctions and the walk along them, compiled: the loops of ``corners.links``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.kernels.common import bilinear, compiled
from calibgui.engine.opencv import Image32
from calibgui.engine.types import Array, IntArray


@compiled
def _towards(slots, du, dv):  # type: ignore[no-untyped-def]
    """The slot that points most along (du, dv), and the cosine between them."""
    best, cosine = 0, -2.0
    for k in range(4):
        c = slots[k, 0] * du + slots[k, 1] * dv
        if c > cosine:
            best, cosine = k, c
    return best, cosine


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
def _nearest(g, uv, slots, contrast, some, near, places, limits, neighbour, back):  # type: ignore[no-untyped-def]
    along, parallel, weakest = limits
    for m in range(some.shape[0]):
        i = some[m]
        for j in near[m]:
            du, dv = uv[j, 0] - uv[i, 0], uv[j, 1] - uv[i, 1]
            distance = np.sqrt(du * du + dv * dv)
            if distance == 0:
                continue
            du, dv = du / distance, dv / distance
            k, cosine = _towards(slots[i], du, dv)
            if neighbour[m, k] >= 0 or cosine <= along:
                continue
            k_back, cosine = _towards(slots[j], -du, -dv)
            if cosine <= along or (k + k_back) % 2 == 0:
                continue
            one, other = slots[i, (k + 1) % 4], slots[j, (k_back + 3) % 4]
            if one[0] * other[0] + one[1] * other[1] <= parallel:
                continue
            sign = 1.0 if k % 2 == 1 else -1.0
            step = _least_step(g, uv[i], du, dv, distance, places, sign)
            if step > weakest * min(contrast[i], contrast[j]):
                neighbour[m, k], back[m, k] = j, k_back


def nearest(
    g: Image32,
    uv: Array,
    slots: Array,
    contrast: Array,
    some: IntArray,
    near: IntArray,
    places: Array,
    limits: tuple[float, float, float],
) -> tuple[IntArray, IntArray]:
    """``links._nearest``: the nearest neighbour (m, 4) at each slot that an edge leads to, -1
    where none, and the slot (m, 4) at which it looks back.

    Args:
        g: (h, w) grey levels.
        uv: (n, 2) junctions, px.
        slots: (n, 4, 2) unit vectors along the edges that leave them.
        contrast: (n,) grey levels.
        some: (m,) the junctions whose neighbours are looked for.
        near: (m, k) the other junctions nearest to each of them, nearest first.
        places: where on the way to a neighbour an edge must lie, over the distance.
        limits: least cosine between an edge and the way to the neighbour, and between their
            crossing edges; least step across the way, over the weaker one's contrast.
    """
    neighbour, back = np.full((len(some), 4), -1), np.full((len(some), 4), -1)
    _nearest(g, uv, slots, contrast, some, near, places, limits, neighbour, back)
    return neighbour, back


@compiled
def _walk(neighbour, back, seeds, steps, nodes, part, placed):  # type: ignore[no-untyped-def]
    seen = np.zeros(neighbour.shape[0], dtype=np.bool_)
    count, parts = 0, 0
    for seed in seeds:
        if seen[seed]:
            continue
        seen[seed] = True
        head = count
        nodes[count], part[count], placed[count] = seed, parts, 0
        count += 1
        while head < count:
            i, turn = nodes[head], placed[head, 2]
            for k in range(4):
                j = neighbour[i, k]
                if j < 0 or seen[j]:
                    continue
                seen[j] = True
                direction = (k + turn) % 4
                nodes[count], part[count] = j, parts
                placed[count, 0] = placed[head, 0] + steps[direction, 0]
                placed[count, 1] = placed[head, 1] + steps[direction, 1]
                placed[count, 2] = (direction + 2 - back[i, k]) % 4
                count += 1
            head += 1
        parts += 1
    return count


def walk(
    neighbour: IntArray, back: IntArray, seeds: IntArray, steps: IntArray
) -> tuple[IntArray, IntArray, IntArray]:
    """``links._reached``: nodes (m,) in the order of a walk from each of the `seeds` not reached
    before, the part (m,) that each belongs to, and its row, column and turn (m, 3)."""
    n = len(neighbour)
    nodes, part, placed = np.empty(n, np.int64), np.empty(n, np.int64), np.empty((n, 3), np.int64)
    count = _walk(neighbour, back, seeds, steps, nodes, part, placed)
    return nodes[:count], part[:count], placed[:count]
