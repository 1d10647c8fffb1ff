"""The refinement's derivatives, and its variances, against other ways to compute them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import pack_observations
from calibgui.engine.hand_eye import refinement
from calibgui.engine.hand_eye.motions import Motions
from calibgui.engine.hand_eye.refinement import Scene
from tests.engine.hand_eye.arms import CAMERA, Arm, W, X, make_arm


def make_scene(arm: Arm, root: Array, noise: float) -> Scene:
    return Scene(CAMERA, root, pack_observations(arm.views), noise**2, arm.poses, 600.0)


def test_the_derivatives_are_central_differences() -> None:
    """1e-6 apart they agree to some 1e-8 of their size."""
    arm = make_arm(np.random.default_rng(3), 4, robot=(1e-3, 1.0))
    root = np.diag([3.0, 3.0, 2.0, 2.0, *6 * [0.0]])[:, :4]
    scene = make_scene(arm, root, 0.1)

    def predict(by_X: Array, by_W: Array, robot: Array) -> Motions:
        moved = scene.robot.after(Motions(np.eye(3), np.zeros(3)).take_step(robot))
        return X.take_step(by_X).invert().after(moved.invert().after(W.take_step(by_W)))

    linear = refinement._linearise(scene, X, W, predict(*np.zeros((3, 6))), np.zeros(4))
    step = 1e-6
    for which, stated in enumerate(
        (linear.by_unknowns[..., :6], linear.by_unknowns[..., 6:12], linear.by_robot)
    ):
        scale = np.repeat([1.0, scene.reach], 3) if which < 2 else np.ones(6)
        for at in range(6):
            change = np.zeros((3, 6))
            change[which, at] = step
            one, other = predict(*change), predict(*-change)
            numeric = one.measure_step_from(other) / (2 * step) * scale[at]
            np.testing.assert_allclose(stated[..., at], numeric, atol=1e-6 * scene.reach)


def test_an_error_of_the_camera_moves_the_poses_as_stated() -> None:
    """Where the corners see the board moves by -G U z, seen from the camera that is off by U z."""
    arm = make_arm(np.random.default_rng(3), 4)
    root = np.diag([3.0, 3.0, 2.0, 2.0, *6 * [0.0]])[:, :4]
    scene = make_scene(arm, root, 0.1)
    boards = X.invert().after(scene.robot.invert().after(W))
    at_zero = refinement._linearise(scene, X, W, boards, np.zeros(4))
    for at in range(4):
        z = np.zeros(4)
        z[at] = 1e-3
        ahead = (
            refinement._linearise(scene, X, W, boards, z).off - at_zero.by_unknowns[..., 12:] @ z
        )
        back = (
            refinement._linearise(scene, X, W, boards, -z).off + at_zero.by_unknowns[..., 12:] @ z
        )
        moved = (ahead - back) / 2e-3
        stated = -at_zero.by_unknowns[..., 12 + at]
        np.testing.assert_allclose(moved, stated, atol=1e-3 * np.abs(stated).max())


def test_the_variances_are_those_of_the_greatest_restricted_likelihood() -> None:
    """SciPy finds the same from the likelihood itself."""
    arm = make_arm(np.random.default_rng(2), 12, noise=0.1, robot=(8e-4, 0.4))
    root = np.diag([3.0, 3.0, 2.0, 2.0, *6 * [0.0]])[:, :4]
    scene = make_scene(arm, root, 0.1)
    boards = X.invert().after(scene.robot.invert().after(W))
    linear = refinement._linearise(scene, X, W, boards, np.zeros(4))
    K, n = len(linear.off), linear.by_unknowns.shape[2]
    J = linear.by_unknowns.reshape(6 * K, n)

    def measure(logs: Array) -> float:
        D = np.repeat(np.exp(logs), 3)
        blocks = linear.noise + (linear.by_robot * D) @ np.swapaxes(linear.by_robot, 1, 2)
        S = np.zeros((6 * K, 6 * K))
        for k in range(K):
            S[6 * k : 6 * k + 6, 6 * k : 6 * k + 6] = blocks[k]
        A = J.T @ np.linalg.solve(S, J)
        A[12:, 12:] += np.eye(n - 12)
        e = linear.off.ravel()
        b = np.linalg.solve(A, J.T @ np.linalg.solve(S, e))
        left = e @ np.linalg.solve(S, e - J @ b)
        return float(left + np.linalg.slogdet(S)[1] + np.linalg.slogdet(A)[1])

    best = minimize(measure, np.log([1e-6, 0.1]), method="Nelder-Mead", options={"xatol": 1e-6})
    found, _ = refinement._estimate_variances(linear, np.array([1e-6, 1.0]))
    np.testing.assert_allclose(found, np.exp(best.x), rtol=0.01)
    assert measure(np.log(found)) == pytest.approx(best.fun, abs=1e-3)
