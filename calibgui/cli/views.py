"""Study how many views are enough, and where to hold the board next."""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.app.outputs import check_figure, save_figure
from calibgui.cli.arguments import positive
from calibgui.cli.console import Console
from calibgui.cli.result import read_camera
from calibgui.engine.threads import one_blas_thread
from calibgui.engine.uncertainty import QUANTITIES, next_views, study
from calibgui.report import quality

_SOLVED = 20
"""Random sets of each size that are calibrated."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("result", type=Path, metavar="RESULT", help="result.json of the camera")
    parser.add_argument(
        "--limit",
        type=positive,
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


def run(options: argparse.Namespace, console: Console) -> None:
    """Read, study, propose, draw and print."""
    for path in filter(None, [options.output, options.next]):
        check_figure(path)
    result = read_camera(options.result, console)
    calibration, views = result.calibration, result.observations()
    with one_blas_thread(), console.progress("calibrating", "size") as advance:
        found = study(calibration, views, _SOLVED, progress=advance)
        proposed = next_views(calibration, views)
    sections = [quality.view_count(found, options.limit), quality.next_views(proposed)]
    if options.output or options.next:
        from calibgui.report import quality_figures  # matplotlib takes a while to import

        if options.output:
            save_figure(quality_figures.view_count(found, options.limit), options.output)
        if options.next:
            size = calibration.camera.size
            save_figure(quality_figures.next_views(proposed, views, size), options.next)
        written = [str(path) for path in (options.output, options.next) if path]
        sections.append(f"Wrote {' and '.join(written)}.")
    console.answer(
        {
            "limit_px": options.limit,
            "views": found.counts,
            "quantities": QUANTITIES,
            "random_median_px": found.random[:, 1],
            "chosen_px": found.chosen,
            "scatter_px": found.scatter,
            "enough": {
                name: {
                    "random": found.enough(name, options.limit),
                    "chosen": found.enough(name, options.limit, chosen=True),
                }
                for name in QUANTITIES
            },
            "next": [
                {
                    "words": one.words,
                    "rvec": one.pose.rvec,
                    "tvec_mm": one.pose.tvec,
                    "before_px": one.before,
                    "after_px": one.after,
                }
                for one in proposed
            ],
        }
    )
    console.say("\n\n".join(sections))
