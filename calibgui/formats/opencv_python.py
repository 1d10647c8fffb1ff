"""The camera as a few lines of Python for OpenCV, to paste into a program.

Reader: Python with numpy and cv2. Pixels are OpenCV's; dist_coeffs are k1 k2 p1 p2 k3.
Cannot hold: other lens models (they are refitted), standard deviations, poses, corners.
"""

from __future__ import annotations

from pathlib import Path

from calibgui.dataset import Result
from calibgui.engine.camera import Camera
from calibgui.formats.camera_refit import FORWARD_MODELS, write_in_models
from calibgui.formats.exporter import FRAME, Exporter, ExportReport


def write_opencv_python(result: Result, path: Path) -> ExportReport:
    """Write the lines as a file."""
    return write_in_models(
        result, path, EXPORTER.models, lambda fitted, note: format_lines(fitted.camera, note)
    )


def format_lines(camera: Camera, note: str) -> str:
    """Return the program text; `camera` is in one of `FORWARD_MODELS`."""
    fx, fy, cx, cy, *coefficients = camera.params.tolist()
    return f"""\
# {note}
# {FRAME}
import cv2
import numpy as np

image_size = {camera.size}
camera_matrix = np.array([[{fx!r}, 0.0, {cx!r}], [0.0, {fy!r}, {cy!r}], [0.0, 0.0, 1.0]])
dist_coeffs = np.array({coefficients!r})  # k1 k2 p1 p2 k3


def undistorted(image):
    return cv2.undistort(image, camera_matrix, dist_coeffs)
"""


EXPORTER = Exporter(
    name="opencv-python",
    title="Python lines for OpenCV",
    suffixes=(".py",),
    models=FORWARD_MODELS,
    limits="Forward distortion model refitted; no standard deviations, no poses.",
    write=write_opencv_python,
)
