"""Fisher information that each view holds about the camera, and how its pose follows the camera.

In the blocks of the normal equations (``refinement/schur.py``), view k alone contributes
Uk = Jc_k^T Jc_k, Wk and Vk. The Schur complement that eliminates its pose,

    Sk = Uk - Wk Vk^-1 Wk^T,

is the view's information about the camera. Information adds up: S = sum_k Sk, so the covariance
from any subset of the views is a sum and an inverse away. Given the camera's error dc, the error
of the pose is

    (w, tau)_k = -Vk^-1 Wk^T dc + e_k,      cov(e_k) = sigma^2 Vk^-1,

e_k independent of dc and of each other. The local rotation w turns about the board's origin,
at T_k from the camera; as a motion of camera space, x -> x + w x X + t, it reads
t = tau + T_k x w, so that the motions of all views are in one frame and can be averaged.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.observations import Observation, Observations, slice_views
from calibgui.engine.calibration.problem import (
    find_free_parameters,
    make_state,
    prepare_observations,
)
from calibgui.engine.calibration.refinement.residuals import State, linearise_residuals
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.geometry import rotations


class FisherInformation(NamedTuple):
    """Information that views hold about the camera's P free parameters, for unit variance."""

    camera: Array
    """(K, P, P) information Sk about the camera."""
    motion_by_camera: Array
    """(K, 6, P) derivative of view k's motion (w, t) by the camera's error."""
    pose_covariance: Array
    """(K, 6, 6) covariance of the part of view k's motion that is independent of the camera."""

    def chosen(self, views: IntArray) -> FisherInformation:
        """Return the information of the views with indices `views`."""
        return FisherInformation(
            self.camera[views], self.motion_by_camera[views], self.pose_covariance[views]
        )


def compute_information(
    calibration: Calibration, views: Sequence[Observation]
) -> FisherInformation:
    """Compute the information that each view of a calibration holds about its camera."""
    return compute_view_information(
        make_state(calibration.camera, calibration.poses),
        prepare_observations(calibration, views),
        calibration.camera.model,
        find_free_parameters(calibration),
        calibration.cost,
        calibration.reference_scale,
    )


def compute_view_information(
    state: State,
    observations: Observations,
    model: str,
    free: IntArray,
    cost: Cost = Cost.IMAGE,
    scale: float = 1.0,
) -> FisherInformation:
    """Compute the information of views, taken or imagined, at a given solution.

    Args:
        state: camera parameters and poses at which the residuals are linearised.
        observations: corners of the K views.
        model: id of the lens model.
        free: (P,) indices of the camera parameters that are estimated.
        cost, scale: residual that is minimised, and its scale, as in the calibration.
    """
    parts = []
    for views in slice_views(len(state.R)):
        _, by_params, by_pose = linearise_residuals(state, observations, views, model, cost, scale)
        Jc = by_params[..., free].reshape(len(by_params), -1, len(free))
        Jp = by_pose.reshape(len(by_pose), -1, 6)
        W = np.swapaxes(Jc, 1, 2) @ Jp
        inverse = np.linalg.inv(np.swapaxes(Jp, 1, 2) @ Jp)
        G = inverse @ np.swapaxes(W, 1, 2)
        M = np.broadcast_to(np.eye(6), (len(W), 6, 6)).copy()
        M[:, 3:, :3] = rotations.make_cross_matrix(state.T[views])
        parts.append(
            FisherInformation(
                np.swapaxes(Jc, 1, 2) @ Jc - W @ G, -M @ G, M @ inverse @ np.swapaxes(M, 1, 2)
            )
        )
    return FisherInformation(*(np.concatenate(blocks) for blocks in zip(*parts, strict=True)))
