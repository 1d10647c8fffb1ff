"""The uncertainty of a camera against the truth, and against what it leaves out."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.changes.camera_uncertainty import estimate_camera_uncertainty
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.camera.camera import Camera
from calibgui.engine.uncertainty.projection_uncertainty import estimate_projection_uncertainty
from tests.engine.scenes import VGA, barrel, looking, scene, seen

TELEPHOTO = Camera(VGA, [7300, 7300, 310, 246, 0.01, 0, 0, 0, 0], "brown-conrady")
"""A lens of 5 degrees."""


def test_a_rotation_that_no_camera_suffers_from_is_left_out() -> None:
    stated, fixed, true = [], [], []
    for seed in range(4):
        rng = np.random.default_rng(seed)
        poses = [looking(TELEPHOTO, rng) for _ in range(14)]
        views = seen(TELEPHOTO, poses, partial=True).noisy(0.05, rng)
        calibration = calibrate(views, VGA, model="brown-conrady")
        found = estimate_camera_uncertainty(calibration, views)
        stated.append(found.median)
        true.append(compare_cameras(TELEPHOTO, calibration.camera, views=views).rms)
        fixed.append(estimate_projection_uncertainty(calibration, views).median)
    assert np.linalg.norm(fixed) > 3 * np.linalg.norm(true)
    assert 0.5 < np.linalg.norm(true) / np.linalg.norm(stated) < 1.5


def test_it_is_at_most_that_of_points_fixed_to_the_boards_where_there_are_corners() -> None:
    views = scene(barrel(), 8).noisy(0.2, np.random.default_rng(1))
    calibration = calibrate(views, VGA)
    found = estimate_camera_uncertainty(calibration, views)
    fixed = estimate_projection_uncertainty(calibration, views)
    assert found.centre < fixed.centre
    assert found.median < fixed.median
    np.testing.assert_array_equal(found.u, fixed.u)
    assert found.distance == np.inf


def test_pixels_that_the_lens_does_not_see_are_unknown() -> None:
    """A fisheye's circle ends within the image."""
    params = [110, 110, 320, 240, -0.02, 0, 0, 0]
    camera = Camera(VGA, params, "kannala-brandt")
    rng = np.random.default_rng(0)
    poses = [looking(camera, rng, fill=(0.3, 0.5)) for _ in range(8)]
    views = seen(camera, poses, partial=True).noisy(0.1, rng)
    found = estimate_camera_uncertainty(calibrate(views, VGA, model="kannala-brandt"), views)
    assert np.isfinite(found.centre)
    assert found.centre == pytest.approx(found.worst_direction[15, 20])
