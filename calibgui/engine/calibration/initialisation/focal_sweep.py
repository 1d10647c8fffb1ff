"""A start of Stage II where the closed form has no focal length: trials, each with a short descent.

Few views, noise or a poor principal point can make the orthogonality of all views' axes
(``closed_form.py``) ask for an imaginary focal length. A few steps of Stage II on the reference
plane, whose cost has a value everywhere, are then taken from each of a sweep of focal lengths
fx = fy; focal lengths, principal point and k1 are those of the lowest cost.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.calibration.initialisation import closed_form
from calibgui.engine.calibration.observations import Observations, select_spread_views
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution, minimise
from calibgui.engine.calibration.refinement.residuals import State, build_stage_two
from calibgui.engine.calibration.result import Cost
from calibgui.engine.geometry.planar_pose import poses_from_homographies

_FOCAL_LENGTHS = np.geomspace(0.3, 6.0, 14)
"""Focal lengths that are tried, in image widths."""
_MAX_ITERATIONS = 6
"""Number of steps of Stage II from each focal length."""
_MAX_VIEWS = 25
"""Number of views, spread evenly over all, that the trials use."""


def sweep_focal_lengths(
    observations: Observations, centre: Array, k1: float, size: Size, known: Array
) -> tuple[Array, Array, float]:
    """Find focal lengths (2,) px, principal point (2,) px in the array frame and k1, px^-2.

    Args:
        observations: the views.
        centre: (2,) principal point to start from.
        k1: first coefficient of the correction to start from.
        size: width and height of the images, px.
        known: (4,) values of fx, fy, cx, cy that are held, px; NaN for those that are not.
    """
    sample = select_spread_views(observations, _MAX_VIEWS)
    free = np.flatnonzero(np.append(np.isnan(known), True))
    normal_at = build_stage_two(sample, "lucchese", Cost.REFERENCE, 1.0, free)
    M = closed_form.fit_homographies(sample, centre, k1)

    def descend_from(focal: float) -> Solution:
        f = np.where(np.isnan(known[:2]), focal * size[0], known[:2])
        params = np.concatenate([f, centre, [k1 * f[0] ** 2], np.zeros(5)])
        start = State(params, *poses_from_homographies(M, f, sample.xy[:, 0]))
        data = float(np.sum(sample.xy**2))
        return minimise(normal_at, start, free, sample.count, data, max_iterations=_MAX_ITERATIONS)

    best = min(
        map(descend_from, _FOCAL_LENGTHS.tolist()), key=lambda solution: solution.normal.cost
    )
    params = best.state.params
    return params[:2], params[2:4], float(params[4] / params[0] ** 2)
