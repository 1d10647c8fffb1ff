"""The plate as it is: deviations of the target from its nominal shape, estimated with the camera.

A corner i of the plate is at X_i = x_i + B_i q, its nominal place and a linear model of the
deviation (mm) with unknowns q that all views share:

`affine`  unequal sides and shear: (b y, a y, 0) from the plate's centre;
`bow`     z = zx (1 - xi^2) + zy (1 - eta^2), xi and eta from -1 to 1 across the plate;
`free`    every corner by itself, in the plane and out of it.

Beside the camera's parameters, q is one more set of shared unknowns in the arrow-shaped normal
equations of ``arrow.py``. A corner's 3-D place enters its image through X_cam
alone, so d(u, v)/dX_i = (d(u, v)/dX_cam) R, and d/dq = (d(u, v)/dX_i) B_i.

Gauge. Moving, turning or scaling the free plate is undone by the poses, seven directions
G (3n, 7) along which the residuals do not change. Adding kappa G G^T to the normal equations
fixes them without touching anything else: the deviations come out with G^T q = 0, no net
motion, turn or scale, whatever kappa. A prior, the deviations' standard deviations in and out
of the plane as the user knows them, adds sigma^2 / s^2 to the diagonal instead, where sigma
is the noise of the corners; it is what lets few views carry a free plate.

Estimating the plate together with the camera, and refusing where the views cannot carry it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration import covariances
from calibgui.engine.calibration.observations import Observations, boards, chunks
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution, minimise
from calibgui.engine.calibration.refinement.normal_equations import (
    Following,
    compiled,
    eq10,
    eq10_rows,
    linearised,
    residuals,
    transposed,
)
from calibgui.engine.calibration.refinement.residuals import Linearised, State
from calibgui.engine.calibration.refinement.schur import NormalAt, NormalEquations, schur, summed
from calibgui.engine.calibration.refinement.whitening import model_variance, weighted
from calibgui.engine.calibration.result import Cost, Report
from calibgui.engine.calibration.result_assembly import Estimate
from calibgui.engine.camera.models import MODELS
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import rotations

_TOGETHER = 512
"""Views whose compiled products are held at once; 11 MB for 156 corners."""


def corners_of(observations: Observations) -> tuple[Array, IntArray]:
    """The plate's distinct corners (n, 2) mm, and which of them each observation is (K, N)."""
    first, like = boards(observations)
    flat = np.round(observations.xy[first, :, :2].reshape(-1, 2), 9)
    points, index = np.unique(flat, axis=0, return_inverse=True)
    return points, index.reshape(len(first), -1)[like].astype(np.int64)


def basis(model: BoardShapeModel, points: Array) -> Array:
    """B (n, 3, Q) of a model, for nominal points (n, 2) mm."""
    n = len(points)
    if model is BoardShapeModel.FREE:
        return np.eye(3 * n).reshape(n, 3, 3 * n)
    low, high = points.min(axis=0), points.max(axis=0)
    centred = points - (low + high) / 2
    B = np.zeros((n, 3, 0 if model is BoardShapeModel.NOMINAL else 2))
    if model is BoardShapeModel.AFFINE:
        B[:, 1, 0] = B[:, 0, 1] = centred[:, 1]
    elif model is BoardShapeModel.BOW:
        B[:, 2] = 1 - (2 * centred / (high - low)) ** 2
    return B


def gauge(points: Array) -> Array:
    """G (3n, 7), orthonormal: motions, turns and scaling of the plate (n, 2)."""
    centred = np.column_stack([points - points.mean(axis=0), np.zeros(len(points))])
    columns = [np.broadcast_to(axis, centred.shape) for axis in np.eye(3)]
    columns += [np.cross(axis, centred) for axis in np.eye(3)]
    columns.append(centred)
    return np.linalg.qr(np.stack([c.ravel() for c in columns], axis=1))[0]


def board_shape_problem(
    observations: Observations,
    model: str,
    free: IntArray,
    points: Array,
    index: IntArray,
    B: Array,
    stiffness: Array,
) -> NormalAt:
    """The normal equations of camera, plate and poses together.

    Args:
        observations: the views, on the nominal plate.
        model: the lens, a key of ``lens.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
        points: (n, 2) the plate's corners, mm.
        index: (K, N) which of them each observation is.
        B: (n, 3, Q) basis of the deviations.
        stiffness: (Q, Q) added to J^T J for q: prior or gauge.

    Returns:
        A function of a state whose `params` are the camera's parameters followed by q.
    """
    P, Q, K = len(free), B.shape[2], len(index)

    def normal_at(state: State) -> NormalEquations:
        q = state.params[-Q:]
        camera = state._replace(params=state.params[:-Q])
        bent = deviated(observations, points, index, B @ q)
        U, W, V = np.zeros((P + Q, P + Q)), np.empty((K, P + Q, 6)), np.empty((K, 6, 6))
        U[P:, P:] = stiffness
        shared, pose = np.append(np.zeros(P), stiffness @ q), np.empty((K, 6))
        costs = np.empty(K)
        products = corner_products(camera, bent, model, free, index, len(B))
        for views, A, D, total in products:
            costs[views] = A[:, -1, -1]
            U[:P, :P] += A[:, :P, :P].sum(axis=0)
            U[P:, :P] += _contracted(total[None, ..., :P], B)[0]
            _add_own_blocks(U[P:, P:], total[..., P + 1 :], B)
            W[views, :P], W[views, P:] = A[:, :P, P:-1], _contracted(D, B)
            V[views], pose[views] = A[:, P:-1, P:-1], A[:, P:-1, -1]
            shared[:P] += A[:, :P, -1].sum(axis=0)
            shared[P:] += _contracted(total[None, ..., P : P + 1], B)[0, :, 0]
        U[:P, P:] = U[P:, :P].T
        cost, costs = summed(costs)
        return NormalEquations(U, W, V, shared, pose, cost + float(q @ stiffness @ q), costs)

    return normal_at


def corner_products(
    state: State,
    observations: Observations,
    model: str,
    free: IntArray,
    index: IntArray,
    count: int,
    with_poses: bool = True,
) -> Iterator[tuple[slice, Array, Array, Array]]:
    """Products of the columns [camera, pose, r] and of the plate's corners', some views at a time.

    Args:
        state: camera and poses.
        observations: the views, on the plate as it is.
        model: the lens, a key of ``lens.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
        index: (K, N) which of the plate's corners each observation is.
        count: n, their number.
        with_poses: whether to form the products with the poses, which take the most room.

    Returns:
        The views, and as ``kernels.plate.products``: (k, P + 7, P + 7) of the first columns with
        each other; (k, n, 3, 6) of the three columns of each corner with the pose's; (n, 3, P + 4)
        of these with the camera's, with r and with themselves, summed over the views.
    """
    K = len(index)
    if compiled(model):
        from calibgui.engine.kernels import board_shape  # takes a while: only when used

        lens, rows = eq10(model, state.params), eq10_rows(model, free)
        for begin in range(0, K, _TOGETHER):
            part = slice(begin, min(begin + _TOGETHER, K))
            R, T, views = state.R[part], state.T[part], transposed(observations.part(part))
            yield (
                part,
                *board_shape.products(lens, R, T, views, rows, index[part], count, with_poses),
            )
        return
    for part in chunks(K):
        with np.errstate(all="ignore"):  # a wild trial overflows; its cost says so
            whole = linearised(state, observations, part, MODELS[model], Cost.IMAGE, 1.0)
        A, D = _products(whole, state.R[part], free, index[part], observations.mask[part], count)
        P = len(free)
        ours, own = [*range(P), P + 6], D[..., P + 7 :]
        total = np.concatenate([D[..., ours], own], axis=-1).sum(axis=0)
        yield part, A, D[..., P : P + 6], total


def on_board_shape(observations: Observations, board_shape: BoardShape) -> Observations:
    """The observations with the corners where a known plate has them.

    Raises:
        CalibrationError: if a corner is not one of the plate's.
    """
    found = scipy.spatial.cKDTree(board_shape.nominal).query(observations.xy[..., :2])
    distance, index = np.asarray(found[0]), np.asarray(found[1], dtype=np.int64)
    if distance.max() > 1e-3:
        raise CalibrationError(
            "The views show corners that the given plate does not have.",
            "Use the plate file made with this target, squares of the same size and the same "
            "origin.",
        )
    return deviated(observations, board_shape.nominal, index, board_shape.deviation)


def deviated(observations: Observations, points: Array, index: IntArray, d: Array) -> Observations:
    """The observations on a plate with deviations d (n, 3) mm from its points (n, 2 or 3)."""
    places = np.array(d)
    places[:, : points.shape[1]] += points
    return replace(observations, xy=places[index])


def _products(
    whole: Linearised, R: Array, free: IntArray, index: IntArray, mask: Array, count: int
) -> tuple[Array, Array]:
    """Products of the columns [camera, pose, r] of some views.

    Returns:
        (K, P + 7, P + 7) with each other, and (K, n, 3, P + 10) with the three columns of the
        plate's corners, by the corner's number; the last three are those columns themselves.
    """
    r, by_params, by_pose = whole
    J = np.concatenate([by_params[..., free], by_pose, r[..., None]], axis=-1)
    rows = J.reshape(len(J), -1, J.shape[-1])
    by_corner = by_pose[..., 3:] @ R[:, None]
    each = np.swapaxes(by_corner, -1, -2) @ np.concatenate([J, by_corner], axis=-1)
    D = np.zeros((len(J), count, 3, J.shape[-1] + 3))
    views, places = np.nonzero(mask)
    D[views, index[views, places]] = each[views, places]
    return np.swapaxes(rows, 1, 2) @ rows, D


def _contracted(D: Array, B: Array) -> Array:
    """(K, Q, m) sum over the corners of B_i^T D_ki, for D (K, n, 3, m)."""
    count, _, Q = B.shape
    if 3 * count == Q:  # the free plate's basis is the identity
        return D.reshape(len(D), Q, -1)
    return np.swapaxes(B.reshape(3 * count, Q), 0, 1) @ D.reshape(len(D), 3 * count, -1)


def _add_own_blocks(U: Array, H: Array, B: Array) -> None:
    """Add to U (Q, Q) the sum over the corners of B_i^T H_i B_i, for H (n, 3, 3)."""
    count, _, Q = B.shape
    if 3 * count == Q:
        place = np.arange(Q).reshape(count, 3)
        U[place[:, :, None], place[:, None, :]] += H
    else:
        U += np.einsum("iaq,iab,ibr->qr", B, H, B)


_LEAST_VIEWS = {BoardShapeModel.AFFINE: 3, BoardShapeModel.BOW: 3, BoardShapeModel.FREE: 6}
"""Views without which the model follows the noise (a free plate without a prior)."""
_LEAST_SEEN = 4
"""Views that must show every corner of a free plate without a prior."""
_ROUNDS = 3
"""Solves until prior and weights have settled."""
_RANK = 1e-9
"""Information left (``uncertainty.py``) below which a plate is not determined."""


def fit_board_shape(
    nominal: Solution,
    observations: Observations,
    model: str,
    free: IntArray,
    shape: BoardShapeModel,
    prior: BoardShapePrior | None,
    report: Report | None,
) -> Estimate:
    """Estimate the plate with everything else, from the solution for the nominal one.

    Args:
        nominal: the converged Stage II with the image cost.
        observations: the views on the nominal plate.
        model: the lens, a key of ``lens.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
        shape: affine, bow or free.
        prior: of a free plate's corners.
        report: told of each iteration.

    Raises:
        CalibrationError: if the views cannot determine the plate, with the reason.
    """
    points, index = corners_of(observations)
    _check(observations, index, len(points), shape, prior)
    B = basis(shape, points)
    gauged = prior is None and shape is BoardShapeModel.FREE
    G = gauge(points) if gauged else np.zeros((B.shape[2], 0))
    bend = _Bend(points, index, B, G, prior)
    found = _solved(nominal, observations, model, free, bend, report)
    inverse, left = covariances.shared_inverse(schur(found.solution.normal))
    if left < _RANK:
        raise CalibrationError(
            f"These views do not determine the plate's shape ({shape.value}).",
            "Add views tilted in different directions that show the whole board, "
            "state a prior, or keep the nominal plate.",
        )
    P = len(free)
    covariance = _without_gauge(found.sigma2 * inverse, G, P)
    camera, of_board_shape = covariance[:P, :P], covariance[P:, P:]
    rvecs = rotations.rotation_vector(found.state.R)
    motion = np.linalg.solve(camera, covariance[:P, P:]).T
    return Estimate(
        solution=found.solution,
        state=found.state,
        observations=found.observations,
        sigma2=found.sigma2,
        camera=camera,
        poses=covariances.pose_covariances(found.solution.normal, covariance, rvecs, found.sigma2),
        by_noise=camera,
        board_shape=BoardShape(shape, points, found.deviation, _spread(B, of_board_shape)),
        shape_unknowns=bend.unknowns,
        following=Following(B @ motion, index),
    )


class _Bend(NamedTuple):
    """How the corners may deviate (``deviations.py``), and what holds them."""

    points: Array
    """(n, 2) the plate's corners, mm."""
    corner: IntArray
    """(K, N) which of them each observation is."""
    B: Array
    """(n, 3, Q) basis of the deviations."""
    G: Array
    """(Q, 7) gauge of a free plate without a prior; (Q, 0) otherwise."""
    prior: BoardShapePrior | None

    @property
    def unknowns(self) -> int:
        """Of the plate, without its gauge."""
        return self.B.shape[2] - self.G.shape[1]

    def stiffness(self, sigma2: float) -> Array:
        """(Q, Q) what is added to J^T J for the plate: the prior, or the gauge."""
        count, _, Q = self.B.shape
        if self.prior is None or 3 * count != Q:
            return self.G @ self.G.T
        s = np.array([self.prior.in_plane, self.prior.in_plane, self.prior.out_of_plane])
        return np.diag(np.tile(sigma2 / s**2, count))


class _Found(NamedTuple):
    """A solution with the plate's unknowns, and what it makes of camera and corners."""

    solution: Solution
    state: State
    """Camera and poses alone."""
    observations: Observations
    """With the corners where the plate has them."""
    deviation: Array
    """(n, 3) mm."""
    sigma2: float
    """Variance of one residual coordinate."""


def _solved(
    nominal: Solution,
    observations: Observations,
    model: str,
    free: IntArray,
    bend: _Bend,
    report: Report | None,
) -> _Found:
    """Camera, poses and plate together, from the solution for the nominal plate.

    Prior and weights are in units of the corners' noise, which the better plate itself lowers.
    """
    Q, P = bend.B.shape[2], len(nominal.state.params)
    known = len(free) + nominal.normal.pose.size
    sigma2 = covariances.variance(nominal.normal.cost, observations.count, known)
    start = nominal.state._replace(params=np.append(nominal.state.params, np.zeros(Q)))
    solution = nominal._replace(state=start)
    once = bend.prior is None and observations.cov is None
    for _ in range(1 if once else _ROUNDS):
        solution = minimise(
            board_shape_problem(observations, model, free, *bend[:3], bend.stiffness(sigma2)),
            solution.state,
            np.append(free, P + np.arange(Q)),
            observations.count,
            float(np.sum(observations.uv**2)),
            report,
            earlier=solution.history,
        )
        state = solution.state._replace(params=solution.state.params[:P])
        deviation = bend.B @ solution.state.params[P:]
        bent = deviated(observations, bend.points, bend.corner, deviation)
        unknowns = known + bend.unknowns
        if observations.cov is not None:
            miss, _ = residuals(state, bent, model, Cost.IMAGE)
            observations = weighted(observations, model_variance(observations, miss, unknowns))
        sigma2 = covariances.variance(solution.normal.cost, observations.count, unknowns)
    return _Found(solution, state, bent, deviation, sigma2)


def _check(
    observations: Observations,
    index: IntArray,
    count: int,
    shape: BoardShapeModel,
    prior: BoardShapePrior | None,
) -> None:
    K = len(observations.mask)
    if prior is None and _LEAST_VIEWS[shape] > K:
        raise CalibrationError(
            f"{K} views cannot carry the plate model {shape.value!r}, which needs "
            f"{_LEAST_VIEWS[shape]}.",
            "Add views, or keep the nominal plate.",
        )
    if shape is not BoardShapeModel.FREE or prior is not None:
        return
    seen = np.bincount(index[observations.mask > 0], minlength=count)
    if (rare := int((seen < _LEAST_SEEN).sum())) > 0:
        raise CalibrationError(
            f"{rare} of the plate's {count} corners are seen in fewer than {_LEAST_SEEN} views.",
            "A free plate needs every corner in several views: add views of those parts, "
            "state a prior, or use the plate models affine or bow.",
        )


def _spread(B: Array, covariance: Array) -> Array:
    """(n, 3) one standard deviation, mm, of the corners' places from the covariance of q."""
    flat = B.reshape(-1, B.shape[2])
    free = len(flat) == len(covariance)  # whose basis is the identity
    variance = np.diag(covariance) if free else np.sum(flat @ covariance * flat, axis=1)
    return np.sqrt(np.maximum(variance, 0.0)).reshape(-1, 3)


def _without_gauge(covariance: Array, G: Array, P: int) -> Array:
    """The covariance with the directions of the gauge, fixed by definition, taken out."""
    left = covariance.copy()
    left[P:] -= G @ (G.T @ left[P:])
    left[:, P:] -= (left[:, P:] @ G) @ G.T
    return left
