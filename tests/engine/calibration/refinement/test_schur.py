"""The arrow-shaped normal equations against dense ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import VIEWS_PER_CHUNK, pack_observations
from calibgui.engine.calibration.refinement.residuals import (
    Linearised,
    State,
    accumulate_normal_equations,
    build_stage_two,
    linearise_residuals,
)
from calibgui.engine.calibration.refinement.schur import (
    Reduced,
    eliminate_poses,
    factorise,
    find_pairs,
    solve_normal_equations,
)
from calibgui.engine.calibration.result import Cost
from tests.engine.calibration.refinement.test_residuals import truth_of
from tests.engine.scenes import barrel, scene

MADE = scene(barrel(), 5, seed=4)
VIEWS = pack_observations(MADE.noisy(0.2, np.random.default_rng(0)))
TRUTH = truth_of(MADE)
FREE = np.array([0, 1, 2, 3, 4, 5, 7])
COST = build_stage_two(VIEWS, "lucchese", Cost.IMAGE, 1.0, FREE)


def jacobian(state: State) -> tuple[Array, Array]:
    """Dense J and r of all unknowns, written out without any block structure."""
    found = linearise_residuals(state, VIEWS, slice(0, 5), "lucchese", Cost.IMAGE, 1.0)
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
    shared, pose = solve_normal_equations(COST(TRUTH), damping)
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
        np.linalg.inv(eliminate_poses(COST(TRUTH))[0]), inverse[:P, :P], rtol=1e-4, atol=1e-12
    )


def test_sums_over_chunks_are_the_sums() -> None:
    """More views than a chunk holds, in two different orders of adding up."""
    count = VIEWS_PER_CHUNK + 3
    rng = np.random.default_rng(0)
    residual, by_params = rng.normal(size=(count, 4, 2)), rng.normal(size=(count, 4, 2, 9))
    by_pose = rng.normal(size=(count, 4, 2, 6))

    def linearise(state: State, views: slice) -> Linearised:  # noqa: ARG001
        return Linearised(residual[views], by_params[views], by_pose[views])

    state = State(np.zeros(9), np.zeros((count, 3, 3)), np.zeros((count, 3)))
    found = accumulate_normal_equations(linearise, state, np.arange(9))
    np.testing.assert_allclose(found.cost, np.sum(residual**2))
    J = by_params.reshape(-1, 9)
    np.testing.assert_allclose(found.U, J.T @ J, rtol=1e-12)
    np.testing.assert_allclose(found.shared, J.T @ residual.ravel(), rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(
        found.W[-1], np.einsum("nip,niq->pq", by_params[-1], by_pose[-1]), rtol=1e-12
    )


def test_factors_of_a_matrix_close_by_give_nearly_the_same_step() -> None:
    moved = TRUTH.take_step(np.zeros(10), np.tile([1e-6, -1e-6, 2e-6, 1e-4, 1e-4, 3e-4], (5, 1)))
    near, here = factorise(eliminate_poses(COST(moved))), COST(TRUTH)
    own, lent = solve_normal_equations(here, 0.0), near.solve(here.shared, here.pose)
    for ours, theirs in zip(own, lent, strict=True):
        theirs = -theirs
        assert (np.abs(ours - theirs) <= 1e-3 * np.abs(ours).max(axis=0)).all()
        assert (ours != theirs).any()


def make_falling_apart(rng: np.random.Generator) -> Array:
    """A matrix (130, 130) that couples some parameters with all others, and the rest in pairs."""
    S = np.zeros((130, 130))
    dense = np.concatenate([np.arange(30), np.arange(70, 100)])
    root = rng.normal(size=(60, 60))
    S[np.ix_(dense, dense)] = root @ root.T + np.eye(60)
    for i in [*range(30, 70, 2), *range(100, 124, 2)]:
        S[i : i + 2, i : i + 2] = [[3.0, 1.0], [1.0, 2.0]]
    for i in range(124, 130):
        S[i, i] = i
    S[60, 61] = S[61, 60] = 0.0  # each by itself
    S[40, 64] = S[64, 40] = 0.3  # no neighbours: two pairs are one block of four
    return S


def test_what_is_coupled_in_pairs_is_solved_apart() -> None:
    rng = np.random.default_rng(5)
    S = make_falling_apart(rng)
    pairs = find_pairs(S)
    assert pairs.coupled is not None
    expected = np.sort([*range(30), *range(70, 100), 40, 41, 64, 65])
    np.testing.assert_array_equal(pairs.coupled, expected)
    unit = 1 / np.sqrt(2 * np.diag(S))
    W, roots = np.zeros((2, 130, 6)), np.tile(np.eye(6), (2, 1, 1))
    right = rng.normal(size=130)
    found = factorise(Reduced(S, W, roots, unit)).solve(right, np.zeros((2, 6)))[0]
    np.testing.assert_allclose(found, np.linalg.solve(S, right), rtol=1e-10, atol=1e-12)


def test_a_parameter_without_information_is_no_pair() -> None:
    S = make_falling_apart(np.random.default_rng(5))
    S[126] = S[:, 126] = 0.0
    S[100:102, 100:102] = 1.0
    pairs = find_pairs(S)
    assert pairs.coupled is not None
    assert {100, 101, 126} <= set(pairs.coupled.tolist())
    assert np.isfinite(pairs.diagonal).all()
    assert find_pairs(S[:90, :90]).coupled is None
