"""The grid among points: which of them are its circles, and which circle each of them is.

The places of a grid form a lattice: of a symmetric one (x, y) = (i, j), of an asymmetric one
(x, y) = (i - j, i + j). In an image every small part of it is nearly a lattice too. It is grown
from a point and two of its neighbours: the points found so far predict the next ones, by
continuing lines and by completing parallelograms, so that perspective and lens may change the
steps from one end to the other. Three points that have no others where their lattice would have its
next ones are no part of a grid, and are not grown: almost all of those in textures. Growth goes
around circles that are covered.

Points are complex numbers u + iv there: a lattice is grown place by place.

The nearest points of a tilted grid need not be the neighbours along rows and columns: the lattice
may have grown along a diagonal. Of the few ways to assign places to it, that is right in which the
points fill a rectangle of the pattern, or the most of one of which a few are covered.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import combinations, product
from typing import NamedTuple

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


class LabelledGrid(NamedTuple):
    """A grid among points."""

    places: IntArray
    """(rows, cols) index of the point at each place, right-handed in the image; -1 where no point
    is, as its circle is covered."""
    left_out: int
    """Number of points where further rows or columns would have some: too few for such lines."""

    def __len__(self) -> int:
        return len(self.points)

    @property
    def points(self) -> IntArray:
        """(n,) indices of its points, row by row."""
        return self.places[self.places >= 0]

    @property
    def is_full(self) -> bool:
        """True if there is a point at every place."""
        return bool((self.places >= 0).all())

    @property
    def is_continued(self) -> bool:
        """True if so many points were left out that it is a part of a larger grid, or of none."""
        return self.left_out > CIRCLE_THRESHOLDS.max_continued_share * len(self)

    def place_points(self, points: Array) -> Array:
        """Return the positions (rows, cols, 2) of its points among `points` (n, 2); NaN where none
        is."""
        return np.where((self.places >= 0)[..., None], points[self.places], np.nan)


def label_grid(
    points: Array, grid_size: GridSize | None, *, asymmetric: bool
) -> LabelledGrid | None:
    """Find the grid of the stated size among points, or else the largest one.

    Args:
        points: (n, 2) px.
        grid_size: rows and columns, inferred if None.
        asymmetric: True if every second row is shifted by half.

    Returns:
        The grid; None if there is none, or if one whose size is not stated is a part of a larger
        one.
    """
    limits = CIRCLE_THRESHOLDS
    if len(points) < limits.min_grid_lines**2:
        return None
    best: LabelledGrid | None = None
    fewest = float(limits.min_grid_circles)
    if grid_size is not None:
        fewest = min(fewest, (1 - limits.max_rejected_share) * grid_size[0] * grid_size[1])
    tree = scipy.spatial.cKDTree(points)
    tried: list[PlacesByPoint] = []
    for seed in _find_nearest(tree, np.median(points, axis=0), _MAX_SEEDS):
        if best is not None and best.is_full and seed in best.points:
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
            grids = list(_cut_grids(placed, grid_size, asymmetric=asymmetric))
            if any(len(grid) >= fewest and not grid.is_continued for grid in grids) and not any(
                grid.is_full for grid in grids
            ):
                placed = _complete_lattice(placed, points, tree)
                grids = list(_cut_grids(placed, grid_size, asymmetric=asymmetric))
            for grid in grids:
                if len(grid) >= fewest:
                    best = max(best or grid, grid, key=partial(_rank_grid, grid_size))
            # A lattice that began across a gap has more gaps than the grid.
            if best is not None and best.is_full and seed in best.points:
                break
    if best is None or best.is_continued:
        return None
    return None if _is_continued(best, points, asymmetric=asymmetric) else best


def _is_continued(grid: LabelledGrid, points: Array, *, asymmetric: bool) -> bool:
    """Return whether a grid of points (n, 2) px is a part of a larger one: most others around lie
    where it goes on, and they are many. Something hides what would join them. In the middle of the
    cells of a symmetric grid they belong to an asymmetric one, turned."""
    limits = CIRCLE_THRESHOLDS
    own = grid.points
    others = np.delete(points, own, axis=0)
    if len(others) <= limits.max_continued_share * len(own):
        return False
    rows, cols = grid.places.shape
    xy = np.array(_list_places((rows, cols), asymmetric=asymmetric), np.float64)
    to_board = homography.fit_homography(
        points[own], xy[grid.places.ravel() >= 0], np.ones(len(own))
    )
    at = homography.apply_homography(to_board, others)
    reach = limits.continued_lines
    near = ((at > xy.min(axis=0) - reach) & (at < xy.max(axis=0) + reach)).all(axis=1)
    x, y = at[near].T
    lattice = np.column_stack([x + y, x - y]) / (2 if asymmetric else 1)
    off = np.abs(lattice - np.rint(lattice)).max(axis=1)
    continuing = int(np.count_nonzero(off < limits.max_continuation_error))
    return continuing > max(limits.max_continued_share * len(own), len(off) / 2)


def _rank_grid(grid_size: GridSize | None, grid: LabelledGrid) -> tuple[int, int, bool, int]:
    """Rank grids: the more points the better, of the same points with fewer gaps, of the stated
    size or else with fewer rows."""
    shape = grid.places.shape
    return len(grid), -grid.places.size, shape == grid_size, -shape[0]


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
    unpredicted: set[Place] = set()
    while edge:
        # Beside a covered circle it may take longer until the points that predict one are placed.
        beside = {(i + di, j + dj) for i, j in edge for di, dj in _STEPS} | unpredicted
        beside -= placed.keys()
        expected = [(place, _predict_point(place, placed, z)) for place in sorted(beside)]
        unpredicted = {place for place, guesses in expected if not guesses}
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


def _complete_lattice(
    placed: PointsByPlace, points: Array, tree: scipy.spatial.cKDTree
) -> PointsByPlace:
    """Grow a lattice on in every basis that the pattern may have in it: a point beside a covered
    one may be predicted in one of them only."""
    for shear in _SHEARS:
        grown = _grow_lattice(_change_basis(placed, shear), points, tree)
        placed = _change_basis(grown, 2 * np.eye(2, dtype=np.int64) - shear)
    return placed


def _change_basis(placed: PointsByPlace, by: IntArray) -> PointsByPlace:
    """Return a lattice with its places in the basis that `by` (2, 2) takes them to."""
    places = np.array(list(placed)) @ by.T
    return dict(zip(map(tuple, places.tolist()), placed.values(), strict=True))


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
    for di, dj in _STEPS[::2]:
        before, after = at(di, dj), at(-di, -dj)
        if before is not None and after is not None:
            guesses.append(((before + after) / 2, abs(after - before) / 2))
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
) -> LabelledGrid | None:
    """Cut the full grid of the stated size out of a lattice; None if there is none, or more than
    one, as in a larger grid."""
    places = _list_places(grid_size, asymmetric=asymmetric)
    if len(by_place) < len(places):
        return None
    starts = [
        (left, top)
        for left, top in by_place
        if all((left + x, top + y) in by_place for x, y in places)
    ]
    if len(starts) != 1:
        return None
    left, top = starts[0]
    found = [by_place[left + x, top + y] for x, y in places]
    return LabelledGrid(np.array(found).reshape(grid_size), len(by_place) - len(found))


def _cut_grids(
    placed: PointsByPlace, grid_size: GridSize | None, *, asymmetric: bool
) -> Iterator[LabelledGrid]:
    """Cut the grids that a lattice fills, but for a few places, in any basis and turn once stray
    points at its borders are left out: as many as give it the stated size, or all."""
    points = np.array(list(placed.values()))
    for xy in _shear_places(placed, asymmetric=asymmetric):
        *larger, least = _drop_stray_borders(xy, asymmetric=asymmetric)
        for kept in (*larger, least) if grid_size else (least,):
            for turn in _TURNS:
                grid = _fill_grid(xy[kept] @ turn.T, points[kept], asymmetric=asymmetric)
                if grid is not None and (kept is least or grid.shape == grid_size):
                    yield LabelledGrid(grid, len(placed) - len(kept))


def _drop_stray_borders(xy: IntArray, *, asymmetric: bool) -> Iterator[IntArray]:
    """Drop border lines with too few places (n, 2), one after the other; yield the indices of the
    places left each time, first those of all."""
    kept = np.arange(len(xy))
    while len(kept):
        yield kept
        here = xy[kept]
        low, high = here.min(axis=0), here.max(axis=0)
        # An asymmetric grid has a circle at every second place along a line.
        full = (high - low + 1)[::-1] / (2 if asymmetric else 1)
        share = np.array([(here == low).sum(axis=0), (here == high).sum(axis=0)]) / full
        if share.min() >= CIRCLE_THRESHOLDS.min_border_share:
            break
        end, axis = np.unravel_index(np.argmin(share), share.shape)
        kept = kept[here[:, axis] != (low, high)[end][axis]]


def _fill_grid(xy: IntArray, points: IntArray, *, asymmetric: bool) -> IntArray | None:
    """Return the grid (rows, cols) of `points` (n,) at the places `xy` (n, 2), -1 where none is;
    None if they do not fill one, but for a few places."""
    limits = CIRCLE_THRESHOLDS
    x, y = (xy - xy.min(axis=0)).T
    width, rows = int(x.max()) + 1, int(y.max()) + 1
    cols = width // 2 if asymmetric else width
    if min(rows, cols) < limits.min_grid_lines:
        return None
    if asymmetric and (width % 2 or (x[0] + y[0]) % 2):
        return None
    if len(xy) < (1 - limits.max_rejected_share) * rows * cols:
        return None
    grid = np.full((rows, cols), -1, dtype=np.int64)
    grid[y, x // 2 if asymmetric else x] = points
    return grid
