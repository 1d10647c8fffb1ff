"""The calibration engine: arrays in, frozen records out; no window, plots or progress bars."""

from __future__ import annotations

from calibgui.engine.calibrate import calibrate
from calibgui.engine.corners import find_corners
from calibgui.engine.errors import CalibrationError, Cancelled, DegenerateError, NoBoardError
from calibgui.engine.images import Image, read_image
from calibgui.engine.imaging.maps import distort_points, project_points, undistort_points
from calibgui.engine.imaging.render import Appearance, render
from calibgui.engine.imaging.undistort import (
    FieldOfView,
    Resampled,
    board_extent,
    rectify_image,
    undistort_image,
)
from calibgui.engine.quality.statistics import Summary, summarise
from calibgui.engine.refit import Refit, refit
from calibgui.engine.targets.charuco import Charuco
from calibgui.engine.targets.circles import Circles
from calibgui.engine.targets.pattern import Checkerboard
from calibgui.engine.types import (
    Ambiguity,
    Assumed,
    Calibration,
    Camera,
    Corners,
    Cost,
    Degeneracy,
    Diagnosis,
    Iteration,
    Observation,
    Plate,
    PlateModel,
    Pose,
    Prior,
    StageOne,
    Status,
    Target,
    Undetermined,
    View,
    ViewResiduals,
    ViewStatus,
)

__all__ = [
    "Ambiguity",
    "Appearance",
    "Assumed",
    "Calibration",
    "CalibrationError",
    "Camera",
    "Cancelled",
    "Charuco",
    "Checkerboard",
    "Circles",
    "Corners",
    "Cost",
    "Degeneracy",
    "DegenerateError",
    "Diagnosis",
    "FieldOfView",
    "Image",
    "Iteration",
    "NoBoardError",
    "Observation",
    "Plate",
    "PlateModel",
    "Pose",
    "Prior",
    "Refit",
    "Resampled",
    "StageOne",
    "Status",
    "Summary",
    "Target",
    "Undetermined",
    "View",
    "ViewResiduals",
    "ViewStatus",
    "board_extent",
    "calibrate",
    "distort_points",
    "find_corners",
    "project_points",
    "read_image",
    "rectify_image",
    "refit",
    "render",
    "summarise",
    "undistort_image",
    "undistort_points",
]
