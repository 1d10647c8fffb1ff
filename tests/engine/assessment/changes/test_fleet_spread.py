"""The spread of a fleet: by where cameras image far points, not by their parameters."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.changes.fleet_spread import measure_fleet_spread
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import VGA


def make_fleet(count: int, seed: int) -> list[Camera]:
    rng = np.random.default_rng(seed)
    scatter = [1.0, 1.0, 2.0, 2.0, 0.002, 0.002, 1e-4, 1e-4, 0.0]
    middle = [650.0, 650.0, 320.0, 240.0, -0.2, 0.05, 0.0, 0.0, 0.0]
    return [Camera(VGA, rng.normal(middle, scatter), "brown-conrady") for _ in range(count)]


def test_the_odd_camera_has_the_largest_z() -> None:
    cameras = make_fleet(60, 1)
    cameras[17] = Camera(VGA, [650, 650, 320, 240, -0.12, 0.05, 0, 0, 0], "brown-conrady")
    spread = measure_fleet_spread(cameras)
    assert np.flatnonzero(spread.is_outlier).tolist() == [17]
    assert spread.z.argmax() == 17
    middle = Camera(VGA, [650, 650, 320, 240, -0.2, 0.05, 0, 0, 0], "brown-conrady")
    expected = compare_cameras(middle, cameras[17])
    assert spread.rms[17] == pytest.approx(expected.rms, rel=0.1)
    assert 0.7 * expected.worst < spread.worst[17] < 1.1 * expected.worst


def test_a_parameter_that_a_rotation_makes_up_for_does_not_count() -> None:
    """30 px of the centre at 6500 px focal length are a rotation, but the oddest parameter."""
    rng = np.random.default_rng(2)
    cameras = [
        Camera(VGA, [6500 * (1 + s), 6500 * (1 + s), 320, 240, *[0] * 5], "brown-conrady")
        for s in rng.normal(0, 1e-3, 40)
    ]
    cameras[3] = Camera(VGA, [6500, 6500, 350, 240, *[0] * 5], "brown-conrady")
    spread = measure_fleet_spread(cameras)
    assert not spread.is_outlier.any()
    assert spread.rms[3] < 0.1


def test_a_camera_that_has_nothing_in_common_is_an_outlier() -> None:
    cameras = make_fleet(20, 3)
    cameras[5] = Camera(VGA, [9.0, 9.0, 320, 240, *[0] * 5], "brown-conrady")
    spread = measure_fleet_spread(cameras)
    assert spread.is_outlier[5] and spread.z.argmax() == 5


def test_few_cameras_are_not_judged() -> None:
    spread = measure_fleet_spread(make_fleet(4, 4))
    assert np.isnan(spread.z).all() and not spread.is_outlier.any()
    assert np.isfinite(spread.rms).all()


def test_equal_cameras_are_no_outliers() -> None:
    spread = measure_fleet_spread(make_fleet(1, 5) * 10)
    assert np.abs(spread.rms).max() < 1e-9 and not spread.is_outlier.any()


def test_one_image_size_at_a_time() -> None:
    other = Camera((320, 240), [300, 300, 160, 120, *[0] * 5], "brown-conrady")
    with pytest.raises(CalibrationError, match="one image size"):
        measure_fleet_spread([*make_fleet(5, 6), other])
