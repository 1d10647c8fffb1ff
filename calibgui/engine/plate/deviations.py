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
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import scipy

from calibgui.engine.errors import CalibrationError
from calibgui.engine.estimation.arrow import NormalAt, NormalEquations, summed
from calibgui.engine.estimation.observations import Observations, boards, chunks
from calibgui.engine.estimation.problem import compiled, eq10, eq10_rows, linearised, transposed
from calibgui.engine.estimation.stage_two import Linearised, State
from calibgui.engine.lens import MODELS
from calibgui.engine.types import Array, Cost, IntArray, Plate, PlateModel

_TOGETHER = 512
"""Views whose compiled products are held at once; 11 MB for 156 corners."""


def corners_of(observations: Observations) -> tuple[Array, IntArray]:
    """The plate's distinct corners (n, 2) mm, and which of them each observation is (K, N)."""
    first, like = boards(observations)
    flat = np.round(observations.xy[first, :, :2].reshape(-1, 2), 9)
    points, index = np.unique(flat, axis=0, return_inverse=True)
    return points, index.reshape(len(first), -1)[like].astype(np.int64)


def basis(model: PlateModel, points: Array) -> Array:
    """B (n, 3, Q) of a model, for nominal points (n, 2) mm."""
    n = len(points)
    if model is PlateModel.FREE:
        return np.eye(3 * n).reshape(n, 3, 3 * n)
    low, high = points.min(axis=0), points.max(axis=0)
    centred = points - (low + high) / 2
    B = np.zeros((n, 3, 0 if model is PlateModel.NOMINAL else 2))
    if model is PlateModel.AFFINE:
        B[:, 1, 0] = B[:, 0, 1] = centred[:, 1]
    elif model is PlateModel.BOW:
        B[:, 2] = 1 - (2 * centred / (high - low)) ** 2
    return B


def gauge(points: Array) -> Array:
    """G (3n, 7), orthonormal: motions, turns and scaling of the plate (n, 2)."""
    centred = np.column_stack([points - points.mean(axis=0), np.zeros(len(points))])
    columns = [np.broadcast_to(axis, centred.shape) for axis in np.eye(3)]
    columns += [np.cross(axis, centred) for axis in np.eye(3)]
    columns.append(centred)
    return np.linalg.qr(np.stack([c.ravel() for c in columns], axis=1))[0]


def plate_problem(
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
        from calibgui.engine.kernels import plate  # takes a while: only when used

        lens, rows = eq10(model, state.params), eq10_rows(model, free)
        for begin in range(0, K, _TOGETHER):
            part = slice(begin, min(begin + _TOGETHER, K))
            R, T, views = state.R[part], state.T[part], transposed(observations.part(part))
            yield part, *plate.products(lens, R, T, views, rows, index[part], count, with_poses)
        return
    for part in chunks(K):
        with np.errstate(all="ignore"):  # a wild trial overflows; its cost says so
            whole = linearised(state, observations, part, MODELS[model], Cost.IMAGE, 1.0)
        A, D = _products(whole, state.R[part], free, index[part], observations.mask[part], count)
        P = len(free)
        ours, own = [*range(P), P + 6], D[..., P + 7 :]
        total = np.concatenate([D[..., ours], own], axis=-1).sum(axis=0)
        yield part, A, D[..., P : P + 6], total


def on_plate(observations: Observations, plate: Plate) -> Observations:
    """The observations with the corners where a known plate has them.

    Raises:
        CalibrationError: if a corner is not one of the plate's.
    """
    found = scipy.spatial.cKDTree(plate.nominal).query(observations.xy[..., :2])
    distance, index = np.asarray(found[0]), np.asarray(found[1], dtype=np.int64)
    if distance.max() > 1e-3:
        raise CalibrationError(
            "The views show corners that the given plate does not have.",
            "Use the plate file made with this target, squares of the same size and the same "
            "origin.",
        )
    return deviated(observations, plate.nominal, index, plate.deviation)


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
