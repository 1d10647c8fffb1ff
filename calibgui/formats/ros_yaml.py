"""ROS's camera_info file (plumb_bob), as camera_calibration_parsers writes and reads it.

Reader: camera_calibration_parsers and image_geometry of ROS, and any YAML reader. Pixels are
OpenCV's (0-based, integer at pixel centres). `rectification_matrix` is the identity and
`projection_matrix` [K | 0]: a rectified image keeps the camera's focal lengths and centre.
Cannot hold: other lens models (they are refitted), standard deviations, poses, corners.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera
from calibgui.formats.camera_refit import FORWARD_MODELS, write_in_models
from calibgui.formats.exporter import FRAME, Exporter, ExportReport


def write_ros(result: Result, path: Path) -> ExportReport:
    """Write a camera_info file; the camera is named after the file."""
    name = _make_camera_name(path)
    return write_in_models(
        result,
        path,
        EXPORTER.models,
        lambda fitted, note: format_camera_info(fitted.camera, name, note),
    )


def format_camera_info(camera: Camera, name: str, note: str) -> str:
    """Return the text of the file; `camera` is in one of `FORWARD_MODELS`."""
    width, height = camera.size
    P = np.hstack([camera.matrix, np.zeros((3, 1))])
    return "".join(
        [
            f"# {note}\n# {FRAME}\n",
            f"image_width: {width}\nimage_height: {height}\ncamera_name: {name}\n",
            _format_matrix("camera_matrix", camera.matrix),
            "distortion_model: plumb_bob\n",
            _format_matrix("distortion_coefficients", camera.coefficients[None]),
            _format_matrix("rectification_matrix", np.eye(3)),
            _format_matrix("projection_matrix", P),
        ]
    )


def _format_matrix(name: str, values: Array) -> str:
    rows, cols = values.shape
    data = ", ".join(_format_number(value) for value in values.ravel().tolist())
    return f"{name}:\n  rows: {rows}\n  cols: {cols}\n  data: [{data}]\n"


def _format_number(value: float) -> str:
    """Write a float so that every YAML reader takes it for a number: YAML 1.1 demands a point."""
    mantissa, exponent, power = repr(value).partition("e")
    return mantissa + (".0" if exponent and "." not in mantissa else "") + exponent + power


def _make_camera_name(path: Path) -> str:
    """Return the file's name as ROS allows it, in letters, digits and underscores."""
    return "".join(c if c.isascii() and c.isalnum() else "_" for c in path.stem)


EXPORTER = Exporter(
    name="ros",
    title="ROS camera_info",
    suffixes=(".yaml", ".yml"),
    models=FORWARD_MODELS,
    limits="Forward distortion model (plumb_bob) refitted; no standard deviations, no poses.",
    write=write_ros,
)
