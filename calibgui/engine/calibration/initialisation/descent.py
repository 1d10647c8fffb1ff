"""Descents of Stage II from several cameras, of which the lowest is the start.

Only a sample of the views takes part, and few steps are taken: a start need not be the minimum,
but it must lie in its basin.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from calibgui.engine.arrays import Array, IntArray, Size
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import (
    Solution,
    StartError,
    minimise,
)
from calibgui.engine.calibration.refinement.residuals import State, build_stage_two
from calibgui.engine.calibration.resection import estimate_poses
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.camera import Camera

_MAX_VIEWS = 25
"""Number of views, spread evenly over all, that descents use."""


def descend(
    observations: Observations,
    cameras: Iterable[Array],
    size: Size,
    model: str,
    free: IntArray,
    max_iterations: int,
) -> State | None:
    """Descend from each of some cameras, and return the lowest end with the poses of all views.

    Args:
        observations: the views.
        cameras: the parameters (P,) of each.
        size: width and height of the images, px.
        model: the lens model, a key of ``camera.models.MODELS``.
        free: indices of the parameters that may change.
        max_iterations: number of steps of each descent.

    Returns:
        None if no camera images all corners.
    """
    sample = select_spread_views(observations, _MAX_VIEWS)
    problem = build_stage_two(sample, model, Cost.IMAGE, 1.0, free)
    data = float(np.sum(sample.uv**2))
    best: Solution | None = None
    for params in cameras:
        start = estimate_poses(Camera(size, params, model), sample)
        try:
            found = minimise(
                problem, start, free, sample.count, data, max_iterations=max_iterations
            )
        except StartError:
            continue
        if best is None or found.normal.cost < best.normal.cost:
            best = found
    if best is None:
        return None
    if len(sample.uv) == len(observations.uv):
        return best.state
    return estimate_poses(Camera(size, best.state.params, model), observations)


def select_spread_views(views: Observations, count: int) -> Observations:
    """Select up to `count` views, spread evenly over all."""
    return views.select_views(np.unique(np.linspace(0, len(views.uv) - 1, count).astype(np.int64)))
