"""Heikkilä and Silvén's fit against truth, and their inverse model against the exact inverse."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods.heikkila_silven import HEIKKILA_SILVEN, fit_inverse_model
from calibgui.engine.calibration.result import Status
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import undistort_points
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import VGA, brown, relative, scene, stored

MODEL = "brown-conrady-4"
K1, K2, P1, P2 = -0.25, 0.12, 3e-4, -5e-4
CAMERA = Camera(VGA, [650, 655, 303, 243, K1, K2, P1, P2], MODEL)
FOLDING = Camera(VGA, [650, 655, 303, 243, -1.5, 0, 0, 0], MODEL)


def distort(ideal: Array, camera: Camera = CAMERA) -> Array:
    """The paper's lens, written out: ideal to measured pixels (n, 2)."""
    k1, k2, p1, p2 = camera.coefficients[:4]
    x, y = ((ideal - camera.centre) / camera.focal).T
    r2 = x**2 + y**2
    radial = 1 + k1 * r2 + k2 * r2**2
    moved = np.column_stack(
        [
            x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x**2),
            y * radial + p1 * (r2 + 2 * y**2) + 2 * p2 * x * y,
        ]
    )
    return moved * camera.focal + camera.centre


def spread_pixels() -> Array:
    return np.random.default_rng(1).uniform([0, 0], np.array(VGA) - 1, (5000, 2))


def test_the_fit_is_exact_on_its_own_model() -> None:
    truth = scene(CAMERA, 6, seed=1)
    found = calibrate(truth.views, VGA, method=HEIKKILA_SILVEN)
    np.testing.assert_allclose(found.camera.params, CAMERA.params, rtol=1e-6, atol=1e-9)
    for pose, true in zip(found.poses, truth.poses, strict=True):
        assert relative(pose.rvec, true.rvec) < 1e-6
        assert relative(pose.tvec, true.tvec) < 1e-6
    assert found.fixed == ("skew",)


def test_the_fit_is_maximum_likelihood_under_noise() -> None:
    views = scene(CAMERA, 6, seed=1).noisy(0.1, np.random.default_rng(0))
    found = calibrate(views, VGA, method=HEIKKILA_SILVEN)
    best = calibrate(views, VGA, model=MODEL)
    assert found.status is Status.CONVERGED
    deviation = np.abs(found.camera.params - best.camera.params)
    assert (deviation <= 1e-4 * np.nan_to_num(best.sigma)).all()


@pytest.mark.data
def test_the_fit_on_bouguets_corners(data_dir: Path) -> None:
    folder = data_dir / "bouguet_calib_example" / "corners_and_results"
    views, size = stored(folder / "corners_25img__benJephunneh.json")
    found = calibrate(views, size, method=HEIKKILA_SILVEN)
    published = [657.3254, 657.7881, 303.0625, 242.5060]  # without skew, the same cost
    np.testing.assert_allclose(found.camera.params[:4], published, atol=2e-4)
    model = fit_inverse_model(found.camera)
    assert model.max_error < 0.03
    assert model.rms_error < 0.003


def test_the_inverse_model_undoes_the_lens() -> None:
    model = fit_inverse_model(CAMERA)
    uv = spread_pixels()
    exact = undistort_points(uv, CAMERA)
    np.testing.assert_allclose(distort(exact), uv, atol=1e-8)
    error = np.linalg.norm(model.correct_points(uv) - exact, axis=1)
    assert error.max() <= model.max_error < 0.05
    assert np.sqrt(np.mean(error**2)) == pytest.approx(model.rms_error, rel=0.2)
    # An uncorrected image is off by tens of pixels.
    assert np.linalg.norm(uv - exact, axis=1).max() > 10


def test_the_inverse_model_is_as_good_as_from_a_grid_of_ideal_points() -> None:
    """The paper's own way, which needs no exact inverse: their grid is distorted."""
    grid = np.stack(np.meshgrid(np.linspace(-45, 690, 40), np.linspace(-35, 515, 40)), axis=-1)
    ideal = grid.reshape(-1, 2)
    (x, y), (xd, yd) = (((uv - CAMERA.centre) / CAMERA.focal).T for uv in (ideal, distort(ideal)))
    r2 = xd**2 + yd**2
    of_x = [-xd * r2, -xd * r2**2, -2 * xd * yd, -(r2 + 2 * xd**2)]
    of_y = [-yd * r2, -yd * r2**2, -(r2 + 2 * yd**2), -2 * xd * yd]
    rows_x = [*of_x, x * r2**2, x * xd * r2, x * yd * r2, x * r2]
    rows_y = [*of_y, y * r2**2, y * xd * r2, y * yd * r2, y * r2]
    T = np.hstack([np.array(rows_x), np.array(rows_y)]).T
    a = np.linalg.lstsq(T, np.concatenate([xd - x, yd - y]), rcond=None)[0]
    model = fit_inverse_model(CAMERA)
    np.testing.assert_allclose(model.coefficients, a, rtol=0.05, atol=1e-4)


def test_the_inverse_model_of_an_ideal_lens_is_the_identity() -> None:
    model = fit_inverse_model(Camera(VGA, [650, 655, 303, 243, 0, 0, 0, 0], MODEL))
    np.testing.assert_allclose(model.correct_points(spread_pixels()), spread_pixels(), atol=1e-9)
    assert model.max_error < 1e-9


def test_the_inverse_model_knows_a_skew() -> None:
    camera = Camera(VGA, [*CAMERA.params[:8], 0.01], MODEL)
    model = fit_inverse_model(camera)
    uv = spread_pixels()
    error = np.linalg.norm(model.correct_points(uv) - undistort_points(uv, camera), axis=1)
    assert error.max() <= 1.05 * model.max_error < 0.05


def test_a_lens_that_folds_over_has_no_inverse_model() -> None:
    with pytest.raises(CalibrationError, match="folds over within the image"):
        fit_inverse_model(FOLDING)


def test_other_lens_models_are_refused() -> None:
    with pytest.raises(CalibrationError, match="not of 'brown-conrady'"):
        fit_inverse_model(brown())


def test_remarks_state_the_inverse_model() -> None:
    views = scene(CAMERA, 4, seed=1).views
    found = calibrate(views, VGA, method=HEIKKILA_SILVEN)
    model = fit_inverse_model(found.camera)
    coefficients, errors = HEIKKILA_SILVEN.list_remarks(found)
    values = [float(value) for value in re.findall(r"a\d = (-?[\d.e-]+),", coefficients)]
    assert values == pytest.approx(model.coefficients.tolist(), rel=1e-3)
    told = [float(value) for value in re.findall(r"([\d.e-]+) px", errors)]
    assert told == pytest.approx([model.max_error, model.rms_error], rel=0.05)
