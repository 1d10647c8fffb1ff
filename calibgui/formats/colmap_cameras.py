"""COLMAP's cameras.txt, with the camera FULL_OPENCV.

Reader: COLMAP and pycolmap, which take it for the first camera of a sparse model. Pixels of COLMAP
have whole numbers at their corners: the principal point is half a pixel more than OpenCV's.
FULL_OPENCV's coefficients are k1 k2 p1 p2 k3 k4 k5 k6, of which the last three are 0.
Cannot hold: other lens models (they are refitted), standard deviations, poses, corners.
"""

from __future__ import annotations

from pathlib import Path

from calibgui.dataset import Result
from calibgui.engine.camera import Camera
from calibgui.engine.geometry import corner_from_array
from calibgui.formats.camera_refit import FORWARD_MODELS, write_in_models
from calibgui.formats.exporter import Exporter, ExportReport


def write_colmap(result: Result, path: Path) -> ExportReport:
    """Write a cameras.txt with one camera."""
    return write_in_models(
        result, path, EXPORTER.models, lambda fitted, note: format_cameras(fitted.camera, note)
    )


def format_cameras(camera: Camera, note: str) -> str:
    """Return the text of the file; `camera` is in one of `FORWARD_MODELS`."""
    values = [*camera.focal, *corner_from_array(camera.centre), *camera.coefficients]
    numbers = " ".join(repr(float(value)) for value in [*values, 0.0, 0.0, 0.0])
    width, height = camera.size
    return (
        f"# {note}\n"
        "# Pixels count from 0 at the corner of the first pixel, u right, v down.\n"
        "# Camera list with one line of data per camera:\n"
        "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
        "# Number of cameras: 1\n"
        f"1 FULL_OPENCV {width} {height} {numbers}\n"
    )


EXPORTER = Exporter(
    name="colmap",
    title="COLMAP cameras.txt",
    suffixes=(".txt",),
    models=FORWARD_MODELS,
    limits="Forward distortion model (FULL_OPENCV) refitted; no standard deviations, no poses.",
    write=write_colmap,
)
