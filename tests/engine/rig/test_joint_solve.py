"""The joint normal equations are those of numerical derivatives of all residuals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.board_shape.estimate import allow_deviations
from calibgui.engine.calibration.observations import Observations, pack_observations
from calibgui.engine.calibration.refinement.residuals import State, linearise_residuals
from calibgui.engine.calibration.result import Cost
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.rig.joint_solve import (
    build_problem,
    compute_instant_products,
    place_corners,
)
from calibgui.engine.rig.problem import BoardProblem, CameraProblem, RigProblem, SightProblem
from calibgui.engine.rig.records import Layout
from tests.engine.rig.scenes import BOARD, RigScene, make_rig

NONE = np.zeros(0, dtype=np.int64)


def make_problem() -> tuple[RigProblem, State]:
    """A rig of three lenses at a state beside the truth, with moving boards and late cameras."""
    scene = make_rig(3, instants=6)
    rng = np.random.default_rng(1)
    sights = []
    for c, camera in enumerate(scene.cameras):
        at = np.array(sorted(camera.views))
        views = pack_observations([camera.views[k] for k in at.tolist()])
        sights.append(make_sight(rng, c, 0, views, at))
    return make_rig_problem(scene, sights, (BoardProblem(NONE),), [], rng)


def make_problem_of_boards() -> tuple[RigProblem, State]:
    """The same with a second board, which two cameras see a part of, both of unknown shape."""
    scene = make_rig(3, instants=6)
    rng = np.random.default_rng(1)
    points = BOARD.points()
    order = np.lexsort(points.T[::-1])  # as `index_board_points` has them
    boards = tuple(
        BoardProblem(
            np.arange(6) if b else NONE,
            deviations := allow_deviations(shape, points[order], np.full(3, 0.01)),
            deviations.make_stiffness(0.04),
        )
        for b, shape in enumerate((BoardShapeModel.FREE, BoardShapeModel.BOW))
    )
    sights = []
    for c, camera in enumerate(scene.cameras):
        at = np.array(sorted(camera.views))
        for b in range(2 if c != 1 else 1):
            some = slice(None) if b == 0 else slice(0, 2)
            views = pack_observations([camera.views[k] for k in at[some].tolist()])
            sight = make_sight(rng, c, b, views, at[some])
            corner = np.argmin(
                np.linalg.norm(views.xy[:, :, None] - points[order], axis=-1), axis=-1
            )
            sights.append(replace(sight, corner=corner))
    place = [0.1, -0.2, 0.05, 20.0, -15.0, 8.0]
    shapes = rng.normal(0, 0.2, sum(board.count for board in boards)).tolist()
    return make_rig_problem(scene, sights, boards, [*place, *shapes], rng)


def make_sight(
    rng: np.random.Generator, c: int, b: int, views: Observations, at: IntArray
) -> SightProblem:
    """Views of a board that moves, by a camera that is late."""
    velocity = np.concatenate(
        [rng.normal(0, 0.2, (len(at), 3)), rng.normal(0, 50, (len(at), 3))], axis=1
    )
    return SightProblem(c, b, views, at, velocity, rng.normal(0, 0.01, len(at)))


def make_rig_problem(
    scene: RigScene,
    sights: list[SightProblem],
    boards: tuple[BoardProblem, ...],
    more: list[float],
    rng: np.random.Generator,
) -> tuple[RigProblem, State]:
    cameras = []
    for c, camera in enumerate(scene.cameras):
        known = rng.normal(0, 0.1, len(camera.camera.params)), np.eye(len(camera.camera.params))
        cameras.append(
            CameraProblem(
                camera.camera.model,
                np.array([0, 2, 3, 5]),
                np.arange(7) if c else NONE,
                known if c == 1 and more else None,
            )
        )
    params = np.concatenate(
        [
            *(
                np.r_[camera.camera.params, pose.rvec, pose.tvec, 0.02 * c]
                for c, (camera, pose) in enumerate(zip(scene.cameras, scene.poses, strict=True))
            ),
            more,
        ]
    )
    R = rotation_from_vector(np.array([pose.rvec for pose in scene.boards]))
    state = State(params, R, np.array([pose.tvec for pose in scene.boards]) + 1.0)
    layout = Layout(tuple(len(camera.camera.params) for camera in scene.cameras), len(boards))
    return RigProblem(tuple(cameras), boards, tuple(sights), layout, len(scene.boards)), state


def list_residuals(problem: RigProblem, state: State) -> Array:
    """All residuals of the rig in one vector, with those that the priors stand for."""
    found = []
    for sight in problem.sights:
        own, views = place_corners(problem, state, sight)
        model = problem.cameras[sight.camera].model
        part = linearise_residuals(own, views, slice(None), model, Cost.IMAGE, 1.0)
        found.append(part.residual.ravel())
    for c, camera in enumerate(problem.cameras):
        if camera.prior is not None:  # of stiffness 1
            away = state.params[problem.layout.camera(c)] - camera.prior[0]
            found.append(away[camera.free])
    for b, board in enumerate(problem.boards):
        if board.deviations is not None:
            root = np.linalg.cholesky(board.stiffness + 1e-9 * np.eye(board.count))
            found.append(root.T @ state.params[problem.locate_deviations(b)])
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


@pytest.mark.parametrize("make", [make_problem, make_problem_of_boards])
def test_normal_equations_are_those_of_central_differences(
    make: Callable[[], tuple[RigProblem, State]],
) -> None:
    problem, state = make()
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
    np.testing.assert_allclose(normal.total_cost, r @ r)


def test_products_of_instants_add_up_to_the_normal_equations() -> None:
    problem, state = make_problem()
    check_products(problem, state)


def test_products_follow_the_deviations_of_boards() -> None:
    """With no motion of the boards' corners they are those of boards that stay."""
    problem, state = make_problem_of_boards()
    boards = tuple(replace(board, stiffness=0 * board.stiffness) for board in problem.boards)
    cameras = tuple(replace(camera, prior=None) for camera in problem.cameras)
    problem = replace(problem, boards=boards, cameras=cameras)
    n, Q = problem.placed, [board.count for board in boards]
    rng = np.random.default_rng(4)
    moved = [rng.normal(0, 0.1, (count, n)) for count in Q]  # coefficients by the other unknowns
    following = [
        board.deviations.B @ part
        for board, part in zip(boards, moved, strict=True)
        if board.deviations is not None
    ]
    check_products(problem, state, following, np.vstack([np.eye(n), *moved]))


def check_products(
    problem: RigProblem,
    state: State,
    following: Sequence[Array] = (),
    chain: Array | None = None,
) -> None:
    """Check products against the normal equations, whose unknowns are `chain` times theirs."""
    normal = build_problem(problem)(state)
    n = problem.placed
    chain = np.eye(n) if chain is None else chain
    first, second = (
        compute_instant_products(problem, state, np.array(part), following)
        for part in ([0, 1, 2], [3, 4, 5])
    )
    products, close = np.concatenate([first, second]), {"rtol": 1e-9, "atol": 1e-5}
    np.testing.assert_allclose(products[:, :n, :n].sum(axis=0), chain.T @ normal.U @ chain, **close)
    np.testing.assert_allclose(products[:, :n, n:-1], chain.T @ normal.W, **close)
    np.testing.assert_allclose(products[:, n:-1, n:-1], normal.V, **close)
    np.testing.assert_allclose(products[:, -1, -1], normal.costs)
