"""A result's camera in a lens model that a file format holds.

The paper corrects measured points, most programs distort ideal ones, and the coefficients of one
model do not express the other. A format names the lens models that it holds. A camera of one of
these is written as calibrated, unless it has a skew that the format cannot hold; any other is
refitted to the same corners (``engine.calibration.refit``). How far the refitted camera is from the
calibrated one is stated in the file itself, and a file is not written if the error would spoil
measurements.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import scipy

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import Calibration, Refit, refit
from calibgui.engine.camera import Camera, find_model, pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.formats.exporter import Exporter, ExportReport, describe_condition
from calibgui.formats.origin import make_mark

MAX_REFIT_ERROR = 2.0
"""Error of a refitted camera where corners were seen, px, from which on no file is written."""
_MAX_NAMES = 20
"""Number of coefficients, at most, whose names a note lists: a splined model has hundreds."""
SUFFICIENT_REFIT_ERROR = 0.3
"""Error of a refitted camera where corners were seen, px, below which no other model is tried: a
single corner is seldom found more exactly."""


def write_in_models(
    result: Result,
    path: Path,
    exporter: Exporter,
    make_content: Callable[[Calibration, str], str | bytes],
) -> ExportReport:
    """Write a camera in one of the lens models that a format holds.

    Args:
        result: the calibration to write.
        path: the file.
        exporter: the format.
        make_content: function that turns the calibration in such a model, and the note on its
            refit, into the content of the file.

    Raises:
        CalibrationError: if none of the models can follow the lens, or the file cannot be written.
    """
    expressed, note, marked = fit_to_format(result, path, exporter)
    content = make_content(expressed.calibration, marked)
    write_atomically(path, content.encode() if isinstance(content, str) else content)
    return ExportReport(path, note, expressed.largest_error)


def fit_to_format(result: Result, path: Path, exporter: Exporter) -> tuple[Refit, str, str]:
    """Express a camera in one of the lens models that a format holds, for the file `path`.

    Returns:
        The refit, the note on it, and the note with the mark of the format for the file itself.

    Raises:
        CalibrationError: if none of the models can follow the lens.
    """
    try:
        expressed = express_in_format(result, exporter)
    except CalibrationError as error:
        held = find_model(result.calibration.camera.model).title
        raise CalibrationError(
            f"{path} is not written: the format {exporter.name!r} has no lens model {held}, and "
            f"these views determine none that it has. {error.message}",
            error.hint,
        ) from error
    check_refit(result, expressed, path)
    note = describe_refit(result, expressed)
    marked = " ".join(filter(None, [make_mark(exporter.name), note, describe_condition(result)]))
    return expressed, note, marked


def express_in_format(result: Result, exporter: Exporter) -> Refit:
    """Return the calibration itself if the format holds its camera, else a refit.

    Of the models in which the format has cameras refitted it is the first that has an image of
    every ray of the original, and an error below `SUFFICIENT_REFIT_ERROR` where corners were seen.
    If there is none, those are preferred that follow the lens where corners were seen, of these
    those that have an image of every ray, and of these the one of the least error. So a lens of 120
    degrees is refitted in a fisheye model although Brown's may just follow it, and so is one
    whose corners of the image look sideways although the board was seen in the middle only.

    Raises:
        CalibrationError: as ``engine.calibrate``, if that fails in all of these models.
    """
    if exporter.holds(result.calibration.camera):
        return Refit(result.calibration, 0.0, 0.0)
    refits: list[tuple[tuple[bool, bool, float], Refit]] = []
    failures: list[CalibrationError] = []
    for model in exporter.refits:
        try:
            zeros = exporter.zeros.get(model, ())
            fitted = refit(result.observations(), result.calibration, model, zeros)
        except CalibrationError as error:
            failures.append(error)
            continue
        whole = _has_image_of_every_ray(result.calibration.camera, fitted.calibration.camera)
        if fitted.covered_error < SUFFICIENT_REFIT_ERROR and whole:
            return fitted
        error_px = fitted.covered_error if math.isfinite(fitted.covered_error) else math.inf
        refits.append(((error_px >= MAX_REFIT_ERROR, not whole, error_px), fitted))
    if not refits:
        raise failures[0]
    return min(refits, key=lambda ranked: ranked[0])[1]


def _has_image_of_every_ray(original: Camera, fitted: Camera) -> bool:
    """Return whether `fitted` images the rays of all pixels that have one under `original`."""
    width, height = original.size
    u, v = np.meshgrid(np.linspace(0, width - 1, 32), np.linspace(0, height - 1, 32))
    rays = rays_from_pixels(np.stack([u, v], axis=-1), original)
    imaged = pixels_from_rays(rays[np.isfinite(rays).all(axis=-1)], fitted)
    return bool(np.isfinite(imaged).all())


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
        f"{path} is not written: the lens model {find_model(model).title}, the nearest that the "
        f"format holds, cannot follow this lens. The refitted camera {size} at the corner seen at "
        f"({u:.0f}, {v:.0f}) px; {np.mean(~(error < MAX_REFIT_ERROR)):.0%} of the corners are off "
        f"by {MAX_REFIT_ERROR:g} px or more.",
        "Export the camera as calibrated with the format 'result' or 'python', or write "
        f"undistorted images. Calibrating with the lens model {model} shows whether it fits.",
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


def find_seen_region(result: Result) -> Array:
    """Return the convex outline (n, 2), px, of the corners, or of a camera's region without any."""
    if result.region is not None:
        return result.region
    corners = np.concatenate([view.uv for view in result.observations()])
    return corners[scipy.spatial.ConvexHull(corners).vertices]


def describe_refit(result: Result, expressed: Refit) -> str:
    """Describe how the exported camera differs from the calibrated one.

    The text has no apostrophes: OpenCV writes them into JSON in a way that only OpenCV reads.
    """
    if result.conversion:
        return result.conversion
    camera = expressed.calibration.camera
    model = find_model(camera.model).title
    stated = dict(zip(camera.names[4:], camera.coefficients.tolist(), strict=True))
    if stated.get("skew") == 0.0:  # hardly any format has an entry for it
        del stated["skew"]
    if 0 < len(stated) <= _MAX_NAMES:
        model += f", {' '.join(stated)}"
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
