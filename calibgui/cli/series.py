"""Describe a camera whose zoom, focus or temperature varies, from calibrations at some settings.

Every parameter becomes a function of the scalar, chosen by its error on settings that it has not
seen. Between the settings the camera is known with its uncertainty, and can be exported; whether it
has changed at all is answered in pixels. Focal lengths (zoom) and dates are read from the
photographs if these are where they were; focus and temperature need a table. Results whose
photographs do not determine the camera are left out by name.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

import numpy as np

from calibgui.app.calibrating.series import (
    AnalysedSeries,
    Scalar,
    analyse_series,
    choose_axis_text,
    export_from_series,
    find_results,
    format_value,
    parse_value,
)
from calibgui.app.outputs.output_files import check_figures, check_outputs, save_figure
from calibgui.cli.arguments import add_export_option
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.engine.assessment import UncertainCamera
from calibgui.formats import EXPORTERS
from calibgui.formats.origin import SERIES_CSV
from calibgui.formats.series_csv import write_series_csv
from calibgui.report import series as words

_ZOOM_FORMATS = [name for name, exporter in EXPORTERS.items() if exporter.write_zoom]
"""Names of the formats that hold a zoom lens."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.set_defaults(usage_error=parser.error)
    parser.add_argument(
        "paths", nargs="+", metavar="RESULT", help="result.json of each setting, or their folder"
    )
    parser.add_argument(
        "--by",
        choices=[scalar.value for scalar in Scalar],
        required=True,
        help="the quantity that varies",
    )
    parser.add_argument(
        "--values",
        type=Path,
        metavar="FILE.csv",
        help="table of file,value: the quantity of each result, as a number (temperatures in °C) "
        "or an ISO date",
    )
    parser.add_argument("--at", metavar="VALUE", help="print the camera at this value")
    add_export_option(
        parser,
        "with --at: a file of the camera there; with --by zoom and without --at: a lens profile of "
        f"all focal lengths ({', '.join(_ZOOM_FORMATS)})",
    )
    parser.add_argument("--table", type=Path, metavar="FILE.csv", help="write all settings as CSV")
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="draw the series (.png, .svg, .pdf)"
    )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Read the results, fit, print and write."""
    options.by = Scalar(options.by)
    at = _read_value(options)
    paths = find_results(options.paths)
    _check_files(options, paths)
    analysed = analyse_series(paths, options.by, options.values)
    results, series, drifts = analysed.results, analysed.series, analysed.drifts
    values = [format_value(one.value, options.by) for one in results]
    missing = [format_value(one.value, options.by) for one in analysed.left_out]
    texts = [
        words.tabulate_settings(series, values, drifts, options.by, missing),
        words.tabulate_functions(series),
        words.describe_series(series, drifts, analysed.left_out),
    ]
    answer: dict[str, Any] = {
        "by": options.by,
        "function": series.function,
        "errors_px": series.errors,
        "inflation": series.inflation,
        "settings": [
            {"file": str(one.path), "value": one.value} | _encode_camera(setting.known)
            for one, setting in zip(results, series.settings, strict=True)
        ],
        "left_out": [
            {
                "file": one.file,
                "value": None if math.isnan(one.value) else one.value,
                "reason": one.reason,
            }
            for one in analysed.left_out
        ],
        "from_first": [
            {"rms_px": drift.difference.rms, "probability": drift.probability} for drift in drifts
        ],
    }
    if at is not None:
        known = series.predict(at)
        answer["at"] = {"value": at} | _encode_camera(known)
        texts.append(words.tabulate_camera_at(known, format_value(at, options.by)))
    for name, path in options.export:
        note = export_from_series(series, at, EXPORTERS[name], path).note
        texts.append(f"Wrote {path}. {note}")
    texts += _write_files(options, analysed)
    console.print_json(answer)
    console.print_text("\n\n".join(texts))


def _read_value(options: argparse.Namespace) -> float | None:
    """Return the value of --at, or end the program if it is none or missing."""
    if options.at is None:
        for name, _ in options.export:
            if options.by is not Scalar.ZOOM or name not in _ZOOM_FORMATS:
                options.usage_error(
                    f"--export {name} needs --at VALUE: the camera where? A profile of all focal "
                    f"lengths is written with --by zoom to {' or '.join(_ZOOM_FORMATS)}."
                )
        return None
    try:
        return parse_value(options.at, options.by)
    except ValueError:
        options.usage_error(f"--at {options.at} is no value of {options.by}")
    return None


def _check_files(options: argparse.Namespace, inputs: tuple[Path, ...]) -> None:
    """Refuse outputs that could not be written, or would replace what must be kept."""
    outputs = [(path, name) for name, path in options.export]
    if options.table:
        outputs.append((options.table, SERIES_CSV))
    check_outputs(outputs, inputs, options.overwrite)
    if options.output:
        check_figures([options.output], inputs, options.overwrite)


def _write_files(options: argparse.Namespace, analysed: AnalysedSeries) -> list[str]:
    """Write table and figure, and return the sentences that say so."""
    texts, series = [], analysed.series
    if options.table:
        files = [str(one.path) for one in analysed.results]
        write_series_csv(series.settings, files, analysed.left_out, options.table)
        texts.append(f"Wrote {options.table}.")
    if options.output:
        from calibgui.report import series_figures  # matplotlib takes a while to import

        unit = options.by.unit and f", {options.by.unit}"
        write = choose_axis_text(analysed)
        figure = series_figures.draw_series(series, options.by + unit, write)
        save_figure(figure, options.output)
        texts.append(f"Wrote {options.output}.")
    return texts


def _encode_camera(known: UncertainCamera) -> dict[str, Any]:
    """Return a camera with its standard deviations for JSON."""
    camera = known.camera
    sigma = np.sqrt(np.diag(known.covariance)).tolist()
    return {
        "model": camera.model,
        "size": camera.size,
        "params": dict(zip(camera.names, camera.params.tolist(), strict=True)),
        "sigma": dict(zip(camera.names, sigma, strict=True)),
    }
