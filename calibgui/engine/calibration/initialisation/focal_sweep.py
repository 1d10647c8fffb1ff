"""A start of Stage II where the closed form has no focal length: trial and a little descent.

Few views, noise or a poor principal point can make the orthogonality of all views' axes
(``closed_form.py``) ask for an imaginary focal length. A few steps of Stage II on the reference
plane, whose cost has a value everywhere, are then taken from each rung of a ladder of focal
lengths fx = fy; where they come lowest, focal lengths, principal point and k1 are read off.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.calibration.initialisation import closed_form
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution, minimise
from calibgui.engine.calibration.refinement.normal_equations import stage_two
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Cost

_RUNGS = np.geomspace(0.3, 6.0, 14)
"""Focal lengths to try, in image widths."""
_STEPS = 6
_VIEWS = 25
"""Views that are enough to tell."""


def climbed(
    observations: Observations, centre: Array, k1: float, size: Size, known: Array
) -> tuple[Array, Array, float]:
    """Focal lengths (2,) px, principal point (2,) px in the array frame and k1, px^-2.

    Args:
        observations: the views.
        centre: (2,) principal point to start from.
        k1: first coefficient of the correction to start from.
        size: of the images, px.
        known: (4,) fx, fy, cx, cy that are held, px; NaN where they are not.
    """
    chosen = np.unique(np.linspace(0, len(observations.uv) - 1, _VIEWS).astype(np.int64))
    some = observations.part(chosen)
    free = np.flatnonzero(np.append(np.isnan(known), True))
    normal_at = stage_two(some, "lucchese", Cost.REFERENCE, 1.0, free)
    M = closed_form.homographies(some, centre, k1)

    def descended(rung: float) -> Solution:
        f = np.where(np.isnan(known[:2]), rung * size[0], known[:2])
        params = np.concatenate([f, centre, [k1 * f[0] ** 2], np.zeros(5)])
        start = State(params, *closed_form.poses(M, f, some))
        data = float(np.sum(some.xy**2))
        return minimise(normal_at, start, free, some.count, data, max_iterations=_STEPS)

    best = min(map(descended, _RUNGS.tolist()), key=lambda solution: solution.normal.cost)
    params = best.state.params
    return params[:2], params[2:4], float(params[4] / params[0] ** 2)
