"""Writing a camera that came without corners in any format, converted where it has to be.

Exporters write results. A camera of another program becomes a result without views, so that every
format needs one function only. If a format does not hold the camera's lens model, the camera is
converted by its rays (``engine.calibration.convert_camera``) into one of the format's, and the file
states by how much the two differ and where. It is not written if that would spoil measurements.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from calibgui.dataset import UNKNOWN_HARDWARE, Hardware, Result, StereoRectification
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import (
    Calibration,
    Conversion,
    Cost,
    Status,
    convert_camera,
    find_followed_angle,
)
from calibgui.engine.camera import Camera, SensorMode, describe_mode, find_model
from calibgui.engine.errors import CalibrationError
from calibgui.formats.camera_refit import (
    MAX_REFIT_ERROR,
    SUFFICIENT_REFIT_ERROR,
    check_refit,
    describe_refit,
    express_in_format,
    find_seen_region,
)
from calibgui.formats.exporter import Exporter, ExportReport


def convert_within_limit(camera: Camera, model: str, angle: float = math.inf) -> Conversion:
    """Convert a camera into another lens model, which must follow it.

    Args:
        camera: the camera.
        model: the other lens model's id.
        angle: largest angle from the axis that counts, rad.

    Raises:
        CalibrationError: if the error is `MAX_REFIT_ERROR` or more, with the part of the image in
            which it would not be; or as ``engine.calibration.convert_camera``.
    """
    found = convert_camera(camera, model, angle)
    if not found.largest_error < MAX_REFIT_ERROR:
        message, hint = _explain_failure(camera, found)
        raise CalibrationError(message[0].upper() + message[1:], hint)
    return found


def convert_alike(
    cameras: Sequence[Camera], exporter: Exporter, path: str | os.PathLike[str]
) -> list[Conversion]:
    """Express cameras of one lens model in one of the lens models that a format holds.

    Of the models in which the format has cameras refitted it is the first whose error is below
    `SUFFICIENT_REFIT_ERROR` for all cameras, else the one of the least error.

    Args:
        cameras: the cameras.
        exporter: the format.
        path: the file that is to be written, for messages.

    Raises:
        CalibrationError: if no model follows all cameras.
    """
    if all(exporter.holds(camera) for camera in cameras):
        return [convert_camera(camera, camera.model) for camera in cameras]
    tried: list[tuple[float, list[Conversion]]] = []
    for model in exporter.refits:
        zeros = exporter.zeros.get(model, ())
        found = [convert_camera(camera, model, zeros=zeros) for camera in cameras]
        tried.append((max(one.largest_error for one in found), found))
        if tried[-1][0] < SUFFICIENT_REFIT_ERROR:
            break
    error, best = min(tried, key=lambda pair: pair[0])
    if not error < MAX_REFIT_ERROR:
        k = max(range(len(best)), key=lambda k: best[k].largest_error)
        message, hint = _explain_failure(cameras[k], best[k])
        raise CalibrationError(f"{os.fspath(path)} is not written: {message}", hint)
    return best


def describe_conversion(original: Camera, found: Conversion) -> str:
    """Describe how far a converted camera is from the original, and where.

    The text has no apostrophes: OpenCV writes them into JSON in a way that only OpenCV reads.
    """
    title = find_model(found.camera.model).title
    if found.camera is original:
        return f"Lens model {title}, as it was read."
    return (
        f"Lens model {title}, converted from {find_model(original.model).title} without corners; "
        f"differs by at most {found.largest_error:.2g} px {_describe_region(found)}."
    )


def export_stream(
    result: Result, mode: SensorMode, exporter: Exporter, path: str | os.PathLike[str]
) -> ExportReport:
    """Write the camera of another stream of a calibrated one.

    Where the format does not hold its lens model, it is refitted to the corners of the calibration,
    as the calibrated camera is.

    Raises:
        CalibrationError: as `write_conversion`, or if none of the format's lens models follows the
            camera or can be squeezed.
    """
    _check_holds_cameras(exporter, path)
    expressed = express_in_format(result, exporter)
    check_refit(result, expressed, Path(path))
    zoom = float(np.abs(mode.factor).max())
    there = replace(
        expressed,
        covered_error=zoom * expressed.covered_error,
        largest_error=zoom * expressed.largest_error,
    )
    note = f"{describe_refit(result, there)} {_describe_stream(mode)}"
    outline = mode.map_points(find_seen_region(result))
    region = np.clip(outline, 0, np.array(mode.size) - 1)
    camera = mode.adapt_camera(expressed.calibration.camera)
    made = replace(_make_result(camera, region, note), hardware=result.find_hardware())
    report = exporter.write(made, Path(path))
    return ExportReport(report.path, report.note, there.largest_error)


def _describe_stream(mode: SensorMode) -> str:
    """Describe in a sentence what images a camera is for."""
    return f"For images of {mode.size[0]} x {mode.size[1]} px: {describe_mode(mode)}."


def export_camera(
    camera: Camera,
    exporter: Exporter,
    path: str | os.PathLike[str],
    angle: float = math.inf,
    mode: SensorMode | None = None,
    rectification: StereoRectification | None = None,
    hardware: Hardware = UNKNOWN_HARDWARE,
) -> ExportReport:
    """Write a camera without corners.

    Args:
        camera: the camera.
        exporter: the format.
        path: the file.
        angle: largest angle from the axis at which a conversion must follow the camera, rad.
        mode: how its images are made from those of the camera that was read, for the note.
        rectification: that of a stereo pair, which is written where the format holds it.
        hardware: the names of camera and lens, likewise.

    Raises:
        CalibrationError: if the format holds corners, none of its lens models follows the camera,
            or the file cannot be written.
    """
    if exporter.holds(camera):
        same = convert_camera(camera, camera.model)
        return write_conversion(camera, same, exporter, path, mode, rectification, hardware)
    if not exporter.refits:
        raise CalibrationError(
            f"{os.fspath(path)} is not written: the format {exporter.name!r} does not hold the "
            f"lens model {camera.model}.",
            f"Convert it with --model into {' or '.join(exporter.models)}.",
        )
    found = []
    for model in exporter.refits:
        found.append(convert_camera(camera, model, angle, exporter.zeros.get(model, ())))
        if found[-1].largest_error < SUFFICIENT_REFIT_ERROR:
            break
    best = min(found, key=lambda conversion: conversion.largest_error)
    if not best.largest_error < MAX_REFIT_ERROR:
        message, hint = _explain_failure(camera, best)
        raise CalibrationError(f"{os.fspath(path)} is not written: {message}", hint)
    return write_conversion(camera, best, exporter, path, mode, rectification, hardware)


def write_conversion(
    original: Camera,
    found: Conversion,
    exporter: Exporter,
    path: str | os.PathLike[str],
    mode: SensorMode | None = None,
    rectification: StereoRectification | None = None,
    hardware: Hardware = UNKNOWN_HARDWARE,
) -> ExportReport:
    """Write a converted camera in a format that holds its lens model; see `export_camera`.

    Raises:
        CalibrationError: if the format holds corners, or the file cannot be written.
    """
    _check_holds_cameras(exporter, path)
    note = describe_conversion(original, found)
    if mode is not None:
        note = f"{note} {_describe_stream(mode)}"
    result = replace(
        _make_result(found.camera, found.region, note),
        rectification=rectification,
        hardware=hardware,
    )
    report = exporter.write(result, Path(path))
    error = max(found.largest_error, report.largest_error_px or 0.0)
    return ExportReport(report.path, report.note, error)


def _check_holds_cameras(exporter: Exporter, path: str | os.PathLike[str]) -> None:
    """Refuse a format that holds corners or poses.

    Raises:
        CalibrationError: if it does.
    """
    if exporter.needs_corners:
        raise CalibrationError(
            f"{os.fspath(path)} is not written: the format {exporter.name!r} holds corners or the "
            "poses of photographs, and there are none of this camera.",
            "Choose a format that holds a camera only.",
        )


def _make_result(camera: Camera, region: Array | None, note: str) -> Result:
    """Return a result without views."""
    unknown = np.full(len(camera.params), np.nan)
    calibration = Calibration(
        camera=camera,
        sigma=unknown,
        covariance=(unknown_covariance := np.full((len(unknown), len(unknown)), np.nan)),
        noise_covariance=unknown_covariance,
        poses=(),
        pose_covariances=np.zeros((0, 6, 6)),
        residuals=(),
        noise=math.nan,
        model_error=0.0,
        reference_scale=math.nan,
        stage_one=(),
        history=(),
        status=Status.CONVERGED,
        cost=Cost.IMAGE,
        fixed=(),
    )
    return Result(calibration, (), conversion=note, region=region)


def _explain_failure(camera: Camera, found: Conversion) -> tuple[str, str]:
    """Say how far a model is from the camera, and up to which angle it would follow."""
    model = found.camera.model
    u, v = found.worst
    off = (
        f"is {found.largest_error:.3g} px off"
        if math.isfinite(found.largest_error)
        else "has no image"
    )
    message = (
        f"the lens model {find_model(model).title} cannot follow this lens "
        f"{_describe_region(found)}: the ray of the pixel ({u:.0f}, {v:.0f}) {off}."
    )
    angle = find_followed_angle(camera, model, SUFFICIENT_REFIT_ERROR)
    whole_degrees = 0 if angle is None else math.floor(math.degrees(angle))
    if whole_degrees < 1:
        return message, "Choose another lens model."
    return message, (
        f"Choose another lens model, or convert a part of the image: with --within {whole_degrees} "
        f"the error is below {SUFFICIENT_REFIT_ERROR:g} px up to {whole_degrees} degrees from the "
        "axis."
    )


def _describe_region(found: Conversion) -> str:
    """Describe the part of the image in which the error was measured."""
    degrees = f"up to {math.degrees(found.angle):.0f} degrees from the axis"
    if found.share > 0.999:
        return f"over the whole image, {degrees}"
    return f"over {found.share:.0%} of the image, {degrees}"
