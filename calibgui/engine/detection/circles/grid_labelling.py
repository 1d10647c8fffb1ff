"""The grid among points: which of them are its circles, and which circle each of them is.

The places of a grid form a lattice: of a symmetric one (x, y) = (i, j), of an asymmetric one
(x, y) = (i - j, i + j). In an image every small part of it is nearly a lattice too. From a point
and two of its neighbours it is grown: what is found so far expects the next points, by going on as
before along a line and by completing parallelograms, so that perspective and lens may change the
steps from one end to the other.

Of a tilted grid the nearest points need not be the neighbours along rows and columns: the lattice
may be counted along a diagonal. Of the few ways of counting it, that is right in which the points
fill a rectangle of the pattern.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product

import numpy as np
import scipy

from calibgui.engine.arrays import Array, GridSize, IntArray

Place = tuple[int, int]
Placed = dict[Place, int]
"""Index of the point at each place of the lattice."""

_LEAST = 12
"""Circles of the smallest grid whose size is found out."""
_LINES = 3
"""Of its shorter side."""
_SEEDS = 8
"""Points, from the middle outwards, from which the lattice is grown."""
_NEIGHBOURS = 5
"""Of each, two of which may be its neighbours on the lattice."""
_PARALLEL = 0.25
"""Least sine of the angle between the two."""
_REACH = 0.3
"""Farthest that a point may be from where it is expected, shorter steps."""
_STRAY = 0.5
"""Share of a border line that must be there for its points to be no strays."""
_STEPS = ((1, 0), (-1, 0), (0, 1), (0, -1))
_SHEARS = tuple(np.array([[1, a], [b, 1]]) for a, b in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)))
_TURNS = tuple(np.array([[c, -s], [s, c]]) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1)))
"""The ways of counting a lattice."""
_NONE: IntArray = np.zeros((0, 0), dtype=np.int64)


def arranged(points: Array, grid_size: GridSize | None, *, asymmetric: bool) -> IntArray | None:
    """The grid of the stated size among points, or else the largest whole one.

    Args:
        points: (n, 2) px.
        board: rows and columns, found out if None.
        asymmetric: whether every second row is shifted by half.

    Returns:
        (rows, cols) indices of the points, right-handed in the image; None if there is no grid.
    """
    if len(points) < _LINES**2:
        return None
    best = _NONE
    fewest = _LEAST if grid_size is None else min(_LEAST, grid_size[0] * grid_size[1])
    tree = scipy.spatial.cKDTree(points)
    for seed in _nearest(tree, np.median(points, axis=0), _SEEDS):
        if seed in best:
            continue
        for start in _corners(seed, points, tree):
            placed = _grown(start, points, tree)
            if len(placed) < fewest:
                continue
            for counted in _countings(placed, asymmetric=asymmetric):
                if grid_size is not None:
                    stated = _window(counted, grid_size, asymmetric=asymmetric)
                    if stated is not None:
                        return stated
                best = max(best, _whole(counted, asymmetric=asymmetric), key=_rank)
            if seed in best:
                break
    return best if best.size else None


def _rank(grid: IntArray) -> tuple[int, int]:
    """The largest grid comes first, of two readings of one that with fewer rows."""
    return grid.size, -grid.shape[0]


def _nearest(tree: scipy.spatial.cKDTree, to: Array, count: int) -> list[int]:
    """The points nearest to a place, the nearest first."""
    found: list[int] = np.asarray(tree.query(to, k=count)[1]).tolist()
    return found


def _corners(seed: int, points: Array, tree: scipy.spatial.cKDTree) -> Iterator[Placed]:
    """A point with two of its neighbours as the first of a lattice, right-handed in the image."""
    neighbours = _nearest(tree, points[seed], _NEIGHBOURS + 1)[1:]
    for one, other in combinations(neighbours, 2):
        a, b = points[one] - points[seed], points[other] - points[seed]
        sine = (a[0] * b[1] - a[1] * b[0]) / (np.linalg.norm(a) * np.linalg.norm(b))
        if abs(sine) > _PARALLEL:
            first, second = (one, other) if sine > 0 else (other, one)
            yield {(0, 0): seed, (1, 0): first, (0, 1): second}


def _grown(placed: Placed, points: Array, tree: scipy.spatial.cKDTree) -> Placed:
    """The lattice with every point that it expects."""
    placed, taken, edge = dict(placed), set(placed.values()), list(placed)
    while edge:
        beside = {(i + di, j + dj) for i, j in edge for di, dj in _STEPS} - placed.keys()
        expected = [(place, _expected(place, placed, points)) for place in sorted(beside)]
        # Where several agree comes first: a point can be taken only once.
        expected.sort(key=lambda item: -len(item[1]))
        edge = []
        for place, guesses in expected:
            if not guesses:
                continue
            at = np.mean([guess for guess, _ in guesses], axis=0)
            reach = _REACH * min(step for _, step in guesses)
            _, nearest = tree.query(at, distance_upper_bound=reach)
            if nearest < len(points) and nearest not in taken:
                placed[place] = int(nearest)
                taken.add(int(nearest))
                edge.append(place)
    return placed


def _expected(place: Place, placed: Placed, points: Array) -> list[tuple[Array, float]]:
    """Where the neighbours of a place expect its point, and the length of their step."""
    i, j = place

    def at(di: int, dj: int) -> Array | None:
        index = placed.get((i + di, j + dj))
        return None if index is None else points[index]

    guesses = []
    for di, dj in _STEPS:
        next_, second, third = (at(k * di, k * dj) for k in (1, 2, 3))
        if next_ is not None and second is not None:
            going_on = 2 * next_ - second if third is None else 3 * (next_ - second) + third
            guesses.append((going_on, float(np.linalg.norm(next_ - second))))
    for di, dj in product((1, -1), (1, -1)):
        along, across, diagonal = at(di, 0), at(0, dj), at(di, dj)
        if along is not None and across is not None and diagonal is not None:
            steps = np.linalg.norm([along - diagonal, across - diagonal], axis=1)
            guesses.append((along + across - diagonal, float(steps.min())))
    return guesses


def _countings(placed: Placed, *, asymmetric: bool) -> Iterator[Placed]:
    """The lattice as the pattern's places (x, y), in all ways that may be right."""
    grid, points = np.array(list(placed)), list(placed.values())
    for shear, turn in product(_SHEARS, _TURNS):
        i, j = shear @ grid.T
        xy = np.array([i - j, i + j] if asymmetric else [i, j])
        x, y = turn @ xy
        yield dict(zip(zip(x.tolist(), y.tolist(), strict=True), points, strict=True))


def _places(grid_size: GridSize, *, asymmetric: bool) -> list[Place]:
    """(x, y) of a grid's circles, row by row."""
    rows, cols = grid_size
    if asymmetric:
        return [(2 * n + m % 2, m) for m in range(rows) for n in range(cols)]
    return [(n, m) for m in range(rows) for n in range(cols)]


def _window(counted: Placed, grid_size: GridSize, *, asymmetric: bool) -> IntArray | None:
    """The one part of a lattice that is a grid of the stated size; two are of a larger one."""
    places = _places(grid_size, asymmetric=asymmetric)
    if len(counted) < len(places):
        return None
    starts = [
        (left, top)
        for left, top in counted
        if all((left + x, top + y) in counted for x, y in places)
    ]
    return _indices(counted, starts[0], grid_size, places) if len(starts) == 1 else None


def _whole(counted: Placed, *, asymmetric: bool) -> IntArray:
    """The grid that a lattice without strays at its borders fills, or an empty one."""
    xy = np.array(list(counted))
    while len(xy) >= _LEAST:
        low, high = xy.min(axis=0), xy.max(axis=0)
        size = high - low + 1
        # Of the places along a line every second is one of an asymmetric grid.
        full = size[::-1] / (2 if asymmetric else 1)
        share = np.array([(xy == low).sum(axis=0), (xy == high).sum(axis=0)]) / full
        if share.min() >= _STRAY:
            break
        end, axis = np.unravel_index(np.argmin(share), share.shape)
        xy = xy[xy[:, axis] != (low, high)[end][axis]]
    else:
        return _NONE
    cols, rows = (size // (2, 1) if asymmetric else size).tolist()
    places = _places((rows, cols), asymmetric=asymmetric)
    if min(rows, cols) < _LINES or {(x, y) for x, y in (xy - low).tolist()} != set(places):
        return _NONE
    return _indices(counted, (int(low[0]), int(low[1])), (rows, cols), places)


def _indices(counted: Placed, start: Place, grid_size: GridSize, places: list[Place]) -> IntArray:
    found = [counted[start[0] + x, start[1] + y] for x, y in places]
    return np.array(found, dtype=np.int64).reshape(grid_size)
