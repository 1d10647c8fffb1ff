"""Basalt's calibration, read by the names that its archive has."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera
from calibgui.formats.basalt_json import EXPORTER, write_basalt
from tests.formats import published
from tests.formats.cameras import example, holding, rays_for


def _project(entry: dict, X: Array) -> Array:
    """Pixels (n, 2) of points (n, 3) by an entry of `intrinsics`."""
    k = dict(entry["intrinsics"])
    fx, fy, cx, cy = (k.pop(name) for name in ("fx", "fy", "cx", "cy"))
    kind = entry["camera_type"]
    if kind == "pinhole-radtan8":
        m = published.radtan8(X, k)
    elif kind == "ucm":
        m = published.eucm(X, k["alpha"], 1.0)
    else:
        m = {
            "pinhole": published.pinhole,
            "kb4": published.equidistant,
            "eucm": published.eucm,
            "ds": published.double_sphere,
        }[kind](X, **k)
    return m * [fx, fy] + [cx, cy]


@pytest.mark.parametrize("model", EXPORTER.models)
def test_basalts_formulas_project_to_our_pixels(tmp_path: Path, result: Result, model: str) -> None:
    camera = example(model)
    report = write_basalt(holding(result, camera), tmp_path / "calibration.json")
    content = json.loads(report.path.read_text())["value0"]
    (entry,) = content["intrinsics"]
    assert [tuple(size) for size in content["resolution"]] == [camera.size]
    assert len(content["T_imu_cam"]) == 1
    assert [len(content[name]) for name in ("calib_accel_bias", "calib_gyro_bias")] == [9, 12]
    rays = rays_for(camera)
    assert np.abs(_project(entry, rays) - pixels_from_rays(rays, camera)).max() < 1e-9
    if (limit := entry["intrinsics"].get("rpmax")) is not None:
        uv = np.random.default_rng(0).uniform([0, 0], [639, 479], (2000, 2))
        b = rays_from_pixels(uv, camera)
        radius = np.hypot(b[:, 0], b[:, 1]) / b[:, 2]
        assert np.nanmax(radius) < limit < 1.1 * np.nanmax(radius)


def _content() -> dict:
    kb4 = {"fx": 420.5, "fy": 420.7, "cx": 469.5, "cy": 479.1}
    kb4 |= {"k1": 0.193, "k2": 0.042, "k3": -0.233, "k4": 0.095}
    ds = {"fx": 350.0, "fy": 350.5, "cx": 470.0, "cy": 480.0, "xi": -0.18, "alpha": 0.59}
    return {
        "value0": {
            "intrinsics": [
                {"camera_type": "kb4", "intrinsics": kb4},
                {"camera_type": "ds", "intrinsics": ds},
            ],
            "resolution": [[960, 960], [960, 961]],
        }
    }


def test_a_camera_of_several_is_chosen_by_number(tmp_path: Path) -> None:
    file = tmp_path / "calibration.json"
    file.write_text(json.dumps(_content()))
    with pytest.raises(CalibrationError, match="holds 2 cameras: 0, 1"):
        read_camera(file)
    read = read_camera(file, name="1")
    assert (read.camera.model, read.camera.size) == ("double-sphere", (960, 961))
    assert read.camera.params.tolist() == [350.0, 350.5, 470.0, 480.0, -0.18, 0.59]
    assert read.notes == ("Camera 1 of 2, counted from 0.",)
    assert read_camera(file, name="0").camera.params.tolist()[4:] == [0.193, 0.042, -0.233, 0.095]


def test_errors_name_file_and_place(tmp_path: Path) -> None:
    file = tmp_path / "calibration.json"
    content = _content()
    content["value0"]["intrinsics"][0]["camera_type"] = "fov"
    del content["value0"]["intrinsics"][1]["intrinsics"]["xi"]
    file.write_text(json.dumps(content))
    with pytest.raises(CalibrationError, match=r"the lens model fov, which cannot be read.*kb4"):
        read_camera(file, name="0")
    with pytest.raises(CalibrationError, match=r"intrinsics\[1\]\.intrinsics\.xi is missing"):
        read_camera(file, name="1")
    content = _content()
    content["value0"]["resolution"] = [[960, 960]]
    file.write_text(json.dumps(content))
    with pytest.raises(CalibrationError, match="not a list with the size of camera 1"):
        read_camera(file, name="1")
