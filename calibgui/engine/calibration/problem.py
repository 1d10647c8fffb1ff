"""The arguments with which a calibration can be repeated on other views of the same camera.

What each view says of the camera, and how its pose answers to the camera's changes.

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
from typing import Any

import numpy as np

from calibgui.engine.arrays import IntArray
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.board_shape.estimate import on_board_shape
from calibgui.engine.calibration.observations import Observation, Observations, pack
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.whitening import weighted
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry import rotations
from calibgui.engine.geometry.pose import Pose


def settings_of(calibration: Calibration) -> dict[str, Any]:
    """Keyword arguments of ``calibrate``: cost, lens, held parameters with their values, plate,
    and what was known of it."""
    camera = calibration.camera
    values = dict(zip(camera.names, camera.params.tolist(), strict=True))
    held = {name: values[name] for name in calibration.fixed}
    board_shape: BoardShape | BoardShapeModel = BoardShapeModel.NOMINAL
    if calibration.board_shape is not None:
        held_board_shape = calibration.settings.get("plate_held", False)
        board_shape = calibration.board_shape if held_board_shape else calibration.board_shape.model
    prior = calibration.settings.get("prior_mm")
    return {
        "cost": calibration.cost,
        "model": camera.model,
        "fix": held,
        "free": [name for name in values if name not in held],
        "board_shape": board_shape,
        "prior": None if prior is None else BoardShapePrior(*prior),
    }


def as_drawn(views: Sequence[Observation]) -> BoardShape:
    """The nominal plate of views, to be held: many calibrations on it need not doubt it anew."""
    places = np.unique(np.round(np.concatenate([view.xy for view in views]), 9), axis=0)
    none = np.zeros((len(places), 3))
    return BoardShape(BoardShapeModel.NOMINAL, places, none, none)


def free_parameters(calibration: Calibration) -> IntArray:
    """Indices of the camera's parameters that were estimated."""
    names = calibration.camera.names
    return np.flatnonzero([name not in calibration.fixed for name in names])


def measured(calibration: Calibration, views: Sequence[Observation]) -> Observations:
    """Views as a calibration takes them: weighed, on the plate that it found or was given."""
    observations = pack(views)
    if calibration.cost is Cost.IMAGE:
        observations = weighted(observations, calibration.model_error**2)
    return (
        observations
        if calibration.board_shape is None
        else on_board_shape(observations, calibration.board_shape)
    )


def state_of(camera: Camera, poses: Sequence[Pose]) -> State:
    """Camera and poses as the solver takes them."""
    R = rotations.rotation(np.array([pose.rvec for pose in poses]))
    return State(camera.params, R, np.array([pose.tvec for pose in poses]))
