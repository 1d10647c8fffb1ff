"""ROS's camera_info, read by YAML readers and, where installed, by ROS's own."""

from __future__ import annotations

import re
from pathlib import Path

import cv2
import numpy as np
import yaml
from hypothesis import given
from hypothesis import strategies as st

from calibgui.dataset import Result
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.formats.camera_refit import express_in_models
from calibgui.formats.ros_yaml import _format_number, write_ros
from tests.formats.readers import RAYS, in_other_python

_YAML_1_1 = re.compile(r"[-+]?([0-9][0-9_]*)\.[0-9_]*([eE][-+][0-9]+)?")
"""A float with a decimal point and a signed exponent: what both YAML versions agree on."""


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_float_is_a_number_to_every_reader(value: float) -> None:
    assert _YAML_1_1.fullmatch(_format_number(value))
    assert yaml.safe_load(_format_number(value)) == value


def test_a_yaml_reader_gets_the_refitted_camera(tmp_path: Path, result: Result) -> None:
    report = write_ros(result, tmp_path / "left cam-1.yaml")
    text = (tmp_path / "left cam-1.yaml").read_text()
    assert f"# {report.note}\n" in text
    info = yaml.safe_load(text)
    camera = express_in_models(result).calibration.camera
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
    assert np.abs(theirs - pixels_from_rays(RAYS[:, :2] / RAYS[:, 2:], camera)).max() < 1e-9


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
    camera = express_in_models(result).calibration.camera
    n = RAYS[:, :2] / RAYS[:, 2:]
    assert (read["name"], read["model"], tuple(read["size"])) == (
        "camera",
        "plumb_bob",
        camera.size,
    )
    assert np.abs(read["raw"] - pixels_from_rays(n, camera)).max() < 1e-6
    straight = n * camera.focal + camera.centre
    assert np.abs(read["rectified"] - straight).max() < 1e-6
    # Its own correction of points stops after five iterations.
    assert np.abs(np.array(read["corrected"]) - straight).max() < 0.5
