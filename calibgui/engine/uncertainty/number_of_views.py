"""How many views are enough? The question with which the paper ends.

Against the number of views: one sigma of the principal point, of the focal length and of
projection, from random sets of the views at hand and from well-chosen ones
(``view_design.py``). Well-chosen sets are grown: the view is added that lowers the loss most;
then, as long as that helps, the view that is missed least is exchanged for the best other
(Fedorov's exchange). And, as a check that assumes nothing, random sets are calibrated in
earnest, each with a plate of its own where one is estimated: their estimates scatter about the
one from all K views with a variance that is (1 - n / K) of the true one, because they share views
with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, IntArray, freeze, freeze_ints
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import as_drawn, settings_of
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.errors import CalibrationError, Progress
from calibgui.engine.uncertainty.view_design import Design, design

QUANTITIES = ("principal point", "focal length", "projection")
QUANTILES = (0.1, 0.5, 0.9)
_EACH = 30
"""Numbers of views up to which each is studied, and numbers studied beyond."""
_DRAWS = 200
"""Random sets of every size."""
_LARGEST = 40
"""Size up to which well-chosen sets are grown."""
_FEWEST = 3
"""Smallest set that is calibrated in earnest."""


@dataclass(frozen=True, eq=False, slots=True)
class ViewCount:
    """The uncertainty against the number of views; columns as `QUANTITIES`."""

    counts: IntArray
    """(n,) numbers of views."""
    random: Array
    """(n, 3 quantiles, 3) one sigma of random sets, px; see `QUANTILES`."""
    chosen: Array
    """(n, 3) one sigma of well-chosen sets, px; NaN beyond the largest that was grown."""
    sets: tuple[IntArray, ...]
    """The well-chosen sets: views in ascending order, one set for each of the first counts."""
    scatter: Array
    """(n, 2) one sigma of principal point and focal length, px, found by calibrating random
    sets; NaN where it was not tried or half the sets failed."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "counts", freeze_ints(self.counts))
        freeze(self, "random", "chosen", "scatter")

    def enough(self, quantity: str, limit: float, chosen: bool = False) -> int | None:
        """The smallest number of views from which one sigma stays within `limit` px.

        Args:
            quantity: one of `QUANTITIES`.
            limit: largest standard deviation, px.
            chosen: of well-chosen sets; otherwise the median of random ones.
        """
        sigma = (self.chosen if chosen else self.random[:, 1])[:, QUANTITIES.index(quantity)]
        above = np.flatnonzero(~(sigma <= limit) & ~np.isnan(sigma))
        known = np.flatnonzero(~np.isnan(sigma))
        first = 0 if not len(above) else above[-1] + 1
        return int(self.counts[first]) if first <= known[-1] else None


def study(
    calibration: Calibration,
    views: Sequence[Observation],
    solved: int = 0,
    seed: int = 0,
    progress: Progress | None = None,
) -> ViewCount:
    """Study how the uncertainty falls with the number of views.

    Args:
        calibration: of the camera.
        views: that it was made from, at least three.
        solved: random sets of each size to calibrate in earnest; 0 for none.
        seed: of the random sets.
        progress: told of each calibration.

    Raises:
        CalibrationError: with fewer than three views.
    """
    K = len(views)
    if K < _FEWEST:
        raise CalibrationError(
            f"{K} views are too few to study their number.", "Calibrate from at least three."
        )
    choice, rng = design(calibration, views), np.random.default_rng(seed)
    each, beyond = np.arange(2, min(K, _EACH) + 1), np.geomspace(2, K, _EACH).astype(int)
    counts = np.unique(np.concatenate([each, beyond]))
    random = [_quantiles(choice, _drawn(rng, K, n, _DRAWS)) for n in counts]
    sets = _grown(choice, counts)
    chosen = np.full((len(counts), len(QUANTITIES)), np.nan)
    chosen[: len(sets)] = choice.numbers(sets)
    return ViewCount(
        counts=counts,
        random=np.array(random),
        chosen=chosen,
        sets=tuple(np.flatnonzero(members) for members in sets),
        scatter=_scatter(calibration, views, counts, solved, rng, progress),
    )


def _drawn(rng: np.random.Generator, K: int, n: int, draws: int) -> Array:
    """(draws, K) random sets of n of K views, 1 for a member."""
    order = rng.random((draws, K)).argsort(axis=1)
    return (order < n).astype(np.float64)


def _quantiles(choice: Design, sets: Array) -> Array:
    """(3, 3) of one sigma of sets (draws, K)."""
    return np.asarray(np.quantile(choice.numbers(sets), QUANTILES, axis=0))


def _grown(choice: Design, counts: IntArray) -> Array:
    """(m, K) well-chosen sets of the first m counts, 1 for a member."""
    members = np.zeros(len(choice.views.camera))
    sets = []
    for n in counts[counts <= _LARGEST]:
        while members.sum() < n:
            members = _changed(choice, members, 1.0)
        members = _exchanged(choice, members)
        sets.append(members)
    return np.array(sets)


def _exchanged(choice: Design, members: Array) -> Array:
    """The set after exchanging views as long as that lowers the loss."""
    loss = choice.loss(members)
    while True:
        other = _changed(choice, _changed(choice, members, -1.0), 1.0)
        if not choice.loss(other) < loss * (1 - 1e-9):
            return members
        members, loss = other, choice.loss(other)


def _changed(choice: Design, members: Array, change: float) -> Array:
    """The set with the one view added (1) or removed (-1) that leaves the least loss."""
    candidates = np.flatnonzero(members == (0.0 if change > 0 else 1.0))
    trials = members + change * np.eye(len(members))[candidates]
    return np.asarray(trials[np.argmin(choice.loss(trials))])


def _scatter(
    calibration: Calibration,
    views: Sequence[Observation],
    counts: IntArray,
    solved: int,
    rng: np.random.Generator,
    progress: Progress | None,
) -> Array:
    """(n, 2) one sigma of centre and focal length from sets that are calibrated."""
    K = len(views)
    sigma = np.full((len(counts), 2), np.nan)
    settings = settings_of(calibration)
    if calibration.cost is Cost.IMAGE and calibration.board_shape is None:
        settings["board_shape"] = as_drawn(views)
    sizes = [i for i, n in enumerate(counts) if _FEWEST <= n < K]
    for done, i in enumerate(sizes):
        n = int(counts[i])
        moved = []
        for members in _drawn(rng, K, n, solved):
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
