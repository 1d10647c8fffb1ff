"""Fill a lattice's holes and extend its borders, one line of corners at a time.

The graph of neighbours misses the corners that are hidden, blurred or at the border of the image.
An empty place next to the lattice is predicted from its neighbours. It is filled by the
saddle point within 0.3 steps that looks most as the place requires (`corner_template`). At the true
border of a board none does, since beyond it three or four sectors are alike. Where nothing can be
added beside the lattice, gaps of up to three steps are bridged, with junctions that lie where the
grid map of the whole lattice places them.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray, compute_lengths
from calibgui.engine.features.corner_template import CornerTemplate, estimate_template
from calibgui.engine.features.lattice import (
    MAX_DEVIATION,
    MAX_GAP,
    Lattice,
    add_border,
    compute_filled_share,
    estimate_steps,
    is_scattered,
    measure_in_steps,
    predict_places,
    trim_lattice,
)
from calibgui.engine.lattices import grid_map

MIN_FILLED_IN_TEXTURE = 0.5
"""Share of its rows and columns that a lattice fills, below which it is as ragged as those of
textures; of a board some part is full."""
MAX_POINTS_PER_PLACE = 6
"""Number of saddle points near a predicted corner, the nearest, that are compared with it."""
_MIN_CORNERS_OVER_GAPS = 12
"""Number of corners from which on their grid map is trusted beyond a gap."""
_MIN_FILLED_BESIDE_GAPS = 0.35
"""Share of its rows and columns that a lattice of many corners fills at least if gaps around it
are bridged: those of boards fill 0.39 or more, through the "waves" one winds from gap to
gap."""
_MAX_GAP_DEVIATION = 0.2
"""Greatest distance of a corner beyond a gap from where the grid map places it, steps."""
_MIN_GROWTH_FOR_TEMPLATE = 1.2
"""Growth in corners, as a factor, after which the typical corner is taken anew and the
prefilter is asked again."""
_MAX_SLOW_ROUNDS = 50
"""Number of rounds, each adding fewer corners than a line of a square board of so many has,
after which growth ends."""
_MAX_RAGGED_ROUNDS = 16
"""Number of such rounds after which a sparse lattice is given up. Boards that are partly hidden
or blinded grow by whole lines all the same, up to 10 slow rounds in 54 growths, and what joins
two boards fills most of its rows and columns; the "halftone" of `tests.benchmarks.refusals` has
up to 44."""
_MAX_LATTICE_SIDE = 200
"""Number of rows or columns beyond which growth ends."""
_MARGIN = 1 + 1e-9
"""Factor of a distance within which points are looked up that are then measured in steps, which
rounds otherwise."""


def grow_lattice(
    lattice: Lattice,
    nearby: PointIndex,
    beyond: PointIndex,
    is_hopeless: Callable[[Lattice], bool],
) -> Lattice | None:
    """Fill every hole and extend every border of a lattice that the saddle points allow; return
    None if it stays ragged however long it grows, as in a texture.

    Args:
        lattice: the lattice to start from; returned itself if nothing can be added.
        nearby: saddle points, which may fill a place beside the lattice's corners.
        beyond: junctions, which may fill a place beyond a gap.
        is_hopeless: test of whether a lattice can no longer become a board's, which ends growth.
    """
    template, size = estimate_template(lattice, nearby.smooth), len(lattice)
    slow_rounds = 0
    while slow_rounds < _MAX_SLOW_ROUNDS and not is_scattered(lattice):
        if len(lattice) > _MIN_GROWTH_FOR_TEMPLATE * size:
            if is_hopeless(lattice):
                break
            template, size = estimate_template(lattice, nearby.smooth), len(lattice)
        grown = _fill_places(lattice, 1, predict_places, nearby, MAX_DEVIATION, template)
        if grown is None and not is_scattered(lattice, _MIN_FILLED_BESIDE_GAPS):
            deviation = _MAX_GAP_DEVIATION
            grown = _fill_places(
                lattice, MAX_GAP, _predict_by_grid_map, beyond, deviation, template
            )
        if grown is None or max(grown.shape) > _MAX_LATTICE_SIDE:
            break
        slow_rounds += (len(grown) - len(lattice)) ** 2 < len(lattice)
        lattice = grown
        is_sparse = compute_filled_share(lattice) < MIN_FILLED_IN_TEXTURE
        if is_sparse and slow_rounds >= _MAX_RAGGED_ROUNDS:
            return None
    return lattice


class PointIndex:
    """Points of one image, found by their place."""

    def __init__(self, smooth: GreyImage, uv: Array) -> None:
        """
        Args:
            smooth: (h, w) the image in which they were found.
            uv: (n, 2) px.
        """
        self.smooth, self.uv = smooth, uv

    @cached_property
    def _tree(self) -> scipy.spatial.cKDTree | None:
        """The points by their place, once one is asked for."""
        return scipy.spatial.cKDTree(self.uv) if len(self.uv) else None

    def pair_nearest(self, uv: Array, farthest: float) -> tuple[IntArray, IntArray]:
        """Pair each of the positions `uv` (n, 2) px with the few points nearest to it, none of them
        as far away as `farthest`, px.

        Returns:
            Indices of positions (m,) and of points (m,).
        """
        if self._tree is None:
            return np.empty(0, np.int64), np.empty(0, np.int64)
        count = min(MAX_POINTS_PER_PLACE, len(self.uv))
        ranks = np.arange(1, count + 1)
        _, index = self._tree.query(uv, ranks, distance_upper_bound=farthest)
        # Where there is none so near, the index is the number of all.
        position, rank = np.nonzero(np.asarray(index) < len(self.uv))
        return position, np.asarray(index)[position, rank]


def _predict_by_grid_map(uv: Array) -> Array:
    """Predict the empty places of a lattice `uv` (rows, cols, 2) px from all of its corners; NaN
    where there is a corner, and everywhere if these are too few."""
    lattice = Lattice(uv, dark=True)
    expected = np.full_like(uv, np.nan)
    if len(lattice) >= _MIN_CORNERS_OVER_GAPS:
        missing = ~lattice.found
        expected[missing] = grid_map.fit_grid_map(lattice).locate(
            np.argwhere(missing).astype(np.float64)
        )
    return expected


def _fill_places(
    lattice: Lattice,
    border: int,
    predict: Callable[[Array], Array],
    points: PointIndex,
    max_deviation: float,
    template: CornerTemplate,
) -> Lattice | None:
    """Fill the empty places of a lattice with the points that fit.

    Args:
        lattice: what is known.
        border: width of the border of places around it that are tried too, steps.
        predict: predicts the places of a lattice (rows, cols, 2), px; NaN where it cannot.
        points: what may fill a place.
        max_deviation: greatest distance of a point from the prediction, steps.
        template: the lattice's typical corner, which a point must match.

    Returns:
        The larger lattice, None if nothing fits.
    """
    uv = add_border(lattice.uv, border)
    framed = Lattice(uv, lattice.dark)
    predicted = predict(uv)
    right, down = estimate_steps(uv)
    is_predicted = np.isfinite(predicted + right + down).all(axis=2)
    rows, cols = np.nonzero(~framed.found & is_predicted)
    steps = compute_lengths(right[rows, cols]) + compute_lengths(down[rows, cols])
    farthest = _MARGIN * max_deviation * float(steps.max(initial=0.0))
    place, index = points.pair_nearest(predicted[rows, cols], farthest)
    r, c = rows[place], cols[place]
    offset = points.uv[index] - predicted[r, c]
    near = measure_in_steps(offset, right[r, c], down[r, c]) < max_deviation
    index, r, c = index[near], r[near], c[near]
    if not len(index):
        return None
    free = _are_free(points.uv[index], right[r, c], down[r, c], lattice)
    index, r, c = index[free], r[free], c[free]
    if not len(index):
        return None
    dark = framed.dark ^ ((r + c) % 2 == 1)
    fits, gap = template.match(points.smooth, points.uv[index], right[r, c], down[r, c], dark)
    order = np.flatnonzero(fits)[np.argsort(gap[fits], kind="stable")]  # the best is written last
    uv[r[order], c[order]] = points.uv[index[order]]
    filled = trim_lattice(Lattice(uv, framed.dark))
    return filled if filled is not None and len(filled) > len(lattice) else None


def _are_free(uv: Array, right: Array, down: Array, lattice: Lattice) -> BoolArray:
    """Return a mask (n,) of the points `uv` (n, 2) px that are no corners of a lattice, to half of
    the shorter of the steps `right` and `down` (n, 2) px."""
    # A tree that is asked so little is not worth balancing.
    corners = lattice.uv[lattice.found]
    tree = scipy.spatial.cKDTree(corners, compact_nodes=False, balanced_tree=False)
    distance, _ = tree.query(uv)
    step = np.minimum(compute_lengths(right), compute_lengths(down))
    return np.asarray(distance > step / 2)
