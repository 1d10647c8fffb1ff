"""Check with one or a few pictures of a board whether a stored calibration is still good.

The exit code is 0 if the calibration is still good, 3 if the camera has changed, and 1 if the
pictures cannot tell. The verdict does not depend on the size of the squares.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from calibgui.app.calibrating.still_good import USUAL_OVERDISPERSION, check_with_corners
from calibgui.cli.arguments import parse_positive
from calibgui.cli.camera import add_camera_name_option, read_camera_and_warn
from calibgui.cli.console import Console
from calibgui.cli.corners import add_corner_options, check_corner_options, read_or_search
from calibgui.cli.result import read_result_file
from calibgui.cli.sensor_mode import adapt_to_images, add_mode_options
from calibgui.dataset import DEFAULT_SQUARE
from calibgui.engine.assessment import DEFAULT_LIMIT, CalibrationCheck, CheckVerdict
from calibgui.engine.threads import limit_blas_threads
from calibgui.formats import EXPORTERS, ImportedCamera
from calibgui.report import tables
from calibgui.report.calibration_check import describe_check, describe_verdict

_EXIT_CODES = {
    CheckVerdict.STILL_GOOD: 0,
    CheckVerdict.CANNOT_TELL: 1,
    CheckVerdict.HAS_CHANGED: 3,
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    add_corner_options(parser, f"only the board's bend depends on it ({DEFAULT_SQUARE:g})")
    parser.usage = (
        "%(prog)s CALIBRATION PATH... [options]\n"
        "       %(prog)s PATH... --with CALIBRATION [options]"
    )
    parser.add_argument(
        "--with",
        dest="calibration",
        type=Path,
        metavar="CALIBRATION",
        help="result.json or the camera file of another program; the first PATH if left out",
    )
    add_camera_name_option(parser)
    add_mode_options(parser, "the pictures")
    parser.add_argument(
        "--limit",
        type=parse_positive,
        default=DEFAULT_LIMIT,
        metavar="PX",
        help=f"change of the camera from which it counts as changed (default {DEFAULT_LIMIT:g})",
    )


def run(options: argparse.Namespace, console: Console) -> int:
    """Read, search, check and print; return the exit code."""
    if options.calibration is None:
        options.calibration = Path(options.paths.pop(0))
        if not options.paths:
            options.usage_error("name the calibration, and then pictures of the board")
    check_corner_options(options)
    stored = read_camera_and_warn(options.calibration, console, options.camera, options.size)
    corner_set = read_or_search(options, console)
    unused = tables.list_unused_views(corner_set.views)
    if not any(view.usable for view in corner_set.views):
        console.print_problem(unused)
    else:
        stored = adapt_to_images(stored, options, console, corner_set.size)
    overdispersion = _read_overdispersion(options.calibration, stored)
    with limit_blas_threads():
        checked = check_with_corners(
            stored.camera, stored.covariance, overdispersion, corner_set, options.limit
        )
    check, names = checked.check, checked.names
    console.print_json(_encode_check(check, names))
    console.print_text(describe_check(check, names, corner_set.board), otherwise=unused)
    if unused:
        console.print_text(unused)
    console.print_line(describe_verdict(check))
    return _EXIT_CODES[check.verdict]


def _read_overdispersion(path: Path, stored: ImportedCamera) -> float:
    """Return by how much views disagreed in the stored calibration."""
    if stored.title != EXPORTERS["result"].title:
        return USUAL_OVERDISPERSION
    return read_result_file(path).calibration.overdispersion


def _encode_check(check: CalibrationCheck, names: Sequence[str]) -> dict[str, Any]:
    """Return the check for JSON."""
    return {
        "verdict": check.verdict,
        "words": describe_verdict(check),
        "limit_px": check.limit,
        "rms_px": check.rms,
        "sigma_x_px": check.sigma_x,
        "sigma_y_px": check.sigma_y,
        "corners": check.count,
        "noise_px": check.noise,
        "change_px": check.change,
        "change_sigma_px": check.change_sigma,
        "change_with_rotation_px": check.whole_change,
        "shift_px": check.shift,
        "shift_sigma_px": check.shift_sigma,
        "scale": check.scale,
        "scale_sigma": check.scale_sigma,
        "board_bend_mm": check.bend,
        "board_bend_sigma_mm": check.bend_sigma,
        "weakness": check.weakness,
        "errors_of_file_known": check.has_covariance,
        "views": [
            {
                "name": name,
                "rms_px": view.rms,
                "corners": view.used,
                "left_out": view.left_out,
                "reason": view.reason,
            }
            for name, view in zip(names, check.views, strict=True)
        ],
    }
