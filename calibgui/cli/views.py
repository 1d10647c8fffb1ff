"""Study how many views are enough, and propose where to hold the board next."""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.app.outputs.output_files import check_figures, save_figure
from calibgui.cli.arguments import parse_positive
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.cli.result import read_result_and_warn
from calibgui.engine.threads import limit_blas_threads
from calibgui.engine.uncertainty import QUANTITIES, propose_views, study_number_of_views
from calibgui.report import quality

_SETS_PER_SIZE = 20
"""Number of random sets of views of each size that are calibrated."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("result", type=Path, metavar="RESULT", help="result.json of the camera")
    parser.add_argument(
        "--limit",
        type=parse_positive,
        default=0.5,
        metavar="PX",
        help="uncertainty to reach (default 0.5)",
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="draw the curves (.png, .svg, .pdf)"
    )
    parser.add_argument(
        "--next", type=Path, metavar="FILE", help="draw where to hold the board next"
    )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Read, study, propose, draw and print."""
    check_figures(filter(None, [options.output, options.next]), [options.result], options.overwrite)
    result = read_result_and_warn(options.result, console)
    calibration, views = result.calibration, result.observations()
    with limit_blas_threads(), console.show_progress("calibrating", "size") as advance:
        found = study_number_of_views(calibration, views, _SETS_PER_SIZE, progress=advance)
        proposed = propose_views(calibration, views)
    sections = [
        quality.tabulate_number_of_views(found, options.limit),
        quality.describe_next_views(proposed),
    ]
    if options.output or options.next:
        from calibgui.report import quality_figures  # matplotlib takes a while to import

        if options.output:
            save_figure(quality_figures.draw_number_of_views(found, options.limit), options.output)
        if options.next:
            size = calibration.camera.size
            save_figure(quality_figures.draw_next_views(proposed, views, size), options.next)
        written = [str(path) for path in (options.output, options.next) if path]
        sections.append(f"Wrote {' and '.join(written)}.")
    console.print_json(
        {
            "limit_px": options.limit,
            "views": found.counts,
            "quantities": QUANTITIES,
            "random_median_px": found.random[:, 1],
            "chosen_px": found.chosen,
            "scatter_px": found.scatter,
            "enough": {
                name: {
                    "random": found.find_sufficient_count(name, options.limit),
                    "chosen": found.find_sufficient_count(name, options.limit, chosen=True),
                }
                for name in QUANTITIES
            },
            "next": [
                {
                    "words": view.instruction,
                    "rvec": view.pose.rvec,
                    "tvec_mm": view.pose.tvec,
                    "before_px": view.before,
                    "after_px": view.after,
                }
                for view in proposed
            ],
        }
    )
    console.print_text("\n\n".join(sections))
