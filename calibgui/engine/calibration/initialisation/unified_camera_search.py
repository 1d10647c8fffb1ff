"""A start of Stage II for any lens: a camera of the unified model, found by trials.

Stage I and the closed form correct a lens by one coefficient, which a lens of 120 degrees and more
does not allow. The unified model (``camera.models.ucm``) follows nearly every lens to a few pixels
with two numbers: the focal length f and alpha, which runs from the pinhole (0) over the
stereographic lens (0.5) to the orthographic one (1). Nothing needs to be known of either:

1. The principal point is the middle of the image. Each alpha of a few, with each angle of a few at
   which the outermost corner may be seen, gives f and with it the rays of all corners; the poses
   follow in closed form (``geometry.planar_pose``).
2. From the trials that reproject the corners best, Levenberg-Marquardt descends a few steps in a
   sample of the views, with f, centre and alpha free. The lowest cost is the start.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.calibration.initialisation.multistart import descend
from calibgui.engine.calibration.observations import Observations, select_spread_views
from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError
from calibgui.engine.calibration.refinement.residuals import State, predict_corners
from calibgui.engine.calibration.resection import estimate_poses
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models import find_model

_ALPHAS = (0.0, 0.3, 0.5, 0.6, 0.7, 0.85)
"""Values of alpha that are tried."""
_OUTERMOST_DEG = (15.0, 25.0, 35.0, 47.0, 60.0, 75.0, 90.0, 105.0)
"""Angles off the axis, degrees, at which the outermost corner is tried."""
_MAX_TRIAL_VIEWS, _MAX_TRIAL_CORNERS = 10, 40
"""Numbers of views, and of corners of each, that trials use."""
_DESCENTS = 3
"""Number of trials from which a descent is made."""
_MAX_ITERATIONS = 12
"""Number of steps of a descent."""


def search_unified_camera(observations: Observations, size: Size, known: Array) -> State:
    """Find a camera of the unified model, and the poses of all views under it.

    Args:
        observations: the views.
        size: width and height of the images, px.
        known: (4,) values of fx, fy, cx, cy that are held, px; NaN for those that are not.

    Raises:
        StartError: if no trial reprojects the corners.
    """
    free = np.flatnonzero(np.append(np.isnan(known), True))
    trials = _try_cameras(observations, size, known)
    found = descend(observations, trials, size, "ucm", free, _MAX_ITERATIONS)
    if found is None:
        raise StartError(
            "No lens that was tried images the corners where they are.",
            "Check that the views number their corners alike and come from one camera.",
        )
    return found


def _try_cameras(views: Observations, size: Size, known: Array) -> list[Array]:
    """Return the parameters (5,) of the trials that reproject the corners best, best first."""
    few = _select_spread_corners(select_spread_views(views, _MAX_TRIAL_VIEWS))
    middle = (np.array(size) - 1) / 2
    centre = np.where(np.isnan(known[2:]), middle, known[2:])
    outermost = float(np.linalg.norm(views.uv - centre, axis=-1).max())
    lens, tried = find_model("ucm"), []
    for alpha in _ALPHAS:
        for angle in np.deg2rad(_OUTERMOST_DEG):
            radius = _compute_unified_radius(alpha, float(angle))
            if not radius > 0:
                continue
            focal = np.where(np.isnan(known[:2]), outermost / radius, known[:2])
            params = np.concatenate([focal, centre, [alpha]])
            state = estimate_poses(Camera(size, params, "ucm"), few)
            tried.append((measure_miss(few, state, lens, size), params))
    tried.sort(key=lambda trial: trial[0])
    return [params for _, params in tried[:_DESCENTS]]


def _compute_unified_radius(alpha: float, angle: float) -> float:
    """Compute the radius, in focal lengths, at which a unified lens images an angle; NaN if not."""
    ray = np.array([np.sin(angle), 0.0, np.cos(angle)])
    return float(find_model("ucm").project(ray, np.array([alpha])).points[0])


def measure_miss(views: Observations, state: State, lens: Lens, size: Size) -> float:
    """Measure the root mean squared miss of the corners, px, each at most an image's width."""
    with np.errstate(all="ignore"):
        miss = predict_corners(state, views, lens, Cost.IMAGE) - views.uv
        square = np.fmin(np.sum(miss**2, axis=-1), float(size[0] ** 2))
    return float(np.sqrt(np.sum(views.mask * square) / views.count))


def _select_spread_corners(views: Observations) -> Observations:
    """Select some corners of each view, spread evenly over its list, unweighted."""
    counts = views.mask.sum(axis=1, keepdims=True)
    places = np.linspace(0.0, 1.0, min(_MAX_TRIAL_CORNERS, views.uv.shape[1])) * (counts - 1)
    chosen = np.round(places).astype(np.int64)
    k = np.arange(len(chosen))[:, None]
    return Observations(views.uv[k, chosen], views.xy[k, chosen], np.ones(chosen.shape))
