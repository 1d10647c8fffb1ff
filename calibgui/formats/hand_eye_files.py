"""Hand and eye for other programs: ROS 2's easy_handeye2, and OpenCV.

easy_handeye2 (.calib): what its publisher reads from ~/.ros2/easy_handeye2/calibrations, under the
file's name, and broadcasts as a static transform from `tracking_base_frame`, the camera, to
`robot_effector_frame`, or `robot_base_frame` of a camera that stands. Lengths are metres, the
quaternion is x, y, z, w, the camera's frame is optical (Z ahead). The frames have the names that
most robots' descriptions use: put those of the robot in their place.

OpenCV (.yaml, .yml): a cv2.FileStorage of the matrices (4, 4) `cam2gripper` and `board2base`, or
`cam2base` and `board2gripper`, in the words of cv2.calibrateHandEye, in millimetres.

Both say what was not found in a comment. Cannot hold: covariances; OpenCV's has standard
deviations.
"""

from __future__ import annotations

import os
from pathlib import Path

import scipy

from calibgui.dataset import HandEyeSet
from calibgui.engine import opencv
from calibgui.engine.arrays import Array
from calibgui.engine.files import write_atomically
from calibgui.engine.geometry import rotation_from_vector
from calibgui.formats.hand_eye_json import make_matrix, write_hand_eye
from calibgui.formats.origin import HAND_EYE, HAND_EYE_OPENCV, HAND_EYE_ROS, make_mark
from calibgui.formats.yaml_document import format_number


def write_easy_handeye(hand_eye_set: HandEyeSet, path: str | os.PathLike[str]) -> None:
    """Write the file of easy_handeye2.

    Raises:
        CalibrationError: if it cannot be written.
    """
    found = hand_eye_set.found
    pose = found.camera_pose
    rotation = scipy.spatial.transform.Rotation.from_matrix(rotation_from_vector(pose.rvec))
    lines = [
        f"# {make_mark(HAND_EYE_ROS)}",
        f"# {_describe_open(hand_eye_set)}",
        "parameters:",
        f"  name: {_quote(Path(path).stem)}",
        f"  calibration_type: {'eye_in_hand' if found.eye_in_hand else 'eye_on_base'}",
        "  robot_base_frame: base_link",
        "  robot_effector_frame: tool0",
        "  tracking_base_frame: camera_optical_frame",
        "  tracking_marker_frame: board",
        "  freehand_robot_movement: true",
        "  move_group_namespace: /",
        "  move_group: manipulator",
        "transform:",
        "  translation:",
        *_format_members("xyz", (pose.tvec / 1000).tolist()),
        "  rotation:",
        *_format_members("xyzw", rotation.as_quat().tolist()),
    ]
    write_atomically(path, ("\n".join(lines) + "\n").encode())


def write_opencv_hand_eye(hand_eye_set: HandEyeSet, path: str | os.PathLike[str]) -> None:
    """Write the file of OpenCV.

    Raises:
        CalibrationError: if it cannot be written.
    """
    found = hand_eye_set.found
    camera, board = (
        ("cam2gripper", "board2base") if found.eye_in_hand else ("cam2base", "board2gripper")
    )
    values: dict[str, int | float | str | Array] = {
        camera: make_matrix(found.camera_pose),
        board: make_matrix(found.board_pose),
        f"{camera}_std_dev": found.sigma[None],
        "tool_std_dev_mm": found.tool.sigma_mm,
    }
    note = (
        f"{make_mark(HAND_EYE_OPENCV)} Lengths are in mm; {camera}_std_dev is of the rotation "
        f"vector, rad, and the translation.\n{_describe_open(hand_eye_set)}"
    )
    text = opencv.format_storage(Path(path).suffix.lower(), values, note)
    write_atomically(path, text.encode())


def _describe_open(hand_eye_set: HandEyeSet) -> str:
    """Describe in a line what the poses leave open."""
    found = hand_eye_set.found
    parts = [f"turns about {_format_axis(axis)}" for axis in found.open_turns]
    parts += [f"shifts along {_format_axis(axis)}" for axis in found.open_shifts]
    return (
        f"The poses leave open: {', '.join(parts)}." if parts else "The poses leave nothing open."
    )


def _format_axis(axis: Array) -> str:
    return "({:.3f}, {:.3f}, {:.3f})".format(*axis.tolist())


def _format_members(names: str, values: list[float]) -> list[str]:
    return [
        f"    {name}: {format_number(value)}" for name, value in zip(names, values, strict=True)
    ]


def _quote(text: str) -> str:
    """Quote a text for YAML."""
    return "'" + text.replace("'", "''") + "'"


WRITERS = {
    ".json": (HAND_EYE, write_hand_eye),
    ".calib": (HAND_EYE_ROS, write_easy_handeye),
    ".yaml": (HAND_EYE_OPENCV, write_opencv_hand_eye),
    ".yml": (HAND_EYE_OPENCV, write_opencv_hand_eye),
}
"""Kind of file and function that writes it, by the suffix."""
