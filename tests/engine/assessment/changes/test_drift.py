"""Drift: rate of false alarms, power, and what the test is blind to by design."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.changes.drift import (
    Drift,
    UncertainCamera,
    choose_covariance,
    measure_drift,
)
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.scenes import BOARD, barrel

NOISE = 0.03
"""About that of the corners of a rendered VGA photograph, px."""


def photograph(camera: Camera, count: int, rng: np.random.Generator) -> list[Observation]:
    """Views of the board inside the image, at distances that suit the focal length."""
    xy = BOARD.points()
    flat = np.pad(xy - xy.mean(axis=0), [(0, 0), (0, 1)])
    views: list[Observation] = []
    while len(views) < count:
        place = rng.uniform([-120, -90, 450], [120, 90, 800]) * [1, 1, camera.focal[0] / 650]
        p = flat @ rotation_from_vector(rng.uniform(-0.6, 0.6, 3)).T + place
        uv = pixels_from_rays(p, camera)
        if ((uv > 5) & (uv < np.array(camera.size) - 6)).all():
            views.append(Observation(uv + rng.normal(0, NOISE, uv.shape), xy))
    return views


def known(calibration: Calibration) -> UncertainCamera:
    return UncertainCamera(calibration.camera, choose_covariance(calibration))


def photographed_twice(change: Array | float, seed: int, distance: float = np.inf) -> Drift:
    """The drift between two calibrations, the camera changed between them."""
    rng, camera = np.random.default_rng(seed), barrel()
    changed = Camera(camera.size, camera.params * (1 + np.asarray(change)), camera.model)
    views = [photograph(c, 12, rng) for c in (camera, changed)]
    a, b = (calibrate(found, camera.size) for found in views)
    covered = views[0] if np.isfinite(distance) else None
    return measure_drift(known(a), known(b), distance=distance, views=covered)


@pytest.mark.parametrize(("distance", "count"), [(np.inf, 24), (600.0, 8)])
def test_an_unchanged_camera_is_seldom_said_to_have_changed(distance: float, count: int) -> None:
    drifts = [photographed_twice(0.0, seed, distance) for seed in range(count)]
    assert sum(drift.has_changed for drift in drifts) <= count / 8
    ratio = np.array([drift.difference.rms / drift.expected for drift in drifts])
    assert 0.6 < np.sqrt(np.mean(ratio**2)) < 1.4


def test_a_drift_of_a_third_of_a_pixel_is_found() -> None:
    scale = np.zeros(10)
    scale[:2] = 0.3 / 250  # 0.3 px at 250 px from the centre
    drifts = [photographed_twice(scale, 1000 + seed) for seed in range(10)]
    assert sum(drift.has_changed for drift in drifts) >= 9
    assert np.median([drift.difference.rms for drift in drifts]) == pytest.approx(0.3, abs=0.08)


def test_a_rotation_makes_up_for_a_shift_of_the_centre() -> None:
    found = calibrate(photograph(barrel(), 12, np.random.default_rng(1)), (640, 480))
    shifted = found.camera.params + np.array([0, 0, 2.0, 0, 0, 0, 0, 0, 0, 0])
    moved = known(found)._replace(camera=Camera((640, 480), shifted, found.camera.model))
    assert measure_drift(known(found), moved).difference.rms < 0.5


def test_lens_models_may_differ() -> None:
    views = photograph(barrel(), 12, np.random.default_rng(2))
    a, b = calibrate(views, (640, 480)), calibrate(views, (640, 480), model="kannala-brandt")
    drift = measure_drift(known(a), known(b))
    assert drift.freedom > 8
    assert np.isfinite(drift.chi_square)


def test_held_cameras_have_nothing_to_test() -> None:
    camera = UncertainCamera(barrel(), np.zeros((10, 10)))
    drift = measure_drift(camera, camera)
    assert (drift.freedom, drift.probability) == (0, 1.0)
