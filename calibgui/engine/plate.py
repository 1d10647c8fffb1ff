"""The plate as it is: deviations of the target from its nominal shape, estimated with the camera.

A corner i of the plate is at X_i = x_i + B_i q, its nominal place and a linear model of the
deviation (mm) with unknowns q that all views share:

`affine`  unequal sides and shear: (b y, a y, 0) from the plate's centre;
`bow`     z = zx (1 - xi^2) + zy (1 - eta^2), xi and eta from -1 to 1 across the plate;
`free`    every corner by itself, in the plane and out of it.

Beside the camera's parameters, q is one more set of shared unknowns in the arrow-shaped normal
equations of ``levenberg_marquardt.py``. A corner's 3-D place enters its image through X_cam
alone, so d(u, v)/dX_i = (d(u, v)/dX_cam) R, and d/dq = (d(u, v)/dX_i) B_i.

Gauge. Moving, turning or scaling the free plate is undone by the poses, seven directions
G (3n, 7) along which the residuals do not change. Adding kappa G G^T to the normal equations
fixes them without touching anything else: the deviations come out with G^T q = 0, no net
motion, turn or scale, whatever kappa. A prior, the deviations' standard deviations in and out
of the plane as the user knows them, adds sigma^2 / s^2 to the diagonal instead, where sigma
is the noise of the corners; it is what lets few views carry a free plate.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from calibgui.engine.errors import CalibrationError
from calibgui.engine.lens import Lens
from calibgui.engine.levenberg_marquardt import NormalAt, NormalEquations
from calibgui.engine.observations import Observations
from calibgui.engine.problem import linearised
from calibgui.engine.stage_two import State
from calibgui.engine.types import Array, Cost, IntArray, Plate, PlateModel


def corners_of(observations: Observations) -> tuple[Array, IntArray]:
    """The plate's distinct corners (n, 2) mm, and which of them each observation is (K, N)."""
    flat = np.round(observations.xy[..., :2].reshape(-1, 2), 9)
    points, index = np.unique(flat, axis=0, return_inverse=True)
    return points, index.reshape(observations.mask.shape).astype(np.int64)


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
    lens: Lens,
    free: IntArray,
    points: Array,
    index: IntArray,
    B: Array,
    stiffness: Array,
) -> NormalAt:
    """The normal equations of camera, plate and poses together.

    Args:
        observations: the views, on the nominal plate.
        lens: the lens model.
        free: (P,) indices of the camera's parameters that may move.
        points: (n, 2) the plate's corners, mm.
        index: (K, N) which of them each observation is.
        B: (n, 3, Q) basis of the deviations.
        stiffness: (Q, Q) added to J^T J for q: prior or gauge.

    Returns:
        A function of a state whose `params` are the camera's parameters followed by q.
    """
    count = len(B)
    places = np.nonzero(observations.mask)
    Q = B.shape[2]

    def normal_at(state: State) -> NormalEquations:
        camera, q = state.params[:-Q], state.params[-Q:]
        bent = deviated(observations, points, index, B @ q)
        with np.errstate(all="ignore"):  # a wild trial overflows; its cost says so
            whole = slice(0, len(state.R))
            r, by_params, by_pose = linearised(
                state._replace(params=camera), bent, whole, lens, Cost.IMAGE, 1.0
            )
        K = len(r)
        cost = float(np.sum(r**2) + q @ stiffness @ q)
        J = np.concatenate([by_params[..., free], by_pose, r[..., None]], axis=-1)
        by_corner = by_pose[..., 3:] @ state.R[:, None]
        flat = J.reshape(K, -1, J.shape[-1])
        A = np.swapaxes(flat, 1, 2) @ flat
        # Products of each corner's own three columns with all others, by the corner's number.
        D = np.zeros((K, count, 3, J.shape[-1] + 3))
        products = np.swapaxes(by_corner, -1, -2) @ np.concatenate([J, by_corner], axis=-1)
        D[places[0], index[places]] = products[places]
        return _assembled(A, D, B, q, stiffness, len(free), cost)

    return normal_at


def on_plate(observations: Observations, plate: Plate) -> Observations:
    """The observations with the corners where a known plate has them.

    Raises:
        CalibrationError: if a corner is not one of the plate's.
    """
    found = cKDTree(plate.nominal).query(observations.xy[..., :2])
    distance, index = np.asarray(found[0]), np.asarray(found[1], dtype=np.int64)
    if distance.max() > 1e-3:
        raise CalibrationError(
            "The views show corners that the given plate does not have.",
            "Use the plate file made with this target, squares of the same size and the same "
            "origin.",
        )
    return deviated(observations, plate.nominal, index, plate.deviation)


def deviated(observations: Observations, points: Array, index: IntArray, d: Array) -> Observations:
    """The observations on a plate with deviations d (n, 3) mm."""
    nominal = np.column_stack([points, np.zeros(len(points))])
    return Observations(
        observations.uv, (nominal + d)[index], observations.mask, observations.whitening
    )


def _assembled(
    A: Array, D: Array, B: Array, q: Array, stiffness: Array, P: int, cost: float
) -> NormalEquations:
    """Blocks for (camera, q) from products per view A (K, P + 7, P + 7) and per corner D."""
    total = _contracted(D.sum(axis=0)[None], B)[0]
    own = _own_blocks(D[..., P + 7 :].sum(axis=0), B)
    by_camera = total[:, :P]
    return NormalEquations(
        U=np.block([[A[:, :P, :P].sum(axis=0), by_camera.T], [by_camera, own + stiffness]]),
        W=np.concatenate([A[:, :P, P : P + 6], _contracted(D[..., P : P + 6], B)], axis=1),
        V=A[:, P : P + 6, P : P + 6],
        shared=np.concatenate([A[:, :P, -1].sum(axis=0), total[:, P + 6] + stiffness @ q]),
        pose=A[:, P : P + 6, -1],
        cost=cost if np.isfinite(cost) else float("inf"),
    )


def _contracted(D: Array, B: Array) -> Array:
    """(K, Q, m) sum over the corners of B_i^T D_ki, for D (K, n, 3, m)."""
    count, _, Q = B.shape
    if 3 * count == Q:  # the free plate's basis is the identity
        return D.reshape(len(D), Q, -1)
    return np.tensordot(D, B, axes=([1, 2], [0, 1])).swapaxes(1, 2)


def _own_blocks(H: Array, B: Array) -> Array:
    """(Q, Q) sum over the corners of B_i^T H_i B_i, for H (n, 3, 3)."""
    count, _, Q = B.shape
    if 3 * count == Q:
        own = np.zeros((count, 3, count, 3))
        own[np.arange(count), :, np.arange(count)] = H
        return own.reshape(Q, Q)
    return np.einsum("iaq,iab,ibr->qr", B, H, B)
