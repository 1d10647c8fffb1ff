"""The refit that the exports hold: an independent measure of how far it is from the original."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from calibgui.dataset.result import Result
from calibgui.engine.arrays import Array
from calibgui.engine.calibration.refit import Refit
from calibgui.engine.camera.projection import rays
from calibgui.formats.forward_model import forward, refit_note
from tests.engine import scenes
from tests.formats.conftest import solved


def moved(result: Result, fitted: Refit, uv: Array) -> Array:
    """(n,) how far OpenCV images the calibrated camera's rays of pixels uv (n, 2) from them."""
    camera = fitted.calibration.camera
    points = np.append(rays(uv, result.calibration.camera), np.ones((len(uv), 1)), axis=1)
    imaged = cv2.projectPoints(
        points, np.zeros(3), np.zeros(3), camera.matrix, np.array(camera.coefficients)
    )[0]
    return np.linalg.norm(imaged.reshape(-1, 2) - uv, axis=1)


@pytest.mark.parametrize("name", ["result", "weighted"])
def test_the_stated_errors_bound_what_opencv_shows(
    name: str, request: pytest.FixtureRequest
) -> None:
    result = request.getfixturevalue(name)
    fitted = forward(result)
    corners = np.concatenate([uv for uv, *_ in result.observations()])
    assert moved(result, fitted, corners).max() == pytest.approx(fitted.covered_error, abs=1e-6)
    # The corners of the image, where the two models part most, and random pixels inside.
    w, h = result.calibration.camera.size
    inside = np.random.default_rng(0).uniform([0, 0], [w - 1, h - 1], (5000, 2))
    outline = np.array([[0, 0], [w - 1, 0], [0, h - 1], [w - 1, h - 1]], dtype=float)
    largest = moved(result, fitted, np.concatenate([inside, outline])).max()
    assert largest == pytest.approx(fitted.largest_error, rel=0.02)
    assert fitted.covered_error < 0.3 < 5 * fitted.covered_error + 1
    note = refit_note(result, fitted)
    assert f"{fitted.covered_error:.3g} px" in note and f"{fitted.largest_error:.3g} px" in note


def test_opencvs_model_is_exported_as_calibrated(forward_result: Result) -> None:
    fitted = forward(forward_result)
    assert fitted.calibration is forward_result.calibration
    assert fitted.largest_error == fitted.covered_error == 0.0
    assert "as calibrated" in refit_note(forward_result, fitted)


def test_what_was_held_stays_held() -> None:
    """A camera calibrated without distortion is not exported with some fitted to the noise."""
    lens = ["k1", "k2", "k3", "p1", "p2"]
    without = forward(solved(scenes.barrel(), fix=lens)).calibration.camera
    assert not without.coefficients.any()
    radial = forward(solved(scenes.barrel(), fix={"p1": 0.0, "p2": 0.0, "fx": 640.0}))
    assert radial.calibration.camera.params[0] == 640.0
    assert (radial.calibration.camera.coefficients == 0).tolist() == [0, 0, 1, 1, 0]


def test_a_model_that_cannot_follow_says_so(result: Result) -> None:
    fitted = Refit(forward(result).calibration, float("nan"), 0.05)
    assert "unlimited" in refit_note(result, fitted)


def test_a_model_that_cannot_follow_the_lens_is_not_recommended(result: Result) -> None:
    camera = forward(result).calibration
    assert "do not use it" in refit_note(result, Refit(camera, 190.0, 35.0))
    assert "do not use it" not in refit_note(result, Refit(camera, 0.3, 0.05))
