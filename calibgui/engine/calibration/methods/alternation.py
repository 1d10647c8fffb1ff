"""Turns between the distortion and all other unknowns, which Zhang's and Weng's methods take.

With the camera and the poses held, the residuals are linear in the coefficients of the distortion,
which a linear solve then finds; with these held, camera and poses are refined by bundle adjustment,
and so on. Each half of a turn makes the cost least over its own unknowns. Where the turns come to
rest its derivatives by both are 0: they end at the minimum that all unknowns together have, and the
estimate has the covariance of that.

The way there is long. The distance from the minimum shrinks by a constant factor a turn, which is
near 1 where camera and poses can do much of what the distortion does. That little changes from one
turn to the next therefore does not tell that they have arrived; that a step of all unknowns
together would hardly lower the cost does.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import IntArray
from calibgui.engine.calibration.methods.method import (
    Problem,
    Refinement,
    evaluate_state,
    refine_by_bundle_adjustment,
    subtract_states,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import (
    Solution,
    measure_scaled_step,
    predict_full_decrease,
)
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.schur import NormalEquations
from calibgui.engine.calibration.result import Calibration, Iteration, Report, Status

SolveDistortion = Callable[[State, Observations, IntArray], State]
"""A function that takes a state, the views and the indices of coefficients, and returns the state
with these coefficients solved for."""

_MAX_DECREASE = 1e-9
"""Decrease of the cost that a step of all unknowns together still predicts, relative to it, below
which the turns have converged: N corners then leave the unknowns within 3e-5 sqrt(2 N) standard
deviations of the minimum, which is 0.002 for five views of 256 corners."""
_ROUNDING = 1e-24
"""Decrease of the cost, relative to the sum of the squared data, that is a rounding error."""


def refine_by_alternation(
    solve_distortion: SolveDistortion,
    names: tuple[str, ...],
    problem: Problem,
    start: State,
    report: Report | None,
    *,
    distortion_first: bool = False,
) -> Refinement:
    """Take turns; an iteration of the history is a turn.

    The status is ``MAX_ITERATIONS`` where that many turns do not suffice.

    Args:
        solve_distortion: the linear half of a turn.
        names: names of the coefficients that it solves for, where they are not held.
        problem: the problem; a turn more than its largest number of iterations is taken at most.
        start: camera and poses.
        report: a function that takes each turn; it returns False to stop.
        distortion_first: True if the first turn solves for the distortion too; otherwise it keeps
            that of the start.
    """
    began, history = time.perf_counter(), list[Iteration]()
    observations, parameters, free = problem.prepared, problem.parameters, problem.free
    linear = np.array([i for i in free if parameters[i] in names], dtype=np.int64)
    held_in_turn = dict.fromkeys(parameters[i] for i in linear)  # held where they are
    rest = replace(problem, held={**problem.held, **held_in_turn})
    state, status = start, Status.MAX_ITERATIONS
    for index in range(problem.max_iterations + 1):
        before = state
        if index or distortion_first:
            state = solve_distortion(state, observations, linear)
        state = refine_by_bundle_adjustment(rest, state, None).solution.state
        here = evaluate_state(problem, observations, state)
        history.append(
            replace(
                here.history[0],
                index=index,
                step=_measure_turn(before, state, here.normal, free),
                seconds=time.perf_counter() - began,
            )
        )
        goes_on = report is None or report(history[-1])
        if _has_converged(here.normal, observations):
            status = Status.CONVERGED
            break
        if not goes_on:
            status = Status.STOPPED
            break
    return Refinement(observations, Solution(state, here.normal, tuple(history), status))


def remark_unfinished_alternation(calibration: Calibration) -> tuple[str, ...]:
    """Return a sentence on turns that did not come to their end."""
    if calibration.status is not Status.MAX_ITERATIONS:
        return ()
    return (
        f"{len(calibration.history) - 1} turns did not reach the least cost: the values may be off "
        "by more than their standard deviations say.",
    )


def _has_converged(normal: NormalEquations, observations: Observations) -> bool:
    """Return whether a step of all unknowns together predicts no decrease worth taking."""
    rounding = _ROUNDING * float(np.sum(observations.uv**2))
    return predict_full_decrease(normal) <= max(_MAX_DECREASE * normal.cost, rounding)


def _measure_turn(before: State, after: State, normal: NormalEquations, free: IntArray) -> float:
    """Return the length of a turn, unknowns scaled to a unit diagonal of J^T J."""
    by_shared, by_pose = subtract_states(after, before)
    return measure_scaled_step(normal, by_shared[free], by_pose)
