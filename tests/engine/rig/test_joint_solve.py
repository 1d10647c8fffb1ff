"""The joint normal equations are those of numerical derivatives of all residuals."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import pack_observations
from calibgui.engine.calibration.refinement.residuals import State, linearise_residuals
from calibgui.engine.calibration.result import Cost
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.rig.joint_solve import (
    CameraProblem,
    RigProblem,
    build_problem,
    compute_instant_products,
    place_views,
)
from calibgui.engine.rig.records import Layout
from tests.engine.rig.scenes import make_rig


def make_problem() -> tuple[RigProblem, State]:
    """A rig of three lenses at a state beside the truth, with moving boards and late cameras."""
    scene = make_rig(3, instants=6)
    rng = np.random.default_rng(1)
    cameras = []
    for c, camera in enumerate(scene.cameras):
        at = np.array(sorted(camera.views))
        velocity = np.concatenate(
            [rng.normal(0, 0.2, (len(at), 3)), rng.normal(0, 50, (len(at), 3))], axis=1
        )
        cameras.append(
            CameraProblem(
                camera.camera.model,
                pack_observations([camera.views[k] for k in at.tolist()]),
                at,
                velocity,
                rng.normal(0, 0.01, len(at)),
                np.array([0, 2, 3, 5]),
                np.arange(7) if c else np.zeros(0, dtype=np.int64),
            )
        )
    params = np.concatenate(
        [
            np.r_[camera.camera.params, pose.rvec, pose.tvec, 0.02 * c]
            for c, (camera, pose) in enumerate(zip(scene.cameras, scene.poses, strict=True))
        ]
    )
    R = rotation_from_vector(np.array([pose.rvec for pose in scene.boards]))
    state = State(params, R, np.array([pose.tvec for pose in scene.boards]) + 1.0)
    layout = Layout(tuple(len(camera.camera.params) for camera in scene.cameras))
    return RigProblem(tuple(cameras), layout, len(scene.boards)), state


def list_residuals(problem: RigProblem, state: State) -> Array:
    """All residuals of the rig in one vector."""
    found = []
    for c, camera in enumerate(problem.cameras):
        part = linearise_residuals(
            place_views(problem, state, c),
            camera.observations,
            slice(None),
            camera.model,
            Cost.IMAGE,
            1.0,
        )
        found.append(part.residual.ravel())
    return np.concatenate(found)


def differentiate(problem: RigProblem, state: State) -> Array:
    """The Jacobian by shared unknowns and the boards' poses, by central differences."""
    n, count = len(problem.free), problem.count
    columns = []
    for i in range(n + 6 * count):
        step = np.zeros(n + 6 * count)
        step[i] = 1e-5
        ends = [
            list_residuals(
                problem,
                state.take_step(sign * step[:n], sign * step[n:].reshape(-1, 6), problem.free),
            )
            for sign in (1, -1)
        ]
        columns.append((ends[0] - ends[1]) / 2e-5)
    return np.stack(columns, axis=1)


def test_normal_equations_are_those_of_central_differences() -> None:
    problem, state = make_problem()
    normal = build_problem(problem)(state)
    J, r = differentiate(problem, state), list_residuals(problem, state)
    n = len(problem.free)
    scale = np.sqrt(np.sum(J**2, axis=0))
    wanted = (J / scale).T @ (J / scale)
    found = np.zeros_like(wanted)
    found[:n, :n] = normal.U
    for k in range(problem.count):
        own = slice(n + 6 * k, n + 6 * k + 6)
        found[:n, own], found[own, :n], found[own, own] = normal.W[k], normal.W[k].T, normal.V[k]
    np.testing.assert_allclose(found / np.outer(scale, scale), wanted, atol=1e-6)
    gradient = np.concatenate([normal.shared, normal.pose.ravel()]) / scale
    np.testing.assert_allclose(gradient, (J / scale).T @ r, atol=1e-5 * np.linalg.norm(r))
    np.testing.assert_allclose(normal.cost, np.sum(normal.costs))
    np.testing.assert_allclose(normal.cost, r @ r)


def test_products_of_instants_add_up_to_the_normal_equations() -> None:
    problem, state = make_problem()
    normal = build_problem(problem)(state)
    n = len(problem.free)
    first, second = (
        compute_instant_products(problem, state, np.array(part)) for part in ([0, 1, 2], [3, 4, 5])
    )
    products = np.concatenate([first, second])
    np.testing.assert_allclose(products[:, :n, :n].sum(axis=0), normal.U, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(products[:, :n, n:-1], normal.W, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(products[:, n:-1, n:-1], normal.V, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(products[:, -1, -1], normal.costs)
