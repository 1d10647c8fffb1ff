"""The calibration engine: numpy, scipy and OpenCV only; arrays in, frozen records out."""

from __future__ import annotations

from calibgui.engine.calibrate import calibrate
from calibgui.engine.errors import CalibrationError, Cancelled, DegenerateError, NoBoardError
from calibgui.engine.refit import Refit, refit
from calibgui.engine.statistics import Summary, summarise
from calibgui.engine.types import (
    Ambiguity,
    Calibration,
    Camera,
    Corners,
    Cost,
    Iteration,
    Observation,
    Pose,
    Status,
    Target,
    View,
    ViewStatus,
)

__all__ = [
    "Ambiguity",
    "Calibration",
    "CalibrationError",
    "Camera",
    "Cancelled",
    "Corners",
    "Cost",
    "DegenerateError",
    "Iteration",
    "NoBoardError",
    "Observation",
    "Pose",
    "Refit",
    "Status",
    "Summary",
    "Target",
    "View",
    "ViewStatus",
    "calibrate",
    "refit",
    "summarise",
]
