"""Poses of views under a known camera and plate: what is left of Stage II when both are held.

The start is closed: rays n of the corners are the image of an ideal camera with f = 1 and the
centre at 0, whose homography from the plate is [r1 r2 T]. Levenberg-Marquardt then minimises
the same cost as the calibration's Stage II, which the camera is judged by.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calibgui.engine.calibration.initialisation import closed_form
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import minimise
from calibgui.engine.calibration.refinement.normal_equations import stage_two
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import rays


def solved(
    start: State, observations: Observations, model: str, cost: Cost, scale: float = 1.0
) -> State:
    """The poses that cost least from `start` on, its camera held; see ``problem.stage_two``.

    Raises:
        CalibrationError: if the start does not reproject the corners.
    """
    none_free = np.zeros(0, dtype=np.int64)
    return minimise(
        stage_two(observations, model, cost, scale, none_free),
        start,
        none_free,
        observations.count,
        float(np.sum(observations.uv**2)),
    ).state


def posed(camera: Camera, observations: Observations) -> State:
    """Poses in closed form of views of a flat plate under a known camera."""
    ideal = replace(observations, uv=rays(observations.uv, camera))
    M = closed_form.homographies(ideal, np.zeros(2), 0.0)
    return State(camera.params, *closed_form.poses(M, np.ones(2), ideal))
