"""The grid among points: which of them are its circles, and which circle each of them is.

The places of a grid form a lattice: of a symmetric one (x, y) = (i, j), of an asymmetric one
(x, y) = (i - j, i + j). In an image every small part of it is nearly a lattice too, which is grown
from a point and two of its neighbours (`lattice_growth`). Three points that have no others where
their lattice would have its next ones are no part of a grid, and are not grown: almost all of those
in textures.

The nearest points of a tilted grid need not be the neighbours along rows and columns: the lattice
may have grown along a diagonal. Of the few ways to assign places to it, that is right in which the
points fill a rectangle of the pattern, or the most of one of which a few are covered.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import combinations
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, BoolArray, GridSize, IntArray
from calibgui.engine.detection.circles.lattice_growth import Place, PointLattice, grow_lattice
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS
from calibgui.engine.geometry import homography

_MAX_SEEDS = 8
"""Number of points, from the middle outwards, from which the lattice is grown."""
_NEIGHBOURS = 5
"""Number of nearest points of a seed, two of which are taken as its neighbours on the lattice."""
_MIN_AROUND = 4
"""Least number of the places `_AROUND` that hold a point."""
_AROUND = np.array([(-1, 0), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1)])
"""(6, 2) coordinates of the places around a seed whose neighbours (1, 0) and (0, 1) are given."""
_MAX_STRAYS = 2
"""Greatest number of points on a line that is none of the grid."""
_SHEARS = tuple(np.array([[1, a], [b, 1]]) for a, b in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)))
_CORNER = np.array([(0, 0), (1, 0), (0, 1)])
"""(3, 2) places of the points that a lattice starts from."""
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
    tried: list[dict[int, Place]] = []
    for seed in _find_nearest(tree, np.median(points, axis=0), _MAX_SEEDS):
        if best is not None and best.is_full and seed in best.points:
            continue
        for start in _start_lattices(seed, points, tree):
            if any(_is_same_lattice(start, other) for other in tried):
                continue
            lattice = grow_lattice(start, points)
            tried.append(lattice.list_places())
            if len(lattice.points) < fewest:
                continue
            grids = list(_cut_grids(lattice, grid_size, asymmetric=asymmetric))
            if any(len(grid) >= fewest and not grid.is_continued for grid in grids) and not any(
                grid.is_full for grid in grids
            ):
                lattice = _complete_lattice(lattice, points)
                grids = list(_cut_grids(lattice, grid_size, asymmetric=asymmetric))
            for grid in grids:
                if len(grid) >= fewest:
                    best = max(best or grid, grid, key=partial(_rank_grid, grid_size))
            # A lattice that began across a gap has more gaps than the grid.
            if best is not None and best.is_full and seed in best.points:
                break
    if best is None or best.is_continued:
        return None
    return None if _is_continued(best, points, asymmetric=asymmetric) else best


def find_lattice(points: Array) -> PointLattice | None:
    """Find the largest lattice among points (n, 2) px; None if there is none."""
    if len(points) <= max(_NEIGHBOURS, _MAX_SEEDS):
        return None
    tree = scipy.spatial.cKDTree(points)
    best: PointLattice | None = None
    for seed in _find_nearest(tree, np.median(points, axis=0), _MAX_SEEDS):
        if best is not None and seed in best.points:
            continue
        for start in _start_lattices(seed, points, tree):
            lattice = grow_lattice(start, points)
            if best is None or len(lattice.points) > len(best.points):
                best = lattice
    return best


def list_boxes(lattice: PointLattice, *, asymmetric: bool) -> Iterator[IntArray]:
    """List the rectangles (h, w), by pitches, that hold all points of a grid's lattice, in any
    basis and turn, but for lines that have two or fewer, or one where every second place is taken:
    indices of the points, -1 where none is. A symmetric grid upside down is the same."""
    strays = _MAX_STRAYS // 2 if asymmetric else _MAX_STRAYS
    for xy in _shear_places(lattice, asymmetric=asymmetric):
        for turn in _TURNS if asymmetric else _TURNS[:2]:
            x, y = (xy @ turn.T).T
            kept = _find_common(x, strays) & _find_common(y, strays)
            if kept.any():
                x, y = x[kept] - x[kept].min(), y[kept] - y[kept].min()
                box = np.full((int(y.max()) + 1, int(x.max()) + 1), -1, dtype=np.int64)
                box[y, x] = lattice.points[kept]
                yield box


def _find_common(line: IntArray, strays: int) -> BoolArray:
    """Find the points (n,) True that share their line with others, and are more than `strays`."""
    start = line.min()
    return np.asarray(np.bincount(line - start)[line - start] > strays)


def _is_continued(grid: LabelledGrid, points: Array, *, asymmetric: bool) -> bool:
    """Return whether a grid of points (n, 2) px is a part of a larger one: most others around lie
    where it goes on, and they are many. Something hides what would join them. In the middle of the
    cells of a symmetric grid they belong to an asymmetric one, turned."""
    limits = CIRCLE_THRESHOLDS
    members = grid.points
    others = np.delete(points, members, axis=0)
    if len(others) <= limits.max_continued_share * len(members):
        return False
    rows, cols = grid.places.shape
    xy = _list_places((rows, cols), asymmetric=asymmetric).astype(np.float64)
    to_board = homography.fit_homography(
        points[members], xy[grid.places.ravel() >= 0], np.ones(len(members))
    )
    at = homography.apply_homography(to_board, others)
    reach = limits.continued_lines
    near = ((at > xy.min(axis=0) - reach) & (at < xy.max(axis=0) + reach)).all(axis=1)
    x, y = at[near].T
    lattice = np.column_stack([x + y, x - y]) / (2 if asymmetric else 1)
    off = np.abs(lattice - np.rint(lattice)).max(axis=1)
    continuing = int(np.count_nonzero(off < limits.max_continuation_error))
    return continuing > max(limits.max_continued_share * len(members), len(off) / 2)


def _rank_grid(grid_size: GridSize | None, grid: LabelledGrid) -> tuple[int, int, bool, int]:
    """Rank grids: the more points the better, of the same points with fewer gaps, of the stated
    size or else with fewer rows."""
    shape = grid.places.shape
    return len(grid), -grid.places.size, shape == grid_size, -shape[0]


def _find_nearest(tree: scipy.spatial.cKDTree, to: Array, count: int) -> list[int]:
    """Find the points nearest to a position, the nearest first."""
    nearest: list[int] = np.asarray(tree.query(to, k=count)[1]).tolist()
    return nearest


def _start_lattices(
    seed: int, points: Array, tree: scipy.spatial.cKDTree
) -> Iterator[PointLattice]:
    """Start lattices, right-handed in the image, from a point and two of its neighbours around
    which others lie where their lattice would have its next ones."""
    neighbours = _find_nearest(tree, points[seed], _NEIGHBOURS + 1)[1:]
    pairs = np.array(list(combinations(neighbours, 2)))
    steps = points[pairs] - points[seed]
    length = np.linalg.norm(steps, axis=2)
    sine = np.linalg.det(steps) / length.prod(axis=1)
    distance = np.asarray(tree.query(points[seed] + _AROUND @ steps)[0])
    reach = CIRCLE_THRESHOLDS.max_prediction_error * length.min(axis=1)
    is_seen = np.count_nonzero(distance < reach[:, None], axis=1) >= _MIN_AROUND
    for pair in np.flatnonzero(is_seen & (abs(sine) > CIRCLE_THRESHOLDS.min_seed_sine)):
        first, second = pairs[pair] if sine[pair] > 0 else pairs[pair, ::-1]
        yield PointLattice(_CORNER, np.array([seed, first, second]))


def _is_same_lattice(start: PointLattice, grown: dict[int, Place]) -> bool:
    """Return whether a lattice would be one that was grown before, in another basis."""
    places = [grown[point] for point in start.points.tolist() if point in grown]
    if len(places) < len(start.points):
        return False
    (i, j), *steps = places
    (ai, aj), (bi, bj) = steps
    return abs((ai - i) * (bj - j) - (aj - j) * (bi - i)) == 1


def _complete_lattice(lattice: PointLattice, points: Array) -> PointLattice:
    """Grow a lattice on in every basis that the pattern may have in it: a point beside a covered
    one may be predicted in one of them only."""
    for shear in _SHEARS:
        grown = grow_lattice(lattice.change_basis(shear), points)
        lattice = grown.change_basis(2 * np.eye(2, dtype=np.int64) - shear)
    return lattice


def _shear_places(lattice: PointLattice, *, asymmetric: bool) -> Iterator[IntArray]:
    """List the places (n, 2) = (x, y) of a lattice's points for every basis that it may have grown
    by, up to turns by quarters."""
    for shear in _SHEARS:
        i, j = shear @ lattice.places.T
        yield np.column_stack([i - j, i + j] if asymmetric else [i, j])


def _list_places(grid_size: GridSize, *, asymmetric: bool) -> IntArray:
    """List (x, y) of a grid's circles (n, 2), row by row."""
    m, n = np.indices(grid_size).reshape(2, -1)
    return np.column_stack([2 * n + m % 2 if asymmetric else n, m])


def _cut_grids(
    lattice: PointLattice, grid_size: GridSize | None, *, asymmetric: bool
) -> Iterator[LabelledGrid]:
    """Cut the grids that a lattice fills, but for a few places, in any basis and turn once stray
    points at its borders are left out: as many as give it the stated size, or all."""
    # An asymmetric grid has a circle at every second place along a line.
    per_circle = 2 if asymmetric else 1
    limits = CIRCLE_THRESHOLDS
    stated = sorted((grid_size[0], per_circle * grid_size[1])) if grid_size else (0, 0)
    for xy in _shear_places(lattice, asymmetric=asymmetric):
        boxes = _drop_borders(xy, per_circle, limits.min_border_share)
        lines = np.sort(boxes[:, 1] - boxes[:, 0] + 1, axis=1)
        is_least = np.arange(len(boxes)) == len(boxes) - 1
        for k in np.flatnonzero((lines == stated).all(axis=1) | is_least):
            box = boxes[k]
            kept = ((xy >= box[0]) & (xy <= box[1])).all(axis=1)
            count = int(np.count_nonzero(kept))
            full = np.prod(box[1] - box[0] + 1) / per_circle
            if count < (1 - limits.max_rejected_share) * full:
                continue
            for turn in _TURNS:
                grid = _fill_grid(xy[kept] @ turn.T, lattice.points[kept], asymmetric=asymmetric)
                if grid is not None and (is_least[k] or grid.shape == grid_size):
                    yield LabelledGrid(grid, len(xy) - count)


@kernels.with_kernel("lattice_growth", "drop_borders")
def _drop_borders(xy: IntArray, places_per_circle: int, min_share: float) -> IntArray:
    """Drop border lines with too few of the places (n, 2), one after the other.

    Args:
        xy: (n, 2) places that are taken.
        places_per_circle: number of places along a line for each that is taken in a full grid.
        min_share: least share of these that a border line must have.

    Returns:
        (k, 2, 2) the least and the greatest place that is left, first of all, then each time.
    """
    boxes = []
    while len(xy):
        low, high = xy.min(axis=0), xy.max(axis=0)
        boxes.append([low, high])
        full = (high - low + 1)[::-1] / places_per_circle
        share = np.array([(xy == low).sum(axis=0), (xy == high).sum(axis=0)]) / full
        if share.min() >= min_share:
            break
        end, axis = np.unravel_index(np.argmin(share), share.shape)
        xy = xy[xy[:, axis] != (low, high)[end][axis]]
    return np.array(boxes)


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
