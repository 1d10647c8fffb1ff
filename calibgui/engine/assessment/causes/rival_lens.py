"""A lens model of another kind, fitted in place of the one that the residuals may speak against.

The score test of ``calibration/score_tests.py`` takes one step from where a calibration stands, and
knows a lens as a displacement over a coarse mesh. A wide lens that a polynomial in tan(theta) does
not follow is far from both: poses and board have moved to make up for it, and what is left bends
sharply at the image's edge. Of the residuals that such a lens left beside a free board the test
explained 41 % in one set of photographs, a motion in each view 60 %, and a fisheye's model 78 %.
Where it matters, the rival is fitted. Nearly all lenses follow a polynomial in theta or one in
tan(theta): one of the two suffices to see whether the other is at fault.

It does not tell which model is best: that is ``lens_choice.py``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.repetition import calibrate_by_model
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.models import find_model
from calibgui.engine.errors import CalibrationError

_BY_ANGLE, _BY_TANGENT = "kannala-brandt-decentering", "brown-conrady"
"""Lens models with a polynomial in theta, and in tan(theta)."""


class Rival(NamedTuple):
    """The views as a lens model of another kind follows them."""

    share: float
    """Share of the squared residuals that it explains, the board's shape being estimated if it was;
    0 if it fits worse."""
    displacement: float
    """Distance of its pixels from the calibration's where there are corners, px rms."""


def fit_rival(calibration: Calibration, views: Sequence[Observation]) -> Rival:
    """Fit a lens model of another kind.

    It explains nothing if it cannot be fitted, or if the model is a spline, which follows any lens.

    Args:
        calibration: a calibration with the image cost.
        views: the views that it was made from.
    """
    model = calibration.camera.model
    if find_model(model).control_points is not None:
        return Rival(0.0, 0.0)
    try:
        rival = calibrate_by_model(
            calibration, views, _BY_TANGENT if model == _BY_ANGLE else _BY_ANGLE
        )
        moved = compare_cameras(rival.camera, calibration.camera, views=views).rms
    except CalibrationError:
        return Rival(0.0, 0.0)
    left = summarise_residuals(rival.residuals).rms / summarise_residuals(calibration.residuals).rms
    return Rival(max(1 - left**2, 0.0), moved)
