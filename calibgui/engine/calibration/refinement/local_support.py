"""Stage II's normal equations of a splined lens, where a corner depends on few coefficients.

A splined lens has hundreds of coefficients (``camera.models.splined_stereographic``), but the image
of a ray depends on 16 control points only. With i among these, B_i their weights, M = w^T w the
weight of the corner, F = diag(fx, fy) and J_p the derivative of its pixel by the pose, the corner
adds

    B_i B_j F M F       to the 2 x 2 block of control points i and j in U,
    B_i F M J_p         to the 2 x 6 block of control point i in its view's W,
    B_i F M r           to the gradient by control point i,

and nothing anywhere else: 16^2 small blocks instead of the product of two rows as long as all the
coefficients. Each view's W then has rows of 0 for the control points that its corners do not
touch, by which ``schur.py`` saves in turn.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.camera.models.splined_stereographic import SplinedStereographic
from calibgui.engine.kernels import with_kernel
from calibgui.engine.kernels.views import CameraAndPoses

Blocks = tuple[Array, Array, Array, Array, Array, Array]
"""U, W, V, the shared gradient, the poses' gradients and the views' costs."""


@with_kernel("splined_lens", "prepare_local_blocks")
def prepare_local_blocks(
    observations: Observations, lens: SplinedStereographic, free: IntArray
) -> Callable[[CameraAndPoses], Blocks]:
    """Return a function from a state to the blocks of J^T J and J^T r, for the image cost.

    Args:
        observations: the views.
        lens: the lens model.
        free: (P,) indices of the camera's parameters that may change.
    """
    P = len(free)
    column = np.full(4 + len(lens.names), P)  # held parameters share a place that is cut off
    column[free] = np.arange(P)

    def blocks_at(state: CameraAndPoses) -> Blocks:
        K = len(state.R)
        U, shared, W = np.zeros((P + 1, P + 1)), np.zeros(P + 1), np.zeros((K, P + 1, 6))
        V, pose, costs = np.empty((K, 6, 6)), np.empty((K, 6)), np.empty(K)
        for k in range(K):
            view = observations.select_views(slice(k, k + 1))
            r, Jc, index, Jp = _linearise_view(state, k, view, lens)
            place = column[index]
            JcT, JpT, r = np.swapaxes(Jc, 1, 2), np.swapaxes(Jp, 1, 2), r[..., None]
            np.add.at(U, (place[:, :, None], place[:, None]), JcT @ Jc)
            np.add.at(W[k], place, JcT @ Jp)
            np.add.at(shared, place, (JcT @ r)[..., 0])
            V[k], pose[k] = (JpT @ Jp).sum(axis=0), (JpT @ r)[..., 0].sum(axis=0)
            costs[k] = np.sum(r * r)
        return U[:P, :P], W[:, :P], V, shared[:P], pose, costs

    return blocks_at


def _linearise_view(
    state: CameraAndPoses, k: int, view: Observations, lens: SplinedStereographic
) -> tuple[Array, Array, IntArray, Array]:
    """Return the whitened residuals (n, 2) of view k, with the derivatives that are not 0.

    They are (n, 2, 36) by fx, fy, cx, cy and 16 control points, the indices (n, 36) of these
    parameters, and the derivatives (n, 2, 6) by the pose.
    """
    xy, focal, centre = view.xy[0], state.params[:2], state.params[2:4]
    rotated = xy @ state.R[k][:, : xy.shape[1]].T
    d, by_ray, weights, first = lens.project_locally(rotated + state.T[k], state.params[4:])
    r = centre + focal * d - view.uv[0]
    Jc = np.zeros((len(d), 2, 36))
    index = np.empty((len(d), 36), dtype=np.intp)
    index[:, :4] = np.arange(4)
    for axis in range(2):
        Jc[:, axis, axis], Jc[:, axis, 2 + axis] = d[:, axis], 1.0
        Jc[:, axis, 4 + axis :: 2] = focal[axis] * weights
        index[:, 4 + axis :: 2] = 4 + axis + 2 * (first[:, None] + lens.neighbours)
    by_point = focal[:, None] * by_ray
    Jp = np.concatenate([np.cross(rotated[:, None], by_point), by_point], axis=-1)
    weight = view.mask[0][:, None, None] * np.eye(2)
    if view.whitening is not None:
        weight = view.whitening[0]
    return (weight @ r[..., None])[..., 0], weight @ Jc, index, weight @ Jp
