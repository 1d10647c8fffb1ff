"""Find points in space from their pixels in the cameras of a rig.

RIG is rig.json of calibgui rig -o. POINTS is a CSV table with the columns point, camera, u and v, a
row for each point that a camera sees. Each place has one standard deviation, which counts the
errors of the pixels and of the calibration; those of the calibration are the same for all points.
The exit code is 1 if no point is seen by two cameras.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from calibgui.app.outputs.output_files import check_outputs, check_suffix
from calibgui.cli.arguments import parse_positive
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.engine.errors import CalibrationError
from calibgui.engine.rig import triangulate_points
from calibgui.formats.origin import SPACE_POINTS_CSV
from calibgui.formats.rig_json import read_rig
from calibgui.formats.space_points_csv import read_seen_points, write_space_points
from calibgui.report.rig import tabulate_space_points
from calibgui.report.tables import format_bullet


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("rig", type=Path, metavar="RIG", help="rig.json")
    parser.add_argument("points", type=Path, metavar="POINTS", help="CSV table of pixels")
    parser.add_argument(
        "--sigma",
        type=parse_positive,
        metavar="PX",
        help="standard deviation of a pixel along each axis; by default that of the rig's corners",
    )
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="write the table (.csv)")
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Read, triangulate, write and print."""
    if options.output is not None:
        check_suffix(options.output, (".csv",), "a table")
        read = [options.rig, options.points]
        check_outputs([(options.output, SPACE_POINTS_CSV)], read, options.overwrite)
    result = read_rig(options.rig)
    names, pixels = read_seen_points(options.points, result)
    sigma = options.sigma or result.rig.rms_alone / 2**0.5
    found = triangulate_points(result.rig, pixels, sigma)
    lost = ~np.isfinite(found.points).all(axis=1)
    if lost.all():
        raise CalibrationError(
            f"No point in {options.points} is seen by two cameras.",
            "Let each point have a row for at least two cameras.",
        )
    if options.output:
        write_space_points(names, pixels, found, options.output)
    console.print_json(
        {
            "points": names,
            "xyz_mm": found.points,
            "covariance_mm2": found.covariance,
            "covariance_by_calibration_mm2": found.by_calibration,
            "rms_px": found.rms,
        }
    )
    console.print_text(tabulate_space_points(names, found, result, sigma))
    if lost.any():
        remark = f"{int(lost.sum())} of {len(names)} points are seen by fewer than two cameras."
        console.print_text(format_bullet(remark), otherwise=remark)
    if options.output:
        console.print_text(f"Wrote {options.output}.")
