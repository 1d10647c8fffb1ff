"""The control points of a splined lens: chosen to cover the corners, and checked that they do.

A splined lens (``camera.models.splined_stereographic``) knows nothing beyond its control points.
Where its user names no angle, these cover the largest one at which a start of the unified model
(``unified_camera_search.py``) sees a corner, and a little more.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.calibration.initialisation.unified_camera_search import search_unified_camera
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.residuals import State, place_points
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models.splined_stereographic import PREFIX
from calibgui.engine.errors import CalibrationError

_COLUMNS, _ROWS = 16, 11
"""Numbers of control points of a splined lens whose user names none."""
_MARGIN = 1.05
"""Extent of the control points over that of the corners, in the stereographic image."""
_MAX_ANGLE_DEG = 340
"""Largest angle that the control points are spread over, degrees."""


def choose_control_points(observations: Observations, size: Size) -> str:
    """Choose the splined lens model whose control points cover the corners; return its id."""
    unknown = np.full(4, np.nan)
    reach = _measure_reach(search_unified_camera(observations, size, unknown), observations)
    aspect = (_COLUMNS - 3) / (_ROWS - 3)  # control points are equally far apart along both axes
    half = _MARGIN * max(reach[0], aspect * reach[1])
    angle = min(int(np.ceil(np.rad2deg(4 * np.arctan(half / 2)))), _MAX_ANGLE_DEG)
    return f"{PREFIX}-{_COLUMNS}x{_ROWS}-{angle}"


def check_control_points(start: State, observations: Observations, lens: Lens) -> None:
    """Refuse a lens model that ends before the corners do, as the start sees them.

    Raises:
        CalibrationError: with the part of the control points' extent that the corners take.
    """
    if lens.edge is None:
        return
    share = float((_measure_reach(start, observations) / lens.edge).max())
    if share > 1:
        raise CalibrationError(
            f"Corners lie up to {share:.2f} times as far from the axis as the control points of "
            "this splined lens model.",
            "Name a larger angle, the last number of its name, or 'splined-stereographic' alone.",
        )


def _measure_reach(state: State, observations: Observations) -> Array:
    """Measure how far (2,) corners are off the axis, along x and y of the stereographic image."""
    _, point = place_points(state, observations.xy)
    length = np.linalg.norm(point, axis=-1, keepdims=True)
    u = 2 * point[..., :2] / (length + point[..., 2:])
    return np.asarray(np.abs(u[observations.mask > 0]).max(axis=0))
