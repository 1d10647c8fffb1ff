"""Hand and eye in one call."""

from __future__ import annotations

import os

import numpy as np
import numpy.typing as npt

from calibgui.app.calibrating.hand_eye import find_hand_eye
from calibgui.engine.hand_eye import HandEye
from calibgui.formats.robot_poses import RobotPoseTable, read_robot_poses
from calibgui.scripting.calibrated_camera import CalibratedCamera


def calibrate_hand_eye(
    camera: CalibratedCamera,
    poses: str | os.PathLike[str] | npt.ArrayLike,
    *,
    eye_in_hand: bool | None = None,
    tool: npt.ArrayLike | None = None,
) -> HandEye:
    """Find where a calibrated camera is in a robot's hand, or beside the robot.

    Args:
        camera: the camera, calibrated from photographs taken at the robot's poses.
        poses: a file of the robot's poses (CSV, JSON, text, MAT), or an array of them, one for each
            photograph, (K, 4, 4) or (K, n) with 6, 7, 12 or 16 numbers. Units, order and direction
            are found out.
        eye_in_hand: True if the camera is in the hand, False if it stands and the board is in the
            hand; None takes the poses for base_from_hand, and finds out.
        tool: (3,) the tool's point in the hand's frame, mm, for which the error is stated; None for
            where the board is.

    Raises:
        CalibrationError: if the poses do not go with the photographs, or do not fit them.

    Example:
        camera = calibgui.calibrate("photographs", square=25)
        found = calibgui.calibrate_hand_eye(camera, "poses.csv")
        print(found.camera_pose, found.tool.sigma_mm)
    """
    if isinstance(poses, str | os.PathLike):
        table = read_robot_poses(poses)
    else:
        numbers = np.asarray(poses, np.float64)
        table = RobotPoseTable("The array", numbers.reshape(len(numbers), -1))
    point = None if tool is None else np.asarray(tool, np.float64)
    return find_hand_eye(camera.result, table, eye_in_hand, point).found
