"""The camera as a few lines of Python for OpenCV, to paste into a program.

Reader: Python with numpy and cv2. Pixels are OpenCV's; dist_coeffs are k1 k2 p1 p2 k3.
Cannot hold: the paper's correction (its forward counterpart is refitted), standard deviations,
poses, corners.
"""

from __future__ import annotations

from pathlib import Path

from calibgui.dataset.result import Result
from calibgui.engine.camera import Camera
from calibgui.formats.exporter import FRAME, Exporter, ExportReport
from calibgui.formats.forward_model import write_forward


def write_opencv_python(result: Result, path: Path) -> ExportReport:
    """Write the lines as a file."""
    return write_forward(result, path, lambda fitted, note: lines(fitted.camera, note))


def lines(camera: Camera, note: str) -> str:
    """The program text; `camera` is in OpenCV's model."""
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
    limits="Forward distortion model refitted; no standard deviations, no poses.",
    write=write_opencv_python,
)
