"""From pixels to rays, and to places on a board's plane, with their covariances."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration import locate_board
from calibgui.engine.camera import Camera, pixels_from_rays
from calibgui.engine.geometry import Pose
from calibgui.engine.uncertainty import find_board_points, find_rays
from tests.engine.scenes import BOARD, LENSES, VGA, brown, example, imaged, looking

XY = BOARD.points()


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(4)


@pytest.mark.parametrize("model", LENSES)
def test_corners_come_back_from_their_pixels(model: str, rng: np.random.Generator) -> None:
    camera = example(model)
    pose = looking(camera, rng, fill=(0.4, 0.5))
    uv = imaged(camera, pose, XY)
    found = find_board_points(uv, camera, pose)
    np.testing.assert_allclose(found.points, XY, atol=1e-6)
    np.testing.assert_allclose(pixels_from_rays(found.rays.rays, camera), uv, atol=1e-9)


def scatter(points: Array, stated: Array) -> Array:
    """(n, d) scatter of draws over what is stated of it."""
    return points.std(axis=0) / np.sqrt(np.diagonal(stated.mean(axis=0), axis1=1, axis2=2))


def test_covariances_are_the_scatter_of_draws(rng: np.random.Generator) -> None:
    """Of the pixel, of the camera, and of the pose that is found with the wrong camera."""
    truth, pose = brown(), Pose((0.4, -0.3, 0.1), (-140, -110, 700))
    exact, xy = imaged(truth, pose, XY), np.array([[100.0, 100], [-40, -30], [350, 250]])
    uv = imaged(truth, pose, xy)
    root = np.diag([1.5, 1.0, 2.0, 2.0, 5e-3, 1e-2, 2e-4, 2e-4, 0.0, 0.0])
    root[1, 0] = 1.4
    covariance = root @ root.T
    draws = []
    for _ in range(80):
        camera = Camera(VGA, truth.params + root @ rng.normal(size=len(root)), truth.model)
        corners = exact + rng.normal(scale=0.3, size=XY.shape)
        board = locate_board(camera, (corners, XY), covariance)
        pixels = uv + rng.normal(scale=0.1, size=uv.shape)
        draws.append(find_board_points(pixels, camera, board, covariance, 0.1))
    points, of_points, rays, of_rays = (
        np.array(column)
        for column in zip(
            *((d.points, d.covariance, d.rays.rays, d.rays.covariance) for d in draws), strict=True
        )
    )
    # The scatter of 80 draws is known to 8 %.
    np.testing.assert_allclose(scatter(points, of_points), 1, atol=0.3)
    np.testing.assert_allclose(scatter(rays, of_rays), 1, atol=0.3)
    np.testing.assert_allclose(points.mean(axis=0), xy, atol=0.18)


def test_pixel_that_is_not_imaged_has_no_ray() -> None:
    camera = Camera(VGA, [300.0, 300, 320, 240, -0.2, 0, 0, 0, 0], "brown-conrady")
    found = find_rays([[320, 240], [-0.6, 240], [320, 479.4], [0, 0]], camera, sigma=0.1)
    has_ray = np.isfinite(found.rays).all(axis=1)
    assert found.is_in_image.tolist() == [True, False, True, True]
    assert has_ray.tolist() == [True, False, True, False]  # the lens folds before the corner
    assert np.isfinite(found.sigma).tolist() == has_ray.tolist()


def test_plane_behind_the_camera_is_not_met() -> None:
    camera = Camera(VGA, [300.0, 300, 320, 240], "pinhole")
    tilted = Pose((0.0, np.radians(30), 0.0), (0, 0, 500))
    found = find_board_points([[320.0, 240], [620, 240], [20, 240]], camera, tilted)
    assert np.isfinite(found.points).all(axis=1).tolist() == [True, True, True]
    steep = Pose((0.0, np.radians(80), 0.0), (0, 0, 500))
    found = find_board_points([[320.0, 240], [620, 240], [20, 240]], camera, steep)
    assert np.isfinite(found.points).all(axis=1).tolist() == [True, True, False]
