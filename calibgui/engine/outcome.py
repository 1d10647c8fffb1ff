"""From a solution to what is reported: covariances, poses, residuals, the Stage I table."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine import cosines, frames, homography, uncertainty
from calibgui.engine.lens import Lens
from calibgui.engine.levenberg_marquardt import Solution
from calibgui.engine.observations import Observations
from calibgui.engine.stage_one import Prealignment
from calibgui.engine.stage_two import State, image_residual, predicted_corners, reference_residual
from calibgui.engine.types import Array, Cost, Plate, Pose, StageOne, ViewResiduals


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
    plate: Plate | None = None
    plate_doubt: float = 0.0
    """As ``Calibration.plate_doubt``."""


def estimated(
    solution: Solution, observations: Observations, precision: uncertainty.Precision
) -> Estimate:
    """The estimate of a solution without a plate of its own."""
    rvecs = np.array([pose.rvec for pose in poses(solution.state)])
    sigma2, camera, _ = precision
    spread = uncertainty.pose_covariances(solution.normal, camera, rvecs, sigma2)
    return Estimate(solution, solution.state, observations, sigma2, camera, spread)


def poses(state: State) -> tuple[Pose, ...]:
    """The views' poses."""
    return tuple(Pose(frames.rotation_vector(R), T) for R, T in zip(state.R, state.T, strict=True))


def residuals(
    state: State, observations: Observations, lens: Lens, cost: Cost, scale: float
) -> tuple[ViewResiduals, ...]:
    """Residuals of every view in the image and on the reference plane.

    A plate that is not flat has no reference plane to register on; its residuals in the image
    are carried over by the derivative of the map between the two.
    """
    if observations.xy.shape[-1] == 3:
        linear = image_residual(state, observations, lens)
        image = -linear.residual
        by_plate = linear.by_pose[..., 3:] @ state.R[:, None, :, :2]
        registered = np.asarray(scale * np.linalg.solve(by_plate, image[..., None])[..., 0])
    else:
        image = observations.uv - predicted_corners(state, observations, lens, cost)
        literal = cost is Cost.PAPER
        registered = reference_residual(state, observations, lens, scale, literal).residual
    return tuple(
        ViewResiduals(image[k, observations.view(k)], registered[k, observations.view(k)])
        for k in range(len(image))
    )


def stage_one_table(first: Prealignment, literal: bool) -> tuple[StageOne, ...]:
    """Table 1, with what the cosines' equation says of each view.

    `literal`: on the paper's grid, equal in pixels along both axes.
    """
    rows = []
    for k, backward in enumerate(homography.inverted(first.forward)):
        view = cosines.view_geometry(backward, literal)
        rows.append(
            StageOne(
                xp=float(first.centre[k, 0]),
                yp=float(first.centre[k, 1]),
                k1=float(first.k1[k]),
                aspect=view.aspect,
                fx=view.fx,
                fy=view.fy,
                iterations=int(first.iterations[k]),
                rms=float(first.rms[k]),
                backward=backward,
                converged=bool(first.converged[k]),
            )
        )
    return tuple(rows)
