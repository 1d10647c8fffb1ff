"""The joint solve of a rig: cameras, their poses and the board's pose at every instant.

The residuals are those of each camera's Stage II (``calibration/refinement/residuals.py``). There
every view has a pose (R, T) cam_from_board of its own, varied by a local (w, tau):
R <- exp(w) R, T <- T + tau. In a rig the pose of the view of camera c at instant i follows from the
camera's pose (Q, S) cam_from_rig, with Q = exp(q), and the board's (B, D) rig_from_board:

    R0 = Q B,    T0 = Q D + S,        dw0 = J dq + Q dw_i,    dtau0 = dS - [Q D]x J dq + Q dtau_i,

where J is the left Jacobian of q, which carries dq to a local rotation. If the camera is late by t,
the board has moved on with the velocity (omega, v) that this camera saw (``time_offsets.py``):

    R = exp(t omega) R0,  T = T0 + t v,  dw = exp(t omega) dw0 + omega dt,  dtau = dtau0 + v dt.

So (w, tau) = C (q, S, t) + G (w_i, tau_i) with known 6 x 7 and 6 x 6 matrices, and everything that
the joint normal equations need follows from the blocks U, W, V of each camera alone. The rig's
shared unknowns are the parameters of all cameras with their poses and times, those of the instants
are eliminated as poses are (``calibration/refinement/schur.py``), at a cost linear in instants.
Levenberg-Marquardt is that of one camera, whose `State` here holds the rig's parameters
(``records.Layout``) and the board's poses.

A camera that is known beforehand brings its covariance as a prior. In the units of the cost, px^2,
it is the square of the noise times the inverse of that covariance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
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
)
from calibgui.engine.calibration.refinement.schur import NormalEquations
from calibgui.engine.calibration.result import Cost, Report
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import (
    compute_inverse_left_jacobian,
    make_cross_matrix,
    rotation_from_vector,
)
from calibgui.engine.rig.records import Layout


@dataclass(frozen=True, eq=False, slots=True)
class CameraProblem:
    """A camera's part in the joint solve."""

    model: str
    """The lens model, a key of ``camera.models.MODELS``."""
    observations: Observations
    """Its views, whitened so that all cameras' residuals count in the same px."""
    instant: IntArray
    """(K,) place of the instant of each view among all instants."""
    velocity: Array
    """(K, 6) local rotation and translation per second of the board in each view, rad/s and mm/s.
    """
    lag: Array
    """(K,) time by which each view is known to be later than its instant, s."""
    free: IntArray
    """Indices of the camera's parameters that may change."""
    unknown: IntArray
    """Indices of the unknowns among q, S and t: 0 to 5 unless it is the reference, and 6."""
    prior: tuple[Array, Array] | None = None
    """Values (P,) of the parameters, and the stiffness (P, P) with which they are held there."""

    def select_views(self, views: IntArray) -> CameraProblem:
        """Return the part of some of the views."""
        return replace(
            self,
            observations=self.observations.select_views(views),
            instant=self.instant[views],
            velocity=self.velocity[views],
            lag=self.lag[views],
        )


@dataclass(frozen=True, eq=False, slots=True)
class RigProblem:
    """The problem that the joint solve is given."""

    cameras: tuple[CameraProblem, ...]
    layout: Layout
    count: int
    """Number of instants."""

    @property
    def corners(self) -> int:
        """Number of corners in all views."""
        return sum(camera.observations.count for camera in self.cameras)

    @property
    def free(self) -> IntArray:
        """(n,) places of the unknowns that instants share in the vector of `layout`."""
        return np.concatenate([self.list_free(c) for c in range(len(self.cameras))])

    def list_free(self, c: int) -> IntArray:
        """Return the places of camera `c`'s unknowns in the vector of `layout`."""
        camera, layout = self.cameras[c], self.layout
        return np.concatenate(
            [layout.camera(c).start + camera.free, layout.pose(c).start + camera.unknown]
        ).astype(np.int64)

    def list_columns(self) -> list[slice]:
        """List the place of each camera's unknowns among all shared ones."""
        ends = np.cumsum([0, *(len(self.list_free(c)) for c in range(len(self.cameras)))]).tolist()
        return [slice(start, end) for start, end in pairwise(ends)]


def solve_jointly(
    problem: RigProblem, start: State, report: Report | None = None, max_iterations: int = 100
) -> Solution:
    """Solve a rig from a start.

    Args:
        problem: the rig's views.
        start: the rig's parameters in the order of its layout, and the board's poses.
        report: a function that takes each iteration; it returns False to stop.
        max_iterations: number of iterations, at most.

    Raises:
        CalibrationError: if the start does not image the corners.
    """
    square = sum(float(np.vdot(c.observations.uv, c.observations.uv)) for c in problem.cameras)
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


def place_views(problem: RigProblem, state: State, c: int) -> State:
    """Return the state of camera `c` alone, with the poses cam_from_board of its views."""
    camera = problem.cameras[c]
    Q, S, late = _read_pose(problem.layout, state, c)
    R = Q @ state.R[camera.instant]
    T = state.T[camera.instant] @ Q.T + S
    own = State(state.params[problem.layout.camera(c)], R, T)
    moved = (late + camera.lag)[:, None] * camera.velocity
    return own.take_step(np.zeros(len(own.params)), moved)


def _read_pose(layout: Layout, state: State, c: int) -> tuple[Array, Array, float]:
    """Return Q (3, 3), S (3,) and t of camera `c`."""
    q, S = np.split(state.params[layout.pose(c)], 2)
    return rotation_from_vector(q), S, float(state.params[layout.offset(c)])


def build_problem(problem: RigProblem) -> NormalAt:
    """Return the problem that is solved: its normal equations at any state of the rig."""
    cost = Cost.IMAGE
    parts = [
        build_stage_two(each.observations, each.model, cost, 1.0, each.free)
        for each in problem.cameras
    ]

    def normal_at(state: State) -> NormalEquations:
        own = [part(place_views(problem, state, c)) for c, part in enumerate(parts)]
        own = [_add_prior(problem, state, c, normal) for c, normal in enumerate(own)]
        return _join(problem, state, own)

    return normal_at


def _add_prior(
    problem: RigProblem, state: State, c: int, normal: NormalEquations
) -> NormalEquations:
    """Add what is known beforehand of camera `c` to its normal equations."""
    camera = problem.cameras[c]
    if camera.prior is None:
        return normal
    mean, stiffness = camera.prior
    among = stiffness[np.ix_(camera.free, camera.free)]
    away = (state.params[problem.layout.camera(c)] - mean)[camera.free]
    return normal._replace(
        U=normal.U + among,
        shared=normal.shared + among @ away,
        prior=scipy.sparse.coo_array(among),
        prior_cost=float(away @ among @ away),
    )


def _join(problem: RigProblem, state: State, normals: Sequence[NormalEquations]) -> NormalEquations:
    """Join the normal equations of the cameras, each by its own poses, to those of the rig."""
    count, columns = problem.count, problem.list_columns()
    n = columns[-1].stop
    U, shared = np.zeros((n, n)), np.zeros(n)
    W, V, pose = np.zeros((count, n, 6)), np.zeros((count, 6, 6)), np.zeros((count, 6))
    costs = np.zeros(count)
    for c, (camera, place, normal) in enumerate(
        zip(problem.cameras, columns, normals, strict=True)
    ):
        C, G = differentiate_view_poses(problem, state, c)
        C = C[..., camera.unknown]
        CT, GT = np.swapaxes(C, 1, 2), np.swapaxes(G, 1, 2)
        middle = place.start + len(camera.free)
        intrinsic, extrinsic = slice(place.start, middle), slice(middle, place.stop)
        U[intrinsic, intrinsic] = normal.U
        U[intrinsic, extrinsic] = np.tensordot(normal.W, C, axes=((0, 2), (0, 1)))
        U[extrinsic, intrinsic] = U[intrinsic, extrinsic].T
        VC, VG = normal.V @ C, normal.V @ G
        U[extrinsic, extrinsic] = np.tensordot(C, VC, axes=((0, 1), (0, 1)))
        shared[intrinsic] = normal.shared
        shared[extrinsic] = np.einsum("kij,ki->j", C, normal.pose)
        # A camera sees the board once at an instant: no place is named twice.
        W[camera.instant, intrinsic] = normal.W @ G
        W[camera.instant, extrinsic] = CT @ VG
        V[camera.instant] += GT @ VG
        pose[camera.instant] += (GT @ normal.pose[..., None])[..., 0]
        costs[camera.instant] += normal.costs
    priors = [normal.prior for normal in normals]
    return NormalEquations(
        U, W, V, shared, pose, sum(normal.cost for normal in normals), costs,
        _join_priors(priors, columns, n), sum(normal.prior_cost for normal in normals),
    )  # fmt: skip


def _join_priors(
    priors: Sequence[scipy.sparse.coo_array | None], columns: Sequence[slice], n: int
) -> scipy.sparse.coo_array | None:
    """Return the priors of the cameras in one matrix (n, n); None if there are none."""
    if all(prior is None for prior in priors):
        return None
    joined = [
        (prior.data, *(place.start + index for index in prior.coords))
        for prior, place in zip(priors, columns, strict=True)
        if prior is not None
    ]
    data, row, column = (np.concatenate(part) for part in zip(*joined, strict=True))
    return scipy.sparse.coo_array((data, (row, column)), (n, n))


def differentiate_view_poses(problem: RigProblem, state: State, c: int) -> tuple[Array, Array]:
    """Differentiate the local (w, tau) of camera `c`'s views.

    Returns:
        C (K, 6, 7) by the camera's (q, S, t), and G (K, 6, 6) by the board's (w_i, tau_i).
    """
    camera = problem.cameras[c]
    Q, _, late = _read_pose(problem.layout, state, c)
    q = state.params[problem.layout.pose(c)][:3]
    J = np.linalg.inv(compute_inverse_left_jacobian(q))
    on = rotation_from_vector((late + camera.lag)[:, None] * camera.velocity[:, :3])
    arm = make_cross_matrix(state.T[camera.instant] @ Q.T)
    count = len(camera.instant)
    C, G = np.zeros((count, 6, 7)), np.zeros((count, 6, 6))
    C[:, :3, :3] = on @ J
    C[:, 3:, :3] = -arm @ J
    C[:, 3:, 3:6] = np.eye(3)
    C[:, :, 6] = camera.velocity
    G[:, :3, :3] = on @ Q
    G[:, 3:, 3:] = Q
    return C, G


def compute_instant_products(problem: RigProblem, state: State, instants: IntArray) -> Array:
    """Compute (m, n + 7, n + 7) products of some instants' columns [shared, board's pose, r].

    Args:
        problem: the rig's views.
        state: the rig.
        instants: (m,) places of the instants, ascending.
    """
    n = len(problem.free)
    products = np.zeros((len(instants), n + 7, n + 7))
    chosen = [np.flatnonzero(np.isin(camera.instant, instants)) for camera in problem.cameras]
    problem = replace(
        problem,
        cameras=tuple(
            camera.select_views(views)
            for camera, views in zip(problem.cameras, chosen, strict=True)
        ),
    )
    for c, (camera, place) in enumerate(zip(problem.cameras, problem.list_columns(), strict=True)):
        if not camera.instant.size:
            continue
        own = compute_view_products(
            place_views(problem, state, c), camera.observations, camera.model, camera.free
        )
        C, G = differentiate_view_poses(problem, state, c)
        intrinsics, p = len(camera.free), len(camera.free) + len(camera.unknown)
        chain = np.zeros((len(camera.instant), intrinsics + 7, p + 7))
        chain[:, :intrinsics, :intrinsics] = np.eye(intrinsics)
        chain[:, intrinsics:-1, intrinsics:p] = C[..., camera.unknown]
        chain[:, intrinsics:-1, p:-1] = G
        chain[:, -1, -1] = 1.0
        at = np.searchsorted(instants, camera.instant)
        to = np.r_[place, n : n + 7]
        products[at[:, None, None], to[:, None], to] += np.swapaxes(chain, 1, 2) @ own @ chain
    return products
