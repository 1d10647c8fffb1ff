"""The problem that a calibration solved, stated again.

A `Calibration` holds results only: parameters, poses, residuals. Whoever analyses one (how far each
view determines the camera, what a further view would add, what leaving one out changes) needs the
problem as the solver saw it: the arguments of `calibrate`, the views with their weights and on the
board that was found, and the state at the minimum. These are recovered here from the result and its
views, so that a result read from a file can be analysed like a fresh one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from calibgui.engine.arrays import IntArray
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.board_shape.parametrisation import place_on_board_shape
from calibgui.engine.calibration.methods import DEFAULT_METHOD
from calibgui.engine.calibration.observations import Observation, Observations, pack_observations
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.refinement.whitening import whiten_observations
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry import rotations
from calibgui.engine.geometry.pose import Pose


def recover_arguments(calibration: Calibration) -> dict[str, Any]:
    """Recover the keyword arguments of `calibrate` that repeat a calibration on other views.

    They are the cost, the lens model, the held parameters with their values, the board shape, what
    was known of it beforehand, and the method.
    """
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
        "method": calibration.settings.get("method", DEFAULT_METHOD),
    }


def recover_image_arguments(calibration: Calibration) -> dict[str, Any]:
    """Recover the arguments as `recover_arguments`, but for the image cost and the default method.

    The lens model of `Cost.PAPER` takes no other cost: the default one is estimated instead.
    """
    settings = recover_arguments(calibration)
    if calibration.cost is Cost.PAPER:
        del settings["model"], settings["free"]
    return settings | {"cost": Cost.IMAGE, "method": DEFAULT_METHOD}


def find_free_parameters(calibration: Calibration) -> IntArray:
    """Return the indices of the camera's parameters that were estimated, ascending."""
    names = calibration.camera.names
    return np.flatnonzero([name not in calibration.fixed for name in names])


def prepare_observations(calibration: Calibration, views: Sequence[Observation]) -> Observations:
    """Prepare views as a calibration takes them: whitened, on the board shape found or held."""
    return weigh_and_place(calibration, pack_observations(views))


def weigh_and_place(calibration: Calibration, observations: Observations) -> Observations:
    """Whiten observations as a calibration does, and place them on the board that it has."""
    if calibration.cost is Cost.IMAGE:
        observations = whiten_observations(observations, calibration.model_error**2)
    return (
        observations
        if calibration.board_shape is None
        else place_on_board_shape(observations, calibration.board_shape)
    )


def make_state(camera: Camera, poses: Sequence[Pose]) -> State:
    """Pack camera and poses as the solver takes them."""
    R = rotations.rotation_from_vector(np.array([pose.rvec for pose in poses]))
    return State(camera.params, R, np.array([pose.tvec for pose in poses]))
