"""Show how far a calibration can be trusted: projection uncertainty and tests of residuals."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.app.outputs.output_files import check_figures, save_figure
from calibgui.cli.arguments import add_map_options, parse_positive
from calibgui.cli.console import Advance, Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.cli.result import read_result_and_warn
from calibgui.dataset import Result
from calibgui.engine.assessment import (
    bootstrap_views,
    check_residuals,
    choose_board_shape,
    cross_validate,
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
        sections = [
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
            "noise": {check.name: check.passed for check in report.checks},
            "cause": None
            if explanation is None
            else {"name": explanation.cause, "advice": explanation.remedy},
        }
    )
    console.print_text("\n\n".join(sections))


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
            quality.tabulate_board_shape_choice(
                choose_board_shape(views, size, min(5, len(views)), **settings)
            )
        )
    return sections
