"""Photographs that show two pictures side by side: those of a stereo camera, stored as one.

The board is then in one picture or the other, and no view has corners in both. Each picture has a
camera of its own, whose principal points lie half an image apart: too far for what a step of the
common camera tells (``mixed_views.py``), and what is left looks like motion. So both cameras are
calibrated. Views that just happen to keep to two sides of one picture have the same principal
point, near where the sides meet.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import recover_image_arguments
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.errors import CalibrationError

_MIN_VIEWS = 3
"""Number of views of each picture from which its camera is calibrated."""
_MIN_DISTANCE = 0.25
"""Distance of the principal points, over the image's side along which the pictures lie, from which
there are two pictures; half of what it is where both are alike and their cameras centred."""
_MIN_DISTANCE_IN_SIGMA = 5.0
"""Distance of the principal points over its standard deviation, from which there are two."""
_MAX_RMS_LEFT = 0.4
"""RMS residual that the two cameras leave, over that of the common one, up to which there are two
pictures. Of 150 rendered sets of boards at two sides of one picture, by a lens that the model did
not follow, it was 0.46 at least; of 58 sets of two pictures, with noise of up to 0.3 px, 0.34 at
most."""


class TwoPictures(NamedTuple):
    """Two pictures side by side."""

    axis: int
    """0 if they lie side by side, 1 if one lies above the other."""
    border: float
    """Column or row between them, in the middle between the corners of both, px."""
    is_second: BoolArray
    """(K,) true for the views of the picture to the right, or below."""
    rms: float
    """RMS residual that is left if each picture has a camera of its own, px."""


def find_two_pictures(calibration: Calibration, views: Sequence[Observation]) -> TwoPictures | None:
    """Find out whether the photographs show two pictures side by side; None if they do not."""
    low, high = (np.array([f(view.uv, axis=0) for view in views]) for f in (np.min, np.max))
    for axis in (0, 1):
        gap = _find_widest_gap(low[:, axis], high[:, axis])
        if gap is not None:
            found = _compare_cameras_of_sides(calibration, views, axis, gap)
            if found is not None:
                return found
    return None


def _find_widest_gap(low: Array, high: Array) -> float | None:
    """Find the middle of the widest gap between intervals (K,) that leaves enough at both sides."""
    order = np.argsort(low)
    reached = np.maximum.accumulate(high[order])[:-1]
    widths = low[order][1:] - reached
    widths[: _MIN_VIEWS - 1] = widths[len(widths) - _MIN_VIEWS + 1 :] = 0.0
    if not (widths > 0).any():
        return None
    k = int(np.argmax(widths))
    return float(reached[k] + widths[k] / 2)


def _compare_cameras_of_sides(
    calibration: Calibration, views: Sequence[Observation], axis: int, border: float
) -> TwoPictures | None:
    """Calibrate the views at each side; None if the cameras are not those of two pictures."""
    is_second = np.array([bool(view.uv[0, axis] > border) for view in views])
    settings, sides = recover_image_arguments(calibration), []
    for side in (~is_second, is_second):
        chosen = [view for view, is_its in zip(views, side, strict=True) if is_its]
        try:
            sides.append(calibrate(chosen, calibration.camera.size, **settings))
        except CalibrationError:
            return None
    first, second = (float(side.camera.centre[axis]) for side in sides)
    sigma = float(np.hypot(*(side.sigma[2 + axis] for side in sides)))
    least = max(_MIN_DISTANCE * calibration.camera.size[axis], _MIN_DISTANCE_IN_SIGMA * sigma)
    if not (first < border < second and second - first > least):
        return None
    remaining_rms = summarise_residuals([*sides[0].residuals, *sides[1].residuals]).rms
    if remaining_rms > _MAX_RMS_LEFT * summarise_residuals(calibration.residuals).rms:
        return None
    return TwoPictures(axis, border, is_second, remaining_rms)
