"""OpenCV's camera files in YAML, XML or JSON, by the file's suffix.

Reader: cv2.FileStorage, of OpenCV 4 and 5. Pixels are OpenCV's (0-based, integer at pixel
centres), lengths millimetres, names those of OpenCV's own calibration sample:
`camera_matrix`, `distortion_coefficients` (k1 k2 p1 p2 k3), `extrinsic_parameters` (a row
rvec, tvec per used view), `avg_reprojection_error` (its RMS); standard deviations are one
sigma, left out where the data leave one undetermined.
Cannot hold: other lens models (they are refitted), correlations, corners.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from calibgui.dataset import Result
from calibgui.engine import opencv
from calibgui.engine.arrays import Array
from calibgui.engine.assessment import summarise_residuals
from calibgui.engine.calibration import Calibration
from calibgui.formats.camera_refit import FORWARD_MODELS, write_in_models
from calibgui.formats.exporter import FRAME, Exporter, ExportReport

_NOTE = f"{FRAME} Lengths are in mm, angles in rad."


def write_opencv(result: Result, path: Path) -> ExportReport:
    """Write OpenCV's YAML, XML or JSON file."""
    suffix = path.suffix.lower()
    return write_in_models(
        result, path, EXPORTER.models, lambda fitted, note: format_storage(fitted, suffix, note)
    )


def format_storage(calibration: Calibration, suffix: str, note: str) -> str:
    """Return the text of the file; `calibration` is in one of `FORWARD_MODELS`."""
    camera = calibration.camera
    values: dict[str, int | float | str | Array] = {
        "image_width": camera.size[0],
        "image_height": camera.size[1],
        "nframes": len(calibration.poses),
        "camera_matrix": camera.matrix,
        "distortion_coefficients": camera.coefficients[None],
        "avg_reprojection_error": summarise_residuals(calibration.residuals).rms,
        "extrinsic_parameters": np.array([[*p.rvec, *p.tvec] for p in calibration.poses]),
    }
    if np.isfinite(calibration.sigma).all():
        values["camera_matrix_std_dev"] = calibration.sigma[None, :4]
        values["distortion_coefficients_std_dev"] = calibration.sigma[None, 4:]
    if suffix == ".json":
        return opencv.format_storage(suffix, {"note": f"{note} {_NOTE}"} | values)
    return opencv.format_storage(suffix, values, f"{note}\n{_NOTE}")


EXPORTER = Exporter(
    name="opencv",
    title="OpenCV YAML, XML or JSON",
    suffixes=(".yaml", ".yml", ".xml", ".json"),
    models=FORWARD_MODELS,
    limits="Forward distortion model refitted; standard deviations but no correlations.",
    write=write_opencv,
)
