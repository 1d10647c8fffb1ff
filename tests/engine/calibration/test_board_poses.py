"""Poses of boards under a known camera, with their covariances."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration import BoardPose, Observation, board_poses, locate_board
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.planar_pose_ambiguity import mirror_poses
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.resection import estimate_poses
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import Pose
from tests.engine.scenes import BOARD, LENSES, VGA, brown, example, imaged, looking

XY = BOARD.points()


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(3)


def as_vector(found: BoardPose) -> Array:
    return np.concatenate([found.pose.rvec, found.pose.tvec])


@pytest.mark.parametrize("model", LENSES)
def test_exact_corners_give_the_pose_back(model: str, rng: np.random.Generator) -> None:
    camera = example(model)
    pose = looking(camera, rng, fill=(0.4, 0.5))
    found = locate_board(camera, (imaged(camera, pose, XY), XY))
    np.testing.assert_allclose(found.pose.rvec, pose.rvec, atol=1e-7)
    np.testing.assert_allclose(found.pose.tvec, pose.tvec, atol=1e-4)
    assert found.rms < 1e-6


def test_pose_is_that_of_opencv(rng: np.random.Generator) -> None:
    camera, pose = brown(), looking(brown(), rng)
    uv = imaged(camera, pose, XY) + rng.normal(scale=0.3, size=XY.shape)
    found = locate_board(camera, (uv, XY))
    points = np.column_stack([XY, np.zeros(len(XY))])
    _, rvec, tvec = cv2.solvePnP(points, uv, camera.matrix, camera.coefficients[:5])
    np.testing.assert_allclose(found.pose.rvec, rvec[:, 0], atol=1e-5)
    np.testing.assert_allclose(found.pose.tvec, tvec[:, 0], atol=5e-3)


@pytest.mark.parametrize("weighted", [False, True])
def test_covariance_is_the_scatter_of_draws(weighted: bool, rng: np.random.Generator) -> None:
    """Of corners' noise and of the camera's own errors, which are correlated."""
    truth, pose = brown(), Pose((0.4, -0.3, 0.1), (-140, -110, 700))
    exact = imaged(truth, pose, XY)
    root = np.diag([1.5, 1.0, 2.0, 2.0, 5e-3, 1e-2, 2e-4, 2e-4, 0.0, 0.0])
    root[1, 0] = 1.4
    noise = rng.uniform(0.1, 0.5, len(XY)) if weighted else np.full(len(XY), 0.3)
    cov = noise[:, None, None] ** 2 * np.eye(2) if weighted else None
    draws, covariances = [], []
    for _ in range(250):
        camera = Camera(VGA, truth.params + root @ rng.normal(size=len(root)), truth.model)
        uv = exact + noise[:, None] * rng.normal(size=XY.shape)
        found = locate_board(camera, Observation(uv, XY, cov), root @ root.T)
        draws.append(as_vector(found))
        covariances.append(found.covariance)
    stated = np.mean(covariances, axis=0)
    sigma = np.sqrt(np.diag(stated))
    # The scatter of 250 draws is known to 4.5 %.
    np.testing.assert_allclose(np.std(draws, axis=0) / sigma, 1, atol=0.18)
    normal = (np.array(draws) - [*pose.rvec, *pose.tvec]) @ np.linalg.inv(
        np.linalg.cholesky(stated)
    ).T
    np.testing.assert_allclose(np.cov(normal.T), np.eye(6), atol=0.35)


def test_errors_of_the_camera_widen_the_pose(rng: np.random.Generator) -> None:
    camera, pose = brown(), looking(brown(), rng)
    view = (imaged(camera, pose, XY) + rng.normal(scale=0.1, size=XY.shape), XY)
    exact = locate_board(camera, view).sigma
    covariance = np.diag([1.0, *[0.0] * (len(camera.params) - 1)])
    assert (locate_board(camera, view, covariance).sigma > exact).all()


def test_mirrored_pose_is_told_from_near_and_not_from_far(rng: np.random.Generator) -> None:
    camera = Camera(VGA, [6000.0, 6000, 320, 240], "pinhole")
    for distance, is_certain in ((3000.0, True), (60_000.0, False)):
        centred = XY - XY.mean(axis=0)
        pose = Pose((0.5, 0.2, 0.0), (0, 0, distance))
        uv = imaged(camera, pose, centred) + rng.normal(scale=0.1, size=XY.shape)
        assert (locate_board(camera, (uv, centred)).lead > 3) == is_certain


def test_better_of_two_poses_is_found(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    """Also from a start on the wrong side."""
    camera = Camera(VGA, [5000.0, 5000, 320, 240], "pinhole")
    centred = XY - XY.mean(axis=0)
    pose = Pose((0.5, 0.2, 0.0), (0, 0, 5000))
    uv = imaged(camera, pose, centred) + rng.normal(scale=0.1, size=XY.shape)

    def start_mirrored(camera: Camera, views: Observations) -> State:
        return mirror_poses(estimate_poses(camera, views), views)

    monkeypatch.setattr(board_poses, "estimate_poses", start_mirrored)
    found = locate_board(camera, (uv, centred))
    assert np.linalg.norm(found.pose.rvec - pose.rvec) < 6 * found.sigma[:3].max()
    assert 3 < found.lead < np.inf


def test_noise_of_few_corners_is_right_on_the_mean(rng: np.random.Generator) -> None:
    camera, few = brown(), XY[[0, 11, 53, 96, 107]]
    exact = imaged(camera, Pose((0.4, -0.3, 0.1), (-140, -110, 700)), few)
    draws = [
        locate_board(camera, (exact + rng.normal(scale=0.3, size=few.shape), few)).noise
        for _ in range(400)
    ]
    assert np.sqrt(np.mean(np.square(draws))) == pytest.approx(0.3, rel=0.06)


def test_view_without_a_pose_is_named() -> None:
    with pytest.raises(CalibrationError, match=r"a\.png has 3 corners"):
        locate_board(brown(), (XY[:3], XY[:3]), name="a.png")
    camera = example("lucchese")
    far = 1e4 * (1 + imaged(camera, Pose((0, 0, 0), (-140, -110, 700)), XY))
    with pytest.raises(CalibrationError, match=r"a\.png: no pose of a flat board"):
        locate_board(camera, (far, XY), name="a.png")
