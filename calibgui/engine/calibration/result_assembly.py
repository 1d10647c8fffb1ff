"""The last step of a calibration: a solution becomes the `Calibration` that is handed over.

The solver works with free parameters, rotation matrices and padded arrays. A `Calibration` lists
all parameters, those that were held included, one pose and one array of residuals a view, and the
paper's Table 1.
"""

from __future__ import annotations

import hashlib
from dataclasses import replace
from functools import partial

import numpy as np

from calibgui.engine.arrays import Array, freeze_array
from calibgui.engine.calibration.board_shape.held import describe_held_shape
from calibgui.engine.calibration.initialisation import single_view_pose
from calibgui.engine.calibration.methods.method import Problem, RegisteredViews
from calibgui.engine.calibration.observations import Observations, digest_views
from calibgui.engine.calibration.refinement import covariances, residuals
from calibgui.engine.calibration.refinement.covariances import Estimate
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import (
    Calibration,
    Cost,
    StageOne,
    StageOneTable,
    ViewResiduals,
)
from calibgui.engine.calibration.starting_point import StartingPoint
from calibgui.engine.geometry import homography, rotations
from calibgui.engine.geometry.pose import Pose


def assemble_calibration(
    point: StartingPoint, estimate: Estimate, seconds: float = np.nan
) -> Calibration:
    """Assemble the calibration that is handed over: all parameters, held ones included.

    Args:
        point: the problem, with what its method has to say about the views.
        estimate: the solution with its covariances. The standard deviations of its undetermined
            parameters are not to be believed; they become NaN.
        seconds: time that the method has taken; NaN if it is not known.
    """
    problem, names = point.problem, point.problem.parameters
    free, cost = problem.free, problem.cost
    lost = [names.index(u.name) for u in estimate.undetermined]

    def with_held_parameters(covariance: Array) -> tuple[Array, Array]:
        """Return the covariance (P, P) of all parameters, and their standard deviations (P,)."""
        whole = np.zeros((len(names), len(names)))
        whole[np.ix_(free, free)] = covariance
        sigma = np.sqrt(np.diag(whole))
        sigma[lost] = np.nan
        return whole, sigma

    state, observations = estimate.state, estimate.observations
    covariance, sigma = with_held_parameters(estimate.camera_covariance)
    rvecs = rotations.vector_from_rotation(state.R)
    remarks, shape = point.remarks, problem.held_shape
    if shape is not None:
        remarks = (*remarks, *describe_held_shape(shape, digest_views(problem.observations)))
    elif estimate.board_shape is not None:
        shape = replace(estimate.board_shape, views=digest_views(problem.observations))
    return Calibration(
        camera=problem.make_camera(state),
        sigma=sigma,
        covariance=covariance,
        noise_covariance=with_held_parameters(estimate.noise_covariance)[0],
        poses=make_poses(rvecs, state.T),
        pose_covariances=covariances.convert_pose_covariances(estimate.pose_covariances, rvecs),
        residuals=compute_view_residuals(state, observations, problem.model, cost, problem.scale),
        noise=float(np.sqrt(estimate.sigma2)),
        model_error=float(np.sqrt(observations.tau2)),
        reference_scale=problem.scale,
        stage_one=StageOneTable(partial(tabulate_stage_one, point.stated.stage_one, cost)),
        history=estimate.solution.history,
        status=estimate.solution.status,
        cost=cost,
        fixed=tuple(name for name in names if name in problem.held),
        undetermined=estimate.undetermined,
        board_shape=shape,
        board_shape_error=estimate.board_shape_error,
        lens_error=estimate.lens_error,
        overdispersion=estimate.overdispersion,
        settings=problem.settings,
        digest=compute_digest(problem),
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


def tabulate_stage_one(views: RegisteredViews, cost: Cost) -> tuple[StageOne, ...]:
    """Tabulate Stage I (the paper's Table 1), with the roots of each view's cosines' equation."""
    registration = views.of_all
    backward = freeze_array(homography.invert_homography(registration.forward))
    geometry = single_view_pose.estimate_view_geometry(backward, cost is Cost.PAPER)
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


def compute_digest(problem: Problem) -> str:
    """Return the SHA-256 of the views and settings of a calibration."""
    digest = hashlib.sha256(repr(sorted(problem.settings.encode().items())).encode())
    views = problem.prepared
    for array in (views.uv, views.xy, views.mask, views.cov):
        if array is not None:
            digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()
