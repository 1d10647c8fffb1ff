"""Show how far a calibration can be trusted: projection uncertainty and the look of residuals."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from calibgui.app.calibration import short_names
from calibgui.app.outputs import check_figure, save_figure
from calibgui.cli.arguments import add_map, positive
from calibgui.cli.console import Console
from calibgui.cli.result import read_camera
from calibgui.dataset.result import Result
from calibgui.engine.assessment import bootstrap, choose_board_shape, cross_validate, examine
from calibgui.engine.boards import BoardShapeModel
from calibgui.engine.calibration import settings_of
from calibgui.engine.threads import one_blas_thread
from calibgui.engine.uncertainty import estimate_projection_uncertainty
from calibgui.report import quality


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("result", type=Path, metavar="RESULT", help="result.json of the camera")
    add_map(parser, "the camera will look at")
    parser.add_argument(
        "--limit",
        type=positive,
        default=0.1,
        metavar="PX",
        help="uncertainty that you can live with; the region within it is measured (default 0.1)",
    )
    parser.add_argument(
        "--validate",
        action="store_true",
        help="calibrate again without some of the views and try these, from resampled views, and "
        "if the plate is nominal with every other model of it",
    )


def run(options: argparse.Namespace, console: Console) -> None:
    """Read, propagate, examine, draw and print."""
    if options.output:
        check_figure(options.output)
    result = read_camera(options.result, console)
    views = result.observations()
    with one_blas_thread():
        found = estimate_projection_uncertainty(result.calibration, views, options.distance)
        report = examine(result.calibration, views, short_names(result.used))
        sections = [quality.projection(found, options.limit), quality.noise(report)]
        if options.validate:
            sections += _validated(result)
    if options.output:
        from calibgui.report import quality_figures  # matplotlib takes a while to import

        save_figure(quality_figures.uncertainty(found, views, options.limit), options.output)
        sections.append(f"Wrote {options.output}.")
    cause = report.cause
    console.answer(
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
            "cause": None if cause is None else {"name": cause.name, "advice": cause.advice},
        }
    )
    console.say("\n\n".join(sections))


def _validated(result: Result) -> list[str]:
    """What calibrations from other views say."""
    calibration, views = result.calibration, result.observations()
    size, settings = calibration.camera.size, settings_of(calibration)
    sections = [
        quality.validation(cross_validate(views, size, min(5, len(views)), **settings)),
        quality.resampled(bootstrap(views, size, **settings), calibration),
    ]
    if settings.pop("plate") is BoardShapeModel.NOMINAL and calibration.cost == "image":
        sections.append(
            quality.board_shapes(choose_board_shape(views, size, min(5, len(views)), **settings))
        )
    return sections
