"""Hand and eye in one call, on poses of real and rendered robots that others made."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import calibgui
from calibgui.engine.boards import BoardShapeModel
from calibgui.engine.calibration import calibrate
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import rotation_from_vector
from calibgui.engine.hand_eye import calibrate_hand_eye
from calibgui.formats.corners_json import read_corners
from calibgui.formats.robot_poses import read_robot_poses
from tests.engine.hand_eye.arms import CAMERA, X, make_arm

DATA = Path(os.environ.get("CALIBGUI_DATA", Path(__file__).parents[3] / "shared" / "data"))


def test_a_calibrated_camera_is_found_in_the_hand(tmp_path: Path) -> None:
    arm = make_arm(np.random.default_rng(0), 12, noise=0.05, robot=(1e-4, 0.05))
    camera = calibgui.calibrate_corners(arm.views, CAMERA.size, model="brown-conrady")
    rows = arm.take_matrices()
    np.savetxt(tmp_path / "poses.txt", rows)
    for poses in (rows.reshape(-1, 4, 4), tmp_path / "poses.txt"):
        found = calibgui.calibrate_hand_eye(camera, poses, tool=[0, 0, 100])
        assert found.eye_in_hand and found.names[0] == "view 1"
        error = found.camera_pose.tvec - X.t
        assert np.abs(error).max() < 5 * found.sigma[3:].max()
    with pytest.raises(CalibrationError, match="The array has 11 poses, and there are 12"):
        calibgui.calibrate_hand_eye(camera, rows[1:])


@pytest.mark.slow
@pytest.mark.data
@pytest.mark.usefixtures("search_here")
def test_a_rendered_robot_of_others() -> None:
    """handeye_cs_synthetic_1, whose truth is in its file."""
    folder = DATA / "handeye_cs_synthetic_1"
    if not folder.is_dir():
        pytest.skip("no real image sets")
    camera = calibgui.calibrate(folder, square=200)
    for name in ("RobotPosesVec.txt", "RobotPoses.mat"):
        found = calibgui.calibrate_hand_eye(camera, folder / name)
        assert found.eye_in_hand and found.reading.startswith("matrices row by row, metres")
        assert np.linalg.norm(found.camera_pose.tvec) < 0.03
        turn = rotation_from_vector(found.camera_pose.rvec) - np.diag([1.0, -1.0, -1.0])
        assert np.abs(turn).max() < 1e-4
        assert found.next_scatter > 100 * found.scatter


@pytest.mark.slow
@pytest.mark.data
def test_halves_of_a_real_robots_poses_agree() -> None:
    """handeye_kuka_1_corners_only, of which no truth is known."""
    folder = DATA / "handeye_kuka_1_corners_only"
    if not folder.is_dir():
        pytest.skip("no real image sets")
    corner_set = read_corners(folder / "corners.json")
    views = [view.observation(corner_set.board) for view in corner_set.views]
    rows = read_robot_poses(folder / "RobotPosesVec.txt").numbers
    whole = calibrate(views, corner_set.size, board_shape=BoardShapeModel.FREE)
    rng, ratios = np.random.default_rng(0), []
    for _ in range(12):
        order = rng.permutation(len(views))
        one, other = (
            calibrate_hand_eye(
                whole.camera,
                [views[k] for k in half],
                rows[half],
                covariance=whole.covariance,
                board_shape=whole.board_shape,
            )
            for half in (order[:15], order[15:])
        )
        error = np.concatenate(
            [
                one.camera_pose.rvec - other.camera_pose.rvec,
                one.camera_pose.tvec - other.camera_pose.tvec,
            ]
        )
        ratios.append(error / np.hypot(one.sigma, other.sigma))
        assert 0.2 < one.robot_sigmas[1] < 2.0 and one.scatter < 3.0 and one.next_scatter > 100.0
    assert 0.75 < np.sqrt(np.mean(np.square(ratios))) < 1.35
    assert np.mean(np.abs(ratios) < 2) > 0.85
