"""Levenberg-Marquardt for the normal equations of bundle adjustment.

A Gauss-Newton step solves the linear model of the residuals; far from the minimum it can lead
uphill. Damping shortens it and turns it downhill until the cost decreases. Marquardt's (1963)
damping lambda diag(J^T J) makes the steps independent of the parameters' units. A step that
decreases the cost divides lambda by ten, one that does not multiplies it by ten and is not taken
(Nielsen 1999 compares such rules). ``schur.py`` solves each step.

The iteration has converged when the decrease that the linear model still predicts is below
1e-12 of the cost: the unknowns are then within about 1e-6 sqrt(2N) of their standard
deviations of the minimum. A slight step with the predicted effect changes J^T J by a hundredth
at most: its factors are used again (``quasi_newton.py``). Where they are large, those of splined
lenses, they are also used again after larger steps and after those that a valley bends.

What is minimised is the corners' cost and that of a prior on the parameters, where the lens model
has one; the iterations report the corners' alone.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.refinement.quasi_newton import MAX_PAIRS, KeptFactors
from calibgui.engine.calibration.refinement.residuals import NormalAt, State
from calibgui.engine.calibration.refinement.schur import (
    NormalEquations,
    eliminate_poses,
    factorise,
    solve_normal_equations,
)
from calibgui.engine.calibration.result import Iteration, Report, Status
from calibgui.engine.errors import CalibrationError

_MAX_DECREASE = 1e-12
"""Predicted decrease of the cost, relative to it, below which the iteration has converged where the
caller asks for nothing else."""
_MAX_DECREASE_TO_REUSE_FACTORS = 1e-4
"""Decrease of a step, relative to the cost, that changes J^T J by a hundredth at most."""
_MAX_DECREASE_TO_KEEP_LARGE_FACTORS = 1e-3
"""Decrease of a step, relative to the cost, up to which the factors for a lens with a prior are
kept: beyond it, the corrections of steps need more iterations than they save factors
(``tests/benchmarks/lens_models.py``)."""
_MAX_UNDAMPED_DECREASE = 1e-6
"""Decrease that a full step predicts, relative to the cost, up to which the iteration has
converged although only strongly damped steps are small."""
_ROUNDING = 1e-26
"""Cost, relative to the sum of the squared data, below which residuals are rounding errors."""
_MIN_INFORMATION = 1e-12
"""Least eigenvalue of the scaled J^T J that rounding errors leave meaningful."""
_START_DAMPING = 1e-6
"""Damping of the first step: less than the information that good views leave
(``covariances.py``)."""
_MIN_DAMPING, _MAX_DAMPING = 1e-12, 1e12
"""Limits of the damping, relative to the diagonal of J^T J."""


class StartError(CalibrationError):
    """An error: the residuals at the start have no value."""


class Solution(NamedTuple):
    """The state at which the iteration ended."""

    state: State
    normal: NormalEquations
    """The normal equations at `state`, undamped."""
    history: tuple[Iteration, ...]
    status: Status
    is_blocked: bool = False
    """True if it did not converge because states without residuals blocked its way."""


def minimise(
    normal_at: NormalAt,
    start: State,
    free: IntArray,
    count: int,
    data_square: float,
    report: Report | None = None,
    max_iterations: int = 100,
    earlier: Sequence[Iteration] = (),
    max_decrease: float = _MAX_DECREASE,
) -> Solution:
    """Minimise the sum of squared residuals.

    Args:
        normal_at: the problem: its normal equations at any state.
        start: the state to begin from.
        free: (P,) indices of the shared parameters that may change.
        count: number of corners, for the RMS of the iteration records.
        data_square: sum of the squared data, which sets the level of rounding errors.
        report: a function that takes each iteration; it returns False to stop.
        max_iterations: number of accepted and rejected steps together, at most.
        earlier: iterations of the solve that this one continues, with its last damping.
        max_decrease: predicted decrease of the cost, relative to it, at which it ends.

    Raises:
        StartError: if the residuals at the start are not finite.
        Cancelled: from `report`.
    """
    log = _Log(list(earlier), count, report)
    state, damping = start, earlier[-1].damping if earlier else _START_DAMPING
    normal = normal_at(state)
    if not np.isfinite(normal.cost):
        raise StartError(
            "The closed-form start does not reproject the corners.",
            "Check that the views number their corners alike and come from one camera.",
        )
    if not earlier and not log.add(normal, 0.0, damping):
        return Solution(state, normal, tuple(log.history), Status.STOPPED)
    status, is_blocked, factors = Status.MAX_ITERATIONS, False, None
    for _ in range(max_iterations):
        if factors is None:
            # Without a prior factors are kept for slight steps only, which need no correction.
            max_pairs = 0 if normal.prior is None else MAX_PAIRS
            factors = KeptFactors(factorise(eliminate_poses(normal, damping)), max_pairs)
        step = factors.solve_step(normal)
        decrease = _predict_decrease(normal, *step)
        is_exact = normal.cost <= _ROUNDING * data_square
        if is_exact or decrease <= max_decrease * normal.total_cost or damping > _MAX_DAMPING:
            if is_exact or _is_minimum(normal, decrease, damping, max_decrease):
                status = Status.CONVERGED
            break
        trial = state.take_step(*step, free)
        at_trial = normal_at(trial)
        if at_trial.total_cost < normal.total_cost:
            length = measure_scaled_step(normal, *step)
            decreased = normal.total_cost - at_trial.total_cost
            if damping > _START_DAMPING or not _leaves_factors(normal, decrease, decreased):
                factors = None
            state, normal = trial, at_trial
            damping = max(damping / 10, _MIN_DAMPING)
            if not log.add(normal, length, damping):
                status = Status.STOPPED
                break
        else:
            damping *= 10
            factors = None
            is_blocked |= not np.isfinite(at_trial.cost)
    is_blocked &= status is Status.MAX_ITERATIONS
    return Solution(state, normal, tuple(log.history), status, is_blocked)


class _Log:
    """The iterations of a solve, which `report` takes one by one."""

    def __init__(self, earlier: list[Iteration], count: int, report: Report | None) -> None:
        self.history, self._count, self._report = earlier, count, report
        self._began = time.perf_counter() - (earlier[-1].seconds if earlier else 0.0)

    def add(self, normal: NormalEquations, step: float, damping: float) -> bool:
        """Record an accepted step of that scaled length; return whether to go on."""
        iteration = Iteration(
            index=len(self.history),
            cost=normal.cost,
            rms=float(np.sqrt(normal.cost / self._count)),
            gradient=_measure_scaled_gradient(normal),
            step=step,
            damping=damping,
            seconds=time.perf_counter() - self._began,
        )
        self.history.append(iteration)
        return self._report is None or self._report(iteration)


def _leaves_factors(normal: NormalEquations, predicted: float, decrease: float) -> bool:
    """Return whether a step leaves J^T J so much as it was that its factors are kept.

    Args:
        normal: the normal equations before the step.
        predicted: the decrease of the cost that was predicted for it.
        decrease: its decrease of the cost.
    """
    if normal.prior is not None:  # hundreds of coefficients, of which some are hardly determined
        return predicted <= _MAX_DECREASE_TO_KEEP_LARGE_FACTORS * normal.total_cost
    is_as_predicted = abs(decrease - predicted) <= 0.1 * predicted
    return is_as_predicted and predicted <= _MAX_DECREASE_TO_REUSE_FACTORS * normal.total_cost


def _is_minimum(
    normal: NormalEquations, decrease: float, damping: float, max_decrease: float
) -> bool:
    """Return whether this is the minimum, where a damped step predicts `decrease`.

    Damping makes steps small as well, against a wall of states that cannot be imaged, and then the
    full step decides. Weak damping cannot: if even the direction of least information predicts
    little, the full step does.
    """
    is_small = decrease <= max_decrease * normal.total_cost
    if is_small and damping / _MIN_INFORMATION <= _MAX_UNDAMPED_DECREASE / _MAX_DECREASE:
        return True
    return predict_full_decrease(normal) <= _MAX_UNDAMPED_DECREASE * normal.total_cost


def predict_full_decrease(normal: NormalEquations) -> float:
    """Return the decrease of the cost that an undamped step of all unknowns predicts."""
    return _predict_decrease(normal, *solve_normal_equations(normal, 0.0))


def _predict_decrease(normal: NormalEquations, by_shared: Array, by_pose: Array) -> float:
    """Return the decrease of the cost that the linear model predicts for a step."""
    return -float(by_shared @ normal.shared + np.vdot(by_pose, normal.pose))


def _measure_scaled_gradient(normal: NormalEquations) -> float:
    """Return the largest gradient entry, unknowns scaled to a unit diagonal of J^T J."""
    shared = normal.shared**2 / np.maximum(normal.U.diagonal(), 1e-300)
    poses = normal.pose**2 / normal.V.diagonal(axis1=1, axis2=2)
    return float(np.sqrt(max(shared.max(initial=0.0), poses.max(initial=0.0))))


def measure_scaled_step(normal: NormalEquations, by_shared: Array, by_pose: Array) -> float:
    """Return the length of a step, unknowns scaled to a unit diagonal of J^T J."""
    square = normal.U.diagonal() @ by_shared**2
    square += np.vdot(normal.V.diagonal(axis1=1, axis2=2), by_pose**2)
    return float(np.sqrt(square))
