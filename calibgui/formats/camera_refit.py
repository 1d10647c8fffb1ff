"""A result's camera in a lens model that a file format holds.

The paper corrects measured points, most programs distort ideal ones, and the coefficients of one
model do not express the other. A format names the lens models that it holds. A camera of one of
these is written as calibrated; any other is refitted to the same corners
(``engine.calibration.refit``). How far the refitted camera is from the calibrated one is stated in
the file itself, and a file is not written if the error would spoil measurements.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import Calibration, Refit, refit
from calibgui.engine.camera import Camera, find_model, pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.formats.exporter import ExportReport

FORWARD_MODELS = ("brown-conrady",)
"""Names of the lens models of formats whose coefficients are k1 k2 p1 p2 k3."""
MAX_REFIT_ERROR = 2.0
"""Error of a refitted camera where corners were seen, px, from which on no file is written."""


def write_in_models(
    result: Result,
    path: Path,
    models: Sequence[str],
    make_text: Callable[[Calibration, str], str],
) -> ExportReport:
    """Write a camera in one of the lens models that a format holds.

    Args:
        result: the calibration to write.
        path: the file.
        models: names of the lens models that the format holds; the first one is refitted to a
            camera of any other.
        make_text: function that turns the calibration in such a model, and the note on its refit,
            into the content of the file.

    Raises:
        CalibrationError: if the model cannot follow the lens, or the file cannot be written.
    """
    expressed = express_in_models(result, models)
    check_refit(result, expressed, path)
    note = describe_refit(result, expressed)
    write_atomically(path, make_text(expressed.calibration, note).encode())
    return ExportReport(path, note, expressed.largest_error)


def express_in_models(result: Result, models: Sequence[str] = FORWARD_MODELS) -> Refit:
    """Return the calibration itself if it is in one of `models`, else a refit in the first of them.

    Raises:
        CalibrationError: as ``engine.calibrate``.
    """
    if result.calibration.camera.model in models:
        return Refit(result.calibration, 0.0, 0.0)
    return refit(result.observations(), result.calibration, models[0])


def check_refit(result: Result, expressed: Refit, path: Path) -> None:
    """Refuse a refitted camera that cannot follow the calibrated one.

    Raises:
        CalibrationError: with the largest error where corners were seen, its place, and what to
            do instead, if the error is `MAX_REFIT_ERROR` or more, or not defined there.
    """
    if expressed.covered_error < MAX_REFIT_ERROR:
        return
    model = expressed.calibration.camera.model
    corners = np.concatenate([view.uv for view in result.observations()])
    error = measure_refit_errors(result.calibration.camera, expressed.calibration.camera, corners)
    worst = int(np.argmax(np.where(np.isfinite(error), error, np.inf)))
    u, v = corners[worst]
    size = f"is {error[worst]:.3g} px off" if math.isfinite(error[worst]) else "has no image"
    raise CalibrationError(
        f"{path} is not written: the format holds the lens model {find_model(model).title}, which "
        f"cannot follow this lens. The refitted camera {size} at the corner seen at ({u:.0f}, "
        f"{v:.0f}) px; {np.mean(~(error < MAX_REFIT_ERROR)):.0%} of the corners are off by "
        f"{MAX_REFIT_ERROR:g} px or more.",
        "Export the camera as calibrated with the format 'result' or 'python', or write "
        f"undistorted images. Calibrating with --model {model} shows whether that model fits.",
    )


def measure_refit_errors(original: Camera, refitted: Camera, uv: Array) -> Array:
    """Measure how far `refitted` images the rays of pixels under `original` from these pixels.

    Args:
        original: camera whose rays are taken.
        refitted: camera that images the rays.
        uv: (n, 2) px.

    Returns:
        (n,) px, NaN where a pixel has no ray, or the ray no image.
    """
    imaged = pixels_from_rays(rays_from_pixels(uv, original), refitted)
    return np.asarray(np.linalg.norm(imaged - uv, axis=-1))


def describe_refit(result: Result, expressed: Refit) -> str:
    """Describe how the exported camera differs from the calibrated one.

    The text has no apostrophes: OpenCV writes them into JSON in a way that only OpenCV reads.
    """
    camera = expressed.calibration.camera
    model = f"{find_model(camera.model).title}, {' '.join(camera.names[4:])}"
    if expressed.calibration is result.calibration:
        return f"Lens model {model}, as calibrated."
    whole = (
        f"{expressed.largest_error:.3g} px over the whole image"
        if math.isfinite(expressed.largest_error)
        else "an unlimited amount in parts of the image that no corner covers"
    )
    return (
        f"Lens model {model}, refitted on the same corners; differs by at most "
        f"{expressed.covered_error:.3g} px where corners were seen and {whole}."
    )
