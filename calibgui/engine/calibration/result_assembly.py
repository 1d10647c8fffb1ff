"""The last step of a calibration: a solution becomes the `Calibration` that is handed over.

The solver works with free parameters, rotation matrices and padded arrays. A `Calibration` lists
all parameters, those that were held included, one pose and one array of residuals a view, and the
paper's Table 1.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, freeze_array
from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.calibration.initialisation import single_view_pose
from calibgui.engine.calibration.initialisation.stage_one import StageOneRegistration
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.options import Options
from calibgui.engine.calibration.refinement import covariances, residuals
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
    """Camera and poses, without the unknowns of a board shape."""
    observations: Observations
    """The views, with the corners where the estimated board has them."""
    sigma2: float
    """Variance of one residual coordinate, in the cost's px^2."""
    camera_covariance: Array
    """(P, P) covariance of the camera's free parameters."""
    pose_covariances: Array
    """(K, 6, 6) covariances of the solver's local (w, tau)."""
    noise_covariance: Array
    """(P, P) covariance of the camera's free parameters from the corners' noise alone."""
    board_shape: BoardShape | None = None
    shape_unknowns: int = 0
    """Number of unknowns of an estimated board shape, less those of its gauge."""
    board_motion: residuals.BoardMotion | None = None
    """Motion of the corners of an estimated board with the camera's parameters."""
    board_shape_error: float = 0.0
    """See ``Calibration.board_shape_error``."""
    lens_error: float = 0.0
    """See ``Calibration.lens_error``."""
    overdispersion: float = 0.0
    """See ``Calibration.overdispersion``."""


def make_estimate(
    solution: Solution, observations: Observations, precision: covariances.Precision
) -> Estimate:
    """Make the estimate of a solution whose board has the shape that it was given."""
    sigma2, camera, _, reduced = precision
    poses = covariances.compute_pose_covariances(reduced, camera, sigma2)
    return Estimate(solution, solution.state, observations, sigma2, camera, poses, camera)


def assemble_calibration(
    estimate: Estimate,
    options: Options,
    undetermined: tuple[Undetermined, ...],
    digest: str,
    remarks: tuple[str, ...] = (),
    seconds: float = np.nan,
) -> Calibration:
    """Assemble the calibration that is handed over: all parameters, held ones included.

    Args:
        estimate: the solution with its covariances.
        options: the options of the calibration.
        undetermined: parameters whose standard deviations are not to be believed; they become NaN.
        digest: SHA-256 of the observations and settings.
        remarks: what the method has to say about the views.
        seconds: time that the method has taken; NaN if it is not known.
    """
    P, free, cost = len(options.names), options.free, options.cost
    lost = [options.names.index(u.name) for u in undetermined]

    def with_held_parameters(covariance: Array) -> tuple[Array, Array]:
        """Return the covariance (P, P) of all parameters, and their standard deviations (P,)."""
        whole = np.zeros((P, P))
        whole[np.ix_(free, free)] = covariance
        sigma = np.sqrt(np.diag(whole))
        sigma[lost] = np.nan
        return whole, sigma

    state, observations = estimate.state, estimate.observations
    covariance, sigma = with_held_parameters(estimate.camera_covariance)
    rvecs = rotations.vector_from_rotation(state.R)
    return Calibration(
        camera=Camera(options.size, state.params, options.model),
        sigma=sigma,
        covariance=covariance,
        noise_covariance=with_held_parameters(estimate.noise_covariance)[0],
        poses=make_poses(rvecs, state.T),
        pose_covariances=covariances.convert_pose_covariances(estimate.pose_covariances, rvecs),
        residuals=compute_view_residuals(state, observations, options.model, cost, options.scale),
        noise=float(np.sqrt(estimate.sigma2)),
        model_error=float(np.sqrt(observations.tau2)),
        reference_scale=options.scale,
        stage_one=options.stage_one,
        history=estimate.solution.history,
        status=estimate.solution.status,
        cost=cost,
        fixed=tuple(name for name in options.names if name in options.held),
        undetermined=undetermined,
        board_shape=options.board_shape or estimate.board_shape,
        board_shape_error=estimate.board_shape_error,
        lens_error=estimate.lens_error,
        overdispersion=estimate.overdispersion,
        settings=options.settings,
        digest=digest,
        warnings=remarks,
        seconds=seconds,
    )


def make_poses(rvecs: Array, T: Array) -> tuple[Pose, ...]:
    """Make the poses of rotation vectors (K, 3) and translations (K, 3), mm."""
    return tuple(map(Pose, freeze_array(rvecs), freeze_array(T)))  # so that no pose copies its part


def compute_view_residuals(
    state: State, observations: Observations, model: str, cost: Cost, scale: float
) -> tuple[ViewResiduals, ...]:
    """Compute the residuals of every view in the image and on the reference plane.

    Args:
        state: camera and poses.
        observations: the views, with the corners where the board has them.
        model: the lens model, a key of ``camera.models.MODELS``.
        cost: the cost that was minimised.
        scale: reference px per mm.
    """
    image, reference = residuals.compute_residuals(state, observations, model, cost)
    reference *= scale
    image.flags.writeable = reference.flags.writeable = False  # so that no view copies its part
    counts = observations.mask.sum(axis=1).astype(int).tolist()
    return tuple(ViewResiduals(image[k, :n], reference[k, :n]) for k, n in enumerate(counts))


def tabulate_stage_one(
    registration: StageOneRegistration, on_paper_grid: bool
) -> tuple[StageOne, ...]:
    """Tabulate Stage I (the paper's Table 1), with the roots of each view's cosines' equation.

    Args:
        registration: Stage I of the views.
        on_paper_grid: whether the reference grid is the paper's, equal in pixels along both axes.
    """
    backward = freeze_array(homography.invert_homography(registration.forward))
    geometry = single_view_pose.estimate_view_geometry(backward, on_paper_grid)
    columns = (
        *registration.centre.T.tolist(),
        registration.k1.tolist(),
        geometry.aspect.tolist(),
        geometry.fx.tolist(),
        geometry.fy.tolist(),
        registration.iterations.tolist(),
        registration.rms.tolist(),
        backward,
        registration.converged.tolist(),
    )
    return tuple(StageOne(*row) for row in zip(*columns, strict=True))
