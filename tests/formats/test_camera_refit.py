"""The refit that the exports hold: an independent measure of how far it is from the original."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.calibration.refit import Refit
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.formats import EXPORTERS, export
from calibgui.formats.camera_refit import (
    FORWARD_MODELS,
    MAX_REFIT_ERROR,
    check_refit,
    describe_refit,
    express_in_models,
)
from tests.engine import scenes
from tests.formats.conftest import solved


def moved(result: Result, fitted: Refit, uv: Array) -> Array:
    """(n,) how far OpenCV images the calibrated camera's rays of pixels uv (n, 2) from them."""
    camera = fitted.calibration.camera
    points = np.append(
        rays_from_pixels(uv, result.calibration.camera), np.ones((len(uv), 1)), axis=1
    )
    imaged = cv2.projectPoints(
        points, np.zeros(3), np.zeros(3), camera.matrix, np.array(camera.coefficients)
    )[0]
    return np.linalg.norm(imaged.reshape(-1, 2) - uv, axis=1)


@pytest.mark.parametrize("name", ["result", "weighted"])
def test_the_stated_errors_bound_what_opencv_shows(
    name: str, request: pytest.FixtureRequest
) -> None:
    result = request.getfixturevalue(name)
    fitted = express_in_models(result)
    corners = np.concatenate([uv for uv, *_ in result.observations()])
    assert moved(result, fitted, corners).max() == pytest.approx(fitted.covered_error, abs=1e-6)
    # The corners of the image, where the two models part most, and random pixels inside.
    w, h = result.calibration.camera.size
    inside = np.random.default_rng(0).uniform([0, 0], [w - 1, h - 1], (5000, 2))
    outline = np.array([[0, 0], [w - 1, 0], [0, h - 1], [w - 1, h - 1]], dtype=float)
    largest = moved(result, fitted, np.concatenate([inside, outline])).max()
    assert largest == pytest.approx(fitted.largest_error, rel=0.02)
    assert fitted.covered_error < 0.3 < 5 * fitted.covered_error + 1
    note = describe_refit(result, fitted)
    assert f"{fitted.covered_error:.3g} px" in note and f"{fitted.largest_error:.3g} px" in note


def test_opencvs_model_is_exported_as_calibrated(forward_result: Result) -> None:
    fitted = express_in_models(forward_result)
    assert fitted.calibration is forward_result.calibration
    assert fitted.largest_error == fitted.covered_error == 0.0
    assert "as calibrated" in describe_refit(forward_result, fitted)


def test_what_was_held_stays_held() -> None:
    """A camera calibrated without distortion is not exported with some fitted to the noise."""
    lens = ["k1", "k2", "k3", "p1", "p2"]
    without = express_in_models(solved(scenes.barrel(), fix=lens)).calibration.camera
    assert not without.coefficients.any()
    radial = express_in_models(solved(scenes.barrel(), fix={"p1": 0.0, "p2": 0.0, "fx": 640.0}))
    assert radial.calibration.camera.params[0] == 640.0
    assert (radial.calibration.camera.coefficients == 0).tolist() == [0, 0, 1, 1, 0]


def test_a_model_that_cannot_follow_says_so(result: Result) -> None:
    fitted = Refit(express_in_models(result).calibration, float("nan"), 0.05)
    assert "unlimited" in describe_refit(result, fitted)


@pytest.fixture(scope="module")
def fisheye() -> Result:
    """A fisheye in the paper's model, which follows it; OpenCV's polynomial folds back."""
    lens = [0.389, -0.021, 0.207, 0.0, 0.0, 0.0]
    return solved(Camera((640, 480), [282.0, 282.0, 319.5, 239.5, *lens]))


FORWARD = [name for name, exporter in EXPORTERS.items() if exporter.models == FORWARD_MODELS]


@pytest.mark.parametrize("name", FORWARD)
def test_a_lens_that_the_model_cannot_follow_is_refused(
    fisheye: Result, tmp_path: Path, name: str
) -> None:
    file = (tmp_path / "camera").with_suffix(EXPORTERS[name].suffixes[0])
    with pytest.raises(
        CalibrationError, match=r"Brown-Conrady.* cannot follow this lens"
    ) as caught:
        export(fisheye, name, file)
    assert not list(tmp_path.iterdir())
    assert str(file) in caught.value.message
    assert "--model brown-conrady" in caught.value.hint and "'python'" in caught.value.hint
    # The stated place and error are the worst among the corners, by OpenCV itself.
    corners = np.concatenate([uv for uv, *_ in fisheye.observations()])
    error = moved(fisheye, express_in_models(fisheye), corners)
    u, v = corners[np.argmax(error)]
    assert error.max() > MAX_REFIT_ERROR
    assert f"({u:.0f}, {v:.0f}) px" in caught.value.message
    assert f"is {error.max():.3g} px off" in caught.value.message


def test_the_same_lens_is_written_in_its_own_model(fisheye: Result, tmp_path: Path) -> None:
    for name in EXPORTERS.keys() - set(FORWARD):
        export(fisheye, name, (tmp_path / name).with_suffix(EXPORTERS[name].suffixes[0]))
    assert len(list(tmp_path.iterdir())) == len(EXPORTERS) - len(FORWARD)


@pytest.mark.parametrize("error", [MAX_REFIT_ERROR, float("nan")])
def test_a_refit_is_refused_from_the_limit_on(result: Result, error: float) -> None:
    camera = express_in_models(result).calibration
    with pytest.raises(CalibrationError, match="cannot follow this lens"):
        check_refit(result, Refit(camera, 190.0, error), Path("camera.yaml"))
    check_refit(result, Refit(camera, 190.0, 0.99 * MAX_REFIT_ERROR), Path("camera.yaml"))
