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
from collections.abc import Iterator
from itertools import islice

import numpy as np
import scipy

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, BoolArray, GreyImage, Int32Array, IntArray
from calibgui.engine.detection.checkerboard.x_junctions import (
    CROSSED,
    Junctions,
    Saddles,
    Tolerance,
)
from calibgui.engine.detection.lattice import STEPS, Lattice, trim
from calibgui.engine.images.sampling import sample

_NEIGHBOURS = 12
"""Junctions around one that its edges may lead to, the nearest."""
_ON_WAY = np.array([0.3, 0.5, 0.7])
"""Where on the way to a neighbour the edge must show."""
_SPARSE, _FEW = 3, 256
"""Cells of a lattice for each of its junctions, and beyond these, from which it is no board's."""
_STEP = 0.25
"""Least step across the edge between two neighbours over the weaker one's contrast."""


def find_lattices(
    saddles: Saddles, junctions: Junctions, most: int, tolerance: Tolerance = CROSSED
) -> list[Lattice]:
    """Lattices of at least one full cell in one image, largest first.

    At most so many: those of which most hangs together.
    """
    if len(junctions) < 4:
        return []
    ends = _link(saddles.smooth, junctions, tolerance)
    arranged = (_arrange(junctions.uv, *part) for part in _parts(ends))
    lattices = islice((lattice for lattice in arranged if lattice is not None), most)
    return sorted(lattices, key=len, reverse=True)


def _link(smooth: GreyImage, junctions: Junctions, tolerance: Tolerance) -> Int32Array:
    """(n, 4) where the edge that leaves each slot ends: 4 j + k at the slot k of junction j, which
    looks back; -1 where it ends at none."""
    ends = (_compiled_nearest if kernels.COMPILED else _nearest)(smooth, junctions, tolerance)
    slots = np.arange(ends.size, dtype=np.int32).reshape(ends.shape)
    ends[ends.ravel()[ends] != slots] = -1
    return ends


def _along(junctions: Junctions) -> Array:
    """(n, 2, 2) unit vectors along the edges that leave junctions at slots 0 and 1."""
    return np.stack([np.cos(junctions.edges), np.sin(junctions.edges)], axis=-1)


def _nearest(smooth: GreyImage, junctions: Junctions, tolerance: Tolerance) -> Int32Array:
    """`_link`, whether or not the other junction looks back."""
    n, along = len(junctions), _along(junctions)
    slots = np.concatenate([along, -along], axis=1)
    tree = scipy.spatial.cKDTree(junctions.uv)
    ranks = np.arange(2, min(_NEIGHBOURS, n - 1) + 2)  # the first is the junction itself
    other = np.asarray(tree.query(junctions.uv, ranks)[1], dtype=np.int64).ravel()
    me = np.repeat(np.arange(n), len(ranks))
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
        (here.max(axis=1) > np.cos(tolerance.along))
        & (there.max(axis=1) > np.cos(tolerance.along))
        & ((k + k_back) % 2 == 1)
        & (crossing > np.cos(tolerance.parallel))
    )
    me, other, distance, d, k, k_back = (x[good] for x in (me, other, distance, d, k, k_back))
    # A real edge lies between: dark on the side that the slots' numbers say.
    way = _ON_WAY * distance[:, None]
    normal = np.clip(0.15 * distance, 1.0, None)[:, None] * np.column_stack([-d[:, 1], d[:, 0]])
    on = junctions.uv[me][:, None] + way[..., None] * d[:, None]
    step = sample(smooth, on + normal[:, None]) - sample(smooth, on - normal[:, None])
    step *= np.where(k % 2 == 1, 1.0, -1.0)[:, None]
    weaker = np.minimum(junctions.contrast[me], junctions.contrast[other])
    good = step.min(axis=1) > _STEP * weaker
    me, other, distance, k, k_back = (x[good] for x in (me, other, distance, k, k_back))
    ends = np.full((n, 4), -1, dtype=np.int32)
    order = np.argsort(-distance, kind="stable")  # the nearest is written last
    ends[me[order], k[order]] = (4 * other + k_back)[order]
    return ends


def _compiled_nearest(smooth: GreyImage, junctions: Junctions, tolerance: Tolerance) -> Int32Array:
    """`_nearest` by the compiled kernel."""
    from calibgui.engine.kernels import neighbour_graph

    points = junctions.uv, _along(junctions), junctions.contrast
    limits = float(np.cos(tolerance.along)), float(np.cos(tolerance.parallel)), _STEP
    return neighbour_graph.nearest(smooth, *points, _NEIGHBOURS, _ON_WAY, limits)


def _parts(ends: Int32Array) -> Iterator[tuple[Int32Array, Int32Array]]:
    """Junctions (m,) and their rows, columns and turns (m, 3) of each connected part with a full
    cell's worth, largest first, without those that their links contradict more often than not."""
    links = np.sum(ends >= 0, axis=1)
    order = np.argsort(-links, kind="stable")
    seeds = order[links[order] > 0]
    if not len(seeds):
        return
    nodes, seed, placed = (_compiled_walk if kernels.COMPILED else _walk)(ends, seeds)
    agree = (_compiled_agreeing if kernels.COMPILED else _agreeing)(ends, nodes, placed)
    begin = np.flatnonzero(np.diff(seed, prepend=-1))
    size = np.diff(begin, append=len(seed))
    for k in np.argsort(-size, kind="stable"):
        if size[k] < 4:
            return
        part = begin[k] + np.flatnonzero(agree[begin[k] : begin[k] + size[k]])
        yield nodes[part], placed[part]


def _walk(ends: Int32Array, seeds: IntArray) -> tuple[Int32Array, Int32Array, Int32Array]:
    """Junctions (m,) in the order of walks from each of the `seeds` not reached before, the seed
    (m,) of each, and their rows, columns and turns (m, 3)."""
    leads = ends.tolist()
    place: dict[int, tuple[int, int, int]] = {}
    origin: list[int] = []
    for seed in seeds.tolist():
        if seed in place:
            continue
        place[seed] = (0, 0, 0)
        queue = deque([seed])
        while queue:
            i = queue.popleft()
            origin.append(seed)
            row, col, turn = place[i]
            for k, end in enumerate(leads[i]):
                j, back = divmod(end, 4)
                if j >= 0 and j not in place:
                    direction = (k + turn) % 4
                    dr, dc = STEPS[direction].tolist()
                    place[j] = (row + dr, col + dc, (direction + 2 - back) % 4)
                    queue.append(j)
    nodes, placed = list(place), list(place.values())
    return np.array(nodes, np.int32), np.array(origin, np.int32), np.array(placed, np.int32)


def _compiled_walk(ends: Int32Array, seeds: IntArray) -> tuple[Int32Array, Int32Array, Int32Array]:
    """`_walk` by the compiled kernel."""
    from calibgui.engine.kernels import neighbour_graph

    return neighbour_graph.walk(ends, seeds, STEPS)


def _agreeing(ends: Int32Array, nodes: Int32Array, placed: Int32Array) -> BoolArray:
    """(m,) which of the junctions `nodes` (m,) most of their links place where they are."""
    where = np.zeros(len(ends), dtype=np.int64)
    where[nodes] = np.arange(len(nodes))
    leads = ends[nodes]
    there = placed[where[leads // 4]]
    direction = (np.arange(4) + placed[:, 2:]) % 4
    agree = np.all(there[..., :2] == placed[:, None, :2] + STEPS[direction], axis=2)
    agree &= there[..., 2] == (direction + 2 - leads) % 4
    return np.asarray(np.sum(np.where(agree, 1, -1), axis=1, where=leads >= 0) > 0)


def _compiled_agreeing(ends: Int32Array, nodes: Int32Array, placed: Int32Array) -> BoolArray:
    """`_agreeing` by the compiled kernel."""
    from calibgui.engine.kernels import neighbour_graph

    return neighbour_graph.agreeing(ends, nodes, placed, STEPS)


def _arrange(uv: Array, nodes: Int32Array, placed: Int32Array) -> Lattice | None:
    """The lattice of the placed junctions, without strays."""
    if len(nodes) < 4:
        return None
    placed[:, :2] -= placed[:, :2].min(axis=0)
    rows, cols = placed[:, :2].max(axis=0) + 1
    if rows * cols > _SPARSE * len(nodes) + _FEW:
        return None
    return trim(_laid_out(uv[nodes], placed, (rows, cols)))


def _laid_out(uv: Array, placed: Int32Array, shape: tuple[int, int]) -> Lattice:
    """Junctions `uv` (m, 2) by their rows, columns and turns (m, 3), of doubles the first."""
    rows, cols, _ = placed.T
    _, first = np.unique(rows * shape[1] + cols, return_index=True)
    dense = np.full((*shape, 2), np.nan)
    dense[rows[first], cols[first]] = uv[first]
    # At an even turn slot 0 points along a row, and the squares (+, +) and (-, -) are dark.
    return Lattice(dense, dark=bool(np.mean(placed.sum(axis=1) % 2) < 0.5))
