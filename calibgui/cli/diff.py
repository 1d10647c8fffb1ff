"""Compare two calibrations: how far apart do both cameras see the same points?

Both are read from result.json or from the files of other programs. Where both are results, the
difference is tested against their uncertainties. With --limit the exit code is 3 if the camera has
drifted: if a pixel that is compared has moved by more than the limit, and the uncertainties do not
explain it.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from pathlib import Path

from calibgui.app.outputs.output_files import check_figures, save_figure
from calibgui.cli.arguments import add_map_options, parse_positive
from calibgui.cli.camera import CAMERA_FILE, add_size_option, read_camera_and_warn
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.cli.result import read_result_file
from calibgui.dataset import Result
from calibgui.engine.assessment import (
    Drift,
    UncertainCamera,
    choose_covariance,
    compare_cameras,
    measure_drift,
)
from calibgui.engine.calibration import Observation
from calibgui.formats import EXPORTERS
from calibgui.report import quality
from calibgui.report.series import describe_drift, has_drifted
from calibgui.report.tables import fill_lines, format_bullet

_HAS_DRIFTED = 3
"""Exit code of a camera that has changed by more than the limit."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.set_defaults(usage_error=parser.error)
    parser.add_argument("a", type=Path, metavar="A", help=CAMERA_FILE)
    parser.add_argument("b", type=Path, metavar="B", help="another one of the same camera")
    for name in ("a", "b"):
        parser.add_argument(
            f"--camera-{name}",
            metavar="NAME",
            help=f"the camera to read from {name.upper()}, if it holds several",
        )
    add_size_option(parser)
    add_overwrite_option(parser)
    add_map_options(parser, "are compared")
    parser.add_argument(
        "--covered",
        action="store_true",
        help="compare only where A's views have corners, not over the whole image",
    )
    parser.add_argument(
        "--limit",
        type=parse_positive,
        metavar="PX",
        help="largest displacement that is allowed: the exit code is 3 if the camera has drifted",
    )


def run(options: argparse.Namespace, console: Console) -> int:
    """Read both, compare, draw and print; return the exit code."""
    if options.output:
        check_figures([options.output], [options.a, options.b], options.overwrite)
    a = read_camera_and_warn(options.a, console, options.camera_a, options.size)
    b = read_camera_and_warn(options.b, console, options.camera_b, options.size)
    results = [
        read_result_file(file) if camera.title == EXPORTERS["result"].title else None
        for file, camera in ((options.a, a), (options.b, b))
    ]
    if options.covered and results[0] is None:
        options.usage_error("--covered is for a result.json as A: other files have no corners")
    covered = results[0].observations() if options.covered and results[0] else None
    where = options.distance, covered
    drift = _measure_drift([r for r in results if r is not None], *where)
    found = compare_cameras(a.camera, b.camera, *where) if drift is None else drift.difference
    expected = None if drift is None else drift.expected
    a_name, b_name = _name_apart(options.a, options.b)
    text = fill_lines(f"A is {a_name}, B is {b_name}.", "", "  ") + "\n"
    text += quality.tabulate_camera_difference(found, expected)
    if drift is not None:
        text += f"\n{format_bullet(describe_drift(drift, options.limit))}"
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
            "expected_rms_px": expected,
            "probability_unchanged": None if drift is None else drift.probability,
            "rvec_b_from_a": found.turn,
            "tvec_b_from_a_mm": found.shift,
            "u": found.u,
            "v": found.v,
            "vector_px": found.vector,
        }
    )
    console.print_text(text)
    if options.limit is None:
        return 0
    beyond = found.worst > options.limit if drift is None else has_drifted(drift, options.limit)
    return _HAS_DRIFTED if beyond else 0


def _name_apart(a: Path, b: Path) -> tuple[str, str]:
    """Return the names of two files, with their folders if they are alike."""
    return (str(a), str(b)) if a.name == b.name else (a.name, b.name)


def _measure_drift(
    results: Sequence[Result], distance: float, views: Sequence[Observation] | None
) -> Drift | None:
    """Test the difference of two results; None unless both cameras are results."""
    if len(results) < 2:
        return None
    alike = results[0].board is not None and results[0].board == results[1].board
    known = [
        UncertainCamera(r.calibration.camera, choose_covariance(r.calibration, alike))
        for r in results
    ]
    return measure_drift(*known, distance=distance, views=views)
