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
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.checkerboard.corner_template import CornerTemplate, estimate_template
from calibgui.engine.detection.checkerboard.thresholds import THRESHOLDS
from calibgui.engine.detection.lattice import (
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
    limits = THRESHOLDS.growth
    template, size = estimate_template(lattice, nearby.smooth), len(lattice)
    slow_rounds = 0
    while slow_rounds < limits.max_slow_rounds and not is_scattered(lattice):
        if len(lattice) > limits.min_growth_for_template * size:
            if is_hopeless(lattice):
                break
            template, size = estimate_template(lattice, nearby.smooth), len(lattice)
        grown = _fill_places(lattice, 1, predict_places, nearby, MAX_DEVIATION, template)
        may_have_gaps = not is_scattered(lattice, limits.min_filled_beside_gaps)
        if grown is None and may_have_gaps and beyond.exceeds(lattice):
            deviation = limits.max_gap_deviation
            grown = _fill_places(
                lattice, MAX_GAP, _predict_by_grid_map, beyond, deviation, template
            )
        if grown is None or max(grown.shape) > limits.max_lattice_side:
            break
        slow_rounds += (len(grown) - len(lattice)) ** 2 < len(lattice)
        lattice = grown
        is_sparse = compute_filled_share(lattice) < THRESHOLDS.search.min_filled_in_texture
        if is_sparse and slow_rounds >= limits.max_ragged_rounds:
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

    def exceeds(self, lattice: Lattice) -> bool:
        """Return whether there are others than the corners of a lattice."""
        if len(self.uv) > len(lattice):
            return True
        if self._tree is None:
            return False
        _, corners = self._tree.query(lattice.uv[lattice.found])
        return len(np.unique(corners)) < len(self.uv)

    def pair_nearest(self, uv: Array, farthest: float) -> tuple[IntArray, IntArray]:
        """Pair each of the positions `uv` (n, 2) px with the few points nearest to it, none of them
        as far away as `farthest`, px.

        Returns:
            Indices of positions (m,) and of points (m,).
        """
        if self._tree is None:
            return np.empty(0, np.int64), np.empty(0, np.int64)
        count = min(THRESHOLDS.growth.max_points_per_place, len(self.uv))
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
    if len(lattice) >= THRESHOLDS.growth.min_corners_over_gaps:
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
    known = np.isfinite(predicted + right + down).all(axis=2)
    rows, cols = np.nonzero(~framed.found & known)
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
