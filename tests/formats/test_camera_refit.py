"""The refit that the exports hold: an independent measure of how far it is from the original."""

from __future__ import annotations

import math
from dataclasses import replace
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
from calibgui.formats import EXPORTERS, camera_refit, export
from calibgui.formats.camera_refit import (
    MAX_REFIT_ERROR,
    check_refit,
    describe_refit,
    express_in_format,
    write_in_models,
)
from tests.engine import scenes
from tests.formats.cameras import holding
from tests.formats.conftest import solved

OPENCV = EXPORTERS["opencv"]


def moved(result: Result, fitted: Refit, uv: Array) -> Array:
    """(n,) how far OpenCV images the calibrated camera's rays of pixels uv (n, 2) from them."""
    camera = fitted.calibration.camera
    points = rays_from_pixels(uv, result.calibration.camera)
    imaged = cv2.projectPoints(
        points, np.zeros(3), np.zeros(3), camera.matrix, np.array(camera.coefficients[:5])
    )[0]
    return np.linalg.norm(imaged.reshape(-1, 2) - uv, axis=1)


@pytest.mark.parametrize("name", ["result", "weighted"])
def test_the_stated_errors_bound_what_opencv_shows(
    name: str, request: pytest.FixtureRequest
) -> None:
    result = request.getfixturevalue(name)
    fitted = express_in_format(result, OPENCV)
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
    fitted = express_in_format(forward_result, OPENCV)
    assert fitted.calibration is forward_result.calibration
    assert fitted.largest_error == fitted.covered_error == 0.0
    assert "as calibrated" in describe_refit(forward_result, fitted)


def test_what_was_held_stays_held() -> None:
    """A camera calibrated without distortion is not exported with some fitted to the noise."""
    lens = ["k1", "k2", "k3", "p1", "p2"]
    without = express_in_format(solved(scenes.barrel(), fix=lens), OPENCV).calibration.camera
    assert not without.coefficients.any()
    held = solved(scenes.barrel(), fix={"p1": 0.0, "p2": 0.0, "fx": 640.0})
    radial = express_in_format(held, OPENCV)
    assert radial.calibration.camera.params[0] == 640.0
    assert (radial.calibration.camera.coefficients[:5] == 0).tolist() == [0, 0, 1, 1, 0]


def test_a_model_that_cannot_follow_says_so(result: Result) -> None:
    fitted = Refit(express_in_format(result, OPENCV).calibration, float("nan"), 0.05)
    assert "unlimited" in describe_refit(result, fitted)


def test_views_that_determine_no_model_of_a_format_are_told_with_its_file(
    result: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> Refit:
        raise CalibrationError("All corners lie in one spot.", "Fill the image.")

    monkeypatch.setattr(camera_refit, "refit", fail)
    with pytest.raises(CalibrationError) as caught:
        export(result, "opencv", tmp_path / "camera.yaml")
    assert "camera.yaml is not written: the format 'opencv' has no" in caught.value.message
    assert caught.value.message.endswith("All corners lie in one spot.")
    assert caught.value.hint == "Fill the image."


@pytest.fixture(scope="module")
def fisheye() -> Result:
    """A fisheye in the paper's model, which follows it; OpenCV's polynomial folds back."""
    lens = [0.389, -0.021, 0.207, 0.0, 0.0, 0.0]
    return solved(Camera((640, 480), [282.0, 282.0, 319.5, 239.5, *lens]))


REFITTING = [name for name, exporter in EXPORTERS.items() if exporter.refits]


PERSPECTIVE_ALONE = [name for name in REFITTING if len(EXPORTERS[name].refits) == 1]


@pytest.mark.parametrize("name", PERSPECTIVE_ALONE)
def test_a_fisheye_is_refused_where_there_is_no_such_model(
    fisheye: Result, tmp_path: Path, name: str
) -> None:
    with pytest.raises(CalibrationError, match="cannot follow this lens"):
        export(fisheye, name, tmp_path / EXPORTERS[name].file_name)


@pytest.mark.parametrize("name", [name for name in REFITTING if name not in PERSPECTIVE_ALONE])
def test_a_fisheye_is_refitted_in_a_model_that_follows_it(
    fisheye: Result, tmp_path: Path, name: str
) -> None:
    """Brown's polynomial, which comes first, is some 15 px off."""
    exporter = EXPORTERS[name]
    assert exporter.refits[0] in ("brown-conrady", "brown-conrady-4")
    expressed = express_in_format(fisheye, exporter)
    assert expressed.calibration.camera.model == exporter.refits[1]
    assert expressed.covered_error < 1
    file = tmp_path / exporter.file_name
    report = export(fisheye, name, file)
    assert f"{expressed.covered_error:.3g} px where corners were seen" in report.note


def test_a_lens_that_looks_sideways_is_refitted_in_a_fisheye_model(
    result: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Brown's model may follow it where corners were seen, but has no image beyond 90 degrees."""
    wide = Camera((640, 480), [150, 150, 319.5, 239.5, -0.2, 0.55], "double-sphere")
    assert rays_from_pixels(np.zeros(2), wide)[2] < 0
    fits = {
        "brown-conrady": Camera((640, 480), [200, 200, 319.5, 239.5, *[0] * 5], "brown-conrady"),
        "kannala-brandt": Camera((640, 480), [200, 200, 319.5, 239.5, *[0] * 4], "kannala-brandt"),
    }
    errors = {"brown-conrady": 0.05, "kannala-brandt": 0.5}

    def refit(_views: object, _original: object, model: str, _zeros: object) -> Refit:
        return Refit(replace(result.calibration, camera=fits[model]), math.nan, errors[model])

    monkeypatch.setattr("calibgui.formats.camera_refit.refit", refit)
    seen = holding(result, wide)
    assert express_in_format(seen, OPENCV).calibration.camera.model == "kannala-brandt"
    errors["kannala-brandt"] = MAX_REFIT_ERROR  # no fisheye's curve: better the middle than nothing
    assert express_in_format(seen, OPENCV).calibration.camera.model == "brown-conrady"


def test_a_model_that_fails_leaves_the_others(
    result: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_views: object, _original: object, model: str, _zeros: object) -> Refit:
        if model == "brown-conrady":
            raise CalibrationError("These views leave k3 undetermined.")
        return Refit(result.calibration, 0.5, 0.5)

    monkeypatch.setattr("calibgui.formats.camera_refit.refit", fail)
    assert express_in_format(result, OPENCV).covered_error == 0.5
    with pytest.raises(CalibrationError, match="k3 undetermined"):
        express_in_format(result, replace(OPENCV, refits=("brown-conrady",)))


def test_a_simple_model_that_follows_is_preferred(result: Result) -> None:
    for name in REFITTING:
        exporter = EXPORTERS[name]
        assert express_in_format(result, exporter).calibration.camera.model == exporter.refits[0]


def test_a_lens_that_no_model_can_follow_is_refused(fisheye: Result, tmp_path: Path) -> None:
    file = tmp_path / "camera.yaml"
    narrow = replace(OPENCV, models=("brown-conrady",), refits=("brown-conrady",))
    with pytest.raises(
        CalibrationError, match=r"Brown-Conrady.* cannot follow this lens"
    ) as caught:
        write_in_models(fisheye, file, narrow, lambda *_: "")
    assert not list(tmp_path.iterdir())
    assert str(file) in caught.value.message
    assert "lens model brown-conrady" in caught.value.hint and "'python'" in caught.value.hint
    # The stated place and error are the worst among the corners, by OpenCV itself.
    corners = np.concatenate([uv for uv, *_ in fisheye.observations()])
    error = moved(fisheye, express_in_format(fisheye, narrow), corners)
    u, v = corners[np.argmax(error)]
    assert error.max() > MAX_REFIT_ERROR
    assert f"({u:.0f}, {v:.0f}) px" in caught.value.message
    assert f"is {error.max():.3g} px off" in caught.value.message


def test_skew_that_a_format_cannot_hold_is_refitted_without() -> None:
    skewed = solved(
        Camera((640, 480), [650, 640, 303, 243, -0.2, 0.1, 3e-4, -5e-4, 0, 5e-4], "brown-conrady"),
        model="brown-conrady",
        free=["skew"],
    )
    assert skewed.calibration.camera.params[-1] != 0
    fitted = express_in_format(skewed, OPENCV)
    assert fitted.calibration is not skewed.calibration
    assert fitted.calibration.camera.model == "brown-conrady"
    assert fitted.calibration.camera.params[-1] == 0
    assert 0 < fitted.covered_error < 1
    assert express_in_format(skewed, EXPORTERS["matlab"]).calibration is skewed.calibration


def test_the_same_lens_is_written_in_its_own_model(fisheye: Result, tmp_path: Path) -> None:
    for name in EXPORTERS.keys() - set(REFITTING):
        (tmp_path / name).mkdir()
        export(fisheye, name, tmp_path / name / EXPORTERS[name].file_name)
    assert len(list(tmp_path.iterdir())) == len(EXPORTERS) - len(REFITTING)


@pytest.mark.parametrize("error", [MAX_REFIT_ERROR, float("nan")])
def test_a_refit_is_refused_from_the_limit_on(result: Result, error: float) -> None:
    camera = express_in_format(result, OPENCV).calibration
    with pytest.raises(CalibrationError, match="cannot follow this lens"):
        check_refit(result, Refit(camera, 190.0, error), Path("camera.yaml"))
    check_refit(result, Refit(camera, 190.0, 0.99 * MAX_REFIT_ERROR), Path("camera.yaml"))
