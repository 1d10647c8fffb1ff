"""The arrow-shaped solver against the dense normal equations, and how it reports and ends."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine import levenberg_marquardt
from calibgui.engine.errors import Cancelled
from calibgui.engine.lens import MODELS
from calibgui.engine.levenberg_marquardt import (
    NormalAt,
    NormalEquations,
    Reduced,
    StartError,
    minimise,
    normal_equations,
    schur,
    solve,
)
from calibgui.engine.observations import CHUNK, pack
from calibgui.engine.problem import linearised, stage_two
from calibgui.engine.stage_two import Linearised, State
from calibgui.engine.types import Array, Cost, Iteration, Status
from tests.engine.scenes import barrel, scene
from tests.engine.test_stage_two import truth_of

MADE = scene(barrel(), 5, seed=4)
VIEWS = pack(MADE.noisy(0.2, np.random.default_rng(0)))
TRUTH = truth_of(MADE)
FREE = np.array([0, 1, 2, 3, 4, 5, 7])
COST = stage_two(VIEWS, "lucchese", Cost.IMAGE, 1.0, FREE)


def jacobian(state: State) -> tuple[Array, Array]:
    """Dense J and r of all unknowns, written out without any block structure."""
    found = linearised(state, VIEWS, slice(0, 5), MODELS["lucchese"], Cost.IMAGE, 1.0)
    K, N = found.residual.shape[:2]
    J = np.zeros((K, N, 2, len(FREE) + 6 * K))
    J[..., : len(FREE)] = found.by_params[..., FREE]
    for k in range(K):
        at = len(FREE) + 6 * k
        J[k, ..., at : at + 6] = found.by_pose[k]
    return J.reshape(2 * K * N, -1), found.residual.ravel()


@pytest.mark.parametrize("damping", [0.0, 1e-3, 10.0])
def test_the_step_solves_the_damped_normal_equations(damping: float) -> None:
    J, r = jacobian(TRUTH)
    A = J.T @ J
    expected = np.linalg.solve(A + damping * np.diag(np.diag(A)), -J.T @ r)
    shared, pose = solve(COST(TRUTH), damping)
    # The dense matrix has a condition number of 1e14 in these units: compare its predictions.
    np.testing.assert_allclose(
        J @ np.concatenate([shared, pose.ravel()]), J @ expected, atol=1e-6 * np.abs(r).max()
    )


def test_the_schur_complement_is_the_inverse_of_the_covariance() -> None:
    J, _ = jacobian(TRUTH)
    unit = 1 / np.linalg.norm(J, axis=0)
    inverse = np.linalg.inv((J * unit).T @ (J * unit)) * np.outer(unit, unit)
    P = len(FREE)
    np.testing.assert_allclose(
        np.linalg.inv(schur(COST(TRUTH))[0]), inverse[:P, :P], rtol=1e-4, atol=1e-12
    )


def test_sums_over_chunks_are_the_sums() -> None:
    """More views than a chunk holds, in two different orders of adding up."""
    count = CHUNK + 3
    rng = np.random.default_rng(0)
    residual, by_params = rng.normal(size=(count, 4, 2)), rng.normal(size=(count, 4, 2, 9))
    by_pose = rng.normal(size=(count, 4, 2, 6))

    def linearise(state: State, views: slice) -> Linearised:  # noqa: ARG001
        return Linearised(residual[views], by_params[views], by_pose[views])

    state = State(np.zeros(9), np.zeros((count, 3, 3)), np.zeros((count, 3)))
    found = normal_equations(linearise, state, np.arange(9))
    np.testing.assert_allclose(found.cost, np.sum(residual**2))
    J = by_params.reshape(-1, 9)
    np.testing.assert_allclose(found.U, J.T @ J, rtol=1e-12)
    np.testing.assert_allclose(found.shared, J.T @ residual.ravel(), rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(
        found.W[-1], np.einsum("nip,niq->pq", by_params[-1], by_pose[-1]), rtol=1e-12
    )


def away(by: float) -> State:
    """The truth moved by some pixels and degrees."""
    step = np.array([30.0, -20.0, 8.0, -6.0, 0.1, -0.1, 0.0, 1e-3, 0.0, 0.0])
    return TRUTH.moved(by * step, by * np.tile([0.02, -0.03, 0.05, 3.0, -2.0, 9.0], (5, 1)))


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


def test_factors_serve_again_after_a_slight_step(monkeypatch: pytest.MonkeyPatch) -> None:
    factored: list[float] = []

    def counted(normal: NormalEquations, damping: float) -> Reduced:
        factored.append(damping)
        return schur(normal, damping)

    monkeypatch.setattr(levenberg_marquardt, "schur", counted)
    sparing, with_spared = run(away(1.0)), len(factored)
    monkeypatch.setattr(levenberg_marquardt, "_SLIGHT", 0.0)
    lavish = run(away(1.0))
    assert with_spared < len(sparing.history) <= len(factored) - with_spared
    assert sparing.status is lavish.status is Status.CONVERGED
    assert sparing.normal.cost == pytest.approx(lavish.normal.cost, rel=1e-11)


def test_history_descends_and_says_what_happened() -> None:
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


def test_the_limit_of_iterations_is_said() -> None:
    solution = run(away(1.0), max_iterations=2)
    assert solution.status is Status.MAX_ITERATIONS
    assert len(solution.history) <= 3


def test_no_residual_is_converged_at_once() -> None:
    exact = stage_two(pack(MADE.views), "lucchese", Cost.IMAGE, 1.0, FREE)
    solution = minimise(exact, TRUTH, FREE, VIEWS.count, float(np.sum(VIEWS.uv**2)))
    assert solution.status is Status.CONVERGED
    assert len(solution.history) <= 2


def test_a_start_without_residuals_is_refused() -> None:
    with pytest.raises(StartError):
        run(TRUTH._replace(T=-TRUTH.T))


def walled(limit: float) -> NormalAt:
    """The problem with no residuals for focal lengths below `limit`."""

    def normal_at(state: State) -> NormalEquations:
        normal = COST(state)
        return normal._replace(cost=np.inf) if state.params[0] < limit else normal

    return normal_at


def test_a_trial_without_residuals_is_only_rejected() -> None:
    free_of_walls = run(TRUTH).state.params[0]
    data = float(np.sum(VIEWS.uv**2))
    solution = minimise(walled(free_of_walls - 0.01), away(1.0), FREE, VIEWS.count, data)
    assert solution.status is Status.CONVERGED
    assert solution.normal.cost == pytest.approx(run(TRUTH).normal.cost, rel=1e-9)


def test_stuck_at_a_wall_is_not_converged() -> None:
    data = float(np.sum(VIEWS.uv**2))
    solution = minimise(walled(655.0), away(1.0), FREE, VIEWS.count, data)
    assert solution.state.params[0] >= 655.0
    assert solution.status is Status.MAX_ITERATIONS
    assert solution.barred
