"""From X-junctions to lattices: links and walk.

Number the four edges that leave a junction 0 (angle A), 1 (B), 2 (A + pi), 3 (B + pi), in the
sense from u to v. Two neighbours are joined by an edge that leaves one at slot k and the other
at slot k', and as A and B are exchanged between neighbours k + k' is odd.

Number the directions on the board 0 (columns grow), 1 (rows grow), 2, 3 alike. A junction is
placed by its cell and its turn rho: slot k points in the board's direction k + rho (mod 4). The
neighbour then has turn rho' with k' + rho' = k + rho + 2 (mod 4). A walk along the links thus
numbers everything that hangs together, right-handed in the image and whatever the distortion,
because only neighbours are ever compared.
"""

from __future__ import annotations

from collections import deque
from itertools import islice

import numpy as np
import scipy

from calibgui.engine import kernels
from calibgui.engine.corners.junctions import Junctions, Saddles
from calibgui.engine.corners.lattice import STEPS, Lattice, trim
from calibgui.engine.imaging.sampling import sample
from calibgui.engine.opencv import Image32
from calibgui.engine.types import Array, IntArray

_NEIGHBOURS = 12
_PORTION = 500
"""Junctions whose nearest ones are looked up at a time."""
_ALONG = float(np.cos(np.radians(20.0)))
"""How closely an edge must point to the neighbour that it leads to."""
_PARALLEL = float(np.cos(np.radians(25.0)))
"""How closely the crossing edges of two neighbours must agree."""
_ON_WAY = np.array([0.3, 0.5, 0.7])
"""Where on the way to a neighbour the edge must show."""
_SPARSE, _FEW = 4, 256
"""Cells of a lattice for each of its junctions, and beyond these, from which it is no board's."""
_STEP = 0.25
"""Least step across the edge between two neighbours over the weaker one's contrast."""


def find_lattices(saddles: Saddles, junctions: Junctions, most: int) -> list[Lattice]:
    """Lattices of at least one full cell in one image, largest first.

    At most so many: those of which most hangs together.
    """
    if len(junctions) < 4:
        return []
    neighbour, back = _link(saddles.smooth, junctions)
    arranged = (
        _arrange(junctions.uv, *_agreeing(nodes, placed, neighbour, back))
        for nodes, placed in _walk(neighbour, back)
    )
    lattices = islice((lattice for lattice in arranged if lattice is not None), most)
    return sorted(lattices, key=len, reverse=True)


def _link(smooth: Image32, junctions: Junctions) -> tuple[IntArray, IntArray]:
    """Neighbour (n, 4) at each slot, -1 where none, and the slot (n, 4) at which it looks back."""
    n = len(junctions)
    ranks = np.arange(2, min(_NEIGHBOURS, n - 1) + 2)  # the first is the junction itself
    tree = scipy.spatial.cKDTree(junctions.uv)
    slots = _slots(junctions)
    search = _compiled_nearest if kernels.COMPILED else _nearest
    neighbour, back = np.full((n, 4), -1), np.full((n, 4), -1)
    for begin in range(0, n, _PORTION):
        some = np.arange(begin, min(begin + _PORTION, n))
        near = np.asarray(tree.query(junctions.uv[some], ranks)[1], dtype=np.int64)
        neighbour[some], back[some] = search(smooth, junctions, slots, some, near)
    one_way = (neighbour < 0) | (neighbour[neighbour, back] != np.arange(n)[:, None])
    neighbour[one_way] = back[one_way] = -1
    return neighbour, back


def _slots(junctions: Junctions) -> Array:
    """(n, 4, 2) unit vectors along the edges that leave junctions."""
    angle = junctions.edges[:, [0, 1, 0, 1]] + np.array([0, 0, np.pi, np.pi])
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _nearest(
    smooth: Image32, junctions: Junctions, slots: Array, some: IntArray, near: IntArray
) -> tuple[IntArray, IntArray]:
    """`_link` of `some` (m,) consecutive junctions, mutual or not, from all edges' directions
    `slots` (n, 4, 2) and the junctions `near` (m, k) each, nearest first."""
    me, other = np.repeat(some, near.shape[1]), near.ravel()
    d = junctions.uv[other] - junctions.uv[me]
    distance = np.linalg.norm(d, axis=1)
    apart = distance > 0
    me, other, distance = me[apart], other[apart], distance[apart]
    d = d[apart] / distance[:, None]
    here = np.einsum("mkd,md->mk", slots[me], d)
    there = -np.einsum("mkd,md->mk", slots[other], d)
    k, k_back = np.argmax(here, axis=1), np.argmax(there, axis=1)
    crossing = np.sum(slots[me, (k + 1) % 4] * slots[other, (k_back + 3) % 4], axis=1)
    good = (
        (here.max(axis=1) > _ALONG)
        & (there.max(axis=1) > _ALONG)
        & ((k + k_back) % 2 == 1)
        & (crossing > _PARALLEL)
    )
    me, other, distance, d, k, k_back = (x[good] for x in (me, other, distance, d, k, k_back))
    # A real edge lies between: dark on the side that the slots' numbers say.
    along = _ON_WAY * distance[:, None]
    normal = np.clip(0.15 * distance, 1.0, None)[:, None] * np.column_stack([-d[:, 1], d[:, 0]])
    on = junctions.uv[me][:, None] + along[..., None] * d[:, None]
    step = sample(smooth, on + normal[:, None]) - sample(smooth, on - normal[:, None])
    step *= np.where(k % 2 == 1, 1.0, -1.0)[:, None]
    weaker = np.minimum(junctions.contrast[me], junctions.contrast[other])
    good = step.min(axis=1) > _STEP * weaker
    me, other, distance, k, k_back = (x[good] for x in (me, other, distance, k, k_back))
    neighbour, back = np.full((len(some), 4), -1), np.full((len(some), 4), -1)
    order = np.argsort(-distance, kind="stable")  # the nearest is written last
    mine = me[order] - some[0]
    neighbour[mine, k[order]] = other[order]
    back[mine, k[order]] = k_back[order]
    return neighbour, back


def _compiled_nearest(
    smooth: Image32, junctions: Junctions, slots: Array, some: IntArray, near: IntArray
) -> tuple[IntArray, IntArray]:
    """`_nearest` by the compiled kernel."""
    from calibgui.engine.kernels import links

    limits = _ALONG, _PARALLEL, _STEP
    points = junctions.uv, slots, junctions.contrast
    return links.nearest(smooth, *points, some, near, _ON_WAY, limits)


def _walk(neighbour: IntArray, back: IntArray) -> list[tuple[IntArray, IntArray]]:
    """Nodes (m,) and their rows, columns and turns (m, 3) of each connected part with a full cell's
    worth, largest first."""
    links = np.sum(neighbour >= 0, axis=1)
    order = np.argsort(-links, kind="stable")
    seeds = order[links[order] > 0]
    if not len(seeds):
        return []
    walked = (_compiled_reached if kernels.COMPILED else _reached)(neighbour, back, seeds)
    ends = np.flatnonzero(np.diff(walked[1])) + 1
    parts = zip(*(np.split(x, ends) for x in (walked[0], walked[2])), strict=True)
    large = (part for part in parts if len(part[0]) >= 4)
    return sorted(large, key=lambda part: len(part[0]), reverse=True)


def _reached(
    neighbour: IntArray, back: IntArray, seeds: IntArray
) -> tuple[IntArray, IntArray, IntArray]:
    """Nodes (m,) in the order of walks from each of the `seeds` not reached before, the walk (m,)
    that reached them, and their rows, columns and turns (m, 3)."""
    to, look = neighbour.tolist(), back.tolist()
    place: dict[int, tuple[int, int, int]] = {}
    walk: list[int] = []
    for seed in seeds.tolist():
        if seed in place:
            continue
        place[seed] = (0, 0, 0)
        queue = deque([seed])
        while queue:
            i = queue.popleft()
            walk.append(seed)
            row, col, turn = place[i]
            for k, j in enumerate(to[i]):
                if j >= 0 and j not in place:
                    direction = (k + turn) % 4
                    dr, dc = STEPS[direction].tolist()
                    place[j] = (row + dr, col + dc, (direction + 2 - look[i][k]) % 4)
                    queue.append(j)
    nodes, placed = np.array(list(place)), np.array(list(place.values()))
    return nodes, np.array(walk), placed


def _compiled_reached(
    neighbour: IntArray, back: IntArray, seeds: IntArray
) -> tuple[IntArray, IntArray, IntArray]:
    """`_reached` by the compiled kernel."""
    from calibgui.engine.kernels import links

    return links.walk(neighbour, back, seeds, STEPS)


def _agreeing(
    nodes: IntArray, placed: IntArray, neighbour: IntArray, back: IntArray
) -> tuple[IntArray, IntArray, IntArray]:
    """Drop the nodes that their links contradict more often than not."""
    where = np.full(len(neighbour), -1)
    where[nodes] = np.arange(len(nodes))
    to = where[neighbour[nodes]]
    linked = (neighbour[nodes] >= 0) & (to >= 0)
    direction = (np.arange(4) + placed[:, 2:]) % 4
    target = placed[:, None, :2] + STEPS[direction]
    turn = (direction + 2 - back[nodes]) % 4
    agree = np.all(placed[to][..., :2] == target, axis=2) & (placed[to][..., 2] == turn)
    votes = np.sum(np.where(linked, np.where(agree, 1, -1), 0), axis=1)
    keep = votes > 0
    return nodes[keep], placed[keep, :2], placed[keep, 2]


def _arrange(uv: Array, nodes: IntArray, cells: IntArray, turns: IntArray) -> Lattice | None:
    """The dense lattice of the placed nodes, without doubles and strays."""
    if len(nodes) < 4:
        return None
    cells = cells - cells.min(axis=0)
    rows, cols = cells.max(axis=0) + 1
    if rows * cols > _SPARSE * len(nodes) + _FEW:
        return None
    _, first = np.unique(cells @ np.array([cols, 1]), return_index=True)
    dense = np.full((rows, cols, 2), np.nan)
    dense[cells[first, 0], cells[first, 1]] = uv[nodes[first]]
    # At an even turn slot 0 points along a row, and the squares (+, +) and (-, -) are dark.
    votes = (turns + cells.sum(axis=1)) % 2
    return trim(Lattice(dense, dark=bool(np.mean(votes) < 0.5)))
