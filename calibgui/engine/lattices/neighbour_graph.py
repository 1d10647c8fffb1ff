"""From X-junctions to lattices: a graph of neighbours, and a walk along it.

A lens bends the rows and columns of a board, so no line through distant junctions can be trusted;
but from one corner to the next an edge always leads. The junctions that such edges join form a
graph, and its connected components, laid out in rows and columns, are the lattices.

Number the four edges that leave a junction 0 (angle A), 1 (B), 2 (A + pi), 3 (B + pi), in the
sense from u to v. Two neighbours are joined by an edge that leaves one at slot k and the other
at slot k', and as A and B are exchanged between neighbours k + k' is odd.

Number the directions on the board 0 (columns grow), 1 (rows grow), 2, 3 alike. A junction is
placed by its cell and its turn rho: slot k points in the board's direction k + rho (mod 4). The
neighbour then has turn rho' with k' + rho' = k + rho + 2 (mod 4). A walk along the edges thus
numbers everything that hangs together, right-handed in the image and whatever the distortion,
because only neighbours are ever compared. It goes first where the edges close cells of four, as
all over a board: an edge that closes none may lead astray, into what is seen in a drop on the lens
or in a reflection, and from there back to another line of the board, or into another board behind
it. So it is followed last, and not to where many cells hang together: what belongs together there
is joined when the lattices grow (`lattice_growth`).

An array `ends` (n, 4) holds the graph: ``ends[i, k] = 4 j + k'`` where slot k of junction i leads
to slot k' of junction j, and -1 where it leads to none.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from itertools import islice

import numpy as np
import scipy

from calibgui.engine import kernels, opencv
from calibgui.engine.arrays import (
    Array,
    BoolArray,
    GreyImage,
    Int32Array,
    IntArray,
    compute_lengths,
)
from calibgui.engine.features.lattice import DIRECTIONS, Lattice, crop_lattice, trim_lattice
from calibgui.engine.images.sampling import sample_image
from calibgui.engine.lattices.x_junctions import (
    CROSSING_TOLERANCE,
    Junctions,
    JunctionTolerance,
    Saddles,
)

_MAX_NEIGHBOURS = 12
"""Number of junctions around one, the nearest, that its edges may lead to."""
_MIN_EDGE_STEP = 0.25
"""Least step across the edge between two neighbours, over the weaker one's contrast."""
_MAX_JOINED_BLOCK = 8
"""Greatest number of junctions that hang together by edges that close cells to which one that
closes none may lead."""
_MAX_CELLS_PER_JUNCTION = 3
"""Greatest number of a lattice's cells per junction, beyond `_MAX_SPARE_CELLS` ..."""
_MAX_SPARE_CELLS = 256
"""... from which on it is too sparse for a board: this bounds the memory that it takes."""
_EDGE_SAMPLES = np.array([0.3, 0.5, 0.7])
"""Places on the line to a neighbour at which the edge must show, over the distance."""
_EDGE_SAMPLES_BESIDE_MARKS = np.array([0.2, 0.8])
"""Such places where something is printed on the middle of the edges."""
_SIDE_OFFSET, _MIN_SIDE_OFFSET = 0.15, 1.0
"""Distance of the samples on either side of an edge from it, over the distance of the neighbours,
and the least such distance, px."""
_MIN_JUNCTIONS = 4
"""Number of junctions of the smallest lattice, one cell."""


def find_lattices(
    saddles: Saddles,
    junctions: Junctions,
    max_count: int,
    tolerance: JunctionTolerance = CROSSING_TOLERANCE,
    bare_reach: float = 0.5,
) -> list[Lattice]:
    """Find the lattices of at least one full cell in one image.

    Args:
        saddles: saddle points, of which only the smoothed image is used.
        junctions: X-junctions among them.
        max_count: greatest number of lattices; those of the largest components are kept.
        tolerance: angles tolerated between an edge and the neighbours that it joins.
        bare_reach: how far from the corners nothing is printed on the edges, squares.

    Returns:
        The lattices, that of the most corners first.
    """
    if len(junctions) < _MIN_JUNCTIONS:
        return []
    places = _EDGE_SAMPLES if bare_reach >= 0.5 else _EDGE_SAMPLES_BESIDE_MARKS
    ends = _link_neighbours(saddles.smooth, junctions, tolerance, places)
    parts = _split_components(ends, _find_closing_edges(ends))
    arranged = (_arrange_lattices(junctions.uv, *part) for part in parts)
    lattices = islice((lattice for lattices in arranged for lattice in lattices), max_count)
    return sorted(lattices, key=len, reverse=True)


def _link_neighbours(
    smooth: GreyImage, junctions: Junctions, tolerance: JunctionTolerance, places: Array
) -> Int32Array:
    """Return the graph's `ends` (n, 4), with the edges that both of their junctions choose and that
    show at `places` (k,), see `_choose_neighbours`."""
    ends = _choose_neighbours(
        smooth,
        junctions.uv,
        _compute_directions(junctions),
        junctions.contrast,
        _MAX_NEIGHBOURS,
        places,
        (
            float(np.cos(tolerance.along)),
            float(np.cos(tolerance.parallel)),
            _MIN_EDGE_STEP,
        ),
    )
    slots = np.arange(ends.size, dtype=np.int32).reshape(ends.shape)
    ends[ends.ravel()[ends] != slots] = -1
    return ends


def _compute_directions(junctions: Junctions) -> Array:
    """Return (n, 2, 2) unit vectors along the edges that leave junctions at slots 0 and 1."""
    return np.stack([np.cos(junctions.edges), np.sin(junctions.edges)], axis=-1)


@kernels.with_kernel("neighbour_graph", "choose_neighbours")
def _choose_neighbours(
    smooth: GreyImage,
    uv: Array,
    along: Array,
    contrast: Array,
    max_neighbours: int,
    places: Array,
    limits: tuple[float, float, float],
) -> Int32Array:
    """Choose the nearest neighbour that an edge leads to, for each slot of each junction.

    Args:
        smooth: (h, w) grey levels.
        uv: (n, 2) junctions, px.
        along: (n, 2, 2) unit vectors along the edges that leave them at slots 0 and 1.
        contrast: (n,) grey levels.
        max_neighbours: number of other junctions, the nearest, that an edge may lead to.
        places: (k,) places on the line to a neighbour at which the edge must show, over the
            distance.
        limits: least cosine between an edge and the line to the neighbour, and between the
            crossing edges of the two; least step across the line, over the weaker one's contrast.

    Returns:
        The graph's `ends` (n, 4), in which a neighbour need not have chosen the same edge.
    """
    min_along, min_parallel, min_edge_step = limits
    n = len(uv)
    slots = np.concatenate([along, -along], axis=1)
    tree = scipy.spatial.cKDTree(uv)
    ranks = np.arange(2, min(max_neighbours, n - 1) + 2)  # the first is the junction itself
    other = np.asarray(tree.query(uv, ranks)[1], dtype=np.int64).ravel()
    me = np.repeat(np.arange(n), len(ranks))
    d = uv[other] - uv[me]
    distance = compute_lengths(d)
    apart = distance > 0
    me, other, distance = me[apart], other[apart], distance[apart]
    d = d[apart] / distance[:, None]
    here = np.einsum("mkd,md->mk", slots[me], d)
    there = -np.einsum("mkd,md->mk", slots[other], d)
    k, k_back = np.argmax(here, axis=1), np.argmax(there, axis=1)
    crossing = np.sum(slots[me, (k + 1) % 4] * slots[other, (k_back + 3) % 4], axis=1)
    good = (
        (here.max(axis=1) > min_along)
        & (there.max(axis=1) > min_along)
        & ((k + k_back) % 2 == 1)
        & (crossing > min_parallel)
    )
    me, other, distance, d, k, k_back = (x[good] for x in (me, other, distance, d, k, k_back))
    # A real edge lies between: dark on the side that the slots' numbers say.
    advance = places * distance[:, None]
    side = np.clip(_SIDE_OFFSET * distance, _MIN_SIDE_OFFSET, None)[:, None]
    normal = side * np.column_stack([-d[:, 1], d[:, 0]])
    on = uv[me][:, None] + advance[..., None] * d[:, None]
    step = sample_image(smooth, on + normal[:, None]) - sample_image(smooth, on - normal[:, None])
    step *= np.where(k % 2 == 1, 1.0, -1.0)[:, None]
    weaker = np.minimum(contrast[me], contrast[other])
    good = step.min(axis=1) > min_edge_step * weaker
    me, other, distance, k, k_back = (x[good] for x in (me, other, distance, k, k_back))
    ends = np.full((n, 4), -1, dtype=np.int32)
    order = np.argsort(-distance, kind="stable")  # the nearest is written last
    ends[me[order], k[order]] = (4 * other + k_back)[order]
    return ends


def _split_components(
    ends: Int32Array, closing: BoolArray
) -> Iterator[tuple[Int32Array, Int32Array]]:
    """Yield the graph's connected components that hold a full cell, largest first.

    Args:
        ends: (n, 4) graph.
        closing: (n, 4) its edges that close cells.

    Yields:
        Junctions (m,), and their rows, columns and turns (m, 3).
    """
    size = _measure_blocks(ends, closing)
    seeds = np.flatnonzero(np.any(ends >= 0, axis=1))
    if not len(seeds):
        return
    seeds = seeds[np.argsort(-size[seeds], kind="stable")]
    nodes, seed, placed = _walk_graph(ends, closing, size > _MAX_JOINED_BLOCK, seeds, DIRECTIONS)
    begin = np.flatnonzero(np.diff(seed, prepend=-1))
    size = np.diff(begin, append=len(seed))
    with_cell = _find_components_with_cell(size, placed)
    for k in with_cell[np.argsort(-size[with_cell], kind="stable")]:
        part = slice(begin[k], begin[k] + size[k])
        yield nodes[part], placed[part]


def _find_components_with_cell(size: IntArray, placed: Int32Array) -> IntArray:
    """Find the components of `size` (k,) junctions that hold a full cell; placed (m, 3) are the
    rows, columns and turns of all, one component after the other."""
    is_large = np.repeat(size >= _MIN_JUNCTIONS, size)  # most of a texture's are smaller
    component = np.repeat(np.arange(len(size)), size)[is_large]
    place = placed[is_large, :2] - placed[:, :2].min(axis=0)
    rows, cols = (int(end) + 2 for end in place.max(axis=0, initial=0))
    key = (component * rows + place[:, 0]) * cols + place[:, 1]
    occupied = np.unique(key)
    is_cell = np.ones(len(key), dtype=np.bool_)
    for step in (1, cols, cols + 1):
        where = np.minimum(np.searchsorted(occupied, key + step), len(occupied) - 1)
        is_cell &= occupied[where] == key + step
    return np.unique(component[is_cell])


@kernels.with_kernel("neighbour_graph", "walk_graph")
def _walk_graph(
    ends: Int32Array,
    closing: BoolArray,
    is_apart: BoolArray,
    seeds: IntArray,
    directions: IntArray,
) -> tuple[Int32Array, Int32Array, Int32Array]:
    """Walk along the graph from each of the seeds that was not reached before, breadth first.

    An edge that closes no cell is followed only once no other is left, and not to every junction.

    Args:
        ends: (n, 4) graph.
        closing: (n, 4) its edges that close cells.
        is_apart: (n,) the junctions to which others do not lead.
        seeds: (k,) junctions to start from.
        directions: (4, 2) steps in row and column of the board's directions.

    Returns:
        Junctions (m,) in the order of the walks, the seed (m,) of each, and their rows, columns and
        turns (m, 3).
    """
    leads, closes = ends.tolist(), closing.tolist()
    place: dict[int, tuple[int, int, int]] = {}
    origin: list[int] = []

    def follow(i: int, k: int) -> None:
        j, back = divmod(leads[i][k], 4)
        if j >= 0 and j not in place and (closes[i][k] or not is_apart[j]):
            row, col, turn = place[i]
            direction = (k + turn) % 4
            dr, dc = directions[direction].tolist()
            place[j] = (row + dr, col + dc, (direction + 2 - back) % 4)
            queue.append(j)

    for seed in seeds.tolist():
        if seed in place:
            continue
        place[seed] = (0, 0, 0)
        queue, loose = deque([seed]), deque[tuple[int, int]]()
        while queue or loose:
            if not queue:
                follow(*loose.popleft())
                continue
            i = queue.popleft()
            origin.append(seed)
            for k in range(4):
                if closes[i][k]:
                    follow(i, k)
                else:
                    loose.append((i, k))
    nodes, placed = list(place), list(place.values())
    return np.array(nodes, np.int32), np.array(origin, np.int32), np.array(placed, np.int32)


@kernels.with_kernel("neighbour_graph", "find_closing_edges")
def _find_closing_edges(ends: Int32Array) -> BoolArray:
    """Find the edges of a graph that close a cell: those (n, 4) from whose slot four of them, each
    the next one to the same side, lead back to it."""
    slots = np.arange(ends.size).reshape(ends.shape)
    leads = np.append(ends, -1)  # from nowhere to nowhere
    closing = np.zeros(ends.shape, np.bool_)
    for side in (1, 3):
        at = slots
        for _ in range(4):
            end = leads[at]
            at = np.where(end < 0, -1, end - end % 4 + (end + side) % 4)
        closing |= at == slots
    return closing


@kernels.with_kernel("neighbour_graph", "measure_blocks")
def _measure_blocks(ends: Int32Array, closing: BoolArray) -> IntArray:
    """Count the junctions (n,) that each of them hangs together with by edges that close cells."""
    n = len(ends)
    i, k = np.nonzero(closing)
    links = scipy.sparse.coo_array((np.ones(len(i)), (i, ends[i, k] // 4)), shape=(n, n))
    _, block = scipy.sparse.csgraph.connected_components(links, directed=False)
    return np.asarray(np.bincount(block)[block])


def _arrange_lattices(uv: Array, nodes: Int32Array, placed: Int32Array) -> list[Lattice]:
    """Arrange a component as a lattice, without strays, and as several where only strays held it
    together: what led across a reflection may have counted too few lines there.

    Args:
        uv: (n, 2) all junctions, px.
        nodes: (m,) those of the component.
        placed: (m, 3) their rows, columns and turns.

    Returns:
        The lattices; none if the component is too sparse or holds no full cell.
    """
    if len(nodes) < _MIN_JUNCTIONS:
        return []
    placed[:, :2] -= placed[:, :2].min(axis=0)
    rows, cols = placed[:, :2].max(axis=0) + 1
    if rows * cols > _MAX_CELLS_PER_JUNCTION * len(nodes) + _MAX_SPARE_CELLS:
        return []
    lattice = trim_lattice(_lay_out(uv[nodes], placed, (rows, cols)))
    if lattice is None:
        return []
    part, count = opencv.label_parts(lattice.found)
    if count == 1:
        return [lattice]
    large = 1 + np.flatnonzero(np.bincount(part.ravel())[1:] >= _MIN_JUNCTIONS)
    # Of hundreds of strays each part would take as long as the whole component.
    parts = (trim_lattice(crop_lattice(lattice.select(part == k))) for k in large)
    return [each for each in parts if each is not None]


def _lay_out(uv: Array, placed: Int32Array, shape: tuple[int, int]) -> Lattice:
    """Lay out junctions `uv` (m, 2) px by their rows, columns and turns (m, 3); where two have one
    place the first is taken."""
    rows, cols, _ = placed[::-1].T
    dense = np.full((*shape, 2), np.nan)
    dense[rows, cols] = uv[::-1]  # the first is written last
    # At an even turn slot 0 points along a row, and the squares (+, +) and (-, -) are dark.
    bright = np.count_nonzero(placed.sum(axis=1) % 2)
    return Lattice(dense, dark=bool(2 * bright < len(placed)))
