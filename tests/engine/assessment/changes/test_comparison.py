"""The difference of two cameras: what a motion undoes, what it leaves, and the errors."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibgui.engine.assessment.changes.comparison import compare_cameras, find_covered_pixels
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.uncertainty.projection_uncertainty import (
    back_project_pixels,
    estimate_projection_uncertainty,
)
from tests.engine.scenes import barrel, scene

PINHOLE = Camera((640, 480), [600, 600, 319.5, 239.5, 0, 0, 0, 0, 0, 0])


def _changed(camera: Camera, **changes: float) -> Camera:
    params = np.array(camera.params)
    for name, change in changes.items():
        params[("fx", "fy", "cx", "cy").index(name)] += change
    return Camera(camera.size, params, camera.model)


@pytest.mark.parametrize("distance", [np.inf, 500.0])
def test_a_camera_does_not_differ_from_itself(distance: float) -> None:
    found = compare_cameras(barrel(), barrel(), distance)
    assert found.worst < 1e-9
    assert np.abs(found.turn).max() < 1e-12


def test_a_shifted_centre_is_mostly_a_rotation() -> None:
    found = compare_cameras(PINHOLE, _changed(PINHOLE, cx=6.0))
    assert found.turn[1] == pytest.approx(-6 / 600, rel=0.3)  # towards the left
    assert found.median < 1.0
    assert found.worst < 4.0


def test_a_longer_lens_is_no_rotation() -> None:
    found = compare_cameras(PINHOLE, _changed(PINHOLE, fx=6.0, fy=6.0))
    corner = np.hypot(319.5, 239.5) * 6 / 600
    assert found.worst == pytest.approx(corner, rel=1e-3)
    assert np.abs(found.turn).max() < 1e-6


def test_a_longer_lens_is_a_shift_near_by() -> None:
    longer = _changed(PINHOLE, fx=6.0, fy=6.0)
    near = compare_cameras(PINHOLE, longer, 500.0)
    assert near.shift[2] == pytest.approx(5, rel=0.2)  # 1 % farther away
    assert near.worst < 0.2 * compare_cameras(PINHOLE, longer).worst


@given(st.tuples(*[st.floats(-0.02, 0.02)] * 3))
def test_the_rotation_is_the_best(turn: tuple[float, float, float]) -> None:
    other = _changed(barrel(), fx=3.0, cx=-4.0)
    found = compare_cameras(barrel(), other)
    uv = np.stack(np.meshgrid(found.u, found.v), axis=-1)
    p = back_project_pixels(uv, barrel(), np.inf)
    q = p @ (rotation_from_vector(np.array(turn)) @ rotation_from_vector(found.turn)).T
    length = np.linalg.norm(pixels_from_rays(q, other) - uv, axis=-1)
    assert found.rms <= np.sqrt(np.mean(length**2)) + 1e-9


def test_two_models_of_one_lens() -> None:
    views = scene(barrel(), 8).noisy(0.0, np.random.default_rng(0))
    result = calibrate(views, barrel().size)
    other = calibrate(views, barrel().size, model="brown-conrady")
    whole = compare_cameras(result.camera, other.camera)
    inside = compare_cameras(result.camera, other.camera, views=views)
    assert inside.median < 0.02
    assert inside.region.mean() < 1
    assert inside.rms <= whole.rms


def test_differences_of_recalibrations_are_what_the_uncertainty_predicts() -> None:
    true = scene(barrel(), 10)
    rng = np.random.default_rng(3)
    results = [calibrate(views, true.size) for views in (true.noisy(0.3, rng) for _ in range(16))]
    views = true.noisy(0.3, rng)
    expected = estimate_projection_uncertainty(calibrate(views, true.size), views).rms * np.sqrt(2)
    pairs = zip(results[::2], results[1::2], strict=True)
    found = [compare_cameras(a.camera, b.camera).vector for a, b in pairs]
    scatter = np.sqrt(np.mean(np.square(found), axis=(0, -1)))
    assert 0.5 < np.median(scatter / expected) < 1.2


def test_covered_is_the_hull_of_the_corners() -> None:
    square = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
    view = Observation(square, square)
    inside = find_covered_pixels(np.array([[5.0, 5.0], [11.0, 5.0], [0.0, 0.0]]), [view])
    assert inside.tolist() == [True, False, True]


def test_cameras_that_cannot_be_compared() -> None:
    with pytest.raises(CalibrationError, match="different sizes"):
        compare_cameras(barrel(), barrel(size=(320, 240)))
    with pytest.raises(CalibrationError, match="not in front"):
        compare_cameras(barrel(), barrel(), -5.0)
