"""Descents of Stage II from several cameras, of which the lowest is the start.

Only a sample of the views takes part, and few steps are taken: a start need not be the minimum,
but it must lie in its basin.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from calibgui.engine.arrays import Array, IntArray, Size
from calibgui.engine.calibration.observations import Observations, select_spread_views
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
_MAX_HELD_ITERATIONS, _MAX_ITERATIONS = 8, 100
"""Number of steps with one parameter held, and of all parameters after it."""


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
    starts = [estimate_poses(Camera(size, params, model), sample) for params in cameras]
    ends = [_descend_from(start, sample, model, free, max_iterations) for start in starts]
    return _take_lowest(ends, observations, size, model)


def descend_along(
    observations: Observations,
    cameras: Iterable[Array],
    size: Size,
    model: str,
    free: IntArray,
    shape: int,
) -> State | None:
    """Descend to the lowest of several minima that lie along one parameter.

    With that parameter held, the others have one minimum, which few steps reach. Where this is
    lower than at the neighbouring values, minima of all lie near, on one side or on both, and
    descents of all parameters begin there and at both neighbours.

    Args:
        observations: the views.
        cameras: parameters (P,) for ascending values of that one.
        size: width and height of the images, px.
        model: the lens model, a key of ``camera.models.MODELS``.
        free: indices of the parameters that may change.
        shape: index of the parameter.

    Returns:
        Camera and poses; None if no camera images all corners.
    """
    sample = select_spread_views(observations, _MAX_VIEWS)
    starts = [estimate_poses(Camera(size, params, model), sample) for params in cameras]
    others = free[free != shape]
    held = [_descend_from(start, sample, model, others, _MAX_HELD_ITERATIONS) for start in starts]
    costs = np.array([end.normal.cost if end else np.inf for end in held])
    beside = np.pad(costs, 1, constant_values=np.inf)
    is_low = (costs <= beside[:-2]) & (costs <= beside[2:])
    near = np.convolve(is_low, np.ones(3), "same") > 0
    begins = [end.state for end, is_near in zip(held, near, strict=True) if end and is_near]
    ends = [_descend_from(begin, sample, model, free, _MAX_ITERATIONS) for begin in begins]
    return _take_lowest(ends, observations, size, model)


def _descend_from(
    start: State, views: Observations, model: str, free: IntArray, max_iterations: int
) -> Solution | None:
    """Take some steps of Stage II from a start; None if it does not image all corners."""
    problem = build_stage_two(views, model, Cost.IMAGE, 1.0, free)
    data = float(np.sum(views.uv**2))
    try:
        return minimise(problem, start, free, views.count, data, max_iterations=max_iterations)
    except StartError:
        return None


def _take_lowest(
    ends: Iterable[Solution | None], observations: Observations, size: Size, model: str
) -> State | None:
    """Return the camera of the lowest end, with the poses of all views; None if there is no end."""
    found = [end for end in ends if end is not None]
    if not found:
        return None
    state = min(found, key=lambda end: end.normal.cost).state
    if len(state.R) == len(observations.uv):
        return state
    return estimate_poses(Camera(size, state.params, model), observations)
