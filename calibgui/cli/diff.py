"""Compare two calibrations: where would camera B see what camera A sees?"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np

from calibgui.app.outputs import check_figure, save_figure
from calibgui.cli.arguments import add_map
from calibgui.cli.console import Console
from calibgui.cli.result import read_camera
from calibgui.dataset.result import Result
from calibgui.engine.assessment import Difference, compare_cameras
from calibgui.engine.uncertainty import estimate_projection_uncertainty
from calibgui.report import quality

_MEDIAN_LENGTH = math.sqrt(2 * math.log(2))
"""Of a difference with independent components of unit variance."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("a", type=Path, metavar="A", help="result.json of a camera")
    parser.add_argument("b", type=Path, metavar="B", help="another result.json of it")
    add_map(parser, "are compared")
    parser.add_argument(
        "--covered",
        action="store_true",
        help="compare only where A's views have corners, not over the whole image",
    )


def run(options: argparse.Namespace, console: Console) -> None:
    """Read both, compare, draw and print."""
    if options.output:
        check_figure(options.output)
    a, b = read_camera(options.a, console), read_camera(options.b, console)
    found = compare_cameras(
        a.calibration.camera,
        b.calibration.camera,
        options.distance,
        a.observations() if options.covered else None,
    )
    expected = _expected(a, b, found)
    text = quality.difference(found, expected)
    if options.output:
        from calibgui.report import quality_figures  # matplotlib takes a while to import

        save_figure(quality_figures.difference(found), options.output)
        text += f"\n\nWrote {options.output}."
    console.answer(
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
    console.say(text)


def _expected(a: Result, b: Result, found: Difference) -> float:
    """Median length, px, of the difference that both uncertainties explain."""
    sigma = [
        estimate_projection_uncertainty(one.calibration, one.observations(), found.distance).rms
        for one in (a, b)
    ]
    return float(_MEDIAN_LENGTH * np.nanmedian(np.hypot(*sigma)[found.region]))
