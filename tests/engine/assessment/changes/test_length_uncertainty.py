"""The error of lengths against those that calibrations from drawn noise make."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.changes.length_uncertainty import estimate_length_uncertainty
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.image_circle import ImageCircle
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.scenes import TRUE_BOARD, VGA, barrel, scene

LENGTH, DEPTH, NOISE = 100.0, 800.0, 0.15


def measure(camera: Camera, R: Array, ends: Array) -> Array:
    """The lengths (n,) between pixels (n, 2, 2) of a camera, turned by R, in the plane."""
    rays = rays_from_pixels(ends, camera) @ R
    points = DEPTH * rays / rays[..., 2:]
    return np.linalg.norm(points[:, 1] - points[:, 0], axis=-1)


@pytest.mark.slow
def test_the_errors_of_drawn_calibrations_are_as_large_as_is_said() -> None:
    made, rng = scene(barrel(), 10, seed=3), np.random.default_rng(5)
    uv = np.array([[320.0, 240.0], [120.0, 100.0], [540.0, 380.0]])
    centre = rays_from_pixels(uv, made.camera)
    centre *= DEPTH / centre[:, 2:]
    steps = LENGTH / 2 * np.array([[-1.0, 0, 0], [1, 0, 0]])
    across = pixels_from_rays(centre[:, None] + steps, made.camera)
    down = pixels_from_rays(centre[:, None] + steps[:, [1, 0, 2]], made.camera)
    by_camera, whole, stated = [], [], []
    for _ in range(60):
        views = made.noisy(NOISE, rng)
        found = calibrate(views, VGA, fix=["k3"], prior=TRUE_BOARD)
        R = rotation_from_vector(compare_cameras(made.camera, found.camera, views=views).turn)
        lengths = np.stack([measure(found.camera, R, ends) for ends in (across, down)])
        by_camera.append(lengths - LENGTH)
        seen = [ends + rng.normal(0, NOISE, ends.shape) for ends in (across, down)]
        whole.append(np.stack([measure(found.camera, R, ends) for ends in seen]) - LENGTH)
        said = estimate_length_uncertainty(found, views, LENGTH, DEPTH, uv)
        stated.append([said.by_calibration, said.sigma])
    said_camera, said_whole = np.mean(stated, axis=0)
    # Of 60 draws a standard deviation is known to 9 %.
    np.testing.assert_allclose(np.std(whole, axis=0).max(axis=0), said_whole, rtol=0.3)
    assert 0.75 < np.median(np.std(by_camera, axis=0).max(axis=0) / said_camera) < 1.35


def test_noise_alone_is_what_the_scale_of_the_image_makes_of_it() -> None:
    views = scene(barrel(), 8).noisy(0.1, np.random.default_rng(1))
    calibration = calibrate(views, VGA)
    found = estimate_length_uncertainty(calibration, views, 1.0, DEPTH, [[309.5, 247.3]])
    expected = np.sqrt(2) * calibration.noise * DEPTH / calibration.camera.focal.min()
    assert found.by_noise[0] == pytest.approx(expected, rel=0.01)
    assert found.by_calibration[0] < 0.01 * found.by_noise[0]


def test_lengths_that_do_not_lie_in_the_image_are_unknown() -> None:
    views = scene(barrel(), 8).noisy(0.1, np.random.default_rng(1))
    calibration = calibrate(views, VGA)
    over_image = estimate_length_uncertainty(calibration, views, LENGTH, DEPTH)
    assert np.isnan(over_image.sigma[0]) and np.isfinite(over_image.sigma).mean() > 0.5
    assert over_image.sigma[over_image.worst] == np.nanmax(over_image.sigma)
    with pytest.raises(CalibrationError, match="does not lie in the image"):
        estimate_length_uncertainty(calibration, views, 2000.0, DEPTH)
    with pytest.raises(CalibrationError, match="above 0"):
        estimate_length_uncertainty(calibration, views, 10.0, -1.0)
    circle = ImageCircle(320, 240, 100)
    lit = replace(calibration, camera=replace(calibration.camera, circle=circle))
    within = estimate_length_uncertainty(lit, views, 10.0, DEPTH)
    assert circle.contains(within.uv[np.isfinite(within.sigma)]).all()


def test_the_scale_of_the_board_goes_one_to_one_into_lengths() -> None:
    views = scene(barrel(), 8).noisy(0.1, np.random.default_rng(1))
    calibration = calibrate(views, VGA)
    uv = [[320.0, 240.0]]
    exact = estimate_length_uncertainty(calibration, views, LENGTH, DEPTH, uv)
    board = Board(5, 6, 30.0, square_sigma=0.06)
    found = estimate_length_uncertainty(calibration, views, LENGTH, DEPTH, uv, board.scale_sigma)
    # A camera from a board that is 0.2 % longer than stated measures lengths 0.2 % too short.
    assert found.by_scale == pytest.approx(0.2)
    assert found.sigma[0] ** 2 == pytest.approx(exact.sigma[0] ** 2 + 0.2**2)
    assert sum(found.shares) == pytest.approx(1.0)
    assert exact.shares[2] == 0.0
