"""The pasted lines project points to the pixels of the calibrated camera."""

from __future__ import annotations

import runpy
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui import engine
from calibgui.dataset import Result
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.formats.camera_refit import express_in_format
from calibgui.formats.engine_python import write_engine_python
from calibgui.formats.opencv_python import EXPORTER, write_opencv_python
from tests.engine import scenes
from tests.formats.cameras import example, holding, rays_for, splined


@pytest.mark.parametrize("name", ["result", "weighted", "forward_result"])
def test_engine_lines_make_the_same_camera(
    tmp_path: Path, name: str, request: pytest.FixtureRequest
) -> None:
    result: Result = request.getfixturevalue(name)
    file = tmp_path / "camera.py"
    report = write_engine_python(result, file)
    assert report.largest_error_px is None
    made = runpy.run_path(str(file))
    camera = result.calibration.camera
    assert made["camera"].size == camera.size and made["camera"].model == camera.model
    np.testing.assert_array_equal(made["camera"].params, camera.params)
    image = np.random.default_rng(0).integers(0, 255, (480, 640)).astype(np.uint8)
    expected = engine.undistort_image(image, camera).image
    np.testing.assert_array_equal(made["undistorted"](image), expected)


@pytest.mark.parametrize("name", ["result", "forward_result"])
def test_opencv_lines_project_to_our_pixels(
    tmp_path: Path, name: str, request: pytest.FixtureRequest
) -> None:
    result: Result = request.getfixturevalue(name)
    file = tmp_path / "camera.py"
    report = write_opencv_python(result, file)
    made = runpy.run_path(str(file))
    fitted = express_in_format(result, EXPORTER).calibration
    assert made["image_size"] == fitted.camera.size
    pose, (_, xy, _) = fitted.poses[0], result.observations()[0]
    board_shape = np.column_stack([xy, np.zeros(len(xy))])
    theirs, _ = cv2.projectPoints(
        board_shape, pose.rvec.copy(), pose.tvec.copy(), made["camera_matrix"], made["dist_coeffs"]
    )
    ours = engine.project_points(xy, fitted.camera, pose)
    np.testing.assert_allclose(theirs.reshape(-1, 2), ours, atol=1e-9)
    assert report.note in file.read_text()
    assert made["undistorted"](np.zeros((480, 640), np.uint8)).shape == (480, 640)


@pytest.mark.parametrize("model", EXPORTER.models)
def test_opencv_lines_of_each_model_project_to_our_pixels(
    tmp_path: Path, result: Result, model: str
) -> None:
    camera = example(model)
    write_opencv_python(holding(result, camera), tmp_path / "camera.py")
    made = runpy.run_path(str(tmp_path / "camera.py"))
    rays = rays_for(camera)
    project = cv2.fisheye.projectPoints if model == "kannala-brandt" else cv2.projectPoints
    theirs = project(
        rays[:, None], np.zeros(3), np.zeros(3), made["camera_matrix"], made["dist_coeffs"]
    )[0]
    assert np.abs(theirs.reshape(-1, 2) - pixels_from_rays(rays, camera)).max() < 1e-9
    image = np.random.default_rng(0).integers(0, 255, (480, 640)).astype(np.uint8)
    assert made["undistorted"](image).any()


@pytest.mark.parametrize("model", [*scenes.LENSES, "splined"])
def test_engine_lines_hold_every_model(tmp_path: Path, result: Result, model: str) -> None:
    camera = splined() if model == "splined" else example(model)
    write_engine_python(holding(result, camera), tmp_path / "camera.py")
    made = runpy.run_path(str(tmp_path / "camera.py"))["camera"]
    assert made.model == camera.model
    np.testing.assert_array_equal(made.params, camera.params)
