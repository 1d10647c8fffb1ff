"""How Levenberg-Marquardt steps, reports and ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.calibration.observations import pack_observations
from calibgui.engine.calibration.refinement import levenberg_marquardt
from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError, minimise
from calibgui.engine.calibration.refinement.residuals import NormalAt, State, build_stage_two
from calibgui.engine.calibration.refinement.schur import NormalEquations, Reduced, eliminate_poses
from calibgui.engine.calibration.result import Cost, Iteration, Status
from calibgui.engine.errors import Cancelled
from tests.engine.calibration.refinement.test_schur import COST, FREE, MADE, TRUTH, VIEWS


def away(by: float) -> State:
    """The truth moved by some pixels and degrees."""
    step = np.array([30.0, -20.0, 8.0, -6.0, 0.1, -0.1, 0.0, 1e-3, 0.0, 0.0])
    return TRUTH.take_step(by * step, by * np.tile([0.02, -0.03, 0.05, 3.0, -2.0, 9.0], (5, 1)))


def run(start: State, **options: object):  # type: ignore[no-untyped-def]
    data = float(np.sum(VIEWS.uv**2))
    return minimise(COST, start, FREE, VIEWS.count, data, **options)  # type: ignore[arg-type]


def test_the_minimum_does_not_depend_on_the_start() -> None:
    near, far = run(TRUTH), run(away(1.0))
    assert near.status is far.status is Status.CONVERGED
    assert far.normal.cost == pytest.approx(near.normal.cost, rel=1e-10)
    np.testing.assert_allclose(far.state.params, near.state.params, rtol=1e-5, atol=1e-6)
    held = np.setdiff1d(np.arange(10), FREE)
    np.testing.assert_array_equal(far.state.params[held], TRUTH.params[held])


def test_factors_are_reused_after_a_slight_step(monkeypatch: pytest.MonkeyPatch) -> None:
    factored: list[float] = []

    def count_factors(normal: NormalEquations, damping: float) -> Reduced:
        factored.append(damping)
        return eliminate_poses(normal, damping)

    monkeypatch.setattr(levenberg_marquardt, "eliminate_poses", count_factors)
    sparing, with_spared = run(away(1.0)), len(factored)
    monkeypatch.setattr(levenberg_marquardt, "_MAX_DECREASE_TO_REUSE_FACTORS", 0.0)
    lavish = run(away(1.0))
    assert with_spared < len(sparing.history) <= len(factored) - with_spared
    assert sparing.status is lavish.status is Status.CONVERGED
    assert sparing.normal.cost == pytest.approx(lavish.normal.cost, rel=1e-11)


def test_it_ends_where_the_caller_asks_for_no_more() -> None:
    least, near = run(away(1.0)), run(away(1.0), max_decrease=1e-3)
    assert near.status is Status.CONVERGED
    assert len(near.history) < len(least.history)
    assert least.normal.cost < near.normal.cost < (1 + 1e-3) * least.normal.cost


def test_history_descends_and_records_each_step() -> None:
    seen: list[Iteration] = []
    solution = run(away(1.0), report=lambda i: seen.append(i) or True)
    assert tuple(seen) == solution.history
    assert [i.index for i in seen] == list(range(len(seen)))
    costs = np.array([i.cost for i in seen])
    assert (np.diff(costs) < 0).all()
    assert (np.diff([i.seconds for i in seen]) >= 0).all()
    assert seen[-1].rms == pytest.approx(np.sqrt(costs[-1] / VIEWS.count))
    assert seen[-1].gradient < 1e-3 < seen[0].gradient
    assert seen[0].step == 0.0
    assert len(seen) < 15


@pytest.mark.parametrize("stop_at", [0, 2])
def test_false_stops_and_keeps_the_best(stop_at: int) -> None:
    solution = run(away(1.0), report=lambda i: i.index < stop_at)
    assert solution.status is Status.STOPPED
    assert len(solution.history) == stop_at + 1
    assert solution.normal.cost == solution.history[-1].cost
    # The state is that of the last record, not of a trial after it.
    assert COST(solution.state).cost == pytest.approx(solution.history[-1].cost)


def test_cancelled_propagates() -> None:
    def report(iteration: Iteration) -> bool:
        if iteration.index == 1:
            raise Cancelled
        return True

    with pytest.raises(Cancelled):
        run(away(1.0), report=report)


def test_the_limit_of_iterations_is_reported() -> None:
    solution = run(away(1.0), max_iterations=2)
    assert solution.status is Status.MAX_ITERATIONS
    assert len(solution.history) <= 3


def test_no_residual_is_converged_at_once() -> None:
    exact = build_stage_two(pack_observations(MADE.views), "lucchese", Cost.IMAGE, 1.0, FREE)
    solution = minimise(exact, TRUTH, FREE, VIEWS.count, float(np.sum(VIEWS.uv**2)))
    assert solution.status is Status.CONVERGED
    assert len(solution.history) <= 2


def test_a_start_without_residuals_is_refused() -> None:
    with pytest.raises(StartError):
        run(TRUTH._replace(T=-TRUTH.T))


def build_wall(limit: float, tried: list[State] | None = None) -> NormalAt:
    """The problem with no residuals for focal lengths below `limit`; `tried` lists the states."""

    def normal_at(state: State) -> NormalEquations:
        if tried is not None:
            tried.append(state)
        normal = COST(state)
        return normal._replace(cost=np.inf) if state.params[0] < limit else normal

    return normal_at


def test_a_trial_without_residuals_is_only_rejected() -> None:
    without_wall = run(TRUTH).state.params[0]
    data = float(np.sum(VIEWS.uv**2))
    solution = minimise(build_wall(without_wall - 0.01), away(1.0), FREE, VIEWS.count, data)
    assert solution.status is Status.CONVERGED
    assert solution.normal.cost == pytest.approx(run(TRUTH).normal.cost, rel=1e-9)


def test_blocked_by_a_wall_is_not_converged() -> None:
    data = float(np.sum(VIEWS.uv**2))
    solution = minimise(build_wall(655.0), away(1.0), FREE, VIEWS.count, data)
    assert solution.state.params[0] >= 655.0
    assert solution.status is Status.MAX_ITERATIONS
    assert solution.is_blocked


def test_steps_that_damping_makes_small_are_not_convergence() -> None:
    """At a wall damping grows until no decrease is predicted; a full step still predicts one."""
    limit, tried = 1000, list[State]()
    data = float(np.sum(VIEWS.uv**2))
    problem = build_wall(655.0, tried)
    solution = minimise(problem, away(1.0), FREE, VIEWS.count, data, max_iterations=limit)
    assert len(tried) < limit / 2  # the stop rule ended the iteration, not the limit
    assert solution.status is Status.MAX_ITERATIONS
    assert solution.is_blocked
    assert solution.normal.cost > 1.01 * run(TRUTH).normal.cost


def test_the_minimum_is_recognised_under_strong_damping() -> None:
    """A solve that starts at the minimum with strong damping ends there, converged."""
    minimum = run(TRUTH)
    earlier = [replace(minimum.history[-1], damping=1e9)]
    solution = run(minimum.state, earlier=earlier)
    assert solution.status is Status.CONVERGED
    assert solution.normal.cost == minimum.normal.cost
