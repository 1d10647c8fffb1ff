"""The joint solve of a rig: cameras and boards, their poses, and where the boards are at instants.

The residuals are those of each camera's Stage II (``calibration/refinement/residuals.py``). There
every view has a pose (R, T) cam_from_board of its own, varied by a local (w, tau):
R <- exp(w) R, T <- T + tau. In a rig the pose of the view of camera c and board b at instant i
follows from the camera's pose (Q, S) cam_from_rig, with Q = exp(q), the boards' (B, D)
rig_from_first at that instant, and that of the board beside the first one, (M, A) first_from_board,
with M = exp(m):

    R0 = Q B M,    T0 = Q (D + B A) + S,
    dw0 = J dq + Q dw_i + Q B L dm,
    dtau0 = dS - [Q (D + B A)]x J dq + Q (dtau_i - [B A]x dw_i) + Q B dA,

where J and L are the left Jacobians of q and m, which carry dq and dm to local rotations. If the
camera is late by t, the board has moved on with the velocity (omega, v) that this camera saw
(``time_offsets.py``):

    R = exp(t omega) R0,  T = T0 + t v,  dw = exp(t omega) dw0 + omega dt,  dtau = dtau0 + v dt.

So (w, tau) = C (q, S, t) + H (m, A) + G (w_i, tau_i) with known matrices, and everything that the
joint normal equations need follows from the blocks U, W, V of the views of each camera and board
alone. The rig's shared unknowns are the parameters of all cameras with their poses and times, the
poses of the boards and the deviations q of their corners where these are estimated
(``calibration/board_shape/parametrisation.py``); those of the instants are eliminated as poses are
(``calibration/refinement/schur.py``), at a cost linear in instants. Levenberg-Marquardt is that of
one camera, whose `State` here holds the rig's parameters (``records.Layout``), followed by the
deviations, and the poses of the first board.

A camera that is known beforehand brings its covariance as a prior. In the units of the cost, px^2,
it is the square of the noise times the inverse of that covariance.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.board_shape.parametrisation import (
    displace_board_points,
    make_board_shape_problem,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import (
    Solution,
    StartError,
    minimise,
)
from calibgui.engine.calibration.refinement.residuals import (
    NormalAt,
    State,
    build_stage_two,
    compute_view_products,
    linearise_residuals,
)
from calibgui.engine.calibration.refinement.schur import NormalEquations
from calibgui.engine.calibration.result import Cost, Report
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import (
    compute_inverse_left_jacobian,
    make_cross_matrix,
    rotation_from_vector,
)
from calibgui.engine.rig.problem import Columns, RigProblem, SightProblem
from calibgui.engine.rig.records import Layout


def solve_jointly(
    problem: RigProblem, start: State, report: Report | None = None, max_iterations: int = 100
) -> Solution:
    """Solve a rig from a start.

    Args:
        problem: the rig's views.
        start: the rig's parameters in the order of its layout, followed by the boards' deviations,
            and the first board's poses.
        report: a function that takes each iteration; it returns False to stop.
        max_iterations: number of iterations, at most.

    Raises:
        CalibrationError: if the start does not image the corners.
    """
    square = sum(float(np.sum(each.observations.uv**2)) for each in problem.sights)
    try:
        return minimise(
            build_problem(problem),
            start,
            problem.free,
            problem.corners,
            square,
            report,
            max_iterations,
        )
    except StartError as error:
        raise CalibrationError(
            "The cameras cannot be joined: where the others see the board, one has no image of it.",
            "Check that all cameras see one board and number its corners alike.",
        ) from error


def place_views(problem: RigProblem, state: State, sight: SightProblem) -> State:
    """Return the state of a camera alone, with the poses cam_from_board of its views of a board.

    The deviations of the board follow the camera's parameters, if they are estimated.
    """
    Q, S, late = _read_pose(problem.layout, state, sight.camera)
    M, A = _read_board_pose(problem.layout, state, sight.board)
    B, D = state.R[sight.instant], state.T[sight.instant]
    params = state.params[problem.layout.camera(sight.camera)]
    deviations = state.params[problem.locate_deviations(sight.board)]
    own = State(np.append(params, deviations), Q @ B @ M, (D + B @ A) @ Q.T + S)
    moved = (late + sight.lag)[:, None] * sight.velocity
    return own.take_step(np.zeros(len(own.params)), moved)


def place_corners(
    problem: RigProblem, state: State, sight: SightProblem
) -> tuple[State, Observations]:
    """Return what `place_views` does without deviations, and the views with the board's corners
    where these have them."""
    own, deviations = place_views(problem, state, sight), problem.boards[sight.board].deviations
    if deviations is None or sight.corner is None:
        return own, sight.observations
    B = deviations.B
    own, q = own._replace(params=own.params[: -B.shape[2]]), own.params[-B.shape[2] :]
    return own, displace_board_points(sight.observations, deviations.points, sight.corner, B @ q)


def _read_pose(layout: Layout, state: State, c: int) -> tuple[Array, Array, float]:
    """Return Q (3, 3), S (3,) and t of camera `c`."""
    q, S = np.split(state.params[layout.pose(c)], 2)
    return rotation_from_vector(q), S, float(state.params[layout.offset(c)])


def _read_board_pose(layout: Layout, state: State, b: int) -> tuple[Array, Array]:
    """Return M (3, 3) and A (3,) of board `b`."""
    if b == 0:
        return np.eye(3), np.zeros(3)
    m, A = np.split(state.params[layout.board(b)], 2)
    return rotation_from_vector(m), A


def build_problem(problem: RigProblem) -> NormalAt:
    """Return the problem that is solved: its normal equations at any state of the rig."""
    parts = [_build_sight(problem, sight) for sight in problem.sights]

    def normal_at(state: State) -> NormalEquations:
        own = [
            part(place_views(problem, state, sight))
            for sight, part in zip(problem.sights, parts, strict=True)
        ]
        return _join(problem, state, own)

    return normal_at


def _build_sight(problem: RigProblem, sight: SightProblem) -> NormalAt:
    """Return the problem of one camera and board, without a prior on the board's deviations."""
    camera, deviations = problem.cameras[sight.camera], problem.boards[sight.board].deviations
    if deviations is None or sight.corner is None:
        return build_stage_two(sight.observations, camera.model, Cost.IMAGE, 1.0, camera.free)
    return make_board_shape_problem(
        sight.observations,
        camera.model,
        camera.free,
        deviations.points,
        sight.corner,
        deviations.B,
        np.zeros_like(problem.boards[sight.board].stiffness),
    )


def _join(problem: RigProblem, state: State, normals: Sequence[NormalEquations]) -> NormalEquations:
    """Join the normal equations of the sights, each by its own poses, to those of the rig."""
    count, columns = problem.count, problem.find_columns()
    n = columns.total
    U, shared = np.zeros((n, n)), np.zeros(n)
    W, V, pose = np.zeros((count, n, 6)), np.zeros((count, 6, 6)), np.zeros((count, 6))
    costs = np.zeros(count)
    priors = []
    for place, stiffness, away in _list_pulls(problem, state, columns):
        pull = stiffness @ away
        U[np.ix_(place, place)] += stiffness
        shared[place] += pull
        priors.append(_Prior(place, scipy.sparse.coo_array(stiffness), float(away @ pull)))
    for sight, normal in zip(problem.sights, normals, strict=True):
        E, G = differentiate_view_poses(problem, state, sight)
        ET, GT = np.swapaxes(E, 1, 2), np.swapaxes(G, 1, 2)
        inner, outer = columns.list_inner(sight), columns.list_outer(sight)
        across = np.tensordot(normal.W, E, axes=((0, 2), (0, 1)))
        VE, VG = normal.V @ E, normal.V @ G
        U[np.ix_(inner, inner)] += normal.U
        U[np.ix_(inner, outer)] += across
        U[np.ix_(outer, inner)] += across.T
        U[np.ix_(outer, outer)] += np.tensordot(E, VE, axes=((0, 1), (0, 1)))
        shared[inner] += normal.shared
        shared[outer] += np.einsum("kij,ki->j", E, normal.pose)
        # A camera sees a board once at an instant: no place is named twice.
        W[sight.instant[:, None], inner] += normal.W @ G
        W[sight.instant[:, None], outer] += ET @ VG
        V[sight.instant] += GT @ VG
        pose[sight.instant] += (GT @ normal.pose[..., None])[..., 0]
        costs[sight.instant] += normal.costs
        if normal.prior is not None:  # the lens model's own, which its equations include
            priors.append(_Prior(inner, normal.prior, normal.prior_cost))
    return NormalEquations(
        U, W, V, shared, pose, sum(normal.cost for normal in normals), costs,
        _join_priors(priors, n), sum(prior.cost for prior in priors),
    )  # fmt: skip


class _Prior(NamedTuple):
    """Knowledge of some unknowns beforehand."""

    place: IntArray
    """(m,) places of the unknowns among all shared ones."""
    matrix: scipy.sparse.coo_array
    """(m, m) stiffness."""
    cost: float


def _list_pulls(
    problem: RigProblem, state: State, columns: Columns
) -> Iterator[tuple[IntArray, Array, Array]]:
    """List what is known beforehand of cameras and of boards' deviations: the places (m,) of the
    unknowns, their stiffness (m, m) and how far (m,) they are from what is known."""
    for c, camera in enumerate(problem.cameras):
        if camera.prior is not None:
            mean, stiffness = camera.prior
            away = state.params[problem.layout.camera(c)] - mean
            among = np.ix_(camera.free, camera.free)
            yield columns.cameras[c], stiffness[among], away[camera.free]
    for b, board in enumerate(problem.boards):
        if board.deviations is not None:
            q = state.params[problem.locate_deviations(b)]
            yield columns.deviations[b], board.stiffness, q


def _join_priors(priors: Sequence[_Prior], n: int) -> scipy.sparse.coo_array | None:
    """Return the priors in one matrix (n, n); None if there are none."""
    if not priors:
        return None
    joined = [
        (prior.matrix.data, *(prior.place[index] for index in prior.matrix.coords))
        for prior in priors
    ]
    data, row, column = (np.concatenate(part) for part in zip(*joined, strict=True))
    return scipy.sparse.coo_array((data, (row, column)), (n, n))


def differentiate_view_poses(
    problem: RigProblem, state: State, sight: SightProblem
) -> tuple[Array, Array]:
    """Differentiate the local (w, tau) of the views of one camera and board.

    Returns:
        E (K, 6, m) by the unknowns among the camera's (q, S, t) and the board's (m, A), and
        G (K, 6, 6) by the first board's (w_i, tau_i).
    """
    layout = problem.layout
    camera, board = problem.cameras[sight.camera], problem.boards[sight.board]
    Q, _, late = _read_pose(layout, state, sight.camera)
    _, A = _read_board_pose(layout, state, sight.board)
    B = state.R[sight.instant]
    on = rotation_from_vector((late + sight.lag)[:, None] * sight.velocity[:, :3])
    aside = B @ A
    arm = make_cross_matrix((state.T[sight.instant] + aside) @ Q.T)
    count = len(sight.instant)
    C, H, G = np.zeros((count, 6, 7)), np.zeros((count, 6, 6)), np.zeros((count, 6, 6))
    J = _compute_left_jacobian(state.params[layout.pose(sight.camera)][:3])
    C[:, :3, :3] = on @ J
    C[:, 3:, :3] = -arm @ J
    C[:, 3:, 3:6] = np.eye(3)
    C[:, :, 6] = sight.velocity
    G[:, :3, :3] = on @ Q
    G[:, 3:, 3:] = Q
    G[:, 3:, :3] = -Q @ make_cross_matrix(aside)
    if board.unknown.size:
        H[:, :3, :3] = on @ (
            Q @ B @ _compute_left_jacobian(state.params[layout.board(sight.board)][:3])
        )
        H[:, 3:, 3:] = Q @ B
    return np.concatenate([C[..., camera.unknown], H[..., board.unknown]], axis=2), G


def _compute_left_jacobian(vector: Array) -> Array:
    """Return J (3, 3), which carries a change of a rotation vector (3,) to a local rotation."""
    return np.asarray(np.linalg.inv(compute_inverse_left_jacobian(vector)))


def compute_instant_products(
    problem: RigProblem,
    state: State,
    instants: IntArray,
    following: Sequence[Array | None] = (),
) -> Array:
    """Compute (m, n + 7, n + 7) products of some instants' columns [shared, first pose, r].

    The deviations of boards are not among the n shared ones: they stay as they are, or follow.

    Args:
        problem: the rig's views.
        state: the rig.
        instants: (m,) places of the instants, ascending.
        following: the motions (corners, 3, n) of each board's corners with the shared unknowns, mm
            per unit; None for a board that stays.
    """
    columns, n = problem.find_columns(), problem.placed
    products = np.zeros((len(instants), n + 7, n + 7))
    for whole_sight in problem.sights:
        chosen = np.flatnonzero(np.isin(whole_sight.instant, instants))
        if not chosen.size:
            continue
        sight = whole_sight.select_views(chosen)
        camera = problem.cameras[sight.camera]
        own, views = place_corners(problem, state, sight)
        E, G = differentiate_view_poses(problem, state, sight)
        inner, p = len(camera.free), len(camera.free) + E.shape[2]
        chain = np.zeros((len(chosen), inner + 7, p + 7))
        chain[:, :inner, :inner] = np.eye(inner)
        chain[:, inner:-1, inner:p] = E
        chain[:, inner:-1, p:-1] = G
        chain[:, -1, -1] = 1.0
        to = np.r_[columns.cameras[sight.camera], columns.list_outer(sight), n : n + 7]
        at = np.searchsorted(instants, sight.instant)
        motion = following[sight.board] if following else None
        if motion is None or sight.corner is None:
            among = compute_view_products(own, views, camera.model, camera.free)
            products[at[:, None, None], to[:, None], to] += np.swapaxes(chain, 1, 2) @ among @ chain
            continue
        r, by_params, by_pose = linearise_residuals(
            own, views, slice(None), camera.model, Cost.IMAGE, 1.0
        )
        rows = np.concatenate([by_params[..., camera.free], by_pose, r[..., None]], axis=-1)
        whole = np.zeros((*rows.shape[:-1], n + 7))
        whole[..., to] = rows @ chain[:, None]
        by_corner = by_pose[..., 3:] @ own.R[:, None]
        whole[..., :n] += by_corner @ motion[sight.corner]
        whole = whole.reshape(len(chosen), -1, n + 7)
        products[at] += np.swapaxes(whole, 1, 2) @ whole
    return products
