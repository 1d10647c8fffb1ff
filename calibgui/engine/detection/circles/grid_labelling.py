"""The grid among points: which of them are its circles, and which circle each of them is.

The places of a grid form a lattice: of a symmetric one (x, y) = (i, j), of an asymmetric one
(x, y) = (i - j, i + j). In an image every small part of it is nearly a lattice too. It is grown
from a point and two of its neighbours: the points found so far predict the next ones, by
continuing lines and by completing parallelograms, so that perspective and lens may change the
steps from one end to the other. Three points that have no others where their lattice would have its
next ones are no part of a grid, and are not grown: almost all of those in textures.

Points are complex numbers u + iv there: a lattice is grown place by place.

The nearest points of a tilted grid need not be the neighbours along rows and columns: the lattice
may have grown along a diagonal. Of the few ways to assign places to it, that is right in which the
points fill a rectangle of the pattern.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product

import numpy as np
import scipy

from calibgui.engine.arrays import Array, GridSize, IntArray
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS
from calibgui.engine.geometry import homography

Place = tuple[int, int]
"""Coordinates on the lattice."""
PointsByPlace = dict[Place, int]
"""Index of the point at each place of the lattice."""

_MAX_SEEDS = 8
"""Number of points, from the middle outwards, from which the lattice is grown."""
_NEIGHBOURS = 5
"""Number of nearest points of a seed, two of which are taken as its neighbours on the lattice."""
PlacesByPoint = dict[int, Place]
"""Place on a lattice of each of its points, by index."""
_MIN_AROUND = 4
"""Least number of the places `_AROUND` that hold a point."""
_AROUND = np.array([(-1, 0), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1)])
"""(6, 2) coordinates of the places around a seed whose neighbours (1, 0) and (0, 1) are given."""
_STEPS = ((1, 0), (-1, 0), (0, 1), (0, -1))
_DIAGONALS = tuple(product((1, -1), (1, -1)))
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
        (rows, cols) indices of the points, right-handed in the image; None if there is no grid, or
        if one whose size is not stated is a part of a larger one.
    """
    limits = CIRCLE_THRESHOLDS
    if len(points) < limits.min_grid_lines**2:
        return None
    best, left_out = _NO_GRID, 0
    fewest = limits.min_grid_circles
    if grid_size is not None:
        fewest = min(fewest, grid_size[0] * grid_size[1])
    tree = scipy.spatial.cKDTree(points)
    tried: list[PlacesByPoint] = []
    for seed in _find_nearest(tree, np.median(points, axis=0), _MAX_SEEDS):
        if seed in best:
            continue
        for start in _start_lattices(seed, points, tree):
            if any(_is_same_lattice(start, other) for other in tried):
                continue
            placed = _grow_lattice(start, points, tree)
            tried.append({point: place for place, point in placed.items()})
            if len(placed) < fewest:
                continue
            for by_place in _assign_places(placed, asymmetric=asymmetric):
                if grid_size is not None:
                    stated = _cut_stated_grid(by_place, grid_size, asymmetric=asymmetric)
                    if stated is not None:
                        return stated
            whole = max(
                _cut_whole_grids(placed, asymmetric=asymmetric), key=_rank_grid, default=best
            )
            if _rank_grid(whole) > _rank_grid(best):
                best, left_out = whole, len(placed) - whole.size
            if seed in best:
                break
    if left_out > limits.max_continued_share * best.size:
        return None
    if not best.size or _is_continued(best, points, asymmetric=asymmetric):
        return None
    return best


def _is_continued(grid: IntArray, points: Array, *, asymmetric: bool) -> bool:
    """Return whether a grid (rows, cols) of points (n, 2) px is a part of a larger one: most others
    around lie where it goes on, and they are many. Something hides what would join them. In the
    middle of the cells of a symmetric grid they belong to an asymmetric one, turned."""
    limits = CIRCLE_THRESHOLDS
    others = np.delete(points, grid.ravel(), axis=0)
    if len(others) <= limits.max_continued_share * grid.size:
        return False
    xy = np.array(_list_places((grid.shape[0], grid.shape[1]), asymmetric=asymmetric), np.float64)
    to_board = homography.fit_homography(points[grid.ravel()], xy, np.ones(len(xy)))
    at = homography.apply_homography(to_board, others)
    reach = limits.continued_lines
    near = ((at > xy.min(axis=0) - reach) & (at < xy.max(axis=0) + reach)).all(axis=1)
    x, y = at[near].T
    lattice = np.column_stack([x + y, x - y]) / (2 if asymmetric else 1)
    off = np.abs(lattice - np.rint(lattice)).max(axis=1)
    continuing = int(np.count_nonzero(off < limits.max_continuation_error))
    return continuing > max(limits.max_continued_share * grid.size, len(off) / 2)


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
        if abs(sine) > CIRCLE_THRESHOLDS.min_seed_sine and _is_lattice_seen(
            points[seed], np.stack([a, b]), tree
        ):
            first, second = (i, j) if sine > 0 else (j, i)
            yield {(0, 0): seed, (1, 0): first, (0, 1): second}


def _is_same_lattice(start: PointsByPlace, grown: PlacesByPoint) -> bool:
    """Return whether a lattice would be one that was grown before, in another basis."""
    places = [grown.get(start[place]) for place in ((0, 0), (1, 0), (0, 1))]
    known = np.array([place for place in places if place is not None])
    return len(known) == 3 and abs(round(np.linalg.det(known[1:] - known[0]))) == 1


def _is_lattice_seen(seed: Array, steps: Array, tree: scipy.spatial.cKDTree) -> bool:
    """Return whether points lie around a seed (2,) px where its `steps` (2, 2) px, one a row, would
    have the next ones of a lattice."""
    reach = CIRCLE_THRESHOLDS.max_prediction_error * np.linalg.norm(steps, axis=1).min()
    distance = np.asarray(tree.query(seed + _AROUND @ steps, distance_upper_bound=reach)[0])
    return bool(np.count_nonzero(np.isfinite(distance)) >= _MIN_AROUND)


def _grow_lattice(
    placed: PointsByPlace, points: Array, tree: scipy.spatial.cKDTree
) -> PointsByPlace:
    """Grow a lattice by every point that lies where it predicts one."""
    placed, taken, edge = dict(placed), set(placed.values()), list(placed)
    z: list[complex] = (points[:, 0] + 1j * points[:, 1]).tolist()
    while edge:
        beside = {(i + di, j + dj) for i, j in edge for di, dj in _STEPS} - placed.keys()
        expected = [(place, _predict_point(place, placed, z)) for place in sorted(beside)]
        # Places with the most predictions come first: a point can be taken only once.
        expected = sorted((item for item in expected if item[1]), key=lambda item: -len(item[1]))
        edge = []
        if not expected:
            break
        means = np.array([sum(at for at, _ in guesses) / len(guesses) for _, guesses in expected])
        found = tree.query(np.column_stack([means.real, means.imag]))
        distance, nearest = np.asarray(found[0]), np.asarray(found[1])
        for (place, guesses), off, point in zip(
            expected, distance.tolist(), nearest.tolist(), strict=True
        ):
            reach = CIRCLE_THRESHOLDS.max_prediction_error * min(step for _, step in guesses)
            if off < reach and point not in taken:
                placed[place] = point
                taken.add(point)
                edge.append(place)
    return placed


def _predict_point(
    place: Place, placed: PointsByPlace, z: list[complex]
) -> list[tuple[complex, float]]:
    """Predict a place's point from its neighbours: positions, and the lengths of their steps."""
    i, j = place

    def at(di: int, dj: int) -> complex | None:
        index = placed.get((i + di, j + dj))
        return None if index is None else z[index]

    guesses = []
    for di, dj in _STEPS:
        next_, second = at(di, dj), at(2 * di, 2 * dj)
        if next_ is not None and second is not None:
            third = at(3 * di, 3 * dj)
            continued = 2 * next_ - second if third is None else 3 * (next_ - second) + third
            guesses.append((continued, abs(next_ - second)))
    for di, dj in _DIAGONALS:
        along, across, diagonal = at(di, 0), at(0, dj), at(di, dj)
        if along is not None and across is not None and diagonal is not None:
            step = min(abs(along - diagonal), abs(across - diagonal))
            guesses.append((along + across - diagonal, step))
    return guesses


def _assign_places(placed: PointsByPlace, *, asymmetric: bool) -> Iterator[PointsByPlace]:
    """Assign the pattern's places (x, y) to the lattice, in all ways that may be right."""
    points = list(placed.values())
    for xy in _shear_places(placed, asymmetric=asymmetric):
        for turn in _TURNS:
            yield dict(zip(map(tuple, (xy @ turn.T).tolist()), points, strict=True))


def _shear_places(placed: PointsByPlace, *, asymmetric: bool) -> Iterator[IntArray]:
    """List the places (n, 2) = (x, y) of a lattice's points for every basis that it may have grown
    by, up to turns by quarters."""
    grid = np.array(list(placed))
    for shear in _SHEARS:
        i, j = shear @ grid.T
        yield np.column_stack([i - j, i + j] if asymmetric else [i, j])


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


def _cut_whole_grids(placed: PointsByPlace, *, asymmetric: bool) -> list[IntArray]:
    """Cut the grids that a lattice fills in any basis and turn once stray points at its borders
    are left out."""
    points, grids = np.array(list(placed.values())), []
    for xy in _shear_places(placed, asymmetric=asymmetric):
        kept = _drop_stray_borders(xy, asymmetric=asymmetric)
        if len(kept) < CIRCLE_THRESHOLDS.min_grid_circles:
            continue
        for turn in _TURNS:
            grid = _fill_grid(xy[kept] @ turn.T, points[kept], asymmetric=asymmetric)
            if grid is not None:
                grids.append(grid)
    return grids


def _drop_stray_borders(xy: IntArray, *, asymmetric: bool) -> IntArray:
    """Return the indices of the places (n, 2) left once border lines with too few are dropped."""
    kept = np.arange(len(xy))
    while len(kept) >= CIRCLE_THRESHOLDS.min_grid_circles:
        here = xy[kept]
        low, high = here.min(axis=0), here.max(axis=0)
        # An asymmetric grid has a circle at every second place along a line.
        full = (high - low + 1)[::-1] / (2 if asymmetric else 1)
        share = np.array([(here == low).sum(axis=0), (here == high).sum(axis=0)]) / full
        if share.min() >= CIRCLE_THRESHOLDS.min_border_share:
            break
        end, axis = np.unravel_index(np.argmin(share), share.shape)
        kept = kept[here[:, axis] != (low, high)[end][axis]]
    return kept


def _fill_grid(xy: IntArray, points: IntArray, *, asymmetric: bool) -> IntArray | None:
    """Return the grid (rows, cols) of `points` (n,) at the places `xy` (n, 2), None if they do not
    fill one."""
    low = xy.min(axis=0)
    width, rows = (xy.max(axis=0) - low + 1).tolist()
    cols = width // 2 if asymmetric else width
    if rows * cols != len(xy) or min(rows, cols) < CIRCLE_THRESHOLDS.min_grid_lines:
        return None
    places = _list_places((rows, cols), asymmetric=asymmetric)
    by_place = dict(zip(map(tuple, (xy - low).tolist()), points.tolist(), strict=True))
    if by_place.keys() != set(places):
        return None
    return _collect_indices(by_place, (0, 0), (rows, cols), places)


def _collect_indices(
    by_place: PointsByPlace, start: Place, grid_size: GridSize, places: list[Place]
) -> IntArray:
    """Collect the indices (rows, cols) of the points at a grid's places."""
    found = [by_place[start[0] + x, start[1] + y] for x, y in places]
    return np.array(found, dtype=np.int64).reshape(grid_size)
