"""Convert a camera file to another lens model or format.

Cameras are read from result.json and from the files of other programs. A calibration of this
program is calibrated again on its corners if its lens model has to change. A camera without corners
is fitted to its own rays; the command says how large the error is, px, and in which part of the
image. The options on the sensor mode make the camera of images that were cropped, binned, scaled or
flipped; as result.json it keeps the calibration, and the mode with it.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from calibgui.app.outputs.output_files import check_outputs
from calibgui.cli.arguments import (
    add_export_folder_option,
    add_export_option,
    add_hardware_option,
    parse_positive,
    read_hardware_options,
)
from calibgui.cli.camera import CAMERA_FILE, add_camera_options, read_camera_and_warn
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option, export_to_folder
from calibgui.cli.result import read_result_file
from calibgui.cli.sensor_mode import adapt_to_images, add_mode_options, is_mode_stated
from calibgui.dataset import Result
from calibgui.engine.calibration import refit
from calibgui.engine.camera import Camera, SensorMode, resolve_model_id
from calibgui.engine.errors import CalibrationError
from calibgui.engine.threads import limit_blas_threads
from calibgui.formats import EXPORTERS, ImportedCamera, export
from calibgui.formats.camera_conversion import (
    convert_within_limit,
    describe_conversion,
    export_camera,
    export_stream,
    write_conversion,
)
from calibgui.formats.camera_refit import MAX_REFIT_ERROR
from calibgui.formats.result_json import encode_mode
from calibgui.report import tables

_MAX_LISTED = 30
"""Number of parameters, at most, that are printed: a splined model has hundreds."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.set_defaults(usage_error=parser.error)
    parser.add_argument("file", type=Path, metavar="FILE", help=CAMERA_FILE)
    add_camera_options(parser)
    add_mode_options(parser, "the images of the new camera")
    parser.add_argument(
        "--model",
        type=_parse_model,
        metavar="NAME",
        help="the lens model to convert to; if left out, the camera's own where the format holds "
        "it, and otherwise the nearest that it holds",
    )
    parser.add_argument(
        "--within",
        type=_parse_angle,
        default=math.inf,
        metavar="DEGREES",
        help="angle from the axis up to which the other model must follow a camera without "
        "corners; the whole image if left out",
    )
    add_export_option(parser, "the file to write")
    add_export_folder_option(parser)
    add_hardware_option(parser)
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Read, convert, write and print."""
    targets = (options.model, options.export, options.export_all, is_mode_stated(options))
    if not any(targets):
        options.usage_error(
            "say what to convert to: --model NAME, --export FORMAT=FILE, --export-all FOLDER, a "
            "sensor mode, or several"
        )
    if options.export_all and is_mode_stated(options):
        options.usage_error("--export-all is for the images of the calibration, without a mode")
    outputs = [(path, name) for name, path in options.export]
    check_outputs(outputs, [options.file], options.overwrite)
    found = read_camera_and_warn(options.file, console, options.camera, options.size)
    adapted = adapt_to_images(found, options, console)
    with limit_blas_threads():
        if found.title == EXPORTERS["result"].title:
            read = read_result_file(options.file)
            read = replace(read, hardware=read_hardware_options(options).over(read.hardware))
            answer = _convert_result(read, adapted.mode, options)
        elif options.export_all:
            raise CalibrationError(
                f"{options.file} holds a camera only, and many formats hold corners or poses.",
                "Name the result.json of a calibration, or the formats with --export.",
            )
        else:
            answer = _convert_camera(adapted, options)
            _tell_of_rectification(found, adapted, options, console)
    if adapted.mode is not None:
        answer["sensor_mode"] = encode_mode(adapted.mode)
    console.print_json(answer)
    console.print_text(_describe(answer))


def _convert_result(
    result: Result, mode: SensorMode | None, options: argparse.Namespace
) -> dict[str, Any]:
    """Convert a calibration on its corners, and write it, or the camera of another stream of it."""
    camera = result.calibration.camera
    answer: dict[str, Any] = {"largest_error_px": 0.0, "note": ""}
    if options.model not in (None, camera.model):
        _check_formats(options, options.model)
        fitted = refit(result.observations(), result.calibration, options.model)
        if not fitted.covered_error < MAX_REFIT_ERROR:
            raise CalibrationError(
                f"The lens model {options.model} cannot follow this lens: it is "
                f"{fitted.covered_error:.3g} px off where corners were seen.",
                "Choose another lens model.",
            )
        result = replace(result, calibration=fitted.calibration)
        answer = {
            "largest_error_px": fitted.covered_error,
            "note": f"Calibrated again on the same corners; differs by at most "
            f"{fitted.covered_error:.2g} px where corners were seen.",
        }
    result, camera = replace(result, mode=mode), result.calibration.camera
    if mode is not None:
        camera = mode.adapt_camera(camera)
    files = {}
    for name, path in options.export:
        if mode is None or name == EXPORTERS["result"].name:
            files[str(path)] = export(result, name, path).note
        else:
            files[str(path)] = export_stream(result, mode, EXPORTERS[name], path).note
    if options.export_all:
        files[str(options.export_all)] = export_to_folder(result, options)
    return _encode_camera(camera) | answer | {"files": files}


def _tell_of_rectification(
    found: ImportedCamera, adapted: ImportedCamera, options: argparse.Namespace, console: Console
) -> None:
    """Say which of the files that were written do not hold the rectification of the one read."""
    if found.rectification is None:
        return
    without = [
        str(path)
        for name, path in options.export
        if adapted.rectification is None or not EXPORTERS[name].holds_rectification
    ]
    if without or not options.export:
        console.print_problem(
            f"calibgui: {options.file} holds the rectification of a stereo pair (R, P), which is "
            f"left out{' of ' if without else ''}{', '.join(without)}."
        )


def _convert_camera(adapted: ImportedCamera, options: argparse.Namespace) -> dict[str, Any]:
    """Convert a camera by its rays, and write it."""
    camera = adapted.camera
    extra = (adapted.mode, adapted.rectification, read_hardware_options(options))
    model = options.model or camera.model
    if options.model:
        _check_formats(options, model)
    found = convert_within_limit(camera, model, options.within)
    files = {}
    for name, path in options.export:
        exporter = EXPORTERS[name]
        if options.model:
            report = write_conversion(camera, found, exporter, path, *extra)
        else:
            report = export_camera(camera, exporter, path, options.within, *extra)
        files[str(path)] = report.note
    return _encode_camera(found.camera) | {
        "largest_error_px": found.largest_error,
        "rms_error_px": found.rms_error,
        "region": {
            "share": found.share,
            "angle_deg": math.degrees(found.angle),
            "outline_px": found.region,
        },
        "note": describe_conversion(camera, found),
        "files": files,
    }


def _check_formats(options: argparse.Namespace, model: str) -> None:
    """Refuse formats that do not hold the lens model that is wanted.

    Raises:
        CalibrationError: if there is one.
    """
    for name, path in options.export:
        if not EXPORTERS[name].holds_model(model):
            raise CalibrationError(
                f"{path} is not written: the format {name!r} does not hold the lens model {model}.",
                "Leave --model out, and the nearest that it holds is taken.",
            )


def _encode_camera(camera: Camera) -> dict[str, Any]:
    return {
        "model": camera.model,
        "size": camera.size,
        "params": dict(zip(camera.names, camera.params.tolist(), strict=True)),
    }


def _describe(answer: Mapping[str, Any]) -> str:
    """Describe the converted camera and the files."""
    width, height = answer["size"]
    lines = [f"{answer['model']}, {width} x {height} px"]
    if len(answer["params"]) <= _MAX_LISTED:
        rows = [[name, f"{value:.9g}"] for name, value in answer["params"].items()]
        lines.append(tables.align_columns(rows, left=(0, 1)))
    remarks = [answer["note"]] if answer["note"] else []
    for file, note in answer["files"].items():
        remarks.append(f"Wrote {file}." if note == answer["note"] else f"Wrote {file}. {note}")
    return "\n".join([*lines, *map(tables.format_bullet, remarks)])


def _parse_model(text: str) -> str:
    """Return the id of a lens model."""
    try:
        return resolve_model_id(text)
    except CalibrationError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def _parse_angle(text: str) -> float:
    """Return an angle in degrees as radians."""
    return math.radians(parse_positive(text))
