"""The views of a camera that is known: all of it is held, and only the boards' poses are found.

The outcome is a `Calibration` like any other, so that whatever shows one shows this: its camera is
the one that was given, with the covariance that was given (NaN where that is not known), each pose
is that of ``board_poses.locate_board``, and the residuals say how far the corners are from where
this camera images them. It does not judge the camera.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.board_poses import BoardPose, locate_board
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import state_problem
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import (
    DEFAULT_METHOD,
    Calibration,
    Cost,
    StageOneTable,
    Status,
)
from calibgui.engine.calibration.result_assembly import (
    compute_digest,
    compute_view_residuals,
    tabulate_stage_one,
)
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.threads import with_one_blas_thread


@with_one_blas_thread
def hold_camera(
    camera: Camera,
    views: Sequence[Observation],
    covariance: Array | None = None,
    names: Sequence[str] | None = None,
) -> Calibration:
    """Locate the board in all views of a known camera.

    Args:
        camera: the camera, which is held.
        views: the views, on the board as it is drawn.
        covariance: (P, P) covariance of the camera's parameters, which counts in that of the poses;
            None if it is not known.
        names: names of the views, for messages; numbers by default.

    Raises:
        CalibrationError: if a view cannot be used, or no pose explains it.
    """
    names = [f"View {k + 1}" for k in range(len(views))] if names is None else names
    fix = dict(zip(camera.names, camera.params.tolist(), strict=True))
    problem = state_problem(
        views,
        camera.size,
        cost=Cost.IMAGE,
        fix=fix,
        free=(),
        model=camera.model,
        board_shape=BoardShapeModel.NOMINAL,
        prior=None,
        max_iterations=0,
        names=names,
        method=DEFAULT_METHOD,
        model_errors=False,
    )
    found = [
        locate_board(camera, view, covariance, name)
        for view, name in zip(views, names, strict=True)
    ]
    unknown = np.full((len(camera.params),) * 2, np.nan)
    stated = unknown if covariance is None else covariance
    return Calibration(
        camera=camera,
        sigma=np.sqrt(np.diag(stated)),
        covariance=stated,
        noise_covariance=stated,
        poses=tuple(each.pose for each in found),
        pose_covariances=np.array([each.covariance for each in found]),
        residuals=compute_view_residuals(
            _collect(camera, found), problem.observations, camera.model, Cost.IMAGE, problem.scale
        ),
        noise=math.sqrt(float(np.mean([each.noise**2 for each in found]))),
        model_error=0.0,
        reference_scale=problem.scale,
        stage_one=StageOneTable(partial(tabulate_stage_one, problem.stage_one, Cost.IMAGE)),
        history=(),
        status=Status.CONVERGED,
        cost=Cost.IMAGE,
        fixed=camera.names,
        settings=problem.settings,
        digest=compute_digest(problem),
    )


def _collect(camera: Camera, found: Sequence[BoardPose]) -> State:
    """Collect camera and poses."""
    R = np.array([rotation_from_vector(each.pose.rvec) for each in found])
    return State(camera.params, R, np.array([each.pose.tvec for each in found]))
