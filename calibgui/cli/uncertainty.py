"""Show how far a calibration can be trusted: projection uncertainty and tests of residuals."""

from __future__ import annotations

import argparse
import math
import re
from pathlib import Path
from typing import Any

import numpy as np

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.app.outputs.output_files import check_figures, save_figure
from calibgui.cli.arguments import add_map_options, parse_length, parse_positive
from calibgui.cli.console import Advance, Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.cli.result import read_result_and_warn
from calibgui.dataset import Result
from calibgui.engine.assessment import (
    LengthUncertainty,
    bootstrap_views,
    check_residuals,
    choose_board_shape,
    cross_validate,
    estimate_length_uncertainty,
    find_explanation,
    list_findings,
)
from calibgui.engine.boards import BoardShapeModel
from calibgui.engine.calibration import recover_arguments
from calibgui.engine.threads import limit_blas_threads
from calibgui.engine.uncertainty import estimate_projection_uncertainty
from calibgui.report import quality


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("result", type=Path, metavar="RESULT", help="result.json of the camera")
    add_overwrite_option(parser)
    add_map_options(parser, "the camera will look at")
    parser.add_argument(
        "--length",
        type=parse_length,
        metavar="MM",
        help="say how wrong a length is that is measured by its two ends, in a plane across the "
        "camera's axis; needs --at",
    )
    parser.add_argument(
        "--at", type=parse_length, metavar="MM", help="distance of the plane of --length"
    )
    parser.add_argument(
        "--pixel",
        type=_parse_pixel,
        metavar="U,V",
        help="where the middle of --length is seen; where it is known worst if left out",
    )
    parser.set_defaults(usage_error=parser.error)
    parser.add_argument(
        "--limit",
        type=parse_positive,
        default=0.1,
        metavar="PX",
        help="largest acceptable uncertainty; the region within it is measured (default 0.1)",
    )
    parser.add_argument(
        "--validate",
        action="store_true",
        help="also calibrate without some of the views and test on these, calibrate from "
        "resampled views and, if the board shape is nominal, with all other models of it",
    )


def run(options: argparse.Namespace, console: Console) -> None:
    """Read, propagate, examine, draw and print."""
    if (options.length is None) is not (options.at is None):
        options.usage_error("--length and --at go together")
    if options.output:
        check_figures([options.output], [options.result], options.overwrite)
    result = read_result_and_warn(options.result, console)
    views = result.observations()
    with limit_blas_threads():
        found = estimate_projection_uncertainty(result.calibration, views, options.distance)
        names = shorten_names(result.used)
        report = check_residuals(result.calibration, views, names)
        findings = () if report.passed else list_findings(result.calibration, views, names)
        explanation = find_explanation(findings)
        lengths = _estimate_length(result, options)
        sections = [] if lengths is None else [quality.describe_length_uncertainty(lengths)]
        sections += [
            quality.tabulate_projection_uncertainty(found, options.limit, result.condition),
            quality.tabulate_noise_report(report, explanation, result.board),
        ]
        if options.validate:
            with console.show_progress("validating", "part") as advance:
                sections += _validate(result, advance)
    if options.output:
        from calibgui.report import quality_figures  # matplotlib takes a while to import

        save_figure(
            quality_figures.draw_projection_uncertainty(found, views, options.limit), options.output
        )
        sections.append(f"Wrote {options.output}.")
    console.print_json(
        {
            "distance_mm": found.distance if math.isfinite(found.distance) else None,
            "centre_px": found.centre,
            "median_px": found.median,
            "worst_px": found.worst,
            "limit_px": options.limit,
            "fraction_within_limit": found.fraction(options.limit),
            "u": found.u,
            "v": found.v,
            "worst_direction_px": found.worst_direction,
            "length": None if lengths is None else _encode_length(lengths),
            "noise": {check.name: check.passed for check in report.checks},
            "cause": None
            if explanation is None
            else {"name": explanation.cause, "advice": explanation.remedy},
        }
    )
    console.print_text("\n\n".join(sections))


def _estimate_length(result: Result, options: argparse.Namespace) -> LengthUncertainty | None:
    """Estimate how wrong the stated length is; None if none is stated."""
    if options.length is None:
        return None
    return estimate_length_uncertainty(
        result.calibration,
        result.observations(),
        options.length,
        options.at,
        options.pixel,
        result.scale_sigma,
    )


def _encode_length(found: LengthUncertainty) -> dict[str, Any]:
    """Return what is written of a length, each as one standard deviation, mm, at its worst."""
    k = found.worst
    return {
        "length_mm": found.length,
        "distance_mm": found.depth,
        "pixel": found.uv[k],
        "sigma_mm": found.sigma[k],
        "by_calibration_mm": found.by_calibration[k],
        "by_noise_mm": found.by_noise[k],
        "by_scale_mm": found.by_scale,
        "median_sigma_mm": float(np.nanmedian(found.sigma)),
    }


def _parse_pixel(text: str) -> tuple[float, float]:
    """Read a column and a row such as "320,240"."""
    match = re.fullmatch(r"(-?\d+(?:\.\d*)?),(-?\d+(?:\.\d*)?)", text.strip())
    if match is None:
        raise argparse.ArgumentTypeError(f"{text!r} is not U,V, as 320,240")
    return float(match[1]), float(match[2])


def _validate(result: Result, advance: Advance) -> list[str]:
    """Describe calibrations from parts of the views, and with other board shapes."""
    calibration, views = result.calibration, result.observations()
    size, settings = calibration.camera.size, recover_arguments(calibration)
    advance(0, 3)
    validation = cross_validate(views, size, min(5, len(views)), calibration, **settings)
    advance(1, 3)
    bootstrap = bootstrap_views(views, size, **settings)
    advance(2, 3)
    sections = [
        quality.tabulate_cross_validation(validation),
        quality.tabulate_bootstrap(bootstrap, calibration),
    ]
    if settings.pop("board_shape") is BoardShapeModel.NOMINAL and calibration.cost == "image":
        sections.append(
            quality.tabulate_board_shape_choice(choose_board_shape(views, size, **settings))
        )
    return sections
