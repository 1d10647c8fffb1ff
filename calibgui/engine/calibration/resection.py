"""Resection: the poses of views under a known camera, which is Stage II with the camera held.

The start is in closed form, from the rays of the corners (``geometry.planar_pose``).
Levenberg-Marquardt then minimises the same cost as the calibration's Stage II, so that residuals
of new views compare with its own.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import minimise
from calibgui.engine.calibration.refinement.residuals import State, build_stage_two
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import rays_from_pixels
from calibgui.engine.geometry.planar_pose import poses_from_rays


def refine_poses(
    start: State, observations: Observations, model: str, cost: Cost, scale: float = 1.0
) -> State:
    """Refine the poses of a start to the least cost, its camera held.

    Args:
        start: camera and poses to start from.
        observations: the views.
        model: the lens model, a key of ``camera.models.MODELS``.
        cost: the cost to minimise.
        scale: reference px per mm, for the costs on the reference plane.

    Raises:
        CalibrationError: if the start does not reproject the corners.
    """
    none_free = np.zeros(0, dtype=np.int64)
    return minimise(
        build_stage_two(observations, model, cost, scale, none_free),
        start,
        none_free,
        observations.count,
        float(np.sum(observations.uv**2)),
    ).state


def estimate_poses(camera: Camera, observations: Observations) -> State:
    """Estimate the poses of views of a flat board under a known camera, in closed form."""
    rays = rays_from_pixels(observations.uv, camera)
    return State(camera.params, *poses_from_rays(rays, observations.xy[..., :2], observations.mask))
