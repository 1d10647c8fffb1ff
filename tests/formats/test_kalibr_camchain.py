"""Kalibr's camchain, read as its ConfigReader reads it: lists by position, models by name."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera
from calibgui.formats.camera_refit import express_in_format
from calibgui.formats.kalibr_camchain import EXPORTER, write_kalibr
from tests.formats import published
from tests.formats.cameras import WIDE_RAYS, example, holding, rays_for

_COUNTS = {"radtan": 4, "equidistant": 4, "none": 0}


def _project(camera: dict, X: Array) -> Array:
    """Pixels (n, 2) of points (n, 3) by the camera of a camchain."""
    *projection, fu, fv, pu, pv = camera["intrinsics"]
    coefficients = camera["distortion_coeffs"]
    distortion = camera["distortion_model"]
    assert len(coefficients) == _COUNTS[distortion]
    assert all(isinstance(x, float) for x in [*camera["intrinsics"], *coefficients])
    model = camera["camera_model"]
    if model == "pinhole" and distortion == "equidistant":
        m = published.equidistant(X, *coefficients)
    else:
        m = {
            "pinhole": published.pinhole,
            "omni": published.omni,
            "eucm": published.eucm,
            "ds": published.double_sphere,
        }[model](X, *projection)
        if distortion == "radtan":
            m = published.radtan(m, *coefficients)
    return m * [fu, fv] + [pu, pv]


@pytest.mark.parametrize("model", EXPORTER.models)
def test_kalibrs_formulas_project_to_our_pixels(tmp_path: Path, result: Result, model: str) -> None:
    camera = example(model)
    report = write_kalibr(holding(result, camera), tmp_path / "camchain.yaml")
    text = report.path.read_text()
    assert f" {report.note}\n" in text
    read = yaml.safe_load(text)["cam0"]
    assert tuple(read["resolution"]) == camera.size
    assert isinstance(read["rostopic"], str) and read["cam_overlaps"] == []
    rays = rays_for(camera)
    assert np.abs(_project(read, rays) - pixels_from_rays(rays, camera)).max() < 1e-9


def test_the_papers_lens_is_refitted_without_k3(tmp_path: Path, result: Result) -> None:
    write_kalibr(result, tmp_path / "camchain.yaml")
    read = yaml.safe_load((tmp_path / "camchain.yaml").read_text())["cam0"]
    assert (read["camera_model"], read["distortion_model"]) == ("pinhole", "radtan")
    fitted = express_in_format(result, EXPORTER)
    rays = WIDE_RAYS[np.abs(WIDE_RAYS[:, 2]) > 0.9 * np.linalg.norm(WIDE_RAYS, axis=1)]
    ours = pixels_from_rays(rays, fitted.calibration.camera)
    assert np.abs(_project(read, rays) - ours).max() < 1e-9


_CAMCHAIN = """\
cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.29, 1e-05, -2.0e-4, 0]
  distortion_model: radtan
  intrinsics: [461.6, 460.3, 362.7, 246.5]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, -0.11]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [0]
  camera_model: omni
  distortion_coeffs: []
  distortion_model: none
  intrinsics: [1.2, 900.0, 901.0, 370.5, 250.25]
  resolution: [752, 480]
  rostopic: /cam1/image_raw
"""


def test_a_camera_of_several_is_chosen_by_name(tmp_path: Path) -> None:
    file = tmp_path / "camchain.yaml"
    file.write_text(_CAMCHAIN)
    with pytest.raises(CalibrationError, match="holds 2 cameras: cam0, cam1") as caught:
        read_camera(file)
    assert "which one" in caught.value.hint
    with pytest.raises(CalibrationError, match=r"no camera 'left'.*cam0, cam1"):
        read_camera(file, name="left")
    left, right = read_camera(file, name="cam0"), read_camera(file, name="cam1")
    assert left.camera.model == "brown-conrady-4" and left.camera.size == (752, 480)
    assert left.camera.params.tolist() == [461.6, 460.3, 362.7, 246.5, -0.29, 1e-5, -2e-4, 0, 0]
    assert left.notes == ("The camera cam0 of 2.",)
    assert right.camera.model == "mei"
    assert right.camera.params.tolist() == [900.0, 901.0, 370.5, 250.25, 1.2, 0, 0, 0, 0]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("distortion_model: radtan", "distortion_model: fov", "pinhole-fov, which cannot be read"),
        ("camera_model: pinhole", "camera_model: edm", "edm-radtan, which cannot be read"),
        ("-0.29, 1e-05", "-0.29", "cam0.distortion_coeffs is not the 4 numbers k1 k2 p1 p2"),
        ("461.6, 460.3", "461.6", "cam0.intrinsics is not the 4 numbers fx fy cx cy"),
        ("461.6", "-461.6", "No camera has the parameters"),
        ("  resolution: [752, 480]\n  rostopic: /cam0", "  rostopic: /cam0", "resolution is miss"),
        ("[752, 480]", "[752.5, 480]", "cam0.resolution is not an array of integers"),
        ("[-0.29,", "[[-0.29,", "is not a YAML file: .* in line"),
    ],
)
def test_errors_name_file_and_place(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in _CAMCHAIN
    file = tmp_path / "camchain.yaml"
    file.write_text(_CAMCHAIN.replace(old, new, 1))
    with pytest.raises(CalibrationError, match=message) as caught:
        read_camera(file, name="cam0")
    assert str(file) in caught.value.message
