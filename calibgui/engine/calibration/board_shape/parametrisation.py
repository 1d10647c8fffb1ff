"""The parametrisation of a board's deviations from its drawing, and their normal equations.

Boards are printed unevenly, glued on crooked and bent by their own weight. Where this is more than
the corners' noise, the deviations are estimated with the camera. A corner i of the board is at
X_i = x_i + B_i q, its place in the drawing and a linear model of the deviation (mm) with unknowns q
that all views share:

`affine`  unequal sides and shear: (b y, a y, 0) from the board's centre;
`bow`     z = zx (1 - xi^2) + zy (1 - eta^2), xi and eta from -1 to 1 across the board;
`free`    every corner by itself, in the plane and out of it.

Beside the camera's parameters, q is one more set of shared unknowns in the arrow-shaped normal
equations of ``refinement/schur.py`` (Triggs et al. 2000). A corner's 3-D place enters its image
through X_cam alone, so d(u, v)/dX_i = (d(u, v)/dX_cam) R, and d/dq = (d(u, v)/dX_i) B_i.

Gauge. Moving, turning or scaling the free board is undone by the poses: these are seven directions
G (3n, 7) along which the residuals do not change. Adding kappa G G^T to the normal equations
fixes them without touching anything else: the deviations come out with G^T q = 0, no net
motion, turn or scale, whatever kappa. A prior, the deviations' standard deviations in and out
of the plane as the user knows them, adds sigma^2 / s^2 to the diagonal instead, where sigma
is the noise of the corners; it is what lets few views carry a free board.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel
from calibgui.engine.calibration.observations import Observations, group_equal_boards, slice_views
from calibgui.engine.calibration.refinement.residuals import (
    Linearised,
    NormalAt,
    State,
    has_compiled_lens,
    linearise_residuals,
)
from calibgui.engine.calibration.refinement.schur import NormalEquations, sum_costs
from calibgui.engine.calibration.result import Cost
from calibgui.engine.errors import CalibrationError
from calibgui.engine.kernels import with_kernel

_MAX_DISTANCE = 1e-3
"""Distance of an observed corner from one of a known board beyond which it is another, mm."""


def index_board_points(observations: Observations) -> tuple[Array, IntArray]:
    """Find the board's distinct corners, and which of them each observation is.

    Returns:
        (n, 2) corners, mm, ascending by x and then y; and (K, N) their indices.
    """
    first, group = group_equal_boards(observations)
    flat = np.ascontiguousarray(observations.xy[first, :, :2].reshape(-1, 2)).round(9)
    # Complex numbers are ordered as wanted, and sorted much faster than rows.
    points, index = np.unique(flat.view(np.complex128)[:, 0], return_inverse=True)
    index = index.reshape(len(first), -1)[group].astype(np.int64)
    return points.view(np.float64).reshape(-1, 2), index


def make_basis(model: BoardShapeModel, points: Array) -> Array:
    """Make the basis B (n, 3, Q) of a model's deviations, for points (n, 2) mm of the drawing."""
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


def make_gauge(points: Array) -> Array:
    """Make the gauge G (3n, 7), orthonormal: motions, turns and scaling of a board (n, 2)."""
    centred = np.column_stack([points - points.mean(axis=0), np.zeros(len(points))])
    columns = [np.broadcast_to(axis, centred.shape) for axis in np.eye(3)]
    columns += [np.cross(axis, centred) for axis in np.eye(3)]
    columns.append(centred)
    return np.linalg.qr(np.stack([c.ravel() for c in columns], axis=1))[0]


def make_board_shape_problem(
    observations: Observations,
    model: str,
    free: IntArray,
    points: Array,
    index: IntArray,
    B: Array,
    stiffness: Array,
) -> NormalAt:
    """Make the normal equations of camera, board shape and poses together.

    Args:
        observations: the views, on the board as it is drawn.
        model: the lens model, a key of ``camera.models.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
        points: (n, 2) the board's corners, mm.
        index: (K, N) index among these of each observation.
        B: (n, 3, Q) basis of the deviations.
        stiffness: (Q, Q) matrix of the prior or the gauge, which is added to J^T J for q.

    Returns:
        A function of a state whose `params` are the camera's parameters followed by q.
    """
    P, Q, K = len(free), B.shape[2], len(index)

    def normal_at(state: State) -> NormalEquations:
        q = state.params[-Q:]
        camera = state._replace(params=state.params[:-Q])
        displaced = displace_board_points(observations, points, index, B @ q)
        U, W, V = np.zeros((P + Q, P + Q)), np.empty((K, P + Q, 6)), np.empty((K, 6, 6))
        U[P:, P:] = stiffness
        shared, pose = np.append(np.zeros(P), stiffness @ q), np.empty((K, 6))
        costs = np.empty(K)
        products = iterate_corner_products(camera, displaced, model, free, index, len(B))
        for views, A, D, total in products:
            costs[views] = A[:, -1, -1]
            U[:P, :P] += A[:, :P, :P].sum(axis=0)
            U[P:, :P] += _contract(total[None, ..., :P], B)[0]
            _add_corner_blocks(U[P:, P:], total[..., P + 1 :], B)
            W[views, :P], W[views, P:] = A[:, :P, P:-1], _contract(D, B)
            V[views], pose[views] = A[:, P:-1, P:-1], A[:, P:-1, -1]
            shared[:P] += A[:, :P, -1].sum(axis=0)
            shared[P:] += _contract(total[None, ..., P : P + 1], B)[0, :, 0]
        U[:P, P:] = U[P:, :P].T
        cost, costs = sum_costs(costs)
        return NormalEquations(U, W, V, shared, pose, cost + float(q @ stiffness @ q), costs)

    return normal_at


@with_kernel("board_shape", "iterate_corner_products", has_compiled_lens)
def iterate_corner_products(
    state: State,
    observations: Observations,
    model: str,
    free: IntArray,
    index: IntArray,
    count: int,
    with_poses: bool = True,
) -> Iterator[tuple[slice, Array, Array, Array]]:
    """Yield products of the columns [camera, pose, r] and of the board's corners, in parts.

    The products with the poses hold until the next part is asked for.

    Args:
        state: camera and poses.
        observations: the views, on the board as it is.
        model: the lens model, a key of ``camera.models.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
        index: (K, N) index of the board's corner that each observation is.
        count: n, the number of the board's corners.
        with_poses: whether to form the products with the poses, which take the most memory.

    Yields:
        A slice of k views and three arrays of products: (k, P + 7, P + 7) of the first columns with
        each other; (k, n, 3, 6) of the three columns of each corner with the pose's, (0, n, 3, 6)
        without the poses; (n, 3, P + 4) of these three with the camera's, with r and with
        themselves, summed over the views.
    """
    K = len(index)
    for part in slice_views(K):
        with np.errstate(all="ignore"):  # a wild trial overflows; its cost says so
            whole = linearise_residuals(state, observations, part, model, Cost.IMAGE, 1.0)
        A, D = _form_products(
            whole, state.R[part], free, index[part], observations.mask[part], count
        )
        P = len(free)
        ours, own = [*range(P), P + 6], D[..., P + 7 :]
        total = np.concatenate([D[..., ours], own], axis=-1).sum(axis=0)
        yield part, A, D[slice(None if with_poses else 0), ..., P : P + 6], total


def place_on_board_shape(observations: Observations, board_shape: BoardShape) -> Observations:
    """Move the corners of observations to where a known board has them.

    Raises:
        CalibrationError: if a corner is not one of the board's.
    """
    index = find_board_points(board_shape, observations.xy[..., :2])
    return displace_board_points(observations, board_shape.nominal, index, board_shape.deviation)


def find_board_points(board_shape: BoardShape, xy: Array) -> IntArray:
    """Find which corner of a known board each of the places xy (..., 2), mm, is.

    Raises:
        CalibrationError: if one is not one of the board's.
    """
    found = scipy.spatial.cKDTree(board_shape.nominal).query(xy)
    distance, index = np.asarray(found[0]), np.asarray(found[1], dtype=np.int64)
    if distance.max() > _MAX_DISTANCE:
        raise CalibrationError(
            "The views show corners that the given board shape does not have.",
            "Use the file made with this board, squares of the same size and the same origin.",
        )
    return index


def displace_board_points(
    observations: Observations, points: Array, index: IntArray, d: Array
) -> Observations:
    """Move the corners of observations by deviations d (n, 3) mm from the points (n, 2 or 3)."""
    places = np.array(d)
    places[:, : points.shape[1]] += points
    return replace(observations, xy=places[index])


def _form_products(
    whole: Linearised, R: Array, free: IntArray, index: IntArray, mask: Array, count: int
) -> tuple[Array, Array]:
    """Form the products of the columns [camera, pose, r] of some views.

    Returns:
        (K, P + 7, P + 7) with each other, and (K, n, 3, P + 10) with the three columns of the
        board's corners, by the corner's index; the last three are those columns themselves.
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


def _contract(D: Array, B: Array) -> Array:
    """Return (K, Q, m) sums over the corners of B_i^T D_ki, for D (K, n, 3, m)."""
    count, _, Q = B.shape
    if 3 * count == Q:  # the free board's basis is the identity
        return D.reshape(len(D), Q, -1)
    return np.swapaxes(B.reshape(3 * count, Q), 0, 1) @ D.reshape(len(D), 3 * count, -1)


def _add_corner_blocks(U: Array, H: Array, B: Array) -> None:
    """Add to U (Q, Q) the sum over the corners of B_i^T H_i B_i, for H (n, 3, 3)."""
    count, _, Q = B.shape
    if 3 * count == Q:
        place = np.arange(Q).reshape(count, 3)
        U[place[:, :, None], place[:, None, :]] += H
    else:
        U += np.einsum("iaq,iab,ibr->qr", B, H, B)
