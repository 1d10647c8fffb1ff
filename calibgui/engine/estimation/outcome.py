"""From a solution to what is reported: covariances, poses, residuals, the Stage I table."""

from __future__ import annotations

from typing import NamedTuple

from calibgui.engine import frames
from calibgui.engine.estimation import cosines, homography, problem, uncertainty
from calibgui.engine.estimation.levenberg_marquardt import Solution
from calibgui.engine.estimation.observations import Observations
from calibgui.engine.estimation.stage_one import Prealignment
from calibgui.engine.estimation.stage_two import State
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
    by_noise: Array
    """(P, P) covariance of the camera's free parameters from the corners' noise alone."""
    plate: Plate | None = None
    plate_unknowns: int = 0
    """Of an estimated plate, without its gauge."""
    following: problem.Following | None = None
    """How an estimated plate moves with the camera."""
    plate_doubt: float = 0.0
    """As ``Calibration.plate_doubt``."""
    view_scatter: float = 0.0
    """As ``Calibration.view_scatter``."""


def estimated(
    solution: Solution, observations: Observations, precision: uncertainty.Precision
) -> Estimate:
    """The estimate of a solution without a plate of its own."""
    rvecs = frames.rotation_vector(solution.state.R)
    sigma2, camera, _ = precision
    spread = uncertainty.pose_covariances(solution.normal, camera, rvecs, sigma2)
    return Estimate(solution, solution.state, observations, sigma2, camera, spread, camera)


def poses(state: State) -> tuple[Pose, ...]:
    """The views' poses."""
    rvecs = frames.rotation_vector(state.R)
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
    image, registered = problem.residuals(state, observations, model, cost)
    counts = observations.mask.sum(axis=1).astype(int).tolist()
    return tuple(
        ViewResiduals(image[k, :n], scale * registered[k, :n]) for k, n in enumerate(counts)
    )


def stage_one_table(first: Prealignment, literal: bool) -> tuple[StageOne, ...]:
    """Table 1, with what the cosines' equation says of each view.

    `literal`: on the paper's grid, equal in pixels along both axes.
    """
    backward = homography.inverted(first.forward)
    geometry = cosines.view_geometry(backward, literal)
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
