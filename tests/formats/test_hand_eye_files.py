"""Files of hand and eye, each read by its reader."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml
from scipy.spatial.transform import Rotation

from calibgui.dataset import HandEyeSet
from calibgui.engine.geometry import rotation_from_vector
from calibgui.engine.hand_eye import calibrate_hand_eye
from calibgui.formats.hand_eye_files import write_easy_handeye, write_opencv_hand_eye
from calibgui.formats.hand_eye_json import encode_hand_eye, write_hand_eye
from calibgui.formats.origin import HAND_EYE, HAND_EYE_OPENCV, HAND_EYE_ROS, is_own
from tests.engine.hand_eye.arms import CAMERA, make_arm, make_standing_arm, move_four_axes
from tests.formats.readers import in_other_python

PARAMETERS = {
    "name",
    "calibration_type",
    "robot_base_frame",
    "robot_effector_frame",
    "tracking_base_frame",
    "tracking_marker_frame",
    "freehand_robot_movement",
    "move_group_namespace",
    "move_group",
}
"""Fields of easy_handeye2_msgs/HandeyeCalibrationParameters: its reader takes no others."""


@pytest.fixture(scope="module", params=["hand", "base", "four-axes"])
def found(request: pytest.FixtureRequest) -> HandEyeSet:
    rng = np.random.default_rng(1)
    make = {"hand": make_arm, "base": make_standing_arm, "four-axes": move_four_axes}
    arm = make[request.param](rng, 8)
    in_hand = request.param != "base"
    rows = arm.take_matrices()
    result = calibrate_hand_eye(CAMERA, arm.views, rows, eye_in_hand=in_hand)
    return HandEyeSet(result, ("c.png: no board.",))


def make_matrix(found: HandEyeSet) -> np.ndarray:
    pose = found.found.camera_pose
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation_from_vector(pose.rvec), pose.tvec
    return matrix


def test_easy_handeye(found: HandEyeSet, tmp_path: Path) -> None:
    """It is read as easy_handeye2 does: by YAML, into the fields of a message of ROS."""
    file = tmp_path / "it's mine.calib"
    write_easy_handeye(found, file)
    assert is_own(file, HAND_EYE_ROS)
    content = yaml.full_load(file.read_text())
    assert content.keys() == {"parameters", "transform"}
    parameters, transform = content["parameters"], content["transform"]
    assert parameters.keys() == PARAMETERS and parameters["name"] == "it's mine"
    assert parameters["freehand_robot_movement"] is True
    kind = "eye_in_hand" if found.found.eye_in_hand else "eye_on_base"
    assert parameters["calibration_type"] == kind
    assert transform["translation"].keys() == set("xyz")
    assert all(isinstance(v, float) for part in transform.values() for v in part.values())
    quaternion = [transform["rotation"][axis] for axis in "xyzw"]
    place = [1000 * transform["translation"][axis] for axis in "xyz"]
    matrix = make_matrix(found)
    np.testing.assert_allclose(
        Rotation.from_quat(quaternion).as_matrix(), matrix[:3, :3], atol=1e-12
    )
    np.testing.assert_allclose(place, matrix[:3, 3], atol=1e-9)
    is_open = len(found.found.open_shifts) > 0
    assert ("leave open: shifts along" in file.read_text()) == is_open


def test_easy_handeye_by_its_own_message(found: HandEyeSet, tmp_path: Path) -> None:
    file = tmp_path / "mine.calib"
    write_easy_handeye(found, file)
    script = (
        "import json, sys, yaml\n"
        "from easy_handeye2_msgs.msg import HandeyeCalibration\n"
        "from rosidl_runtime_py import set_message_fields\n"
        "read = HandeyeCalibration()\n"
        "set_message_fields(read, yaml.full_load(open(sys.argv[1]).read()))\n"
        "t = read.transform.translation\n"
        "print(json.dumps([t.x, t.y, t.z]))\n"
    )
    place = in_other_python(script, file, needs="import easy_handeye2_msgs, rosidl_runtime_py")
    np.testing.assert_allclose(place, found.found.camera_pose.tvec / 1000)


@pytest.mark.parametrize("suffix", [".yaml", ".yml"])
def test_opencv(found: HandEyeSet, suffix: str, tmp_path: Path) -> None:
    file = tmp_path / f"hand_eye{suffix}"
    write_opencv_hand_eye(found, file)
    assert is_own(file, HAND_EYE_OPENCV)
    storage = cv2.FileStorage(str(file), cv2.FILE_STORAGE_READ)
    camera, board = (
        ("cam2gripper", "board2base") if found.found.eye_in_hand else ("cam2base", "board2gripper")
    )
    np.testing.assert_allclose(storage.getNode(camera).mat(), make_matrix(found), atol=1e-12)
    place = storage.getNode(board).mat()[:3, 3]
    np.testing.assert_allclose(place, found.found.board_pose.tvec, atol=1e-12)
    np.testing.assert_allclose(storage.getNode(f"{camera}_std_dev").mat()[0], found.found.sigma)
    assert storage.getNode("tool_std_dev_mm").real() == found.found.tool.sigma_mm


def test_json(found: HandEyeSet, tmp_path: Path) -> None:
    file = tmp_path / "hand_eye.json"
    write_hand_eye(found, file)
    assert is_own(file, HAND_EYE)
    content = json.loads(file.read_text())
    pose = content["hand_from_camera" if found.found.eye_in_hand else "base_from_camera"]
    np.testing.assert_array_equal(pose["matrix"], make_matrix(found))
    np.testing.assert_array_equal(pose["covariance"], found.found.covariance)
    assert content["tool"]["robot_share"] == found.found.tool.robot_share
    assert [view["image"] for view in content["views"]] == list(found.found.names)
    assert content["left_out"] == ["c.png: no board."] and content["shift"] == 0
    assert len(content["open_shifts"]) == len(found.found.open_shifts)


def test_json_of_no_second_reading(found: HandEyeSet) -> None:
    alone = replace(found, found=replace(found.found, next_scatter=np.inf))
    assert encode_hand_eye(alone)["next_scatter_mm"] == np.inf
