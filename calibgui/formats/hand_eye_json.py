"""hand_eye.json: the camera in a robot's hand, or beside the robot, and how certain that is.

    {"format": "calibgui-hand-eye", "version": 1, "eye_in_hand": true,
     "hand_from_camera": {"matrix", "rvec", "tvec_mm", "sigma_rvec", "sigma_tvec_mm", "covariance"},
     "base_from_board": {...}, "open_turns", "open_shifts", "camera_errors_count",
     "tool": {"sigma_mm", "sigma_rad", "robot_share"}, "robot": {"sigma_rad", "sigma_mm"},
     "rms_px", "noise_px", "reading", "as_well", "shift", "scatter_mm", "next_scatter_mm",
     "views": [{"image", "correction": [rx, ry, rz, x, y, z]}, ...], "left_out"}

Of a camera that stands it is "base_from_camera" and "hand_from_board". b_from_a takes a's
coordinates to b's; `matrix` is (4, 4), lengths mm, angles rad. Each sigma is one standard
deviation, `covariance` that of (rvec, tvec); nothing of it counts what is open: the axes about
which the camera may be turned and the directions along which it may be shifted, in the frame of
hand or base. `robot` is how accurate one pose of the robot is, `correction` its most likely error.

Reader: any JSON reader. Cannot hold: the corners and the camera (``result_json.py``).
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from calibgui.dataset import HandEyeSet
from calibgui.engine.arrays import Array
from calibgui.engine.geometry import Pose, rotation_from_vector
from calibgui.formats.json_document import write_json

FORMAT = "calibgui-hand-eye"
VERSION = 1


def make_matrix(pose: Pose) -> Array:
    """Return a pose as a matrix (4, 4), mm."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation_from_vector(pose.rvec), pose.tvec
    return matrix


def name_frames(hand_eye_set: HandEyeSet) -> tuple[str, str]:
    """Name the camera's pose and the board's."""
    if hand_eye_set.found.eye_in_hand:
        return "hand_from_camera", "base_from_board"
    return "base_from_camera", "hand_from_board"


def encode_hand_eye(hand_eye_set: HandEyeSet) -> dict[str, Any]:
    """Return the content of hand_eye.json."""
    found = hand_eye_set.found
    camera, board = name_frames(hand_eye_set)
    return {
        "format": FORMAT,
        "version": VERSION,
        "eye_in_hand": found.eye_in_hand,
        camera: _encode_pose(found.camera_pose, found.covariance),
        board: _encode_pose(found.board_pose, found.board_covariance),
        "open_turns": found.open_turns,
        "open_shifts": found.open_shifts,
        "camera_errors_count": hand_eye_set.has_covariance,
        "tool": found.tool._asdict(),
        "robot": dict(zip(("sigma_rad", "sigma_mm"), found.robot_sigmas.tolist(), strict=True)),
        "rms_px": found.rms,
        "noise_px": found.noise,
        "reading": found.reading,
        "as_well": list(found.rivals),
        "shift": found.shift,
        "scatter_mm": found.scatter,
        "next_scatter_mm": found.next_scatter,
        "views": [
            {"image": name, "correction": correction}
            for name, correction in zip(found.names, found.corrections, strict=True)
        ],
        "left_out": list(hand_eye_set.left_out),
    }


def write_hand_eye(hand_eye_set: HandEyeSet, path: str | os.PathLike[str]) -> None:
    """Write hand_eye.json.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    write_json(path, encode_hand_eye(hand_eye_set))


def _encode_pose(pose: Pose, covariance: Array) -> dict[str, Any]:
    sigma = np.sqrt(np.diag(covariance))
    return {
        "matrix": make_matrix(pose),
        "rvec": pose.rvec,
        "tvec_mm": pose.tvec,
        "sigma_rvec": sigma[:3],
        "sigma_tvec_mm": sigma[3:],
        "covariance": covariance,
    }
