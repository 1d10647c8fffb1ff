"""ROS's camera_info, read by YAML readers and, where installed, by ROS's own."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from calibgui.dataset import Result
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera
from calibgui.formats.camera_refit import express_in_format
from calibgui.formats.ros_yaml import EXPORTER, write_ros
from calibgui.formats.yaml_document import format_number
from tests.formats.cameras import example, holding, rays_for
from tests.formats.readers import RAYS, in_other_python

_YAML_1_1 = re.compile(r"[-+]?([0-9][0-9_]*)\.[0-9_]*([eE][-+][0-9]+)?")
"""A float with a decimal point and a signed exponent: what both YAML versions agree on."""


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_float_is_a_number_to_every_reader(value: float) -> None:
    assert _YAML_1_1.fullmatch(format_number(value))
    assert yaml.safe_load(format_number(value)) == value


def test_a_yaml_reader_gets_the_refitted_camera(tmp_path: Path, result: Result) -> None:
    report = write_ros(result, tmp_path / "left cam-1.yaml")
    text = (tmp_path / "left cam-1.yaml").read_text()
    assert f" {report.note}\n" in text
    info = yaml.safe_load(text)
    camera = express_in_format(result, EXPORTER).calibration.camera
    assert (info["image_width"], info["image_height"]) == camera.size
    assert info["camera_name"] == "left_cam_1"
    assert info["distortion_model"] == "plumb_bob"

    def matrix(name: str) -> np.ndarray:
        entry = info[name]
        return np.reshape(entry["data"], (entry["rows"], entry["cols"]))

    K, D = matrix("camera_matrix"), matrix("distortion_coefficients")
    assert np.array_equal(matrix("rectification_matrix"), np.eye(3))
    assert np.array_equal(matrix("projection_matrix"), np.hstack([K, np.zeros((3, 1))]))
    theirs = cv2.projectPoints(RAYS, np.zeros(3), np.zeros(3), K, D)[0].reshape(-1, 2)
    assert np.abs(theirs - pixels_from_rays(RAYS, camera)).max() < 1e-9


_ROS = """
import json, sys
import cv2
import numpy as np
from camera_calibration_parsers import readCalibration
from image_geometry import PinholeCameraModel

name, info = readCalibration(sys.argv[1])
model = PinholeCameraModel()
model.fromCameraInfo(info)
rays = np.array(json.loads(sys.argv[2]))
raw = cv2.projectPoints(rays, np.zeros(3), np.zeros(3), np.array(model.intrinsicMatrix()),
                        np.array(model.distortionCoeffs()))[0].reshape(-1, 2)
print(json.dumps({
    "name": name,
    "model": info.distortion_model,
    "size": model.fullResolution(),
    "raw": raw.tolist(),
    "rectified": [model.project3dToPixel(ray) for ray in rays],
    "corrected": [np.ravel(model.rectifyPoint(uv)).tolist() for uv in raw],
}))
"""


def test_ros_projects_what_it_reads_to_our_pixels(tmp_path: Path, result: Result) -> None:
    file = tmp_path / "camera.yaml"
    write_ros(result, file)
    read = in_other_python(
        _ROS, file, RAYS.tolist(), needs="import camera_calibration_parsers, image_geometry"
    )
    camera = express_in_format(result, EXPORTER).calibration.camera
    n = RAYS[:, :2] / RAYS[:, 2:]
    assert (read["name"], read["model"], tuple(read["size"])) == (
        "camera",
        "plumb_bob",
        camera.size,
    )
    assert np.abs(read["raw"] - pixels_from_rays(RAYS, camera)).max() < 1e-6
    straight = n * camera.focal + camera.centre
    assert np.abs(read["rectified"] - straight).max() < 1e-6
    # Its own correction of points stops after five iterations.
    assert np.abs(np.array(read["corrected"]) - straight).max() < 0.5


_NAMES = {"rational": "rational_polynomial", "kannala-brandt": "equidistant"}
"""ROS's names of models that are not plumb_bob."""


@pytest.mark.parametrize("model", EXPORTER.models)
def test_each_model_projects_to_our_pixels(tmp_path: Path, result: Result, model: str) -> None:
    camera = example(model)
    write_ros(holding(result, camera), tmp_path / "a.yaml")
    info = yaml.safe_load((tmp_path / "a.yaml").read_text())
    assert info["distortion_model"] == _NAMES.get(model, "plumb_bob")
    K, D = (
        np.reshape(info[name]["data"], (info[name]["rows"], info[name]["cols"]))
        for name in ("camera_matrix", "distortion_coefficients")
    )
    assert D.size == {"rational": 8, "kannala-brandt": 4}.get(model, 5)
    rays = rays_for(camera)
    project = cv2.fisheye.projectPoints if model == "kannala-brandt" else cv2.projectPoints
    theirs = project(rays[:, None], np.zeros(3), np.zeros(3), K, D)[0].reshape(-1, 2)
    assert np.abs(theirs - pixels_from_rays(rays, camera)).max() < 1e-9


_CAMERA_INFO = """\
image_width: 640
image_height: 480
camera_name: left
camera_matrix:
  rows: 3
  cols: 3
  data: [538.63, 0, 457.698, 0, 539.723, 297.003, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [-0.30678, 8e-2, 0.0028784, -0.00015829, 0]}
"""


def test_a_file_of_others_is_read(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text(_CAMERA_INFO)
    read = read_camera(tmp_path / "a.yaml")
    assert read.title == "ROS camera_info"
    assert read.camera.model == "brown-conrady" and read.camera.size == (640, 480)
    expected = [538.63, 539.723, 457.698, 297.003, -0.30678, 8e-2, 0.0028784, -0.00015829, 0, 0]
    assert read.camera.params.tolist() == expected
    # Files of the first ROS do not name the model, and are then like OpenCV's.
    (tmp_path / "b.yaml").write_text(_CAMERA_INFO.replace("distortion_model: plumb_bob\n", ""))
    assert read_camera(tmp_path / "b.yaml").camera.params.tolist() == expected
    whole, _, _ = _CAMERA_INFO.partition("distortion_coefficients")
    rectified = f"{whole}distortion_coefficients: {{rows: 1, cols: 0, data: []}}\n"
    (tmp_path / "c.yaml").write_text(rectified)
    assert read_camera(tmp_path / "c.yaml").camera.model == "pinhole"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("plumb_bob", "ftheta", "lens model 'ftheta', which cannot be read.*equidistant"),
        ("plumb_bob", "equidistant", "is not 4 coefficients, as equidistant has .5 are given"),
        ("cols: 5", "cols: 4", "data is not a list of 4 entries"),
        ("-0.30678", "x", "is not a finite number"),
        ("image_height: 480\n", "", "image_height is missing"),
        ("image_width: 640", "image_width: wide", "image_width is not a finite number"),
    ],
)
def test_errors_name_file_and_place(tmp_path: Path, old: str, new: str, message: str) -> None:
    file = tmp_path / "a.yaml"
    file.write_text(_CAMERA_INFO.replace(old, new, 1))
    with pytest.raises(CalibrationError, match=message) as caught:
        read_camera(file)
    assert str(file) in caught.value.message


_MESSAGE = """\
header:
  frame_id: camera
height: 480
width: 640
distortion_model: plumb_bob
{d}: [-0.3, 0.1, 0.001, 0.0, 0.0]
{k}: [500.0, 0.0, 320.0, 0.0, 501.0, 240.0, 0.0, 0.0, 1.0]
{r}: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
{p}: [480.0, 0.0, 320.0, -48.0, 0.0, 480.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0]
binning_x: {binning}
roi:
  x_offset: 0
---
"""


@pytest.mark.parametrize("names", ["dkrp", "DKRP"])
@pytest.mark.parametrize("count", [1, 2])
def test_a_message_is_read_as_it_is_printed(tmp_path: Path, names: str, count: int) -> None:
    file = tmp_path / "camera_info.yaml"
    text = _MESSAGE.format(**dict(zip("dkrp", names, strict=True)), binning=0)
    file.write_text(text * count)
    read = read_camera(file)
    assert read.title == EXPORTER.title
    assert not read.notes
    assert read.camera.size == (640, 480)
    np.testing.assert_array_equal(read.camera.matrix, [[500, 0, 320], [0, 501, 240], [0, 0, 1]])
    assert read.camera.coefficients[:4].tolist() == [-0.3, 0.1, 0.001, 0.0]
    assert read.rectification is not None
    assert read.rectification.P[0].tolist() == [480.0, 0.0, 320.0, -48.0]


def _write_as_block(text: str) -> str:
    """Write each list of a message with one number a line, as ROS 2 prints them."""
    lines = []
    for line in text.splitlines():
        name, _, values = line.partition(": [")
        lines += (
            [f"{name}:", *(f"- {v}" for v in values.rstrip("]").split(", "))] if values else [line]
        )
    return "\n".join(lines) + "\n"


_PRINTED: dict[str, Callable[[str], str]] = {
    "block": _write_as_block,
    "block twice": lambda text: 2 * _write_as_block(text),
    "windows": lambda text: text.replace("\n", "\r\n"),
    "no end of line": lambda text: text.rstrip("\n"),
    "blank lines": lambda text: text + "\n\n",
    "marked at both ends": lambda text: f"---\n{text}",
    "end of document": lambda text: text.replace("\n---\n", "\n...\n"),
    "many": lambda text: 30 * text,
    "cut in the next": lambda text: text + text[: text.index("width")],
    "stamp": lambda text: text.replace(
        "  frame_id: camera", "  stamp:\n    sec: 12\n    nanosec: 5\n  frame_id: camera"
    ),
    "frame of no name": lambda text: text.replace("frame_id: camera", "frame_id: ''"),
    "all of the region": lambda text: text.replace(
        "  x_offset: 0\n",
        "  x_offset: 0\n  y_offset: 0\n  height: 0\n  width: 0\n  do_rectify: false\n",
    ),
}  # fmt: skip


@pytest.mark.parametrize("way", _PRINTED)
def test_messages_are_read_however_they_are_printed(tmp_path: Path, way: str) -> None:
    file = tmp_path / "camera_info.yaml"
    text = _MESSAGE.format(**dict(zip("dkrp", "dkrp", strict=True)), binning=0)
    file.write_bytes(_PRINTED[way](text).encode())
    camera = read_camera(file).camera
    assert camera.size == (640, 480)
    np.testing.assert_array_equal(camera.matrix, [[500, 0, 320], [0, 501, 240], [0, 0, 1]])
    assert camera.coefficients[:4].tolist() == [-0.3, 0.1, 0.001, 0.0]


def test_a_message_of_reduced_images_says_whose_camera_it_holds(tmp_path: Path) -> None:
    file = tmp_path / "camera_info.yaml"
    file.write_text(_MESSAGE.format(**dict(zip("dkrp", "dkrp", strict=True)), binning=2))
    assert "--binning" in read_camera(file).notes[0]
