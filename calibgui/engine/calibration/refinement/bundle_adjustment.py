"""Stage II from its start to the minimum, past what can keep it from there.

Tilts that the start mistook for their mirror images are righted (``tilts.py``).

The correction of a pincushion lens folds over beyond its outermost corners, and the image cost
has no value where a fold comes before them: neither at a start beyond it nor on a way through
it. Registration on the reference plane always has one; with the lower terms of the lens only,
its solution mostly folds outside. For lenses on the brink of it the solution's coefficients are
weakened until all corners have an image.

The same detour is taken where the solve was slow. It has then crept along a valley that the
views hardly bar, and in few and noisy views such a valley can have several lows: with e the
eigenvector of the scaled information of least eigenvalue (``uncertainty.py``), starts a few
standard deviations to either side of the solution along e, the poses following as
dk = -Vk^-1 Wk^T e, roll into its neighbours. The lowest counts.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from calibgui.engine.arrays import IntArray
from calibgui.engine.calibration import covariances
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement import normal_equations
from calibgui.engine.calibration.refinement.levenberg_marquardt import (
    Solution,
    StartError,
    minimise,
)
from calibgui.engine.calibration.refinement.planar_pose_ambiguity import ProblemOf, righted
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.schur import NormalAt, schur
from calibgui.engine.calibration.refinement.whitening import model_variance, weighted
from calibgui.engine.calibration.result import Cost, Iteration, Report, Status

_REWEIGHTINGS = 4
"""Rounds of estimating the model's own errors; each changes the weights ten times less."""
_TURNS = 3
"""Rounds of righting tilts: some righted better the camera that tells the others."""
_SLOW = 15
"""Iterations beyond which another way is tried; one in thirty wild problems takes as many."""
_ASIDE = 4.0
"""Standard deviations to the side that another low is looked for."""
_FLAT = 1e-10
"""Information left that is taken to be the least."""
_SAME = 1e-9
"""Difference of costs, relative, that is none."""
_FIRST_COEFFICIENT = 4
_WEAKER = 0.99
_WEAKENINGS = 10
_LOWER = 6
"""Number of the camera's parameters up to k2: focal lengths, centre, k1, k2 in every model."""


def solved(
    observations: Observations,
    start: State,
    *,
    model: str,
    cost: Cost,
    scale: float,
    free: IntArray,
    report: Report | None,
    max_iterations: int,
    earlier: Sequence[Iteration] = (),
) -> Solution:
    """Stage II.

    Args:
        observations: the views.
        start: where to begin.
        model: the lens, a key of ``lens.MODELS``.
        cost: what is minimised.
        scale: reference px per mm, for the costs on the reference plane.
        free: (P,) indices of the camera's parameters that may move.
        report: told of each iteration; may stop it.
        max_iterations: of each solve.
        earlier: iterations of the solve that this one continues.

    Raises:
        StartError: if neither the start nor its registration reprojects the corners.
        Cancelled: from `report`.
    """
    stage = _StageTwo(observations, model, cost, scale, free, report, max_iterations, earlier)
    by_way_of_the_plate = partial(stage.registered, stage.with_tilts_righted, start)
    direct = True
    try:
        solution = stage.with_tilts_righted(start)
    except StartError:
        direct, solution = False, by_way_of_the_plate()
    slow = len(solution.history) - len(earlier) > _SLOW
    if solution.status is Status.STOPPED or not (slow or solution.barred):
        return solution
    if direct:
        solution = _lower(solution, by_way_of_the_plate)
    for beside in _beside(solution, free, observations.count):
        solution = _lower(solution, partial(stage.with_tilts_righted, beside))
    return solution


@dataclass(frozen=True, eq=False, slots=True)
class _StageTwo:
    """The arguments of `solved` but for the start, and the ways from one to a minimum."""

    observations: Observations
    model: str
    cost: Cost
    scale: float
    free: IntArray
    report: Report | None
    max_iterations: int
    earlier: Sequence[Iteration]

    def problem_of(self, views: Observations, free: IntArray) -> NormalAt:
        """What is minimised."""
        return normal_equations.stage_two(views, self.model, self.cost, self.scale, free)

    def registration(self, views: Observations, free: IntArray) -> NormalAt:
        """The same on the reference plane."""
        return normal_equations.stage_two(views, self.model, Cost.REFERENCE, self.scale, free)

    def direct(self, start: State, earlier: Sequence[Iteration] | None = None) -> Solution:
        """Straight down, after the iterations that were earlier."""
        earlier = self.earlier if earlier is None else earlier
        return self._minimum(self.problem_of, start, self.free, self.report, earlier)

    def registered(self, then: Callable[[State], Solution], start: State) -> Solution:
        """First on the reference plane with the lower terms of the lens, `then` from there."""
        lower = self.free[self.free < _LOWER]
        registered = self._minimum(self.registration, start, lower, None, ())
        return _weakened(then, registered.state, self.free)

    def with_tilts_righted(self, start: State) -> Solution:
        """Straight down, with tilts righted as long as there are any to be."""
        solution = self.direct(start)
        for _ in range(_TURNS):
            if solution.status is Status.STOPPED:
                break
            turned = righted(self.problem_of, self.registration, self.observations, solution)
            if turned is None:
                break
            try:
                solution = self.direct(turned, solution.history)
            except StartError:
                other = _lower(solution, partial(self.registered, self.direct, turned))
                if other is solution:
                    break
                solution = other
        return solution

    def _minimum(
        self,
        problem_of: ProblemOf,
        start: State,
        free: IntArray,
        report: Report | None,
        earlier: Sequence[Iteration],
    ) -> Solution:
        return minimise(
            problem_of(self.observations, free),
            start,
            free,
            self.observations.count,
            float(np.sum(self.observations.uv**2)),
            report,
            self.max_iterations,
            earlier,
        )


def _lower(solution: Solution, other: Callable[[], Solution]) -> Solution:
    """The lower one of two solutions, of which the second may have no start."""
    try:
        found = other()
    except StartError:
        return solution
    return found if found.normal.cost <= (1 + _SAME) * solution.normal.cost else solution


def _beside(solution: Solution, free: IntArray, corners: int) -> list[State]:
    """States along the valley of what the views determine least, to both sides of a solution."""
    normal = solution.normal
    reduced = schur(normal)
    values, vectors = covariances.information_left(reduced)
    sigma2 = covariances.variance(normal.cost, corners, len(free) + normal.pose.size)
    if not free.size or not np.isfinite(sigma2):
        return []
    along = reduced.unit * vectors[:, 0] * np.sqrt(sigma2 / max(values[0], _FLAT))
    states = []
    for side in (_ASIDE, -_ASIDE):
        pull = np.tensordot(normal.W, side * along, axes=([1], [0]))
        by_poses = -np.linalg.solve(normal.V, pull[..., None])[..., 0]
        states.append(solution.state.moved(side * along, np.asarray(by_poses), free))
    return states


def _weakened(run: Callable[[State], Solution], start: State, free: IntArray) -> Solution:
    """The solution from a start whose lens is weakened, if need be, until all corners are seen."""
    for _ in range(_WEAKENINGS):
        try:
            return run(start)
        except StartError:
            params = start.params.copy()
            params[free[free >= _FIRST_COEFFICIENT]] *= _WEAKER
            start = start._replace(params=params)
    return run(start)


def reweighted(
    observations: Observations, solution: Solution, model: str, solve: Callable[..., Solution]
) -> tuple[Observations, Solution]:
    """The solution with the floor under the corners' covariances that its residuals call for."""
    unknowns = len(solution.normal.shared) + solution.normal.pose.size
    tau2 = 0.0
    for _ in range(_REWEIGHTINGS):
        before = tau2
        miss, _ = normal_equations.residuals(solution.state, observations, model, Cost.IMAGE)
        tau2 = model_variance(observations, miss, unknowns)
        if solution.status is Status.STOPPED or abs(tau2 - before) <= 0.01 * before:
            break
        observations = weighted(observations, tau2)
        solution = solve(observations, solution.state, earlier=solution.history)
    return observations, solution
