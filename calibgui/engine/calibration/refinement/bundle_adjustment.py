"""Bundle adjustment: Stage II from its start to the minimum, by detours where it needs them.

Camera and poses are refined together (Triggs et al. 2000) by Levenberg-Marquardt. Three things can
keep that from the right minimum, and each has its remedy here.

Poses that the start mistook for their mirror images are corrected
(``planar_pose_ambiguity.py``).

The correction of a pincushion lens folds over beyond its outermost corners, and the image cost
has no value where a fold comes before them: neither at a start beyond it nor on a way through
it. Registration on the reference plane always has one; with the lower terms of the lens only,
its solution mostly folds outside. For lenses that barely do the solution's coefficients are
weakened until all corners have an image.

The same detour is taken where the solve was slow. It has then crept along a valley of the cost,
and in few and noisy views such a valley can have several minima: with e the eigenvector of the
scaled information of least eigenvalue (``covariances.py``), starts a few standard deviations to
either side of the solution along e, with poses that follow as dk = -Vk^-1 Wk^T e, lead to its
neighbours. The lowest minimum is the solution, and if it is still on its way after all iterations
that a solve is given, it is given more.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from calibgui.engine.arrays import IntArray
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement import covariances, residuals
from calibgui.engine.calibration.refinement.levenberg_marquardt import (
    Solution,
    StartError,
    minimise,
)
from calibgui.engine.calibration.refinement.planar_pose_ambiguity import (
    BuildProblem,
    correct_mirrored_poses,
)
from calibgui.engine.calibration.refinement.residuals import NormalAt, State
from calibgui.engine.calibration.refinement.schur import eliminate_poses
from calibgui.engine.calibration.refinement.whitening import (
    estimate_model_variance,
    whiten_observations,
)
from calibgui.engine.calibration.result import Cost, Iteration, Report, Status

_MAX_REWEIGHTINGS = 4
"""Number of estimates of the model's own errors; each changes the weights ten times less."""
_MAX_POSE_CORRECTIONS = 3
"""Number of corrections of mirrored poses: each improves the camera that the next relies on."""
_MAX_DIRECT_ITERATIONS = 15
"""Number of iterations beyond which detours are tried; one in thirty wild problems takes more."""
_MAX_CONTINUATIONS = 2
"""Number of further solves from where one used up its iterations, at most."""
_LAST_ITERATIONS, _MIN_DESCENT = 10, 1e-6
"""Number of last iterations, and decrease of the cost in them, relative to it, from which a solve
has not come near its end."""
_SIDE_STEP = 4.0
"""Distance from the solution, in standard deviations, of the starts along a valley."""
_MIN_INFORMATION = 1e-10
"""Scaled information below which a direction counts as having this much."""
_COST_TOLERANCE = 1e-9
"""Difference of costs, relative to them, up to which they are equal."""
_MIN_POSE_INFORMATION = 1e-14
"""Scaled information below which rounding errors leave nothing of a pose."""
_FIRST_COEFFICIENT = 4
"""Index of the first lens coefficient among the camera's parameters."""
_WEAKENING = 0.99
"""Factor by which the lens coefficients are weakened at a time."""
_MAX_WEAKENINGS = 10
"""Number of weakenings, at most."""
_LOWER_TERMS = 6
"""Number of the camera's parameters up to k2: focal lengths, centre, k1, k2 in every model."""


def solve_stage_two(
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
    """Solve Stage II.

    Args:
        observations: the views.
        start: the state to begin from.
        model: the lens, a key of ``camera.models.MODELS``.
        cost: the cost that is minimised.
        scale: reference px per mm, for the costs on the reference plane.
        free: (P,) indices of the camera's parameters that may change.
        report: a function that takes each iteration; it returns False to stop.
        max_iterations: number of iterations of each solve, at most.
        earlier: iterations of the solve that this one continues.

    Raises:
        StartError: if neither the start nor its registration reprojects the corners, or if no
            camera of the model sees all boards where they can be.
        Cancelled: from `report`.
    """
    stage = _StageTwo(observations, model, cost, scale, free, report, max_iterations, earlier)
    solve_by_registration = partial(
        stage.solve_by_registration, stage.solve_with_corrected_poses, start
    )
    is_direct = True
    try:
        solution = stage.solve_with_corrected_poses(start)
    except StartError:
        is_direct = False
        try:
            solution = solve_by_registration()
        except StartError as error:
            raise _make_model_error(model) from error
    if _has_lost_pose(solution):
        raise _make_model_error(model)
    is_slow = len(solution.history) - len(earlier) > _MAX_DIRECT_ITERATIONS
    if solution.status is Status.STOPPED or not (is_slow or solution.is_blocked):
        return solution
    if is_direct:
        solution = _take_lower(solution, solve_by_registration)
    for beside in _step_aside(solution, free, observations.count):
        solution = _take_lower(solution, partial(stage.solve_with_corrected_poses, beside))
    for _ in range(_MAX_CONTINUATIONS):
        if solution.is_blocked or not _is_descending(solution):
            break
        solution = stage.solve_directly(solution.state, solution.history)
    if _has_lost_pose(solution):
        raise _make_model_error(model)
    return solution


@dataclass(frozen=True, eq=False, slots=True)
class _StageTwo:
    """The arguments of `solve_stage_two` except the start, and the routes from one to a minimum."""

    observations: Observations
    model: str
    cost: Cost
    scale: float
    free: IntArray
    report: Report | None
    max_iterations: int
    earlier: Sequence[Iteration]

    def build_problem(self, views: Observations, free: IntArray) -> NormalAt:
        """Return the problem that is solved."""
        return residuals.build_stage_two(views, self.model, self.cost, self.scale, free)

    def build_registration(self, views: Observations, free: IntArray) -> NormalAt:
        """Return the same problem on the reference plane."""
        return residuals.build_stage_two(views, self.model, Cost.REFERENCE, self.scale, free)

    def solve_directly(self, start: State, earlier: Sequence[Iteration] | None = None) -> Solution:
        """Minimise from a start, after the iterations that were earlier."""
        earlier = self.earlier if earlier is None else earlier
        return self._minimise(self.build_problem, start, self.free, self.report, earlier)

    def solve_by_registration(self, then: Callable[[State], Solution], start: State) -> Solution:
        """Minimise on the reference plane with the lower terms of the lens, `then` from there."""
        lower = self.free[self.free < _LOWER_TERMS]
        registered = self._minimise(self.build_registration, start, lower, None, ())
        return _solve_with_weakened_lens(then, registered.state, self.free)

    def solve_with_corrected_poses(self, start: State) -> Solution:
        """Minimise from a start, and again as long as mirrored poses are found and corrected."""
        solution = self.solve_directly(start)
        for _ in range(_MAX_POSE_CORRECTIONS):
            if solution.status is Status.STOPPED:
                break
            corrected = correct_mirrored_poses(
                self.build_problem, self.build_registration, self.observations, solution
            )
            if corrected is None:
                break
            try:
                solution = self.solve_directly(corrected, solution.history)
            except StartError:
                other = _take_lower(
                    solution, partial(self.solve_by_registration, self.solve_directly, corrected)
                )
                if other is solution:
                    break
                solution = other
        return solution

    def _minimise(
        self,
        build_problem: BuildProblem,
        start: State,
        free: IntArray,
        report: Report | None,
        earlier: Sequence[Iteration],
    ) -> Solution:
        return minimise(
            build_problem(self.observations, free),
            start,
            free,
            self.observations.count,
            float(np.vdot(self.observations.uv, self.observations.uv)),
            report,
            self.max_iterations,
            earlier,
        )


def _has_lost_pose(solution: Solution) -> bool:
    """Return whether a board has gone so far away that its corners leave its pose open."""
    V = solution.normal.V
    size = np.sqrt(np.diagonal(V, axis1=1, axis2=2))
    with np.errstate(divide="ignore", invalid="ignore"):
        scaled = V / (size[:, :, None] * size[:, None]) - _MIN_POSE_INFORMATION * np.eye(6)
    try:
        np.linalg.cholesky(scaled)
    except np.linalg.LinAlgError:
        return True
    return not np.isfinite(scaled).all()


def _make_model_error(model: str) -> StartError:
    """Make the error of a lens model that cannot follow the corners."""
    return StartError(
        f"The lens model {model!r} cannot image all corners, however it is started.",
        "For a wide lens choose the lens model 'kannala-brandt'. Otherwise check that the views "
        "number their corners alike and come from one camera.",
    )


def _is_descending(solution: Solution) -> bool:
    """Return whether a solve used up its iterations while its cost still decreased."""
    costs = [iteration.cost for iteration in solution.history[-_LAST_ITERATIONS:]]
    before, last = costs[0], costs[-1]
    return solution.status is Status.MAX_ITERATIONS and before - last > _MIN_DESCENT * last


def _take_lower(solution: Solution, other: Callable[[], Solution]) -> Solution:
    """Return the lower of two solutions, of which the second may have no start."""
    try:
        found = other()
    except StartError:
        return solution
    before, after = solution.normal.total_cost, found.normal.total_cost
    return found if after <= (1 + _COST_TOLERANCE) * before else solution


def _step_aside(solution: Solution, free: IntArray, corners: int) -> list[State]:
    """Return states to both sides of a solution along the direction least determined."""
    normal = solution.normal
    reduced = eliminate_poses(normal)
    values, vectors = covariances.decompose_information(reduced)
    sigma2 = covariances.estimate_variance(normal.cost, corners, len(free) + normal.pose.size)
    if not free.size or not np.isfinite(sigma2):
        return []
    along = reduced.unit * vectors[:, 0] * np.sqrt(sigma2 / max(values[0], _MIN_INFORMATION))
    states = []
    for side in (_SIDE_STEP, -_SIDE_STEP):
        pull = np.tensordot(normal.W, side * along, axes=([1], [0]))
        by_poses = -np.linalg.solve(normal.V, pull[..., None])[..., 0]
        states.append(solution.state.take_step(side * along, np.asarray(by_poses), free))
    return states


def _solve_with_weakened_lens(
    run: Callable[[State], Solution], start: State, free: IntArray
) -> Solution:
    """Solve from a start whose lens is weakened, if need be, until all corners have an image."""
    for _ in range(_MAX_WEAKENINGS):
        try:
            return run(start)
        except StartError:
            params = start.params.copy()
            params[free[free >= _FIRST_COEFFICIENT]] *= _WEAKENING
            start = start._replace(params=params)
    return run(start)


def reweight_and_solve(
    observations: Observations, solution: Solution, model: str, solve: Callable[..., Solution]
) -> tuple[Observations, Solution]:
    """Solve again with the model's own errors in the weights, as the residuals show them.

    Args:
        observations: the views, with covariances.
        solution: the solution under the covariances alone.
        model: the lens, a key of ``camera.models.MODELS``.
        solve: a function as `solve_stage_two` of observations, start and earlier iterations.

    Returns:
        The observations with their new weights, and the new solution.
    """
    unknowns = len(solution.normal.shared) + solution.normal.pose.size
    tau2 = 0.0
    for _ in range(_MAX_REWEIGHTINGS):
        before = tau2
        miss = residuals.compute_misses(solution.state, observations, model, Cost.IMAGE)
        tau2 = estimate_model_variance(observations, miss, unknowns)
        if solution.status is Status.STOPPED or abs(tau2 - before) <= 0.01 * before:
            break
        observations = whiten_observations(observations, tau2)
        solution = solve(observations, solution.state, earlier=solution.history)
    return observations, solution
