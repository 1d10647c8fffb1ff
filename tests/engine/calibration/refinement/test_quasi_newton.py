"""Steps from kept factors against the textbook's dense BFGS update."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.refinement.quasi_newton import KeptFactors
from calibgui.engine.calibration.refinement.schur import (
    NormalEquations,
    eliminate_poses,
    factorise,
)

P, K = 5, 3
COUNT = P + 6 * K


def make_quadratic(rng: np.random.Generator, second: float) -> tuple[NormalEquations, Array, Array]:
    """Normal equations, their dense matrix, and a Hessian that differs by `second` derivatives."""
    Jc, Jp = rng.normal(size=(K, 30, P)), rng.normal(size=(K, 30, 6))
    JcT, JpT = np.swapaxes(Jc, 1, 2), np.swapaxes(Jp, 1, 2)
    normal = NormalEquations(
        (JcT @ Jc).sum(axis=0), JcT @ Jp, JpT @ Jp, np.zeros(P), np.zeros((K, 6)), 0.0, np.zeros(K)
    )
    dense = np.zeros((COUNT, COUNT))
    dense[:P, :P] = normal.U
    for k in range(K):
        at = slice(P + 6 * k, P + 6 * k + 6)
        dense[:P, at], dense[at, :P], dense[at, at] = normal.W[k], normal.W[k].T, normal.V[k]
    along = np.linalg.qr(rng.normal(size=(COUNT, 3)))[0]
    return normal, dense, dense + second * along @ along.T


def with_gradient(normal: NormalEquations, gradient: Array) -> NormalEquations:
    return normal._replace(shared=gradient[:P], pose=gradient[P:].reshape(K, 6))


def join(step: tuple[Array, Array]) -> Array:
    return np.concatenate([step[0], step[1].ravel()])


def test_the_second_step_is_that_of_the_dense_bfgs_update() -> None:
    rng = np.random.default_rng(0)
    normal, dense, hessian = make_quadratic(rng, 8.0)
    factors = KeptFactors(factorise(eliminate_poses(normal)))
    g = rng.normal(size=COUNT)
    s = join(factors.solve_step(with_gradient(normal, g)))
    np.testing.assert_allclose(s, -np.linalg.solve(dense, g), rtol=1e-9)
    y = hessian @ s
    across = np.eye(COUNT) - np.outer(s, y) / (s @ y)
    inverse = across @ np.linalg.inv(dense) @ across.T + np.outer(s, s) / (s @ y)
    second = join(factors.solve_step(with_gradient(normal, g + y)))
    np.testing.assert_allclose(second, -inverse @ (g + y), rtol=1e-8, atol=1e-12)


def test_pairs_lead_to_the_minimum_that_factors_alone_approach_slowly() -> None:
    rng = np.random.default_rng(1)
    normal, dense, hessian = make_quadratic(rng, -6.0)
    assert np.linalg.eigvalsh(hessian)[0] > 0.5
    b = rng.normal(size=COUNT)
    expected = np.linalg.solve(hessian, b)
    factors = KeptFactors(factorise(eliminate_poses(normal)))
    corrected, plain = np.zeros(COUNT), np.zeros(COUNT)
    for _ in range(12):
        corrected += join(factors.solve_step(with_gradient(normal, hessian @ corrected - b)))
        plain -= np.linalg.solve(dense, hessian @ plain - b)
    left, left_plain = (np.abs(x - expected).max() for x in (corrected, plain))
    assert left < 1e-3 * left_plain
    assert left < 1e-7 * np.abs(expected).max()


def test_steps_lead_downhill_where_the_cost_bends_down() -> None:
    rng = np.random.default_rng(2)
    normal, _, hessian = make_quadratic(rng, -200.0)
    assert np.linalg.eigvalsh(hessian)[0] < 0
    factors = KeptFactors(factorise(eliminate_poses(normal)))
    x, g = np.zeros(COUNT), rng.normal(size=COUNT)
    for _ in range(6):
        gradient = g + hessian @ x
        step = join(factors.solve_step(with_gradient(normal, gradient)))
        assert step @ gradient < 0
        x += step
