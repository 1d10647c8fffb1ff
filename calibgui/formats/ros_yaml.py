"""ROS's camera_info file (plumb_bob), as camera_calibration_parsers writes and reads it.

Reader: camera_calibration_parsers and image_geometry of ROS, and any YAML reader. Pixels are
OpenCV's (0-based, integer at pixel centres). `rectification_matrix` is the identity and
`projection_matrix` [K | 0]: a rectified image keeps the camera's focal lengths and centre.
Cannot hold: the paper's correction (its forward counterpart is refitted), standard
deviations, poses, corners.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from calibgui.dataset.result import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera
from calibgui.formats.exporter import FRAME, Exporter, ExportReport
from calibgui.formats.forward_model import write_forward


def write_ros(result: Result, path: Path) -> ExportReport:
    """Write a camera_info file; the camera is named after the file."""
    name = _camera_name(path)
    return write_forward(result, path, lambda fitted, note: camera_info(fitted.camera, name, note))


def camera_info(camera: Camera, name: str, note: str) -> str:
    """The text of the file; `camera` is in OpenCV's model."""
    width, height = camera.size
    P = np.hstack([camera.matrix, np.zeros((3, 1))])
    return "".join(
        [
            f"# {note}\n# {FRAME}\n",
            f"image_width: {width}\nimage_height: {height}\ncamera_name: {name}\n",
            _matrix("camera_matrix", camera.matrix),
            "distortion_model: plumb_bob\n",
            _matrix("distortion_coefficients", camera.coefficients[None]),
            _matrix("rectification_matrix", np.eye(3)),
            _matrix("projection_matrix", P),
        ]
    )


def _matrix(name: str, values: Array) -> str:
    rows, cols = values.shape
    data = ", ".join(_number(value) for value in values.ravel().tolist())
    return f"{name}:\n  rows: {rows}\n  cols: {cols}\n  data: [{data}]\n"


def _number(value: float) -> str:
    """A float that every YAML reader takes for a number: YAML 1.1 wants a point in it."""
    mantissa, exponent, power = repr(value).partition("e")
    return mantissa + (".0" if exponent and "." not in mantissa else "") + exponent + power


def _camera_name(path: Path) -> str:
    """ROS's names consist of letters, digits and underscores."""
    return "".join(c if c.isascii() and c.isalnum() else "_" for c in path.stem)


EXPORTER = Exporter(
    name="ros",
    title="ROS camera_info",
    suffixes=(".yaml", ".yml"),
    limits="Forward distortion model (plumb_bob) refitted; no standard deviations, no poses.",
    write=write_ros,
)
