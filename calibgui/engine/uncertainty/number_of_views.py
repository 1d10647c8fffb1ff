"""The number of views that is enough: the question with which the paper ends.

The study gives one sigma of the principal point, of the focal length and of projection against
the number of views, for random sets of the views at hand and for well-chosen ones
(``view_design.py``). Well-chosen sets are grown: the view is added that lowers the loss most;
then, as long as that helps, the view that is missed least is exchanged for the best other
(Fedorov, Theory of Optimal Experiments, 1972). As a check that assumes nothing, random sets are
calibrated, each with a board shape of its own where one is estimated: their estimates scatter
about the one from all K views with a variance that is (1 - n / K) of the true one, because they
share views with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, IntArray, freeze, freeze_ints
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import recover_arguments
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.errors import CalibrationError, Progress
from calibgui.engine.uncertainty.view_design import ViewDesign, build_design

QUANTITIES = ("principal point", "focal length", "projection")
"""Quantities whose uncertainty is studied."""
QUANTILES = (0.1, 0.5, 0.9)
"""Quantiles of random sets that are given."""
_MAX_STUDIED_SIZES = 30
"""Number of views up to which each number is studied; as many are spread geometrically."""
_RANDOM_SETS_PER_SIZE = 200
"""Number of random sets of every size."""
_MAX_CHOSEN_VIEWS = 40
"""Number of views up to which well-chosen sets are grown."""
_MIN_SOLVED_VIEWS = 3
"""Number of views below which a set is not calibrated."""


@dataclass(frozen=True, eq=False, slots=True)
class ViewCountStudy:
    """Uncertainty against the number of views; columns are those of `QUANTITIES`."""

    counts: IntArray
    """(n,) numbers of views."""
    random: Array
    """(n, 3 quantiles, 3) one sigma of random sets, px; see `QUANTILES`."""
    chosen: Array
    """(n, 3) one sigma of well-chosen sets, px; NaN beyond the largest that was grown."""
    sets: tuple[IntArray, ...]
    """The well-chosen sets: views in ascending order, one set for each of the first counts."""
    scatter: Array
    """(n, 2) one sigma of principal point and focal length, px, from random sets that were
    calibrated; NaN where it was not tried or half the sets failed."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "counts", freeze_ints(self.counts))
        freeze(self, "random", "chosen", "scatter")

    def find_sufficient_count(
        self, quantity: str, limit: float, chosen: bool = False
    ) -> int | None:
        """Return the smallest number of views from which one sigma stays within `limit` px.

        It is None if all views together do not reach it.

        Args:
            quantity: one of `QUANTITIES`.
            limit: largest standard deviation, px.
            chosen: True for well-chosen sets; otherwise the median of random ones counts.
        """
        sigma = (self.chosen if chosen else self.random[:, 1])[:, QUANTITIES.index(quantity)]
        above = np.flatnonzero(~(sigma <= limit) & ~np.isnan(sigma))
        known = np.flatnonzero(~np.isnan(sigma))
        first = 0 if not len(above) else above[-1] + 1
        return int(self.counts[first]) if first <= known[-1] else None


def study_number_of_views(
    calibration: Calibration,
    views: Sequence[Observation],
    solved: int = 0,
    progress: Progress | None = None,
) -> ViewCountStudy:
    """Study how the uncertainty falls with the number of views.

    The random sets are the same each time.

    Args:
        calibration: the calibration.
        views: the views that it was made from, at least three.
        solved: number of random sets of each size to calibrate; 0 for none.
        progress: function that is called after each calibration.

    Raises:
        CalibrationError: with fewer than three views.
    """
    K = len(views)
    if K < _MIN_SOLVED_VIEWS:
        raise CalibrationError(
            f"{K} views are too few to study their number.", "Calibrate from at least three."
        )
    design, rng = build_design(calibration, views), np.random.default_rng(0)
    each, beyond = (
        np.arange(2, min(K, _MAX_STUDIED_SIZES) + 1),
        np.geomspace(2, K, _MAX_STUDIED_SIZES).astype(int),
    )
    counts = np.unique(np.concatenate([each, beyond]))
    random = [
        _compute_quantiles(design, _draw_random_sets(rng, K, n, _RANDOM_SETS_PER_SIZE))
        for n in counts
    ]
    sets = _grow_chosen_sets(design, counts)
    chosen = np.full((len(counts), len(QUANTITIES)), np.nan)
    chosen[: len(sets)] = design.compute_sigmas(sets)
    return ViewCountStudy(
        counts=counts,
        random=np.array(random),
        chosen=chosen,
        sets=tuple(np.flatnonzero(members) for members in sets),
        scatter=_measure_scatter(calibration, views, counts, solved, rng, progress),
    )


def _draw_random_sets(rng: np.random.Generator, K: int, n: int, draws: int) -> Array:
    """Draw random sets (draws, K) of n of K views, 1 for a member."""
    order = rng.random((draws, K)).argsort(axis=1)
    return (order < n).astype(np.float64)


def _compute_quantiles(design: ViewDesign, sets: Array) -> Array:
    """Compute the quantiles (3, 3) of one sigma of sets (draws, K)."""
    return np.asarray(np.quantile(design.compute_sigmas(sets), QUANTILES, axis=0))


def _grow_chosen_sets(design: ViewDesign, counts: IntArray) -> Array:
    """Grow the well-chosen sets (m, K) of the first m counts, 1 for a member."""
    members = np.zeros(len(design.views.camera))
    sets = []
    for n in counts[counts <= _MAX_CHOSEN_VIEWS]:
        while members.sum() < n:
            members = _change_one_view(design, members, 1.0)
        members = _exchange_views(design, members)
        sets.append(members)
    return np.array(sets)


def _exchange_views(design: ViewDesign, members: Array) -> Array:
    """Exchange views as long as that lowers the loss, and return the set (K,)."""
    loss = design.compute_loss(members)
    while True:
        other = _change_one_view(design, _change_one_view(design, members, -1.0), 1.0)
        if not design.compute_loss(other) < loss * (1 - 1e-9):
            return members
        members, loss = other, design.compute_loss(other)


def _change_one_view(design: ViewDesign, members: Array, change: float) -> Array:
    """Add (1) or remove (-1) the one view that leaves the least loss, and return the set (K,)."""
    candidates = np.flatnonzero(members == (0.0 if change > 0 else 1.0))
    trials = members + change * np.eye(len(members))[candidates]
    return np.asarray(trials[np.argmin(design.compute_loss(trials))])


def _measure_scatter(
    calibration: Calibration,
    views: Sequence[Observation],
    counts: IntArray,
    solved: int,
    rng: np.random.Generator,
    progress: Progress | None,
) -> Array:
    """Calibrate random sets and return one sigma (n, 2) of centre and focal length, px."""
    K = len(views)
    sigma = np.full((len(counts), 2), np.nan)
    settings = recover_arguments(calibration) | {"model_errors": False}
    sizes = [i for i, n in enumerate(counts) if _MIN_SOLVED_VIEWS <= n < K]
    for done, i in enumerate(sizes):
        n = int(counts[i])
        moved = []
        for members in _draw_random_sets(rng, K, n, solved):
            some = [views[k] for k in np.flatnonzero(members).tolist()]
            with suppress(CalibrationError):  # too few, or too much alike
                found = calibrate(some, calibration.camera.size, **settings).camera.params
                moved.append(found[:4] - calibration.camera.params[:4])
        if len(moved) > solved / 2:
            squares = np.mean(np.square(moved), axis=0) / (1 - n / K)
            sigma[i] = np.sqrt([squares[2:].mean(), squares[:2].mean()])
        if progress is not None:
            progress(done + 1, len(sizes))
    return sigma
