"""Levenberg-Marquardt for arrow-shaped normal equations (``arrow.py``).

Marquardt's damping lambda diag(J^T J) makes the steps independent of the parameters' units.

The iteration has converged when the decrease that the linear model still predicts is below
1e-12 of the cost: the unknowns are then within about 1e-6 sqrt(2N) of their standard
deviations of the minimum. A slight step that does what was foreseen leaves J^T J as it was but
for a hundredth: its factors serve again.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.schur import (
    NormalAt,
    NormalEquations,
    factored,
    schur,
    solve,
)
from calibgui.engine.calibration.result import Iteration, Report, Status
from calibgui.engine.errors import CalibrationError

_CONVERGED = 1e-12
_SLIGHT = 1e-4
"""Decrease of a step, relative to the cost, that leaves J^T J as it was to a hundredth."""
_SETTLED = 1e-6
"""Decrease that a full step still predicts, relative to the cost, where damped ones fail."""
_ROUNDING = 1e-26
"""Cost below which the residuals are rounding errors, relative to the squared data."""
_DAMPING = 1e-6
"""To start with: less than the information that good views leave (``uncertainty.py``)."""
_LEAST_DAMPING, _MAX_DAMPING = 1e-12, 1e12


class StartError(CalibrationError):
    """The residuals at the start have no value."""


class Solution(NamedTuple):
    """Where the iteration ended."""

    state: State
    normal: NormalEquations
    """At `state`, undamped."""
    history: tuple[Iteration, ...]
    status: Status
    barred: bool = False
    """Whether it did not converge and states without residuals barred its way."""


def minimise(
    normal_at: NormalAt,
    start: State,
    free: IntArray,
    count: int,
    data_square: float,
    report: Report | None = None,
    max_iterations: int = 100,
    earlier: Sequence[Iteration] = (),
) -> Solution:
    """Minimise the sum of squared residuals.

    Args:
        normal_at: the problem.
        start: where to begin.
        free: (P,) indices of the shared parameters that may move.
        count: number of corners, for the RMS of the iteration records.
        data_square: sum of the squared data, which sets the level of rounding errors.
        report: told of each iteration; may stop it.
        max_iterations: accepted and rejected steps together.
        earlier: iterations of the solve that this one continues, with its last damping.

    Raises:
        StartError: if the residuals at the start are not finite.
        Cancelled: from `report`.
    """
    log = _Log(list(earlier), count, report)
    state, damping = start, earlier[-1].damping if earlier else _DAMPING
    normal = normal_at(state)
    if not np.isfinite(normal.cost):
        raise StartError(
            "The closed-form start does not reproject the corners.",
            "Check that the views number their corners alike and come from one camera.",
        )
    if not earlier and not log.added(normal, 0.0, damping):
        return Solution(state, normal, tuple(log.history), Status.STOPPED)
    status, barred, factors = Status.MAX_ITERATIONS, False, None
    for _ in range(max_iterations):
        factors = factors.at(normal) if factors else factored(schur(normal, damping))
        step = factors.step(normal)
        decrease = _decrease(normal, *step)
        exact = normal.cost <= _ROUNDING * data_square
        if exact or decrease <= _CONVERGED * normal.cost or damping > _MAX_DAMPING:
            if exact or _settled(normal, decrease, damping):
                status = Status.CONVERGED
            break
        trial = state.moved(*step, free)
        at_trial = normal_at(trial)
        if at_trial.cost < normal.cost:
            length = _scaled_length(normal, *step)
            foreseen = abs(normal.cost - at_trial.cost - decrease) <= 0.1 * decrease
            if not (foreseen and damping <= _DAMPING and decrease <= _SLIGHT * normal.cost):
                factors = None
            state, normal = trial, at_trial
            damping = max(damping / 10, _LEAST_DAMPING)
            if not log.added(normal, length, damping):
                status = Status.STOPPED
                break
        else:
            damping *= 10
            factors = None
            barred |= not np.isfinite(at_trial.cost)
    barred &= status is Status.MAX_ITERATIONS
    return Solution(state, normal, tuple(log.history), status, barred)


class _Log:
    """The iterations of a solve, told to `report` as they come."""

    def __init__(self, earlier: list[Iteration], count: int, report: Report | None) -> None:
        self.history, self._count, self._report = earlier, count, report
        self._began = time.perf_counter() - (earlier[-1].seconds if earlier else 0.0)

    def added(self, normal: NormalEquations, step: float, damping: float) -> bool:
        """Whether to go on after an accepted step of that length."""
        iteration = Iteration(
            index=len(self.history),
            cost=normal.cost,
            rms=float(np.sqrt(normal.cost / self._count)),
            gradient=_scaled_gradient(normal),
            step=step,
            damping=damping,
            seconds=time.perf_counter() - self._began,
        )
        self.history.append(iteration)
        return self._report is None or self._report(iteration)


def _settled(normal: NormalEquations, decrease: float, damping: float) -> bool:
    """Whether this is the minimum, where a damped step still gains `decrease`."""
    # Damping makes steps small as well, against a wall of states that cannot be imaged; not
    # where it is below the information that rounding leaves (1e-12) over `_SETTLED`.
    if decrease <= _CONVERGED * normal.cost and damping * 1e12 <= _SETTLED / _CONVERGED:
        return True
    return _decrease(normal, *solve(normal, 0.0)) <= _SETTLED * normal.cost


def _decrease(normal: NormalEquations, by_shared: Array, by_pose: Array) -> float:
    """Decrease of the cost that the linear model predicts of a step, without its curvature."""
    return -float(by_shared @ normal.shared + np.sum(by_pose * normal.pose))


def _scaled_gradient(normal: NormalEquations) -> float:
    """Largest gradient entry, unknowns scaled to a unit diagonal of J^T J."""
    shared = np.abs(normal.shared) / np.sqrt(np.maximum(np.diag(normal.U), 1e-300))
    poses = np.abs(normal.pose) / np.sqrt(np.diagonal(normal.V, axis1=1, axis2=2))
    return float(max(shared.max(initial=0.0), poses.max(initial=0.0)))


def _scaled_length(normal: NormalEquations, by_shared: Array, by_pose: Array) -> float:
    """Length of a step, unknowns scaled to a unit diagonal of J^T J."""
    square = np.sum(np.diag(normal.U) * by_shared**2)
    square += np.sum(np.diagonal(normal.V, axis1=1, axis2=2) * by_pose**2)
    return float(np.sqrt(square))
