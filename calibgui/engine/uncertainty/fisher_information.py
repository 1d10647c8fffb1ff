"""What each view says of the camera, and how its pose answers to the camera's changes.

In the blocks of ``arrow.py``, view k alone contributes Uk = Jc_k^T Jc_k, Wk and
Vk. Eliminating its own pose leaves

    Sk = Uk - Wk Vk^-1 Wk^T,

what the view says of the camera. These add up: S = sum_k Sk, so the covariance from any
subset of the views is a sum and an inverse away. Given the camera's error dc, the pose is

    (w, tau)_k = -Vk^-1 Wk^T dc + e_k,      cov(e_k) = sigma^2 Vk^-1,

e_k independent of dc and of each other. The local rotation w turns about the plate's origin,
at T_k from the camera; as a motion of camera space, x -> x + w x X + t, it reads
t = tau + T_k x w, so that the motions of all views are in one frame and can be averaged.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.observations import Observation, Observations, chunks
from calibgui.engine.calibration.problem import free_parameters, measured, state_of
from calibgui.engine.calibration.refinement.normal_equations import linearised
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.models import MODELS
from calibgui.engine.geometry import rotations


class Information(NamedTuple):
    """What views say of the camera's free parameters, for residuals of unit variance."""

    camera: Array
    """(K, P, P) Sk."""
    answer: Array
    """(K, 6, P) motion (w, t) of view k with the camera's error, with the sign above."""
    own: Array
    """(K, 6, 6) covariance of the motion that is the view's own."""

    def chosen(self, views: IntArray) -> Information:
        """That of some of the views."""
        return Information(self.camera[views], self.answer[views], self.own[views])


def information(calibration: Calibration, views: Sequence[Observation]) -> Information:
    """What each of the views that a calibration was made from says of its camera."""
    return view_information(
        state_of(calibration.camera, calibration.poses),
        measured(calibration, views),
        calibration.camera.model,
        free_parameters(calibration),
        calibration.cost,
        calibration.reference_scale,
    )


def view_information(
    state: State,
    observations: Observations,
    model: str,
    free: IntArray,
    cost: Cost = Cost.IMAGE,
    scale: float = 1.0,
) -> Information:
    """The blocks of each view, chunk by chunk; the arguments are ``problem.stage_two``'s."""
    parts = []
    for views in chunks(len(state.R)):
        _, by_params, by_pose = linearised(state, observations, views, MODELS[model], cost, scale)
        Jc = by_params[..., free].reshape(len(by_params), -1, len(free))
        Jp = by_pose.reshape(len(by_pose), -1, 6)
        W = np.swapaxes(Jc, 1, 2) @ Jp
        inverse = np.linalg.inv(np.swapaxes(Jp, 1, 2) @ Jp)
        G = inverse @ np.swapaxes(W, 1, 2)
        M = np.broadcast_to(np.eye(6), (len(W), 6, 6)).copy()
        M[:, 3:, :3] = rotations.cross_matrix(state.T[views])
        parts.append(
            Information(
                np.swapaxes(Jc, 1, 2) @ Jc - W @ G, -M @ G, M @ inverse @ np.swapaxes(M, 1, 2)
            )
        )
    return Information(*(np.concatenate(blocks) for blocks in zip(*parts, strict=True)))
