"""The calibration engine: arrays in, frozen records out; no window, plots or progress bars."""

from __future__ import annotations

from calibgui.engine.assessment.residual_statistics import Summary, summarise
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import Checkerboard
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.pattern import Ambiguity
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.refit import Refit, refit
from calibgui.engine.calibration.result import (
    Assumed,
    Calibration,
    Cost,
    Degeneracy,
    DegenerateError,
    Diagnosis,
    Iteration,
    StageOne,
    Status,
    Undetermined,
    ViewResiduals,
)
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import distort_points, project_points, undistort_points
from calibgui.engine.detection.corners import Corners
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import CalibrationError, Cancelled, NoBoardError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.reading import Image, read_image
from calibgui.engine.images.rendering import Appearance, render
from calibgui.engine.images.undistortion import (
    FieldOfView,
    Resampled,
    board_extent,
    rectify_image,
    undistort_image,
)

__all__ = [
    "Ambiguity",
    "Appearance",
    "Assumed",
    "Board",
    "BoardShape",
    "BoardShapeModel",
    "BoardShapePrior",
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
    "Pose",
    "Refit",
    "Resampled",
    "StageOne",
    "Status",
    "Summary",
    "Undetermined",
    "ViewResiduals",
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
