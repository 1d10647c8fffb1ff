"""Measure how far corners scatter in frames of a board that stands still: the noise floor.

Take 20 to 30 photographs of a board in front of a camera that both stand still. What differs from
frame to frame is the noise of the corners; what moved meanwhile is told apart, and said.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from calibgui.cli.console import Console
from calibgui.cli.corners import add_corner_options, check_corner_options, read_or_search
from calibgui.cli.result import read_result_and_warn
from calibgui.dataset import Result
from calibgui.engine.assessment import measure_repeatability, summarise_residuals
from calibgui.report.quality import describe_repeatability


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    add_corner_options(parser, "no pixel depends on it")
    parser.add_argument(
        "--result",
        type=Path,
        metavar="RESULT",
        help="result.json of the same camera, whose residuals are shown beside",
    )


def run(options: argparse.Namespace, console: Console) -> None:
    """Read, search, measure and print."""
    check_corner_options(options)
    result = read_result_and_warn(options.result, console) if options.result else None
    corner_set = read_or_search(options, console)
    used = [view for view in corner_set.views if view.usable]
    found = measure_repeatability([view.observation(corner_set.board) for view in used])
    residuals = None if result is None else _measure_residuals(result)
    console.print_json(
        {
            "frames": found.frames,
            "corners": len(found.uv),
            "sigma_px": found.rms,
            "sigma_of_sigma_px": found.rms_sigma,
            "stated_sigma_px": found.stated,
            "motion_px": found.motion,
            "residual_sigma_px": residuals,
            "uv": found.uv,
            "corner_sigma_px": found.sigma,
        }
    )
    console.print_text(describe_repeatability(found, residuals))


def _measure_residuals(result: Result) -> float:
    """Return the standard deviation of a calibration's residuals along an axis, px."""
    summary = summarise_residuals(result.calibration.residuals)
    return float(np.hypot(summary.sigma_x, summary.sigma_y) / np.sqrt(2))
