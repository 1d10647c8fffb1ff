"""From X-junctions to the lattice of a board: links, walk, growth.

Number the four edges that leave a junction 0 (angle A), 1 (B), 2 (A + pi), 3 (B + pi), in the
sense from u to v. Two neighbours are joined by an edge that leaves one at slot k and the other
at slot k', and as A and B are exchanged between neighbours k + k' is odd.

Number the directions on the board 0 (columns grow), 1 (rows grow), 2, 3 alike. A junction is
placed by its cell and its turn rho: slot k points in the board's direction k + rho (mod 4). The
neighbour then has turn rho' with k' + rho' = k + rho + 2 (mod 4). A walk along the links thus
numbers everything that hangs together, right-handed in the image and whatever the distortion,
because only neighbours are ever compared.

Holes and borders are then filled where the extrapolated lattice meets a saddle point whose four
sectors have the grey levels that its place requires.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from calibgui.engine import kernels, opencv
from calibgui.engine.corners.junctions import Junctions, Saddles
from calibgui.engine.opencv import Image32
from calibgui.engine.types import Array, BoolArray, IntArray

STEPS = np.array([(0, 1), (1, 0), (0, -1), (-1, 0)])
"""(row, col) steps of the board's directions 0 to 3."""
_NEIGHBOURS = 12
_ALONG = float(np.cos(np.radians(20.0)))
"""How closely an edge must point to the neighbour that it leads to."""
_PARALLEL = float(np.cos(np.radians(25.0)))
"""How closely the crossing edges of two neighbours must agree."""
_STEP = 0.25
"""Least step across the edge between two neighbours over the weaker one's contrast."""
DEVIATION = 0.3
"""Greatest distance from the neighbours' prediction, in steps of the lattice."""


@dataclass(frozen=True, eq=False, slots=True)
class Lattice:
    """Junctions placed on a board whose size and origin are still open."""

    uv: Array
    """(rows, cols, 2) px, NaN where nothing was found."""
    dark: bool
    """Whether the square before cell (0, 0), above its row and left of its column, is dark."""

    @property
    def shape(self) -> tuple[int, int]:
        return self.uv.shape[0], self.uv.shape[1]

    @property
    def found(self) -> BoolArray:
        """(rows, cols) where there is a corner."""
        return np.isfinite(self.uv[..., 0])

    def __len__(self) -> int:
        return int(np.count_nonzero(self.found))

    def under(self, mask: BoolArray) -> Lattice:
        """The lattice's corners under a mask (rows, cols)."""
        return Lattice(np.where(mask[..., None], self.uv, np.nan), self.dark)

    def spacing(self) -> Array:
        """(rows, cols) shorter of the steps to the neighbours, px; NaN where nothing was found."""
        right, down = axes(self.uv)
        return np.fmin(np.linalg.norm(right, axis=2), np.linalg.norm(down, axis=2))


def find_lattices(saddles: Saddles, junctions: Junctions) -> list[Lattice]:
    """All lattices of at least one full cell in one image, largest first."""
    if len(junctions) < 4:
        return []
    neighbour, back = _link(saddles.smooth, junctions)
    lattices = []
    for nodes, cells, turns in _walk(neighbour, back):
        lattice = _arrange(junctions.uv, nodes, cells, turns)
        if lattice is not None:
            lattices.append(lattice)
    return sorted(lattices, key=len, reverse=True)


def _link(smooth: Image32, junctions: Junctions) -> tuple[IntArray, IntArray]:
    """Neighbour (n, 4) at each slot, -1 where none, and the slot (n, 4) at which it looks back."""
    n = len(junctions)
    count = min(_NEIGHBOURS, n - 1)
    ranks = np.arange(1, count + 2)
    distance, other = (np.asarray(x) for x in cKDTree(junctions.uv).query(junctions.uv, ranks))
    me = np.repeat(np.arange(n), count)
    distance, other = distance[:, 1:].ravel(), other[:, 1:].ravel()
    apart = distance > 0
    me, other, distance = me[apart], other[apart], distance[apart]
    d = (junctions.uv[other] - junctions.uv[me]) / distance[:, None]

    angle = junctions.edges[:, [0, 1, 0, 1]] + np.array([0, 0, np.pi, np.pi])
    slots = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
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
    along = np.array([0.3, 0.5, 0.7]) * distance[:, None]
    normal = np.clip(0.15 * distance, 1.0, None)[:, None] * np.column_stack([-d[:, 1], d[:, 0]])
    on = junctions.uv[me][:, None] + along[..., None] * d[:, None]
    step = opencv.sample(smooth, on + normal[:, None]) - opencv.sample(smooth, on - normal[:, None])
    step *= np.where(k % 2 == 1, 1.0, -1.0)[:, None]
    weaker = np.minimum(junctions.contrast[me], junctions.contrast[other])
    good = step.min(axis=1) > _STEP * weaker
    me, other, distance, k, k_back = (x[good] for x in (me, other, distance, k, k_back))

    neighbour, back = np.full((n, 4), -1), np.full((n, 4), -1)
    order = np.argsort(-distance, kind="stable")  # the nearest is written last
    neighbour[me[order], k[order]] = other[order]
    back[me[order], k[order]] = k_back[order]
    mutual = (neighbour >= 0) & (neighbour[neighbour, back] == np.arange(n)[:, None])
    return np.where(mutual, neighbour, -1), np.where(mutual, back, -1)


def _walk(neighbour: IntArray, back: IntArray) -> list[tuple[IntArray, IntArray, IntArray]]:
    """Nodes (m,), cells (m, 2) and turns (m,) of each connected part with a full cell's worth."""
    links = np.sum(neighbour >= 0, axis=1)
    to, look = neighbour.tolist(), back.tolist()
    steps = [(int(r), int(c)) for r, c in STEPS]
    place: dict[int, tuple[int, int, int]] = {}
    parts = []
    for seed in np.argsort(-links, kind="stable").tolist():
        if links[seed] == 0 or seed in place:
            continue
        place[seed] = (0, 0, 0)
        queue, part = deque([seed]), []
        while queue:
            i = queue.popleft()
            part.append(i)
            row, col, turn = place[i]
            for k, j in enumerate(to[i]):
                if j >= 0 and j not in place:
                    direction = (k + turn) % 4
                    dr, dc = steps[direction]
                    place[j] = (row + dr, col + dc, (direction + 2 - look[i][k]) % 4)
                    queue.append(j)
        if len(part) >= 4:
            nodes = np.array(part)
            placed = np.array([place[i] for i in part])
            parts.append(_agreeing(nodes, placed, neighbour, back))
    return parts


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
    if rows * cols > 16 * len(nodes) + 256:
        return None
    _, first = np.unique(cells @ np.array([cols, 1]), return_index=True)
    dense = np.full((rows, cols, 2), np.nan)
    dense[cells[first, 0], cells[first, 1]] = uv[nodes[first]]
    # At an even turn slot 0 points along a row, and the squares (+, +) and (-, -) are dark.
    votes = (turns + cells.sum(axis=1)) % 2
    return trim(Lattice(dense, dark=bool(np.mean(votes) < 0.5)))


def trim(lattice: Lattice) -> Lattice | None:
    """The lattice without corners off their neighbours' prediction or outside every full cell."""
    uv = lattice.uv.copy()
    right, down = axes(uv)
    uv[in_steps(uv - predict(uv), right, down) > DEVIATION] = np.nan
    found = np.isfinite(uv[..., 0])
    cell = found[:-1, :-1] & found[1:, :-1] & found[:-1, 1:] & found[1:, 1:]
    keep = np.zeros_like(found)
    for dr in (0, 1):
        for dc in (0, 1):
            keep[dr : dr + cell.shape[0], dc : dc + cell.shape[1]] |= cell
    if not keep.any():
        return None
    uv[~keep] = np.nan
    return crop(Lattice(uv, lattice.dark))


def crop(lattice: Lattice) -> Lattice:
    """The lattice without empty border lines."""
    if not lattice.found.any():
        return Lattice(lattice.uv[:0, :0], lattice.dark)
    rows, cols = (np.flatnonzero(lattice.found.any(axis=axis)) for axis in (1, 0))
    r, c = int(rows[0]), int(cols[0])
    dark = lattice.dark ^ bool((r + c) % 2)
    return Lattice(lattice.uv[r : rows[-1] + 1, c : cols[-1] + 1], dark)


def supported(lattice: Lattice) -> Lattice:
    """The lattice without corners that have no neighbours to tell the steps there."""
    while True:
        right, down = axes(lattice.uv)
        known = np.asarray(np.isfinite(right + down).all(axis=2))
        if known[lattice.found].all():
            return lattice
        lattice = lattice.under(known)


def predict(uv: Array) -> Array:
    """Where its neighbours expect each place of a lattice `uv` (rows, cols, 2), found or not.

    The mean of the midpoints of opposite neighbours or, where there are none, of the
    extrapolations p_1 + (p_1 - p_2) + (p_1 - 2 p_2 + p_3) / 2 of the lines that end there
    (half the quadratic's second difference: all of it would amplify noise sevenfold).

    Returns:
        Predictions (rows, cols, 2) px, NaN where there is no basis.
    """
    if kernels.COMPILED:
        from calibgui.engine.kernels import lattice

        return lattice.predict(uv)
    shift = shifted(uv, 3)
    extrapolated = []
    for step in STEPS:
        p1, p2, p3 = (shift(k * step) for k in (1, 2, 3))
        slope = p1 - p2
        bend = np.where(np.isnan(p3), 0.0, slope - (p2 - p3))
        extrapolated.append(p1 + slope + 0.5 * bend)
    middle = [(shift(step) + shift(-step)) / 2 for step in STEPS[:2]]
    inner, outer = _nanmean(middle), _nanmean(extrapolated)
    return np.where(np.isnan(inner), outer, inner)


def in_steps(offset: Array, right: Array, down: Array) -> Array:
    """Largest coordinate (...,) of `offset` (..., 2) px in the local basis of lattice steps.

    NaN where a step is unknown; infinite or NaN where the steps are parallel.
    """
    det = right[..., 0] * down[..., 1] - right[..., 1] * down[..., 0]
    a = offset[..., 0] * down[..., 1] - offset[..., 1] * down[..., 0]
    b = right[..., 0] * offset[..., 1] - right[..., 1] * offset[..., 0]
    largest = np.maximum(abs(a), abs(b))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(largest / abs(det))


def _nanmean(values: list[Array]) -> Array:
    """Mean over the list where finite, NaN where nothing is."""
    stack = np.stack(values)
    finite = np.isfinite(stack)
    count = finite.sum(axis=0)
    total = np.where(finite, stack, 0.0).sum(axis=0)
    return np.divide(total, count, out=np.full_like(total, np.nan), where=count > 0)


def axes(uv: Array) -> tuple[Array, Array]:
    """Steps (rows, cols, 2) to the next column and to the next row of a lattice, px.

    From the nearest neighbours on the line, else from those two places away, else the mean of
    the steps of the four places around; NaN where there is none of these.
    """
    if kernels.COMPILED:
        from calibgui.engine.kernels import lattice

        return lattice.axes(uv)
    steps = []
    shift = shifted(uv, 2)
    for step in (STEPS[0], STEPS[1]):
        near = _nanmean([shift(step) - uv, uv - shift(-step)])
        far = _nanmean([(shift(2 * step) - uv) / 2, (uv - shift(-2 * step)) / 2])
        around = (shift(step) - shift(-step)) / 2
        own = np.where(np.isnan(near), np.where(np.isnan(around), far, around), near)
        beside = shifted(own, 1)
        steps.append(np.where(np.isnan(own), _nanmean([beside(s) for s in STEPS]), own))
    return steps[0], steps[1]


def shifted(uv: Array, reach: int) -> Callable[[IntArray], Array]:
    """What stands (drow, dcol) places away from each place of `uv` (rows, cols, 2), NaN outside;
    for steps of up to `reach`."""
    around = bordered(uv, reach)
    rows, cols = uv.shape[:2]

    def at(step: IntArray) -> Array:
        r, c = reach + step
        return around[r : r + rows, c : c + cols]

    return at


def bordered(uv: Array, width: int) -> Array:
    """`uv` (rows, cols, 2) with a border of NaN."""
    rows, cols = uv.shape[:2]
    result = np.full((rows + 2 * width, cols + 2 * width, 2), np.nan)
    result[width : width + rows, width : width + cols] = uv
    return result
