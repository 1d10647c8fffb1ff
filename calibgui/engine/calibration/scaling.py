"""A calibration with another length of the board's squares.

Pixels say nothing of lengths: with a board that is r times as large, every pose is r times as far
away, and the camera and its residuals are the same. So a length that is stated later, or was stated
wrongly, takes no other solve. That holds as long as nothing else was said in mm.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.geometry.pose import Pose


def has_own_lengths(calibration: Calibration) -> bool:
    """Return whether a calibration was told lengths besides those of the board's drawing."""
    settings = calibration.settings
    return settings.prior is not None or bool(settings.is_board_shape_held)


def scale_lengths(calibration: Calibration, ratio: float) -> Calibration:
    """Return a calibration from a board of squares `ratio` times as long.

    Raises:
        ValueError: if it was told other lengths (`has_own_lengths`), with which it would differ.
    """
    if has_own_lengths(calibration):
        raise ValueError("a calibration that was told other lengths has to be made anew")
    to_longer = np.repeat([1.0, ratio], 3)
    shape = calibration.board_shape
    return replace(
        calibration,
        poses=tuple(Pose(pose.rvec, ratio * pose.tvec) for pose in calibration.poses),
        pose_covariances=calibration.pose_covariances * np.outer(to_longer, to_longer),
        reference_scale=calibration.reference_scale / ratio,
        board_shape=None if shape is None else _scale_board_shape(shape, ratio),
        board_shape_error=ratio * calibration.board_shape_error,
    )


def compute_scale_covariance(pose: Pose, scale_sigma: float) -> Array:
    """Compute the covariance (6, 6) of (rvec, tvec) that an error of the board's scale brings.

    A board that is longer by a share s is farther away by that share: d tvec = s tvec.

    Args:
        pose: the pose of the board.
        scale_sigma: standard deviation of s.
    """
    moved = scale_sigma * np.concatenate([np.zeros(3), pose.tvec])
    return np.outer(moved, moved)


def _scale_board_shape(shape: BoardShape, ratio: float) -> BoardShape:
    """Return a board's shape with all lengths `ratio` times as long."""
    return replace(
        shape,
        nominal=ratio * shape.nominal,
        deviation=ratio * shape.deviation,
        sigma=ratio * shape.sigma,
        covariance=None if shape.covariance is None else ratio**2 * shape.covariance,
    )
