"""The normal equations that Stage II's solver asks for: compiled where they can be.

The compiled kernel needs numba and knows the image cost of the two polynomial lens models.
Everything else, and machines without numba, use the readable numpy code; both give the same
solution to rounding (``tests/engine/kernels``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.observations import Observations, chunks
from calibgui.engine.calibration.refinement.residuals import (
    Linearised,
    State,
    image_residual,
    predicted_corners,
    reference_residual,
    registration_error,
)
from calibgui.engine.calibration.refinement.schur import (
    NormalAt,
    NormalEquations,
    normal_equations,
    summed,
)
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models import MODELS

if TYPE_CHECKING:
    from calibgui.engine.kernels.normal_equations import Views
    from calibgui.engine.kernels.polynomial_lens import Eq10Camera


_EQ10_ROWS = {
    "lucchese": np.arange(10),
    "opencv": np.array([0, 1, 2, 3, 4, 5, 8, 7, 6]),  # k1 k2 p1 p2 k3; its p1 is eq. 10's p2
}
"""Place of each camera parameter among fx, fy, cx, cy, k1, k2, k3, p1, p2, p3."""


class Following(NamedTuple):
    """How the corners of an estimated plate move with the camera's parameters."""

    motion: Array
    """(n, 3, P) mm per unit of each."""
    corner: IntArray
    """(K, N) which of the plate's corners each observation is."""


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
    if compiled(model, cost):
        return _compiled(observations, model, free)

    def linearise(state: State, views: slice) -> Linearised:
        return linearised(state, observations, views, MODELS[model], cost, scale)

    return lambda state: normal_equations(linearise, state, free)


def compiled(model: str, cost: Cost = Cost.IMAGE) -> bool:
    """Whether there are kernels for a lens model and a cost."""
    return kernels.COMPILED and cost is Cost.IMAGE and model in _EQ10_ROWS


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


def residuals(
    state: State, observations: Observations, model: str, cost: Cost
) -> tuple[Array, Array]:
    """(K, N, 2) measured minus predicted corners, px, and registered minus nominal ones, mm."""
    seen, registered = np.empty_like(observations.uv), np.empty_like(observations.uv)
    unread = list(chunks(len(state.R)))
    if compiled(model, cost):
        from calibgui.engine.kernels import normal_equations as normal_equations_module

        found = normal_equations_module.residuals(
            eq10(model, state.params), state.R, state.T, transposed(observations)
        )
        seen[:], registered[:] = (np.swapaxes(part, 1, 2) for part in found)
        # The kernel gives a view up for one corner that its Newton's method does not reach.
        given_up = ~np.isfinite(seen + registered).all(axis=(1, 2))
        unread = [slice(k, k + 1) for k in np.flatnonzero(given_up).tolist()]
    for views in unread:
        part, own = observations.part(views), state.part(views)
        seen[views] = part.uv - predicted_corners(own, part, MODELS[model], cost)
        there = registration_error(own, part, MODELS[model], cost)
        registered[views] = np.where(np.isfinite(seen[views]), there, np.nan)
    return seen, registered


def _compiled(observations: Observations, model: str, free: IntArray) -> NormalAt:
    """The kernel's sums as `NormalEquations`."""
    from calibgui.engine.kernels import normal_equations as normal_equations_module

    views, rows, P = transposed(observations), eq10_rows(model, free), len(free)

    def normal_at(state: State) -> NormalEquations:
        A = normal_equations_module.products(
            eq10(model, state.params), state.R, state.T, views, rows
        )
        # Summed over views in a fixed order, whichever thread made them.
        cost, costs = summed(A[:, -1, -1])
        return NormalEquations(
            U=A[:, :P, :P].sum(axis=0),
            W=A[:, :P, P:-1],
            V=A[:, P:-1, P:-1],
            shared=A[:, :P, -1].sum(axis=0),
            pose=A[:, P:-1, -1],
            cost=cost,
            costs=costs,
        )

    return normal_at


def view_products(
    state: State,
    observations: Observations,
    model: str,
    free: IntArray,
    following: Following | None = None,
) -> Array:
    """(K, P + 7, P + 7) products of each view's columns [camera, pose, r], with the image cost.

    Args:
        state: camera and poses.
        observations: the views, on the plate as it is.
        model: the lens, a key of ``lens.MODELS``.
        free: (P,) indices of the camera's parameters that may move.
        following: how an estimated plate moves with the camera; that counts as the camera's part.
    """
    if compiled(model):
        from calibgui.engine.kernels import board_shape
        from calibgui.engine.kernels import normal_equations as normal_equations_module

        lens, rows = eq10(model, state.params), eq10_rows(model, free)
        given = lens, state.R, state.T, transposed(observations), rows
        if following is None:
            return normal_equations_module.products(*given)
        return board_shape.followed(*given, following.corner, following.motion)
    parts = []
    for views in chunks(len(state.R)):
        r, by_params, by_pose = linearised(
            state, observations, views, MODELS[model], Cost.IMAGE, 1.0
        )
        by_camera = by_params[..., free]
        if following is not None:
            by_corner = by_pose[..., 3:] @ state.R[views, None]
            by_camera = by_camera + by_corner @ following.motion[following.corner[views]]
        J = np.concatenate([by_camera, by_pose, r[..., None]], axis=-1)
        J = J.reshape(len(J), -1, J.shape[-1])
        parts.append(np.swapaxes(J, 1, 2) @ J)
    return np.concatenate(parts)


def eq10(model: str, params: Array) -> Eq10Camera:
    """A camera's parameters as the kernels take them."""
    from calibgui.engine.kernels.polynomial_lens import Eq10Camera

    camera = np.zeros(10)
    camera[_EQ10_ROWS[model]] = params
    return Eq10Camera(tuple(camera.tolist()), model == "lucchese")


def eq10_rows(model: str, free: IntArray) -> IntArray:
    """(P,) places of the free parameters among eq. 10's."""
    return _EQ10_ROWS[model][free]


def transposed(observations: Observations) -> Views:
    """The views as the kernels take them."""
    from calibgui.engine.kernels.normal_equations import Views

    K, N = observations.mask.shape
    xyz = np.zeros((K, 3, N))
    xyz[:, : observations.xy.shape[-1]] = np.swapaxes(observations.xy, 1, 2)
    weight = np.zeros((K, 4, 0 if observations.unweighted else N))
    if observations.whitening is not None:
        weight[:] = np.swapaxes(observations.whitening.reshape(K, N, 4), 1, 2)
    elif weight.size:
        weight[:, 0] = weight[:, 3] = observations.mask
    return Views(np.array(np.swapaxes(observations.uv, 1, 2), order="C"), xyz, weight)
