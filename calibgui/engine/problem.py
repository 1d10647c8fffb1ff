"""The normal equations that Stage II's solver asks for: compiled where they can be.

The compiled kernel needs numba and knows the image cost of the two polynomial lens models.
Everything else, and machines without numba, use the readable numpy code; both give the same
solution to rounding (``tests/engine/kernels``).
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.lens import MODELS, Lens
from calibgui.engine.levenberg_marquardt import NormalAt, NormalEquations, normal_equations
from calibgui.engine.observations import Observations
from calibgui.engine.stage_two import Linearised, State, image_residual, reference_residual
from calibgui.engine.types import Array, Cost, IntArray

_EQ10_ROWS = {
    "lucchese": np.arange(10),
    "opencv": np.array([0, 1, 2, 3, 4, 5, 8, 7, 6]),  # k1 k2 p1 p2 k3; its p1 is eq. 10's p2
}
"""Place of each camera parameter among fx, fy, cx, cy, k1, k2, k3, p1, p2, p3."""


def stage_two(
    observations: Observations, model: str, cost: Cost, scale: float, free: IntArray
) -> NormalAt:
    """The problem that Stage II solves.

    Args:
        observations: the views.
        model: the lens, a key of ``lens.MODELS``.
        cost: what is minimised.
        scale: reference px per mm, for the costs on the reference plane.
        free: (P,) indices of the camera's parameters that may move.
    """
    if kernels.COMPILED and cost is Cost.IMAGE and model in _EQ10_ROWS:
        return _compiled(observations, model, free)

    def linearise(state: State, views: slice) -> Linearised:
        return linearised(state, observations, views, MODELS[model], cost, scale)

    return lambda state: normal_equations(linearise, state, free)


def linearised(
    state: State, observations: Observations, views: slice, lens: Lens, cost: Cost, scale: float
) -> Linearised:
    """Residuals of a slice of the views with derivatives, whitened; zero for padding."""
    part = observations.part(views)
    if cost is Cost.IMAGE:
        result = image_residual(state.part(views), part, lens)
    else:
        result = reference_residual(state.part(views), part, lens, scale, cost is Cost.PAPER)
    weight = part.whitening
    if weight is None:
        weight = part.mask[..., None, None] * np.eye(2)
    return Linearised(
        (weight @ result.residual[..., None])[..., 0],
        weight @ result.by_params,
        weight @ result.by_pose,
    )


def _compiled(observations: Observations, model: str, free: IntArray) -> NormalAt:
    """The kernel's sums as `NormalEquations`."""
    from calibgui.engine.kernels.stage_two import products  # takes a while: only when used

    to_eq10 = _EQ10_ROWS[model]
    uv = np.ascontiguousarray(np.swapaxes(observations.uv, 1, 2))
    xyz = np.zeros((len(uv), 3, uv.shape[2]))
    xyz[:, : observations.xy.shape[-1]] = np.swapaxes(observations.xy, 1, 2)
    weight = _weights(observations)
    rows, P = to_eq10[free], len(free)

    def normal_at(state: State) -> NormalEquations:
        params: Array = np.zeros(10)
        params[to_eq10] = state.params
        A = products(params, model == "lucchese", state.R, state.T, uv, xyz, weight, rows)
        # Summed over views in a fixed order, whichever thread made them.
        total = A[:, :P, :P].sum(axis=0), A[:, :P, -1].sum(axis=0), float(A[:, -1, -1].sum())
        cost = total[2] if np.isfinite(total[2]) else float("inf")
        return NormalEquations(
            U=total[0],
            W=A[:, :P, P:-1],
            V=A[:, P:-1, P:-1],
            shared=total[1],
            pose=A[:, P:-1, -1],
            cost=cost,
        )

    return normal_at


def _weights(observations: Observations) -> Array | None:
    """(K, 4, N) whitening for the kernel; None if every view is complete and unweighted."""
    K, N = observations.mask.shape
    if observations.whitening is not None:
        return np.ascontiguousarray(np.swapaxes(observations.whitening.reshape(K, N, 4), 1, 2))
    if observations.mask.all():
        return None
    weight = np.zeros((K, 4, N))
    weight[:, 0] = weight[:, 3] = observations.mask
    return weight
