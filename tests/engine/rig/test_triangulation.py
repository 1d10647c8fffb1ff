"""Points are found where they are, by as many cameras as see them."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from calibgui.engine.camera.distortion import project_points
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.rig import Rig, calibrate_rig, triangulate_points
from tests.engine.rig.scenes import RigScene, compose, make_rig

POINTS = np.array([[60.0, 20.0, 700.0], [120.0, -40.0, 500.0], [0.0, 0.0, 1500.0]])


@pytest.fixture(scope="module")
def scene() -> RigScene:
    return make_rig(3, instants=16)


@pytest.fixture(scope="module")
def rig(scene: RigScene) -> Rig:
    return calibrate_rig(scene.noisy(0.1, np.random.default_rng(1)))


def see(rig: Rig, c: int) -> np.ndarray:
    return np.concatenate(
        [
            project_points(
                np.zeros((1, 2)), rig.cameras[c], compose(rig.poses[c], Pose(np.zeros(3), X))
            )
            for X in POINTS
        ]
    )


def test_points_come_back(rig: Rig) -> None:
    pixels = {c: see(rig, c) for c in range(3)}
    pixels[2][0] = np.nan
    found = triangulate_points(rig, pixels, 0.1)
    np.testing.assert_allclose(found.points, POINTS, atol=1e-8)
    assert np.isnan(found.residuals[2, 0]).all()
    assert (found.rms < 1e-9).all()


def test_errors_by_pixels_and_by_the_rig_are_their_derivatives(rig: Rig) -> None:
    """Both covariances are those of central differences."""
    pixels = {c: see(rig, c) for c in (0, 1)}
    sigma = 0.3
    exact = replace(rig, covariance=np.zeros_like(rig.covariance))
    J = []
    for c in (0, 1):
        for axis in (0, 1):
            ends = []
            for sign in (1, -1):
                moved = {k: uv.copy() for k, uv in pixels.items()}
                moved[c][:, axis] += sign * 1e-3
                ends.append(triangulate_points(exact, moved).points)
            J.append((ends[0] - ends[1]) / 2e-3)
    by_pixels = sigma**2 * np.einsum("jna,jnb->nab", J, J)
    found = triangulate_points(rig, pixels, sigma)
    np.testing.assert_allclose(found.by_pixels, by_pixels, rtol=1e-4, atol=1e-6)

    # An error of the second camera's pose alone.
    place = rig.layout.pose(1).start + 3
    one = np.zeros_like(rig.covariance)
    one[place, place] = 0.04
    ends = []
    for sign in (1, -1):
        tvec = rig.poses[1].tvec + np.array([sign * 1e-3, 0, 0])
        poses = (rig.poses[0], Pose(rig.poses[1].rvec, tvec), rig.poses[2])
        ends.append(triangulate_points(replace(rig, poses=poses), pixels).points)
    slope = (ends[0] - ends[1]) / 2e-3
    unseen = rig.layout.pose(2).start + 3
    one[unseen, unseen] = 0.04  # of a camera that takes no part
    found = triangulate_points(replace(rig, covariance=one), pixels)
    wanted = 0.04 * np.einsum("na,nb->nab", slope, slope)
    np.testing.assert_allclose(found.by_calibration, wanted, rtol=1e-4, atol=1e-6)


def test_two_pinholes_agree_with_opencv() -> None:
    from calibgui.engine.camera.camera import Camera

    plain = Camera((640, 480), [500.0, 500.0, 320.0, 240.0], "pinhole")
    scene = make_rig(2, instants=8, lenses=[plain])
    rig = calibrate_rig(scene.cameras)
    pixels = {c: see(rig, c) + 0.2 * (-1) ** c for c in (0, 1)}
    P = []
    for camera, pose in zip(rig.cameras, rig.poses, strict=True):
        R, _ = cv2.Rodrigues(pose.rvec.copy())
        P.append(camera.matrix @ np.c_[R, pose.tvec])
    R, T = cv2.Rodrigues(rig.poses[1].rvec.copy())[0], rig.poses[1].tvec
    K = [np.linalg.inv(camera.matrix) for camera in rig.cameras]
    cross = np.array([[0, -T[2], T[1]], [T[2], 0, -T[0]], [-T[1], T[0], 0]])
    F = K[1].T @ cross @ R @ K[0]
    matched = cv2.correctMatches(F, pixels[0][None].copy(), pixels[1][None].copy())
    X = cv2.triangulatePoints(P[0], P[1], matched[0][0].T.copy(), matched[1][0].T.copy())
    found = triangulate_points(rig, pixels)
    np.testing.assert_allclose(found.points, (X[:3] / X[3]).T, rtol=1e-6)


def test_a_point_that_one_camera_sees_has_no_place(rig: Rig) -> None:
    pixels = {c: see(rig, c) for c in (0, 1)}
    pixels[1][1] = np.nan
    found = triangulate_points(rig, pixels)
    assert np.isnan(found.points[1]).all()
    assert np.isfinite(found.points[[0, 2]]).all()
    with pytest.raises(CalibrationError, match="at least two cameras"):
        triangulate_points(rig, {0: see(rig, 0)})
    with pytest.raises(CalibrationError, match="at least two cameras"):
        triangulate_points(rig, {0: see(rig, 0), 7: see(rig, 1)})
