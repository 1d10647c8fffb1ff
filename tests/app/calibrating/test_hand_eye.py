"""Photographs and poses are paired, and what does not go together is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.app.calibrating.hand_eye import find_hand_eye, pair_poses
from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.engine.calibration import make_observation
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.formats.robot_poses import RobotPoseTable
from tests.engine.hand_eye.arms import CAMERA, X, make_arm

ARM = make_arm(np.random.default_rng(0), 6)
VIEWS = tuple(
    View(f"folder/{k}.png", ViewStatus.FOUND, points=make_observation(*view))
    for k, view in enumerate(ARM.views)
)
SET = CornerSet(CAMERA.size, VIEWS)
ROWS = ARM.take_matrices()


def test_a_known_camera_and_its_errors() -> None:
    table = RobotPoseTable("robot.csv", ROWS)
    found = find_hand_eye((CAMERA, None, SET), table)
    assert not found.has_covariance and not found.left_out
    np.testing.assert_allclose(found.found.camera_pose.tvec, X.t, atol=1e-9)
    assert found.found.names[0] == "0.png"
    count = len(CAMERA.params)
    assert find_hand_eye((CAMERA, np.eye(count), SET), table).has_covariance
    unknown = np.full((count, count), np.nan)
    assert not find_hand_eye((CAMERA, unknown, SET), table).has_covariance


@pytest.mark.parametrize("name", ["folder/{}.png", "{}.png", "{}", "elsewhere/{}.jpg"])
def test_poses_by_name(name: str) -> None:
    """By path, name, or name without suffix, in whatever order."""
    names = tuple(name.format(k) for k in (5, 0, 4, 1, 3, 2))
    used, rows, left_out = pair_poses(VIEWS, RobotPoseTable("robot.csv", ROWS, names))
    assert list(used) == list(VIEWS) and rows == [1, 3, 5, 4, 2, 0] and left_out == ()


def test_what_has_no_counterpart_is_said() -> None:
    failed = View("folder/x.png").refuse(ViewStatus.NO_BOARD, "No board.")
    hidden = replace(VIEWS[1], enabled=False)
    views = (*VIEWS[:1], hidden, *VIEWS[2:], failed)
    names = ("0", "1", "2", "3", "4", "x", "y")
    table = RobotPoseTable("robot.csv", np.vstack([ROWS, ROWS[:1]]), names)
    used, rows, left_out = pair_poses(views, table)
    assert [view.name for view in used] == ["0.png", "2.png", "3.png", "4.png"]
    assert rows == [0, 2, 3, 4]
    assert left_out == (
        "x.png: No board.",
        "5.png: it has no pose.",
        "y: there is no such photograph.",
    )


def test_poses_by_order_count_all_photographs() -> None:
    """A photograph without a board has its pose as well, and one that is left out."""
    failed = View("folder/x.png").refuse(ViewStatus.NO_BOARD, "No board.")
    views = (failed, *VIEWS[:4], replace(VIEWS[4], enabled=False))
    used, rows, _ = pair_poses(views, RobotPoseTable("robot.csv", ROWS))
    assert [view.name for view in used] == ["0.png", "1.png", "2.png", "3.png"]
    assert rows == [1, 2, 3, 4]


def test_what_does_not_go_together_is_refused() -> None:
    table = RobotPoseTable("robot.csv", ROWS)
    with pytest.raises(CalibrationError, match=r"robot\.csv has 5 poses, and there are 6 photo"):
        pair_poses(VIEWS, RobotPoseTable("robot.csv", ROWS[1:]))
    with pytest.raises(CalibrationError, match="names none of the photographs") as refusal:
        pair_poses(VIEWS, RobotPoseTable("robot.csv", ROWS, tuple("abcdef")))
    assert "0.png" in refusal.value.hint
    with pytest.raises(CalibrationError, match="names none of the photographs"):
        pair_poses((), RobotPoseTable("robot.csv", ROWS, tuple("abcdef")))
    small = Camera((640, 480), CAMERA.params, CAMERA.model)
    with pytest.raises(CalibrationError, match="have 1280 x 960 px, and the camera 640 x 480 px"):
        find_hand_eye((small, None, SET), table)
    with pytest.raises(CalibrationError, match="The side of a square is not known"):
        find_hand_eye((CAMERA, None, replace(SET, lengths_confirmed=False)), table)
