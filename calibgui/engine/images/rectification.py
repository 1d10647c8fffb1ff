"""Rectification: the board as seen from straight above, at a constant scale (figure 9b)."""

from __future__ import annotations

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.resampling import (
    Pixels,
    ResampledImage,
    check_image,
    make_matrix,
    resample_image,
)

Extent = tuple[float, float, float, float]
"""Least X and Y, greatest X and Y of a rectangle on the board, mm."""


def rectify_image(
    image: Pixels, camera: Camera, pose: Pose, extent: Extent, pixels_per_mm: float
) -> ResampledImage:
    """Make the image of the board as seen from straight above.

    Every output pixel is a point of the board's plane, and takes the level at its image.

    Args:
        image: (h, w) or (h, w, c) of the camera's size.
        camera: the camera that took it.
        pose: cam_from_board of this image, mm.
        extent: rectangle of the board to show, mm; the first pixel's outer corner is its least
            X and Y (`compute_board_extent` returns that of a board).
        pixels_per_mm: scale of the output.

    Raises:
        CalibrationError: if the image has another size than the camera, or the output would
            have no pixels or too many.
    """
    image = check_image(image, camera)
    left, top, right, bottom = extent
    low, high = np.array([left, top]), np.array([right, bottom])
    shape = (high - low) * pixels_per_mm
    if not (np.isfinite(shape).all() and shape.min() >= 0.5 and shape.max() <= opencv.MAX_SIDE):
        raise CalibrationError(
            f"A rectified image of {shape[0]:.0f} x {shape[1]:.0f} pixels cannot be made.",
            f"Choose an extent and a scale that give 1 to {opencv.MAX_SIDE} pixels a side.",
        )
    width, height = np.rint(shape).astype(int)
    matrix = make_matrix(np.full(2, pixels_per_mm), -low * pixels_per_mm - 0.5)

    def source(p: Array) -> Array:
        return project_points((p - matrix[:2, 2]) / pixels_per_mm, camera, pose)

    return resample_image(image, (int(width), int(height)), matrix, source)


def compute_board_extent(board: Board) -> Extent:
    """Return the rectangle that holds the board's points and a square around them, mm."""
    side = board.square
    right, bottom = (board.points().max(axis=0) + side).tolist()
    return -side, -side, right, bottom
