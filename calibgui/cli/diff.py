"""Compare two calibrations: how far apart do both cameras see the same points?"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np

from calibgui.app.outputs import check_figure, save_figure
from calibgui.cli.arguments import add_map_options
from calibgui.cli.console import Console
from calibgui.cli.result import read_result_and_warn
from calibgui.dataset import Result
from calibgui.engine.assessment import CameraDifference, compare_cameras
from calibgui.engine.uncertainty import estimate_projection_uncertainty
from calibgui.report import quality

_MEDIAN_LENGTH = math.sqrt(2 * math.log(2))
"""Median length of a vector whose two components are independent and of unit variance."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("a", type=Path, metavar="A", help="result.json of a camera")
    parser.add_argument("b", type=Path, metavar="B", help="another result.json of the same camera")
    add_map_options(parser, "are compared")
    parser.add_argument(
        "--covered",
        action="store_true",
        help="compare only where A's views have corners, not over the whole image",
    )


def run(options: argparse.Namespace, console: Console) -> None:
    """Read both, compare, draw and print."""
    if options.output:
        check_figure(options.output)
    a, b = read_result_and_warn(options.a, console), read_result_and_warn(options.b, console)
    found = compare_cameras(
        a.calibration.camera,
        b.calibration.camera,
        options.distance,
        a.observations() if options.covered else None,
    )
    expected = _estimate_expected_difference(a, b, found)
    text = quality.tabulate_camera_difference(found, expected)
    if options.output:
        from calibgui.report import quality_figures  # matplotlib takes a while to import

        save_figure(quality_figures.draw_camera_difference(found), options.output)
        text += f"\n\nWrote {options.output}."
    console.print_json(
        {
            "distance_mm": found.distance if math.isfinite(found.distance) else None,
            "rms_px": found.rms,
            "median_px": found.median,
            "worst_px": found.worst,
            "expected_median_px": expected,
            "rvec_b_from_a": found.turn,
            "tvec_b_from_a_mm": found.shift,
            "u": found.u,
            "v": found.v,
            "vector_px": found.vector,
        }
    )
    console.print_text(text)


def _estimate_expected_difference(a: Result, b: Result, found: CameraDifference) -> float:
    """Estimate the median length, px, of the difference that both uncertainties explain."""
    sigma = [
        estimate_projection_uncertainty(
            result.calibration, result.observations(), found.distance
        ).rms
        for result in (a, b)
    ]
    return float(_MEDIAN_LENGTH * np.nanmedian(np.hypot(*sigma)[found.region]))
