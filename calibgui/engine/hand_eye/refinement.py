"""Hand and eye by least reprojection errors, with the robot's own noise as two variances.

The hand was not where the robot says, H_k, but at H_k (exp(rho_k), delta_k), whose errors have the
variances s_r^2, rad^2, about each axis and s_t^2, mm^2, along each. So the board was at

    C_k = X^-1 (H_k (exp(rho_k), delta_k))^-1 W

before the camera. Its corners say that a pose near the best is off by m_k = -V_k^-1 P^T r with
the covariance sigma^2 V_k^-1, V = P^T P (``calibration/board_poses.py``), and by G_k dtheta if the
camera is off by dtheta, whose covariance U U^T is known: dtheta = U z with z of variance 1. With

    dC_k = J_k (dX, dW) + L_k (rho_k, delta_k),

the corners' place is off the robot's by e_k, of covariance S_k = sigma^2 V_k^-1 + L_k D L_k^T with
D = diag(s_r^2, s_t^2), and generalised least squares over all poses yield X, W and z. Each C_k then
moves to its best place between corners and robot, where the corners are looked at again, until
nothing moves: bundle adjustment in which the robot's poses are observations.

*Variances.* s_r^2 and s_t^2 are those of the greatest restricted likelihood, which counts the
unknowns (REML). With V_i = L E_i L^T and P = S^-1 - S^-1 J A^+ J^T S^-1, A = J^T S^-1 J + prior,

    s_i^2 <- s_i^2 sqrt(e^T P V_i P e / tr(P V_i))

raises it at every step and leaves them positive (Zhou, Hu, Qiao, Cho and Zhou 2019, "MM algorithms
for variance components models").

*What is open.* Lengths are in distances of the camera from the board. A direction of (X, W) counts
as open if its standard deviation is more than a radian or such a distance, or if it is determined
by rounding alone; it keeps the value that it had at the start.

*Covariance.* The poses' own scatter, not the assumption that all of them err alike: each leaves
r_k = (I - K_k)^-1/2 S_k^-1/2 (e_k - J_k b), K_k its part of the hat matrix, and

    A^+ (sum_k J_k^T S_k^-1/2 r_k r_k^T S_k^-1/2 J_k) A^+

is the cluster-robust covariance with a pose for a cluster (Bell and McCaffrey 2002, "CR2", unbiased
if all err alike), to which the camera's part is added, which no scatter shows as all poses share
it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.residuals import State, compute_view_products
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry.rotations import make_cross_matrix
from calibgui.engine.hand_eye.motions import Motions

_MAX_STEPS, _MAX_VARIANCE_STEPS = 100, 1000
"""Numbers of steps that are never needed."""
_STEP_TOLERANCE = 1e-12
"""Step, rad and distances of the board, at which nothing moves any more."""
_GAIN_TOLERANCE = 1e-4
"""Gain of twice the likelihood's logarithm that means nothing."""
_ROUNDING = 1e-13
"""Eigenvalue over the largest one below which it is rounding alone."""
_FIRST_VARIANCES = (1e-6, 1.0)
"""Variances of a robot to begin with, rad^2 and mm^2."""


class Scene(NamedTuple):
    """All that is known: the camera, the corners and the robot."""

    camera: Camera
    camera_root: Array
    """(P, Q) U, a root of the covariance of the camera's parameters."""
    observations: Observations
    """The corners, whitened."""
    variance: float
    """sigma^2 of a whitened corner's coordinate, px^2."""
    robot: Motions
    """(K,) H_k, base_from_hand."""
    reach: float
    """Distance of the camera from the board, mm."""


class Estimate(NamedTuple):
    """Hand and eye where nothing moves any more."""

    X: Motions
    """hand_from_camera."""
    W: Motions
    """base_from_board."""
    params: Array
    """(P,) the camera's parameters, moved within their covariance."""
    boards: Motions
    """(K,) C_k, cam_from_board, at their best places between corners and robot."""
    variances: Array
    """(2,) s_r^2, rad^2, and s_t^2, mm^2."""
    corrections: Array
    """(K, 6) rho_k and delta_k, rad and mm, in the hand's frame."""
    covariance: Array
    """(12, 12) of steps of X and W; without what is open."""
    parts: Array
    """(3, 12, 12) what the robot, the corners and the camera contribute if all poses err alike."""
    open_directions: Array
    """(n, 12) steps of X and W that are open, of length 1 in rad and distances of the board."""


class _Linear(NamedTuple):
    """The corners' word on X, W and z, linear near the poses C_k."""

    off: Array
    """(K, 6) e_k."""
    by_unknowns: Array
    """(K, 6, 12 + Q) J_k, of X and W in rad and distances of the board, and of z."""
    by_robot: Array
    """(K, 6, 6) L_k."""
    noise: Array
    """(K, 6, 6) sigma^2 V_k^-1."""


class _Solution(NamedTuple):
    """Generalised least squares with given variances."""

    step: Array
    """(12 + Q,) b."""
    left: Array
    """(K, 6) e_k - J_k b."""
    weights: Array
    """(K, 6, 6) S_k^-1."""
    inverse: Array
    """(12 + Q, 12 + Q) A^+."""
    information: Array
    """(12, 12) of X and W, the camera's errors eliminated."""
    open_directions: Array
    """(n, 12) directions that are open."""


def refine_hand_eye(scene: Scene, X: Motions, W: Motions, boards: Motions) -> Estimate:
    """Refine hand and eye from a start.

    Args:
        scene: what is known.
        X: hand_from_camera.
        W: base_from_board.
        boards: (K,) cam_from_board, from the corners alone.
    """
    variances = np.array(_FIRST_VARIANCES)
    z = np.zeros(scene.camera_root.shape[1])
    for _ in range(_MAX_STEPS):
        linear = _linearise(scene, X, W, boards, z)
        variances, solution = _estimate_variances(linear, variances)
        step, z = solution.step[:12], solution.step[12:]
        corrections = _correct_robot(linear, solution, variances)
        by_X, by_W = (step * _scale(scene)).reshape(2, 6)
        X, W = X.take_step(by_X), W.take_step(by_W)
        boards = _predict(scene.robot, X, W).take_step(_multiply(linear.by_robot, corrections))
        gain = step @ solution.information @ step
        if gain < _GAIN_TOLERANCE**2 or np.abs(step).max() < _STEP_TOLERANCE:
            break
    scale = np.outer(_scale(scene), _scale(scene))
    influence = solution.inverse @ np.swapaxes(linear.by_unknowns, 1, 2) @ solution.weights
    to_robot = influence @ linear.by_robot * np.sqrt(_spread(variances))
    camera = solution.inverse[:12, 12:] @ solution.inverse[12:, :12]
    parts = [_sum_squares(to_robot), _sum_squares(influence @ np.linalg.cholesky(linear.noise))]
    scatter = _measure_scatter(linear, solution, variances)
    return Estimate(
        X,
        W,
        scene.camera.params + scene.camera_root @ z,
        boards,
        variances,
        corrections,
        (scatter + camera) * scale,
        np.stack([*parts, camera]) * scale,
        solution.open_directions,
    )


def _scale(scene: Scene) -> Array:
    """Return (12,) the rad and mm of steps of 1."""
    return np.tile(np.repeat([1.0, scene.reach], 3), 2)


def _spread(variances: Array) -> Array:
    """Return (6,) the diagonal of D."""
    return np.repeat(variances, 3)


def _multiply(matrices: Array, vectors: Array) -> Array:
    """Multiply matrices (K, m, n) by vectors (K, n)."""
    return np.asarray((matrices @ vectors[..., None])[..., 0])


def _sum_squares(columns: Array) -> Array:
    """Return the sum of a a^T (12, 12) over all columns a of (K, n, m), for X and W."""
    return np.einsum("kac,kbc->ab", columns[:, :12], columns[:, :12])


def _predict(robot: Motions, X: Motions, W: Motions) -> Motions:
    """Predict C_k for a robot that is where it says."""
    return X.invert().after(robot.invert().after(W))


def _linearise(scene: Scene, X: Motions, W: Motions, boards: Motions, z: Array) -> _Linear:
    """Linearise: with q a point's place in the hand's frame, C = X^-1 q and q = H^-1 W.

    Steps turn what they move from the left: R_C moves with X by -R_X^T w, with W by R_X^T R_H^T w
    and with the robot by -R_X^T rho; T_C = R_X^T (q - t_X) moves with X by R_X^T (q - t_X) x w.
    """
    P = len(scene.camera.params)
    pose = slice(P, P + 6)
    state = State(scene.camera.params + scene.camera_root @ z, boards.R, boards.t)
    products = compute_view_products(
        state, scene.observations, scene.camera.model, np.arange(P, dtype=np.int64)
    )
    inverse = np.asarray(np.linalg.inv(products[:, pose, pose]), np.float64)
    seen = -_multiply(inverse, products[:, pose, -1])
    by_camera = inverse @ products[:, pose, :P] @ scene.camera_root
    to_eye, q = X.R.T, scene.robot.invert().after(W).t
    by_X, by_W, by_robot = np.zeros((3, len(q), 6, 6))
    by_X[:, :3, :3] = by_X[:, 3:, 3:] = by_robot[:, :3, :3] = by_robot[:, 3:, 3:] = -to_eye
    by_X[:, 3:, :3] = to_eye @ make_cross_matrix(q - X.t)
    by_robot[:, 3:, :3] = to_eye @ make_cross_matrix(q)
    by_W[:, :3, :3] = by_W[:, 3:, 3:] = to_eye @ np.swapaxes(scene.robot.R, 1, 2)
    by_motions = np.concatenate([by_X, by_W], axis=2) * _scale(scene)
    return _Linear(
        off=boards.measure_step_from(_predict(scene.robot, X, W)) + seen + by_camera @ z,
        by_unknowns=np.concatenate([by_motions, by_camera], axis=2),
        by_robot=by_robot,
        noise=scene.variance * inverse,
    )


def _solve(linear: _Linear, variances: Array) -> _Solution:
    """Solve for X, W and z, leaving alone what is open."""
    J, L = linear.by_unknowns, linear.by_robot
    S = linear.noise + (L * _spread(variances)) @ np.swapaxes(L, 1, 2)
    weights = np.asarray(np.linalg.inv(S), np.float64)
    JS = np.swapaxes(J, 1, 2) @ weights
    A, right = (JS @ J).sum(axis=0), _multiply(JS, linear.off).sum(axis=0)
    # The camera's errors, of which the prior says enough, are eliminated first.
    by_camera = np.linalg.inv(A[12:, 12:] + np.eye(len(A) - 12))
    onto = np.concatenate([np.eye(12), -by_camera @ A[12:, :12]])
    information = A[:12, :12] + A[:12, 12:] @ onto[12:]
    values, vectors = np.linalg.eigh(information)
    is_told = values > max(1.0, _ROUNDING * values[-1])
    root = onto @ (vectors[:, is_told] / np.sqrt(values[is_told]))
    inverse = root @ root.T
    inverse[12:, 12:] += by_camera
    step = inverse @ right
    return _Solution(
        step, linear.off - J @ step, weights, inverse, information, vectors[:, ~is_told].T
    )


def _correct_robot(linear: _Linear, solution: _Solution, variances: Array) -> Array:
    """Return (K, 6) the most likely errors of the robot's poses."""
    pulls = _multiply(solution.weights, solution.left)
    return _spread(variances) * _multiply(np.swapaxes(linear.by_robot, 1, 2), pulls)


def _estimate_variances(linear: _Linear, variances: Array) -> tuple[Array, _Solution]:
    """Estimate (2,) the variances, and solve with them."""
    L = linear.by_robot
    for _ in range(_MAX_VARIANCE_STEPS):
        solution = _solve(linear, variances)
        weighted = solution.weights @ L
        square = (_multiply(np.swapaxes(weighted, 1, 2), solution.left) ** 2).sum(axis=0)
        onto = np.swapaxes(linear.by_unknowns, 1, 2) @ weighted
        trace = (L * weighted).sum(axis=(0, 1)) - (onto * (solution.inverse @ onto)).sum(
            axis=(0, 1)
        )
        square, trace = square.reshape(2, 3).sum(axis=1), trace.reshape(2, 3).sum(axis=1)
        raised = variances * np.sqrt(square / trace)
        gain = float(np.abs((raised - variances) * (square - trace)).sum())
        variances = raised
        if gain < _GAIN_TOLERANCE:
            break
    return variances, _solve(linear, variances)


def _measure_scatter(linear: _Linear, solution: _Solution, variances: Array) -> Array:
    """Measure (12, 12) how X and W scatter by what each pose disagrees with the others."""
    L = linear.by_robot
    root = np.linalg.cholesky(linear.noise + (L * _spread(variances)) @ np.swapaxes(L, 1, 2))
    white = np.linalg.solve(root, linear.by_unknowns)
    values, vectors = np.linalg.eigh(
        np.eye(6) - white @ solution.inverse @ np.swapaxes(white, 1, 2)
    )
    # A pose that alone determines something leaves nothing of it to scatter.
    values = np.where(values > np.sqrt(_ROUNDING), values, np.inf)
    left = _multiply(
        np.swapaxes(vectors, 1, 2), np.linalg.solve(root, solution.left[..., None])[..., 0]
    )
    left = _multiply(vectors, left / np.sqrt(values))
    return _sum_squares(solution.inverse @ np.swapaxes(white, 1, 2) @ left[..., None])
