"""The camera as a few lines of Python for OpenCV, to paste into a program.

Reader: Python with numpy and cv2. Pixels are OpenCV's; dist_coeffs are k1 k2 p1 p2 and up to eight
more, or k1 k2 k3 k4 of cv2.fisheye, whose functions the lines then call.
Cannot hold: other lens models and skew (they are refitted), standard deviations, poses, corners.
"""

from __future__ import annotations

from pathlib import Path

from calibgui.dataset import Result
from calibgui.engine.camera import Camera
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import FRAME, Exporter, ExportReport
from calibgui.formats.opencv_lens import (
    FISHEYE,
    PERSPECTIVE_MODELS,
    list_coefficient_names,
    list_coefficients,
)


def write_opencv_python(result: Result, path: Path) -> ExportReport:
    """Write the lines as a file."""
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_lines(fitted.camera, note)
    )


def format_lines(camera: Camera, note: str) -> str:
    """Return the program text; `camera` is in one of the format's models."""
    fx, fy, cx, cy = camera.params[:4].tolist()
    coefficients = list_coefficients(camera).tolist()
    undistort = "cv2.undistort(image, camera_matrix, dist_coeffs)"
    if camera.model == FISHEYE:
        undistort = (
            "cv2.fisheye.undistortImage(image, camera_matrix, dist_coeffs, Knew=camera_matrix)"
        )
    return f"""\
# {note}
# {FRAME}
import cv2
import numpy as np

image_size = {camera.size}
camera_matrix = np.array([[{fx!r}, 0.0, {cx!r}], [0.0, {fy!r}, {cy!r}], [0.0, 0.0, 1.0]])
dist_coeffs = np.array({coefficients!r})  # {list_coefficient_names(camera)}


def undistorted(image):
    return {undistort}
"""


EXPORTER = Exporter(
    name="opencv-python",
    title="Python lines for OpenCV",
    suffixes=(".py",),
    models=(*PERSPECTIVE_MODELS, FISHEYE),
    refits=("brown-conrady", FISHEYE),
    readers="Python with OpenCV",
    keeps="the camera in the models of cv2.projectPoints or cv2.fisheye",
    loses="standard deviations, poses, corners",
    write=write_opencv_python,
)
