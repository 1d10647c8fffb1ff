"""From a solution to what is reported: covariances, poses, residuals, the Stage I table."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.calibration import covariances
from calibgui.engine.calibration.initialisation import single_view_pose
from calibgui.engine.calibration.initialisation.stage_one import Prealignment
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.options import Options
from calibgui.engine.calibration.refinement import normal_equations
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import (
    Calibration,
    Cost,
    StageOne,
    Undetermined,
    ViewResiduals,
)
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry import homography, rotations
from calibgui.engine.geometry.pose import Pose


class Estimate(NamedTuple):
    """A solution with its covariances."""

    solution: Solution
    state: State
    """Camera and poses, without the plate's unknowns."""
    observations: Observations
    """With the corners where the plate has them."""
    sigma2: float
    """Variance of one residual coordinate."""
    camera: Array
    """(P, P) covariance of the camera's free parameters."""
    poses: Array
    """(K, 6, 6) covariances of (rvec, tvec)."""
    by_noise: Array
    """(P, P) covariance of the camera's free parameters from the corners' noise alone."""
    board_shape: BoardShape | None = None
    shape_unknowns: int = 0
    """Of an estimated plate, without its gauge."""
    following: normal_equations.Following | None = None
    """How an estimated plate moves with the camera."""
    board_shape_error: float = 0.0
    """As ``Calibration.plate_doubt``."""
    view_scatter: float = 0.0
    """As ``Calibration.view_scatter``."""


def estimated(
    solution: Solution, observations: Observations, precision: covariances.Precision
) -> Estimate:
    """The estimate of a solution without a plate of its own."""
    rvecs = rotations.rotation_vector(solution.state.R)
    sigma2, camera, _ = precision
    spread = covariances.pose_covariances(solution.normal, camera, rvecs, sigma2)
    return Estimate(solution, solution.state, observations, sigma2, camera, spread, camera)


def reported(
    estimate: Estimate, asked: Options, undetermined: tuple[Undetermined, ...], digest: str
) -> Calibration:
    """The calibration as it is handed over: all parameters, held ones included.

    Args:
        estimate: of what is asked.
        asked: by the user.
        undetermined: parameters whose standard deviations are not to be believed.
        digest: of the observations and settings.
    """
    P, free, cost = len(asked.names), asked.free, asked.cost
    lost = [asked.names.index(u.name) for u in undetermined]

    def deviations(covariance: Array) -> tuple[Array, Array]:
        whole = np.zeros((P, P))
        whole[np.ix_(free, free)] = covariance
        sigma = np.sqrt(np.diag(whole))
        sigma[lost] = np.nan
        return whole, sigma

    state, observations = estimate.state, estimate.observations
    covariance, sigma = deviations(estimate.camera)
    return Calibration(
        camera=Camera(asked.size, state.params, asked.model),
        sigma=sigma,
        covariance=covariance,
        sigma_by_noise=deviations(estimate.by_noise)[1],
        poses=poses(state),
        pose_covariances=estimate.poses,
        residuals=residuals(state, observations, asked.model, cost, asked.scale),
        noise=float(np.sqrt(estimate.sigma2)),
        model_error=float(np.sqrt(observations.tau2)),
        reference_scale=asked.scale,
        stage_one=stage_one_table(asked.first, literal=cost is Cost.PAPER),
        history=estimate.solution.history,
        status=estimate.solution.status,
        cost=cost,
        fixed=tuple(name for name in asked.names if name in asked.held),
        undetermined=undetermined,
        board_shape=asked.board_shape or estimate.board_shape,
        board_shape_error=estimate.board_shape_error,
        view_scatter=estimate.view_scatter,
        settings=asked.settings,
        digest=digest,
    )


def poses(state: State) -> tuple[Pose, ...]:
    """The views' poses."""
    rvecs = rotations.rotation_vector(state.R)
    return tuple(Pose(rvec, T) for rvec, T in zip(rvecs, state.T, strict=True))


def residuals(
    state: State, observations: Observations, model: str, cost: Cost, scale: float
) -> tuple[ViewResiduals, ...]:
    """Residuals of every view in the image and on the reference plane.

    Args:
        state: camera and poses.
        observations: the views, with the corners where the plate has them.
        model: the lens, a key of ``lens.MODELS``.
        cost: what was minimised.
        scale: reference px per mm.
    """
    image, registered = normal_equations.residuals(state, observations, model, cost)
    counts = observations.mask.sum(axis=1).astype(int).tolist()
    return tuple(
        ViewResiduals(image[k, :n], scale * registered[k, :n]) for k, n in enumerate(counts)
    )


def stage_one_table(first: Prealignment, literal: bool) -> tuple[StageOne, ...]:
    """Table 1, with what the cosines' equation says of each view.

    `literal`: on the paper's grid, equal in pixels along both axes.
    """
    backward = homography.inverted(first.forward)
    geometry = single_view_pose.view_geometry(backward, literal)
    columns = (
        *first.centre.T.tolist(),
        first.k1.tolist(),
        geometry.aspect.tolist(),
        geometry.fx.tolist(),
        geometry.fy.tolist(),
        first.iterations.tolist(),
        first.rms.tolist(),
        backward,
        first.converged.tolist(),
    )
    return tuple(StageOne(*row) for row in zip(*columns, strict=True))
