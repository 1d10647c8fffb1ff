"""Series: unseen zooms within their uncertainty, choice of the function, refusals."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.changes.drift import UncertainCamera, choose_covariance
from calibgui.engine.assessment.changes.series import Series, Setting, fit_series
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from tests.engine.assessment.changes.test_drift import photograph
from tests.engine.scenes import VGA

ZOOMS = np.linspace(18.0, 55.0, 12)


def zoomed(mm: float) -> Camera:
    """A lens whose focal length, centre and distortion vary with the zoom."""
    s = mm - 18.0
    f = 600 + 22 * s + 0.1 * s**2
    centre = [315 + 0.2 * s, 243 - 0.1 * s + 0.004 * s**2]
    distortion = [0.28 - 0.012 * s + 1e-4 * s**2, 0.1 - 0.004 * s, -0.04, 4e-4, -7e-4, 0.0]
    return Camera(VGA, [f, 1.001 * f, *centre, *distortion])


def make_series(seed: int) -> Series:
    rng = np.random.default_rng(seed)
    settings = []
    for mm in ZOOMS:
        found = calibrate(photograph(zoomed(mm), 12, rng), VGA)
        known = UncertainCamera(found.camera, choose_covariance(found))
        settings.append(Setting(float(mm), known))
    return fit_series(settings)


def miss(series: Series, mm: float) -> Array:
    """Errors of the camera at a zoom, in standard deviations."""
    known = series.predict(mm)
    sigma = np.sqrt(np.diag(known.covariance))[:9]
    return (known.camera.params - zoomed(mm).params)[:9] / sigma


def test_unseen_zooms_are_as_uncertain_as_is_said() -> None:
    between = (ZOOMS[:-1] + ZOOMS[1:]) / 2
    z = np.array([[miss(series, mm) for mm in between] for series in map(make_series, range(1))])
    assert np.sqrt(np.mean(z**2)) < 1.5
    assert np.median(np.abs(z)) > 0.3


def test_functions_that_are_too_simple_are_not_taken() -> None:
    series = make_series(7)
    assert series.errors["degree 0"] > 10 * series.errors[series.function]
    assert series.errors["degree 1"] > 5 * series.errors[series.function]


def exact(values: Array, params: Array, sigma: float = 0.01) -> list[Setting]:
    """Settings with given parameters and alike uncertainties."""
    covariance = np.diag([sigma**2] * 4 + [(1e-3 * sigma) ** 2] * 5 + [0.0])
    cameras = [Camera(VGA, row) for row in params]
    known = [UncertainCamera(camera, covariance) for camera in cameras]
    return [Setting(float(v), k) for v, k in zip(values, known, strict=True)]


def stepping(values: Array) -> Array:
    """Parameters with a step in the focal length."""
    params = np.tile(zoomed(18.0).params, (len(values), 1))
    params[:, :2] += 40.0 * (values > 0.5)[:, None]
    return params


def test_a_spline_follows_a_step_and_says_that_it_misses_it() -> None:
    values = np.linspace(0, 1, 9)
    series = fit_series(exact(values, stepping(values)))
    assert series.inflation > 100
    before = series.predict(0.2).camera.focal[0]
    assert abs(before - 600) < 3 * np.sqrt(series.predict(0.2).covariance[0, 0])


def test_a_polynomial_averages_over_settings() -> None:
    values = np.linspace(0, 1, 9)
    series = fit_series(exact(values, np.tile(zoomed(18.0).params, (9, 1))))
    assert series.function == "degree 0"
    np.testing.assert_allclose(np.sqrt(series.predict(0.5).covariance[0, 0]), 0.01 / 3, rtol=1e-6)
    assert series.predict(0.5).covariance[9, 9] == 0


def test_what_is_beyond_the_settings_is_refused() -> None:
    values = np.linspace(0, 1, 4)
    series = fit_series(exact(values, np.tile(zoomed(18.0).params, (4, 1))))
    with pytest.raises(CalibrationError, match="outside of the series"):
        series.predict(1.01)


def _with(setting: Setting, **change: object) -> Setting:
    return setting._replace(known=setting.known._replace(**change))


def test_settings_that_do_not_belong_together_are_refused() -> None:
    values = np.linspace(0, 1, 4)
    good = exact(values, np.tile(zoomed(18.0).params, (4, 1)))
    with pytest.raises(CalibrationError, match="2 settings"):
        fit_series(good[:2])
    with pytest.raises(CalibrationError, match="Several results are at 0"):
        fit_series([*good, good[0]])
    other = Camera((320, 240), zoomed(18.0).params)
    with pytest.raises(CalibrationError, match="different sizes"):
        fit_series([_with(good[0], camera=other), *good[1:]])
    brown = Camera(VGA, zoomed(18.0).params, "brown-conrady")
    with pytest.raises(CalibrationError, match="different lens models"):
        fit_series([_with(good[0], camera=brown), *good[1:]])
    held = np.diag([1e-4] * 4 + [1e-10] * 4 + [0.0] * 2)
    with pytest.raises(CalibrationError, match="Different parameters are held"):
        fit_series([_with(good[0], covariance=held), *good[1:]])
