"""The calibration engine: arrays in, frozen records out; no window, plots or progress bars.

This is the short face: photographs are read (`read_image`), corners found (`find_corners`), the
camera calibrated (`calibrate`), boards located with it (`locate_board`) and its images undistorted
(`undistort_image`, `rectify_image`). Everything else is on the faces of the rooms:
``calibgui.engine.camera``, ``.boards``, ``.images``, ``.features``, ``.lattices``, ``.detection``,
``.calibration``, ``.redetection``, ``.uncertainty``, ``.hand_eye`` and ``.assessment``. Angles are
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

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.assessment.residuals.residual_statistics import (
        ResidualSummary as ResidualSummary,
        summarise_residuals as summarise_residuals,
    )
    from calibgui.engine.boards.april_grid import AprilGrid as AprilGrid
    from calibgui.engine.boards.board import Board as Board
    from calibgui.engine.boards.charuco import Charuco as Charuco
    from calibgui.engine.boards.checkerboard import Checkerboard as Checkerboard
    from calibgui.engine.boards.circle_grid import Circles as Circles
    from calibgui.engine.boards.listed_circles import (
        ListedCircles as ListedCircles,
        list_circles as list_circles,
    )
    from calibgui.engine.boards.pattern import Symmetry as Symmetry
    from calibgui.engine.boards.puzzleboard import PuzzleBoard as PuzzleBoard
    from calibgui.engine.boards.shape import (
        BoardShape as BoardShape,
        BoardShapeModel as BoardShapeModel,
        BoardShapePrior as BoardShapePrior,
    )
    from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard as TaggedCheckerboard
    from calibgui.engine.calibration.board_poses import (
        BoardPose as BoardPose,
        locate_board as locate_board,
    )
    from calibgui.engine.calibration.calibrate import calibrate as calibrate
    from calibgui.engine.calibration.observations import Observation as Observation
    from calibgui.engine.calibration.refit import Refit as Refit, refit as refit
    from calibgui.engine.calibration.result import (
        Assumption as Assumption,
        Calibration as Calibration,
        Cost as Cost,
        Degeneracy as Degeneracy,
        DegenerateError as DegenerateError,
        Diagnosis as Diagnosis,
        Iteration as Iteration,
        StageOne as StageOne,
        Status as Status,
        Undetermined as Undetermined,
        ViewResiduals as ViewResiduals,
    )
    from calibgui.engine.camera.camera import Camera as Camera
    from calibgui.engine.camera.distortion import (
        distort_points as distort_points,
        project_points as project_points,
        undistort_points as undistort_points,
    )
    from calibgui.engine.features.corners import Corners as Corners
    from calibgui.engine.detection.find_corners import find_corners as find_corners
    from calibgui.engine.errors import (
        CalibrationError as CalibrationError,
        Cancelled as Cancelled,
        NoBoardError as NoBoardError,
    )
    from calibgui.engine.geometry.pose import Pose as Pose
    from calibgui.engine.images.reading import Image as Image, read_image as read_image
    from calibgui.engine.images.rectification import (
        compute_board_extent as compute_board_extent,
        rectify_image as rectify_image,
    )
    from calibgui.engine.images.rendering import (
        Appearance as Appearance,
        render_view as render_view,
    )
    from calibgui.engine.images.resampling import ResampledImage as ResampledImage
    from calibgui.engine.images.undistortion import (
        FieldOfView as FieldOfView,
        undistort_image as undistort_image,
    )
    from calibgui.engine.uncertainty.back_projection import (
        find_board_points as find_board_points,
        find_rays as find_rays,
    )

load_on_demand(
    __name__,
    {
        "assessment.residuals.residual_statistics": ["ResidualSummary", "summarise_residuals"],
        "boards.april_grid": ["AprilGrid"],
        "boards.board": ["Board"],
        "boards.charuco": ["Charuco"],
        "boards.checkerboard": ["Checkerboard"],
        "boards.circle_grid": ["Circles"],
        "boards.listed_circles": ["ListedCircles", "list_circles"],
        "boards.pattern": ["Symmetry"],
        "boards.puzzleboard": ["PuzzleBoard"],
        "boards.shape": ["BoardShape", "BoardShapeModel", "BoardShapePrior"],
        "boards.tagged_checkerboard": ["TaggedCheckerboard"],
        "calibration.board_poses": ["BoardPose", "locate_board"],
        "calibration.calibrate": ["calibrate"],
        "calibration.observations": ["Observation"],
        "calibration.refit": ["Refit", "refit"],
        "calibration.result": [
            "Assumption",
            "Calibration",
            "Cost",
            "Degeneracy",
            "DegenerateError",
            "Diagnosis",
            "Iteration",
            "StageOne",
            "Status",
            "Undetermined",
            "ViewResiduals",
        ],
        "camera.camera": ["Camera"],
        "camera.distortion": ["distort_points", "project_points", "undistort_points"],
        "detection.find_corners": ["find_corners"],
        "errors": ["CalibrationError", "Cancelled", "NoBoardError"],
        "features.corners": ["Corners"],
        "geometry.pose": ["Pose"],
        "images.reading": ["Image", "read_image"],
        "images.rectification": ["compute_board_extent", "rectify_image"],
        "images.rendering": ["Appearance", "render_view"],
        "images.resampling": ["ResampledImage"],
        "images.undistortion": ["FieldOfView", "undistort_image"],
        "uncertainty.back_projection": ["find_board_points", "find_rays"],
    },
)
