"""poses.json: the pose of one photograph is read back, for the camera that it was found with."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import LocatedView, PoseSet
from calibgui.engine import Camera, locate_board
from calibgui.engine.calibration import BoardPose
from calibgui.engine.errors import CalibrationError
from calibgui.engine.uncertainty import find_board_points
from calibgui.formats.poses_json import read_pose, write_poses
from tests.engine.scenes import BOARD, brown, imaged, looking

CAMERA = brown()


@pytest.fixture
def found() -> BoardPose:
    rng = np.random.default_rng(3)
    xy = BOARD.points()
    uv = imaged(CAMERA, looking(CAMERA, rng), xy) + rng.normal(scale=0.1, size=xy.shape)
    return locate_board(CAMERA, (uv, xy), np.diag(np.full(len(CAMERA.params), 1e-6)))


@pytest.fixture
def file(found: BoardPose, tmp_path: Path) -> Path:
    """Two photographs with a pose, and one without."""
    views = [LocatedView(f"a/{k}.png", found) for k in range(2)]
    without = LocatedView("c.png", None, "No board.")
    write_poses(PoseSet(CAMERA, (*views, without), BOARD), tmp_path / "poses.json")
    return tmp_path / "poses.json"


@pytest.mark.parametrize("name", ["1.png", "a/1.png"])
def test_pose_comes_back(file: Path, found: BoardPose, name: str) -> None:
    read = read_pose(file, CAMERA, name)
    for part in ("covariance", "noise_covariance", "by_camera", "noise", "lead"):
        np.testing.assert_allclose(getattr(read, part), getattr(found, part), rtol=1e-12)
    np.testing.assert_array_equal(read.pose.tvec, found.pose.tvec)
    np.testing.assert_array_equal(read.pose.rvec, found.pose.rvec)


@pytest.mark.parametrize(
    ("name", "message"),
    [(None, "several poses"), ("c.png", r"no pose of c\.png"), ("d.png", r"no pose of d\.png")],
)
def test_pose_must_be_one(file: Path, name: str | None, message: str) -> None:
    with pytest.raises(CalibrationError, match=message):
        read_pose(file, CAMERA, name)


def test_only_pose_needs_no_name(file: Path, found: BoardPose) -> None:
    content = json.loads(file.read_text())
    del content["views"][0]
    file.write_text(json.dumps(content))
    np.testing.assert_array_equal(read_pose(file, CAMERA).pose.tvec, found.pose.tvec)


def test_poses_of_another_camera_are_refused(file: Path) -> None:
    other = Camera(CAMERA.size, CAMERA.params + 1e-9, CAMERA.model)
    with pytest.raises(CalibrationError, match="found with another camera"):
        read_pose(file, other, "1.png")


def test_other_file_is_refused(file: Path) -> None:
    file.write_text('{"views": []}')
    with pytest.raises(CalibrationError, match="is not a file of poses"):
        read_pose(file, CAMERA)


def test_the_scale_of_the_board_comes_back(found: BoardPose, tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    board = replace(BOARD, square_sigma=0.002 * BOARD.square)
    xy = BOARD.points()
    uv = imaged(CAMERA, looking(CAMERA, rng), xy) + rng.normal(scale=0.1, size=xy.shape)
    errors = np.diag(np.full(len(CAMERA.params), 1e-6))
    scaled = locate_board(CAMERA, (uv, xy), errors, scale_sigma=board.scale_sigma)
    along = scaled.pose.tvec / np.linalg.norm(scaled.pose.tvec)
    added = along @ (scaled.covariance - found.covariance)[3:, 3:] @ along
    assert added == pytest.approx((0.002 * np.linalg.norm(scaled.pose.tvec)) ** 2)
    write_poses(PoseSet(CAMERA, (LocatedView("a.png", scaled),), board), tmp_path / "poses.json")
    read = read_pose(tmp_path / "poses.json", CAMERA)
    assert read.scale_sigma == board.scale_sigma
    np.testing.assert_allclose(read.covariance, scaled.covariance, rtol=1e-12)
    corner = find_board_points(uv[-1:], CAMERA, read).covariance[0]
    exact = find_board_points(uv[-1:], CAMERA, replace(read, scale_sigma=0.0)).covariance[0]
    np.testing.assert_allclose(corner - exact, 0.002**2 * np.outer(xy[-1], xy[-1]), rtol=0.01)
