"""The calibration engine: arrays in, frozen records out; no window, plots or progress bars.

This is the short face: photographs are read (`read_image`), corners found (`find_corners`), the
camera calibrated (`calibrate`) and its images undistorted (`undistort_image`, `rectify_image`).
Everything else is on the faces of the rooms: ``calibgui.engine.camera``, ``.boards``, ``.images``,
``.detection``, ``.calibration``, ``.redetection``, ``.uncertainty`` and ``.assessment``. Angles are
radians, lengths millimetres, image points pixels (0-based, integer at the pixel's centre, v down).

Five views of a board are rendered here in place of photographs.

    >>> from calibgui.engine import Board, Camera, Observation, Pose
    >>> from calibgui.engine import calibrate, find_corners, render_view
    >>> board = Board(rows=6, cols=7, square=30.0)
    >>> camera = Camera((640, 480), [650, 650, 320, 240, 0.2, 0, 0, 0, 0, 0])
    >>> tilts = [(0.5, 0, 0), (-0.5, 0, 0), (0, 0.5, 0), (0, -0.5, 0), (0.3, 0.4, 0)]
    >>> views = []
    >>> for tilt in tilts:
    ...     image = render_view(camera, Pose(tilt, (-90, -75, 500)), board, noise=1.0, seed=1)
    ...     corners = find_corners(image, (board.rows, board.cols))
    ...     views.append(Observation(corners.uv, board.points(corners.grid), corners.cov))
    >>> calibration = calibrate(views, camera.size)
    >>> bool(abs(calibration.camera.params[0] - 650) < 3)  # the focal length, px
    True
"""

from __future__ import annotations

from calibgui.engine.assessment.residual_statistics import ResidualSummary, summarise_residuals
from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import Checkerboard
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.refit import Refit, refit
from calibgui.engine.calibration.result import (
    Assumption,
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
from calibgui.engine.images.rectification import compute_board_extent, rectify_image
from calibgui.engine.images.rendering import Appearance, render_view
from calibgui.engine.images.resampling import ResampledImage
from calibgui.engine.images.undistortion import FieldOfView, undistort_image

__all__ = [
    "Appearance",
    "AprilGrid",
    "Assumption",
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
    "PuzzleBoard",
    "Refit",
    "ResampledImage",
    "ResidualSummary",
    "StageOne",
    "Status",
    "Symmetry",
    "TaggedCheckerboard",
    "Undetermined",
    "ViewResiduals",
    "calibrate",
    "compute_board_extent",
    "distort_points",
    "find_corners",
    "project_points",
    "read_image",
    "rectify_image",
    "refit",
    "render_view",
    "summarise_residuals",
    "undistort_image",
    "undistort_points",
]
