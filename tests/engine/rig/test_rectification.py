"""Rectified pairs have the same points in their rows, and OpenCV's matrices."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera, pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.rig import StereoPair, find_epipolar_line, rectify_pair, rectify_stereo_image

SIZE = (640, 480)
FIRST = Camera(SIZE, [520, 522, 315, 246, -0.2, 0.05, 1e-3, -5e-4, 0.01], "brown-conrady")
SECOND = Camera(SIZE, [510, 511, 325, 236, -0.19, 0.06, -5e-4, 8e-4, 0.0], "brown-conrady")
WIDE = Camera(SIZE, [180, 181, 322, 238, -0.02, 3e-3, -1e-3, 1e-4], "kannala-brandt")
ASIDE = Pose([0.02, -0.05, 0.03], [-80.0, 3.0, 5.0])
ABOVE = Pose([0.04, 0.02, -0.03], [4.0, -90.0, 6.0])
POINTS = np.random.default_rng(1).uniform([-250, -180, 600], [250, 180, 2500], (200, 3))


def see(pair: StereoPair, points: Array) -> tuple[Array, Array]:
    """The pixels of points in the first camera's frame in both images."""
    R = rotation_from_vector(pair.pose.rvec)
    return (
        pixels_from_rays(points, pair.cameras[0]),
        pixels_from_rays(points @ R.T + pair.pose.tvec, pair.cameras[1]),
    )


@pytest.mark.parametrize("cameras", [(FIRST, SECOND), (WIDE, WIDE)])
@pytest.mark.parametrize("pose", [ASIDE, ABOVE])
@pytest.mark.parametrize("is_angular", [False, True])
def test_rows_agree(cameras: tuple[Camera, Camera], pose: Pose, is_angular: bool) -> None:
    pair = rectify_pair(cameras, pose, is_angular=is_angular)
    assert pair.is_upright == (pose is ABOVE)
    assert np.abs(pair.measure_row_errors(*see(pair, POINTS))).max() < 1e-8
    for which in (0, 1):
        pixels = np.random.default_rng(2).uniform(0, SIZE, (50, 2))
        ideal = pair.ideal[which]
        rays = ideal.find_rays(pixels)
        shown = np.isfinite(rays).all(axis=1)
        assert shown.sum() > 40
        back = ideal.find_pixels(rays[shown])
        np.testing.assert_allclose(back, pixels[shown], atol=1e-9)


@pytest.mark.parametrize("pose", [ASIDE, ABOVE, Pose([0.02, 0.05, 0.0], [80.0, 3.0, 5.0])])
def test_disparities_lead_to_the_points(pose: Pose) -> None:
    pair = rectify_pair((FIRST, SECOND), pose)
    first, second = (pair.rectify_points(uv, which) for which, uv in enumerate(see(pair, POINTS)))
    along = 1 if pair.is_upright else 0
    d = first[:, along] - second[:, along]
    X = np.concatenate([first, d[:, None], np.ones((len(d), 1))], axis=1) @ (
        pair.disparity_to_depth.T
    )
    rectified = POINTS @ pair.rotations[0].T
    np.testing.assert_allclose(X[:, :3] / X[:, 3:], rectified, rtol=1e-9)
    assert pair.compute_disparity(rectified[0, 2]) == pytest.approx(d[0])
    for P, seen, start in zip(pair.projections, (first, second), (rectified,) * 2, strict=True):
        image = np.concatenate([start, np.ones((len(start), 1))], axis=1) @ P.T
        np.testing.assert_allclose(image[:, :2] / image[:, 2:], seen, atol=1e-8)


def test_matrices_are_those_of_opencv() -> None:
    pair = rectify_pair((FIRST, SECOND), ASIDE)
    K = [camera.matrix for camera in pair.cameras]
    D = [camera.coefficients[:5].copy() for camera in pair.cameras]
    R, T = rotation_from_vector(ASIDE.rvec), ASIDE.tvec[:, None].copy()
    found = cv2.stereoRectify(K[0], D[0], K[1], D[1], SIZE, R, T, alpha=-1)
    # The x axes are the same; about them OpenCV turns by half of the whole rotation.
    for ours, theirs in zip(pair.rotations, found[:2], strict=True):
        np.testing.assert_allclose(ours[0], theirs[0], atol=1e-9)
    angle = np.arccos(np.clip((np.trace(pair.rotations[0] @ found[0].T) - 1) / 2, -1, 1))
    assert np.degrees(angle) < 0.5
    np.testing.assert_allclose(
        pair.projections[1][0, 3] / pair.projections[0][0, 0], -pair.baseline
    )


def test_the_fundamental_matrix_and_the_line_hold_the_point() -> None:
    pair = rectify_pair((FIRST, SECOND), ASIDE)
    first, second = see(pair, POINTS)
    plain = []
    for uv, camera in zip((first, second), pair.cameras, strict=True):
        undistorted = cv2.undistortPoints(
            uv[:, None].copy(), camera.matrix, camera.coefficients[:5].copy(), P=camera.matrix,
            criteria=(3, 200, 1e-14),
        )  # fmt: skip
        plain.append(np.concatenate([undistorted[:, 0], np.ones((len(uv), 1))], axis=1))
    side = np.einsum("ni,ij,nj->n", plain[1], pair.fundamental, plain[0])
    assert np.abs(side).max() < 1e-6
    seen = [k for k in range(len(POINTS)) if ((second[k] > 20) & (second[k] < [620, 460])).all()]
    for k in seen[:5]:
        line = find_epipolar_line(pair, first[k], 2000)
        assert np.linalg.norm(line - second[k], axis=1).min() < 2.0


def test_images_are_moved_as_points_are() -> None:
    pair = rectify_pair((FIRST, SECOND), ASIDE)
    image = np.zeros((480, 640), np.float32)
    u, v = 400, 150
    image[v - 2 : v + 3, u - 2 : u + 3] = 1.0
    moved = rectify_stereo_image(image, pair, 0).image
    place = np.indices(moved.shape).reshape(2, -1) @ moved.ravel() / moved.sum()
    np.testing.assert_allclose(place[::-1], pair.rectify_points(np.array([u, v]), 0), atol=0.1)


def test_cameras_that_have_no_rows_in_common_are_refused() -> None:
    with pytest.raises(CalibrationError, match="along the line of their centres"):
        rectify_pair((FIRST, SECOND), Pose([0.0, 0.0, 0.0], [0.0, 0.0, -100.0]))
    with pytest.raises(CalibrationError, match="away from each other"):
        rectify_pair((FIRST, SECOND), Pose([0.0, np.pi, 0.0], [-100.0, 0.0, 0.0]))
    with pytest.raises(CalibrationError, match="one place"):
        rectify_pair((FIRST, SECOND), Pose([0.0, 0.1, 0.0], [0.0, 0.0, 0.0]))
