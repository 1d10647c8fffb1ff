"""The same camera in another lens model: how near, and what is held."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.refit import measure_displacement, refit
from calibgui.engine.camera.camera import Camera
from tests.engine.scenes import VGA, barrel, imaged, scene


def test_forward_model_images_the_same_points() -> None:
    made = scene(barrel(0.9), 10, seed=1)
    original = calibrate(made.views, made.size)
    found = refit(made.views, original)
    assert found.calibration.camera.model == "brown-conrady"
    # Two polynomials of one degree are inverse to each other up to the next: measured 0.06 px.
    assert found.covered_error < 0.1
    assert found.covered_error <= found.largest_error < 1.0
    for pose, view in zip(found.calibration.poses, made.views, strict=True):
        miss = imaged(found.calibration.camera, pose, view.xy) - view.uv
        assert np.abs(miss).max() < 0.1


def test_there_and_back() -> None:
    made = scene(barrel(), 8, seed=1)
    views = made.noisy(0.1, np.random.default_rng(0))
    forward = refit(views, calibrate(views, made.size)).calibration
    back = refit(views, forward, model="lucchese").calibration
    straight = calibrate(views, made.size)
    sd = straight.sigma[:9]
    assert (np.abs(back.camera.params - straight.camera.params)[:9] < 1e-3 * sd).all()


def test_held_pinhole_parameters_stay_held() -> None:
    made = scene(barrel(), 8, seed=1)
    views = made.noisy(0.1, np.random.default_rng(0))
    original = calibrate(views, made.size, fix={"cx": 301.0, "k3": None})
    found = refit(views, original).calibration
    assert found.camera.params[2] == 301.0
    assert "k3" not in found.fixed


def test_a_lens_without_distortion_is_refitted_without() -> None:
    made = scene(Camera(VGA, [650, 650, 320, 240, 0, 0, 0, 0, 0, 0]), 6)
    original = calibrate(made.views, VGA, fix=["k1", "k2", "k3", "p1", "p2"])
    found = refit(made.views, original)
    assert not found.calibration.camera.coefficients.any()
    assert found.largest_error < 1e-6


def test_displacement_of_cameras_that_differ_by_their_centre() -> None:
    a = barrel()
    b = Camera(a.size, a.params + np.eye(10)[2] * 3.0)
    grid = np.stack(np.meshgrid(np.linspace(0, 639, 5), np.linspace(0, 479, 4)), axis=-1)
    assert measure_displacement(a, b, grid).shape == (4, 5)
    np.testing.assert_allclose(measure_displacement(a, b, grid), 3.0, atol=1e-9)


def test_where_a_lens_has_no_image_the_error_is_unknown() -> None:
    folded = Camera(VGA, [650, 650, 320, 240, -2.0, 0, 0, 0, 0, 0])
    wide = Camera(VGA, [400, 400, 320, 240, 0, 0, 0, 0, 0, 0])
    assert np.isnan(measure_displacement(wide, folded, np.array([[639.0, 479.0]]))).all()
    assert measure_displacement(wide, folded, np.array([[320.0, 240.0]])) == pytest.approx(0.0)
