"""The grid among points: which of them are its circles, and which circle each of them is.

The places of a grid form a lattice: of a symmetric one (x, y) = (i, j), of an asymmetric one
(x, y) = (i - j, i + j). In an image every small part of it is nearly a lattice too. It is grown
from a point and two of its neighbours: the points found so far predict the next ones, by
continuing lines and by completing parallelograms, so that perspective and lens may change the
steps from one end to the other.

The nearest points of a tilted grid need not be the neighbours along rows and columns: the lattice
may have grown along a diagonal. Of the few ways to assign places to it, that is right in which the
points fill a rectangle of the pattern.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations, product

import numpy as np
import scipy

from calibgui.engine.arrays import Array, GridSize, IntArray
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS

Place = tuple[int, int]
"""Coordinates on the lattice."""
PointsByPlace = dict[Place, int]
"""Index of the point at each place of the lattice."""

_MAX_SEEDS = 8
"""Number of points, from the middle outwards, from which the lattice is grown."""
_NEIGHBOURS = 5
"""Number of nearest points of a seed, two of which are taken as its neighbours on the lattice."""
_STEPS = ((1, 0), (-1, 0), (0, 1), (0, -1))
_SHEARS = tuple(np.array([[1, a], [b, 1]]) for a, b in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)))
_TURNS = tuple(np.array([[c, -s], [s, c]]) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1)))
"""Bases of the lattice that the first neighbours may have been, and turns of it."""
_NO_GRID: IntArray = np.zeros((0, 0), dtype=np.int64)


def label_grid(points: Array, grid_size: GridSize | None, *, asymmetric: bool) -> IntArray | None:
    """Find the grid of the stated size among points, or else the largest whole one.

    Args:
        points: (n, 2) px.
        grid_size: rows and columns, inferred if None.
        asymmetric: True if every second row is shifted by half.

    Returns:
        (rows, cols) indices of the points, right-handed in the image; None if there is no grid.
    """
    limits = CIRCLE_THRESHOLDS
    if len(points) < limits.min_grid_lines**2:
        return None
    best = _NO_GRID
    fewest = limits.min_grid_circles
    if grid_size is not None:
        fewest = min(fewest, grid_size[0] * grid_size[1])
    tree = scipy.spatial.cKDTree(points)
    for seed in _find_nearest(tree, np.median(points, axis=0), _MAX_SEEDS):
        if seed in best:
            continue
        for start in _start_lattices(seed, points, tree):
            placed = _grow_lattice(start, points, tree)
            if len(placed) < fewest:
                continue
            for by_place in _assign_places(placed, asymmetric=asymmetric):
                if grid_size is not None:
                    stated = _cut_stated_grid(by_place, grid_size, asymmetric=asymmetric)
                    if stated is not None:
                        return stated
                best = max(best, _cut_whole_grid(by_place, asymmetric=asymmetric), key=_rank_grid)
            if seed in best:
                break
    return best if best.size else None


def _rank_grid(grid: IntArray) -> tuple[int, int]:
    """Rank grids: the larger is better, of two readings of one the one with fewer rows."""
    return grid.size, -grid.shape[0]


def _find_nearest(tree: scipy.spatial.cKDTree, to: Array, count: int) -> list[int]:
    """Find the points nearest to a position, the nearest first."""
    found: list[int] = np.asarray(tree.query(to, k=count)[1]).tolist()
    return found


def _start_lattices(
    seed: int, points: Array, tree: scipy.spatial.cKDTree
) -> Iterator[PointsByPlace]:
    """Start lattices, right-handed in the image, from a point and two of its neighbours."""
    neighbours = _find_nearest(tree, points[seed], _NEIGHBOURS + 1)[1:]
    for i, j in combinations(neighbours, 2):
        a, b = points[i] - points[seed], points[j] - points[seed]
        sine = (a[0] * b[1] - a[1] * b[0]) / (np.linalg.norm(a) * np.linalg.norm(b))
        if abs(sine) > CIRCLE_THRESHOLDS.min_seed_sine:
            first, second = (i, j) if sine > 0 else (j, i)
            yield {(0, 0): seed, (1, 0): first, (0, 1): second}


def _grow_lattice(
    placed: PointsByPlace, points: Array, tree: scipy.spatial.cKDTree
) -> PointsByPlace:
    """Grow a lattice by every point that lies where it predicts one."""
    placed, taken, edge = dict(placed), set(placed.values()), list(placed)
    # Plain numbers: arrays of two take ten times as long.
    known = {place: tuple(points[index].tolist()) for place, index in placed.items()}
    while edge:
        beside = {(i + di, j + dj) for i, j in edge for di, dj in _STEPS} - placed.keys()
        guesses = {place: _predict_point(place, known) for place in sorted(beside)}
        # Places with the most predictions come first: a point can be taken only once.
        expected = sorted(
            (place for place, found in guesses.items() if found),
            key=lambda place: -len(guesses[place]),
        )
        if not expected:
            break
        at = [
            [sum(values) / len(values) for values in list(zip(*guesses[place], strict=True))[:2]]
            for place in expected
        ]
        distances, indices = (np.asarray(found).tolist() for found in tree.query(np.array(at)))
        edge = []
        for place, distance, nearest in zip(expected, distances, indices, strict=True):
            step = min(step for *_, step in guesses[place])
            is_near = distance < CIRCLE_THRESHOLDS.max_prediction_error * step
            if is_near and nearest not in taken:
                placed[place] = nearest
                known[place] = tuple(points[nearest].tolist())
                taken.add(nearest)
                edge.append(place)
    return placed


def _predict_point(
    place: Place, known: dict[Place, tuple[float, float]]
) -> list[tuple[float, float, float]]:
    """Predict a place's point (u, v) px from its neighbours, and the lengths of their steps.

    Args:
        place: the place.
        known: the points px by place.
    """
    i, j = place
    guesses = []
    for di, dj in _STEPS:
        next_, second = known.get((i + di, j + dj)), known.get((i + 2 * di, j + 2 * dj))
        if next_ is None or second is None:
            continue
        u, v = next_[0] - second[0], next_[1] - second[1]
        third = known.get((i + 3 * di, j + 3 * dj))
        if third is None:
            continued = 2 * next_[0] - second[0], 2 * next_[1] - second[1]
        else:
            continued = 3 * u + third[0], 3 * v + third[1]
        guesses.append((*continued, math.sqrt(u * u + v * v)))
    for di, dj in product((1, -1), (1, -1)):
        along, across = known.get((i + di, j)), known.get((i, j + dj))
        diagonal = known.get((i + di, j + dj))
        if along is None or across is None or diagonal is None:
            continue
        u, v = along[0] + across[0] - diagonal[0], along[1] + across[1] - diagonal[1]
        guesses.append((u, v, min(math.dist(along, diagonal), math.dist(across, diagonal))))
    return guesses


def _assign_places(placed: PointsByPlace, *, asymmetric: bool) -> Iterator[PointsByPlace]:
    """Assign the pattern's places (x, y) to the lattice, in all ways that may be right."""
    grid, points = np.array(list(placed)), list(placed.values())
    for shear, turn in product(_SHEARS, _TURNS):
        i, j = shear @ grid.T
        xy = np.array([i - j, i + j] if asymmetric else [i, j])
        x, y = turn @ xy
        yield dict(zip(zip(x.tolist(), y.tolist(), strict=True), points, strict=True))


def _list_places(grid_size: GridSize, *, asymmetric: bool) -> list[Place]:
    """List (x, y) of a grid's circles, row by row."""
    rows, cols = grid_size
    if asymmetric:
        return [(2 * n + m % 2, m) for m in range(rows) for n in range(cols)]
    return [(n, m) for m in range(rows) for n in range(cols)]


def _cut_stated_grid(
    by_place: PointsByPlace, grid_size: GridSize, *, asymmetric: bool
) -> IntArray | None:
    """Cut the grid of the stated size out of a lattice; None if there is none, or more than one, as
    in a larger grid."""
    places = _list_places(grid_size, asymmetric=asymmetric)
    if len(by_place) < len(places):
        return None
    starts = [
        (left, top)
        for left, top in by_place
        if all((left + x, top + y) in by_place for x, y in places)
    ]
    return _collect_indices(by_place, starts[0], grid_size, places) if len(starts) == 1 else None


def _cut_whole_grid(by_place: PointsByPlace, *, asymmetric: bool) -> IntArray:
    """Cut the grid that a lattice fills once stray points at its borders are left out; it is empty
    if they fill none."""
    xy = np.array(list(by_place))
    while len(xy) >= CIRCLE_THRESHOLDS.min_grid_circles:
        low, high = xy.min(axis=0), xy.max(axis=0)
        size = high - low + 1
        # An asymmetric grid has a circle at every second place along a line.
        full = size[::-1] / (2 if asymmetric else 1)
        share = np.array([(xy == low).sum(axis=0), (xy == high).sum(axis=0)]) / full
        if share.min() >= CIRCLE_THRESHOLDS.min_border_share:
            break
        end, axis = np.unravel_index(np.argmin(share), share.shape)
        xy = xy[xy[:, axis] != (low, high)[end][axis]]
    else:
        return _NO_GRID
    cols, rows = (size // (2, 1) if asymmetric else size).tolist()
    places = _list_places((rows, cols), asymmetric=asymmetric)
    too_narrow = min(rows, cols) < CIRCLE_THRESHOLDS.min_grid_lines
    if too_narrow or {(x, y) for x, y in (xy - low).tolist()} != set(places):
        return _NO_GRID
    return _collect_indices(by_place, (int(low[0]), int(low[1])), (rows, cols), places)


def _collect_indices(
    by_place: PointsByPlace, start: Place, grid_size: GridSize, places: list[Place]
) -> IntArray:
    """Collect the indices (rows, cols) of the points at a grid's places."""
    found = [by_place[start[0] + x, start[1] + y] for x, y in places]
    return np.array(found, dtype=np.int64).reshape(grid_size)
