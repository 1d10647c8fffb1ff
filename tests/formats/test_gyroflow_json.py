"""Lens profiles, read by the names that Gyroflow has and projected by its formulas.

Gyroflow has no reader in Python. Its formulas are OpenCV's, which calibrates its own profiles.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from calibgui.dataset import Hardware, Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera
from calibgui.formats.gyroflow_json import EXPORTER, write_gyroflow, write_gyroflow_zoom
from tests.formats.cameras import example, holding, rays_for


def project(profile: dict[str, Any], params: dict[str, Any], rays: Array) -> Array:
    """Pixels of rays (n, 3) by the model that a profile names."""
    points = rays[:, None, :] / np.linalg.norm(rays, axis=-1)[:, None, None]
    matrix, coefficients = (
        np.array(params[name]) for name in ("camera_matrix", "distortion_coeffs")
    )
    zero = np.zeros(3)
    function = {
        "opencv_fisheye": cv2.fisheye.projectPoints,
        "opencv_standard": cv2.projectPoints,
    }[profile["distortion_model"]]
    return function(points, zero, zero, matrix, coefficients)[0].reshape(-1, 2)


def interpolate(profile: dict[str, Any], focal: float) -> dict[str, Any]:
    """The parameters at a focal length, linear between two entries, as Gyroflow has them."""
    entries = sorted((float(key), entry) for key, entry in profile["interpolations"].items())
    at = [mm for mm, _ in entries]
    found = {}
    for name in ("camera_matrix", "distortion_coeffs"):
        table = np.array([entry[name] for _, entry in entries])
        flat = table.reshape(len(at), -1)
        mixed = [np.interp(focal, at, column) for column in flat.T]
        found[name] = np.reshape(mixed, table.shape[1:])
    return found


@pytest.mark.parametrize("model", EXPORTER.models)
def test_opencvs_formulas_project_to_our_pixels(tmp_path: Path, result: Result, model: str) -> None:
    camera = example(model)
    report = write_gyroflow(holding(result, camera), tmp_path / "profile.json")
    profile = json.loads(report.path.read_text())
    width, height = camera.size
    assert profile["calib_dimension"] == profile["orig_dimension"] == {"w": width, "h": height}
    assert profile["asymmetrical"] is True, "or Gyroflow centres the principal point"
    assert profile["calibrator_version"], "or Gyroflow refuses the profile"
    rays = rays_for(camera)
    found = project(profile, profile["fisheye_params"], rays)
    assert np.abs(found - pixels_from_rays(rays, camera)).max() < 1e-6


def test_a_zoom_lens_is_interpolated_between_its_focal_lengths(tmp_path: Path) -> None:
    def make(mm: float) -> Camera:
        params = [20 * mm, 20 * mm, 318 + mm / 10, 240 - mm / 20, -0.3 + mm / 200, 0.05, 0, 0, 0]
        return Camera((640, 480), params, "brown-conrady")

    report = write_gyroflow_zoom([(mm, make(mm)) for mm in (50.0, 24.0, 35.5)], tmp_path / "a.json")
    profile = json.loads(report.path.read_text())
    assert list(profile["interpolations"]) == ["24", "35.5", "50"]
    assert profile["fisheye_params"]["camera_matrix"][0][0] == 480.0, "the shortest"
    counts = {len(one["distortion_coeffs"]) for one in profile["interpolations"].values()}
    assert counts == {len(profile["fisheye_params"]["distortion_coeffs"])}
    rays = rays_for(make(30.0))
    for mm in (24.0, 30.0, 41.0, 50.0):
        found = project(profile, interpolate(profile, mm), rays)
        assert np.abs(found - pixels_from_rays(rays, make(mm))).max() < 1e-6
    assert report.largest_error_px == pytest.approx(0.0, abs=1e-9)


def test_all_focal_lengths_are_converted_into_one_lens_model(tmp_path: Path) -> None:
    """The first is nearly a pinhole and would be followed by any model; the last is a fisheye."""
    cameras = [
        (mm, Camera((640, 480), [f, f, 320, 240, *lens], "double-sphere"))
        for mm, f, lens in [(50.0, 900, [0.0, 0.02]), (8.0, 180, [-0.2, 0.55])]
    ]
    report = write_gyroflow_zoom(cameras, tmp_path / "a.json")
    profile = json.loads(report.path.read_text())
    assert profile["distortion_model"] == "opencv_fisheye"
    assert "converted from Double sphere" in report.note
    rays = rays_for(cameras[0][1])
    for mm, camera in cameras:
        ours = pixels_from_rays(rays, camera)
        inside = ((ours > 0) & (ours < [639, 479])).all(axis=1)
        found = project(profile, interpolate(profile, mm), rays)
        error = np.linalg.norm(found - ours, axis=1)[inside]
        assert error.max() <= report.largest_error_px + 0.01
    skewed = Camera((640, 480), [600, 600, 320, 240, 0.2, 0, 0, 0, 0.1, -0.1], "lucchese")
    with pytest.raises(CalibrationError, match="is not written"):
        write_gyroflow_zoom([(8.0, skewed)], tmp_path / "b.json")
    assert not (tmp_path / "b.json").exists()


def test_a_focal_length_of_a_zoom_lens_is_read_by_its_name(tmp_path: Path) -> None:
    cameras = [
        (mm, Camera((640, 480), [20 * mm, 20 * mm, 318, 240, -0.1, 0.01, 0, 0, 0], "brown-conrady"))
        for mm in (24.0, 70.5)
    ]
    report = write_gyroflow_zoom(cameras, tmp_path / "zoom.json")
    with pytest.raises(CalibrationError, match=r"holds 2 cameras: 24, 70\.5"):
        read_camera(report.path)
    read = read_camera(report.path, "70.5").camera
    np.testing.assert_allclose(read.params, cameras[1][1].params, rtol=1e-12)


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ({"distortion_model": "gopro_superview"}, "lens model gopro_superview"),
        ({"fisheye_params": {}}, "camera_matrix"),
        ({"calib_dimension": None}, "calib_dimension"),
    ],
)
def test_a_profile_that_is_not_read_is_named(
    tmp_path: Path, result: Result, entry: dict[str, Any], message: str
) -> None:
    path = write_gyroflow(result, tmp_path / "profile.json").path
    path.write_text(json.dumps(json.loads(path.read_text()) | entry))
    with pytest.raises(CalibrationError, match=message):
        read_camera(path)


def test_a_centre_that_gyroflow_does_not_use_is_told_of(tmp_path: Path, result: Result) -> None:
    path = write_gyroflow(result, tmp_path / "profile.json").path
    assert read_camera(path).notes == ()
    path.write_text(json.dumps(json.loads(path.read_text()) | {"asymmetrical": False}))
    assert "in the middle" in read_camera(path).notes[0]
    with pytest.raises(CalibrationError, match="Leave the name '24' out"):
        read_camera(path, "24")


@pytest.mark.parametrize(("aspect", "stretch"), [(1.33, (1.33, 1.0)), (0.75, (1.0, 1 / 0.75))])
def test_pixels_that_are_not_square_are_stretched(
    tmp_path: Path, result: Result, aspect: float, stretch: tuple[float, float]
) -> None:
    """Gyroflow has the camera matrix of the stretched images, and divides by the stretch."""
    square = example("brown-conrady")
    params = square.params * [1, aspect * square.params[0] / square.params[1], *[1] * 8]
    camera = Camera(square.size, params, square.model)
    file = write_gyroflow(holding(result, camera), tmp_path / "profile.json").path
    profile = json.loads(file.read_text())
    stated = [profile[f"input_{axis}_stretch"] for axis in ("horizontal", "vertical")]
    np.testing.assert_allclose(stated, stretch)
    width, height = (round(s * side) for s, side in zip(stretch, camera.size, strict=True))
    assert profile["calib_dimension"] == {"w": width, "h": height}
    assert profile["orig_dimension"] == dict(zip("wh", camera.size, strict=True))
    K = np.array(profile["fisheye_params"]["camera_matrix"])
    assert K[0, 0] == pytest.approx(K[1, 1])
    rays = rays_for(camera)
    stretched = project(profile, profile["fisheye_params"], rays)
    np.testing.assert_allclose(stretched / stated, pixels_from_rays(rays, camera), atol=1e-6)
    read = read_camera(file).camera
    assert read.size == camera.size
    np.testing.assert_allclose(read.params, camera.params, rtol=1e-9)


def test_camera_and_lens_are_named(tmp_path: Path, result: Result) -> None:
    hardware = Hardware(maker="Sony", model="A7", lens="FE 24mm")
    file = write_gyroflow(replace(result, hardware=hardware), tmp_path / "profile.json").path
    profile = json.loads(file.read_text())
    assert profile["name"] == "Sony A7 FE 24mm"
    assert [profile[f"{key}_model"] for key in ("camera", "lens")] == ["A7", "FE 24mm"]
    assert profile["camera_brand"] == "Sony"
