"""Lens profiles of Adobe's, projected by the formulas that RawTherapee documents and applies.

x_d = x (1 + k1 r^2 + k2 r^4 + k3 r^6 + 2 (k4 y + k5 x)) + k5 r^2, and y_d with k4 alike, in units
of the focal length. Of a fisheye, with the angle theta from the axis in place of r, it is
theta (1 + k1 theta^2 + k2 theta^4) from the centre.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Hardware, Result
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.formats import export
from calibgui.formats.adobe_lcp import EXPORTER
from calibgui.formats.camera_conversion import export_camera
from tests.formats.cameras import PERSPECTIVE, RAYS, WIDE_RAYS, example, holding

_CAMERA = "{http://ns.adobe.com/photoshop/1.0/camera-profile}"


def read(path: Path) -> tuple[dict[str, str], dict[str, float]]:
    """What a profile says of camera and lens, and its lens model."""
    (model,) = (
        model
        for kind in ("PerspectiveModel", "FisheyeModel")
        for model in ET.parse(path).iter(f"{_CAMERA}{kind}")
    )
    (names,) = (
        entry.attrib for entry in ET.parse(path).iter() if f"{_CAMERA}ImageWidth" in entry.attrib
    )
    values = {key.removeprefix(_CAMERA): float(value) for key, value in model[0].attrib.items()}
    return {key.removeprefix(_CAMERA): value for key, value in names.items()}, values


@pytest.mark.parametrize("model", [name for name in EXPORTER.models if name in PERSPECTIVE])
def test_the_formulas_project_to_our_pixels(tmp_path: Path, result: Result, model: str) -> None:
    camera = example(model)
    path = export(holding(result, camera), "lcp", tmp_path / "camera.lcp").path
    names, value = read(path)
    width, height = int(names["ImageWidth"]), int(names["ImageLength"])
    assert (width, height) == camera.size
    k1, k2, k3 = (value[f"RadialDistortParam{n}"] for n in (1, 2, 3))
    k4, k5 = (value[f"TangentialDistortParam{n}"] for n in (1, 2))
    x, y = RAYS[:, 0] / RAYS[:, 2], RAYS[:, 1] / RAYS[:, 2]
    r2 = x * x + y * y
    common = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3 + 2 * (k4 * y + k5 * x)
    longer = max(width, height)
    u = value["ImageXCenter"] * width + value["FocalLengthX"] * longer * (x * common + k5 * r2)
    v = value["ImageYCenter"] * height + value["FocalLengthY"] * longer * (y * common + k4 * r2)
    assert np.abs(np.column_stack([u, v]) - 0.5 - pixels_from_rays(RAYS, camera)).max() < 1e-9


@pytest.mark.parametrize("k3", [0.0, 0.004])
def test_a_fisheye_has_two_coefficients(tmp_path: Path, k3: float) -> None:
    camera = Camera((640, 480), [260.0, 250, 318, 243, -0.02, 0.004, k3, 0], "kannala-brandt")
    report = export_camera(camera, EXPORTER, tmp_path / "camera.lcp")
    assert report.note.endswith("as it was read.") == (k3 == 0)
    _, value = read(report.path)
    assert "RadialDistortParam3" not in value
    angle = np.arctan2(np.linalg.norm(WIDE_RAYS[:, :2], axis=1), WIDE_RAYS[:, 2])
    seen = pixels_from_rays(WIDE_RAYS, camera)
    inside = ((seen > 0) & (seen < camera.size)).all(axis=1) & (angle > 0)
    theta, rays = angle[inside], WIDE_RAYS[inside]
    k1, k2 = value["RadialDistortParam1"], value["RadialDistortParam2"]
    r = theta * (1 + k1 * theta**2 + k2 * theta**4) / np.linalg.norm(rays[:, :2], axis=1)
    u = value["ImageXCenter"] * 640 + value["FocalLengthX"] * 640 * r * rays[:, 0]
    v = value["ImageYCenter"] * 480 + value["FocalLengthY"] * 640 * r * rays[:, 1]
    off = np.abs(np.column_stack([u, v]) - 0.5 - seen[inside]).max()
    assert len(theta) > 5
    assert off < 1e-9 + 1.01 * (report.largest_error_px or 0.0) < 2


def test_camera_and_lens_are_named(tmp_path: Path, result: Result) -> None:
    hardware = Hardware(maker='A & "B"', model="X", lens="18 mm", crop=1.5)
    stated = replace(holding(result, example("pinhole")), hardware=hardware)
    names, _ = read(export(stated, "lcp", tmp_path / "camera.lcp").path)
    assert (names["Make"], names["Model"], names["Lens"]) == ('A & "B"', "X", "18 mm")
    film = np.hypot(36, 24) / 1.5 * 0.8
    assert float(names["FocalLength"]) == pytest.approx(310 / 640 * film, rel=1e-3)
