"""Find where a camera is in a robot's hand, or beside the robot, from photographs and poses.

PATH is a result.json with its views, or photographs of the board or a corners file: with --with
they are of a known camera, and otherwise the camera is calibrated from them first. --poses names
the robot's poses, in whatever convention: CSV, JSON, text or MAT, one for each photograph, by its
name or in the order of the photographs. The convention that fits is told. The exit code is 1 if
none does.
"""

from __future__ import annotations

import argparse
import itertools
from pathlib import Path

from calibgui.app.calibrating.best_camera import calibrate_best
from calibgui.app.calibrating.hand_eye import find_hand_eye, parse_point
from calibgui.app.calibrating.settings import Settings
from calibgui.app.outputs.output_files import check_suffix
from calibgui.cli.arguments import is_corners_file
from calibgui.cli.camera import add_camera_name_option, read_camera_and_warn
from calibgui.cli.console import Console
from calibgui.cli.corners import add_corner_options, check_corner_options, read_or_search
from calibgui.cli.notices import explain_solve
from calibgui.cli.outputs import add_overwrite_option, check_corner_outputs
from calibgui.cli.result import read_result_and_warn
from calibgui.cli.sensor_mode import adapt_to_images, add_mode_options
from calibgui.dataset import CornerSet, Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera
from calibgui.formats.hand_eye_files import WRITERS
from calibgui.formats.hand_eye_json import encode_hand_eye
from calibgui.formats.origin import RESULT, is_own
from calibgui.formats.robot_poses import read_robot_poses
from calibgui.report.hand_eye import (
    describe_in_a_line,
    list_hand_eye_remarks,
    tabulate_hand_eye,
)
from calibgui.report.tables import format_bullet


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.set_defaults(usage_error=parser.error)
    add_corner_options(parser, "needed, as the robot's poses have lengths")
    parser.add_argument(
        "--poses",
        type=Path,
        required=True,
        metavar="FILE",
        help="the robot's poses: .csv, .json, .txt or .mat",
    )
    parser.add_argument(
        "--with",
        dest="calibration",
        type=Path,
        metavar="CALIBRATION",
        help="the camera of the photographs: result.json or the camera file of another program",
    )
    add_camera_name_option(parser)
    add_mode_options(parser, "the photographs")
    parser.add_argument(
        "--mount",
        choices=("hand", "base"),
        help="where the camera is; if left out, the poses are taken for those of the hand in the "
        "base, as robots state them, which tells",
    )
    parser.add_argument(
        "--tool",
        type=_parse_point,
        metavar="X,Y,Z",
        help="the tool's point in the hand's frame, mm, for which ± is stated (where the board is)",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="write the result as .json, for ROS's easy_handeye2 as .calib, for OpenCV as .yaml; "
        "may be repeated",
    )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Read, search, calibrate, find, write and print."""
    is_result = len(options.paths) == 1 and _is_result(Path(options.paths[0]))
    if is_result and options.calibration:
        options.usage_error("--with names the camera of photographs; a result has its own")
    if not is_result:
        check_corner_options(options)
    _check_outputs(options)
    table = read_robot_poses(options.poses)
    source = (
        read_result_and_warn(Path(options.paths[0]), console)
        if is_result
        else _read_views(options, console)
    )
    eye_in_hand = None if options.mount is None else options.mount == "hand"
    found = find_hand_eye(source, table, eye_in_hand, options.tool)
    for path in options.output:
        WRITERS[path.suffix.lower()][1](found, path)
    console.print_json(encode_hand_eye(found))
    console.print_text(tabulate_hand_eye(found) + "\n")
    for remark in list_hand_eye_remarks(found):
        console.print_text(format_bullet(remark), otherwise=remark)
    for path in options.output:
        console.print_text(f"Wrote {path}.")
    console.print_line(describe_in_a_line(found))


def _parse_point(text: str) -> Array:
    """Read a point such as "0,0,120"."""
    try:
        return parse_point(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not X,Y,Z, as 0,0,120") from None


def _is_result(path: Path) -> bool:
    try:
        return path.suffix.lower() == ".json" and is_own(path, RESULT)
    except OSError:
        return False


def _check_outputs(options: argparse.Namespace) -> None:
    """Refuse outputs that have no format, could not be written or replace what is kept.

    Raises:
        CalibrationError: naming the first.
    """
    for path in options.output:
        check_suffix(path, WRITERS, "a file of hand and eye")
    outputs = [(path, WRITERS[path.suffix.lower()][0]) for path in options.output]
    others = [options.poses, *([options.calibration] if options.calibration else [])]
    check_corner_outputs(options, outputs, others)


def _read_views(
    options: argparse.Namespace, console: Console
) -> Result | tuple[Camera, Array | None, CornerSet]:
    """Read or search the views, and calibrate their camera unless it is known."""
    if options.calibration is not None:
        stored = read_camera_and_warn(options.calibration, console, options.camera, options.size)
        corner_set = read_or_search(options, console)
        stored = adapt_to_images(stored, options, console, corner_set.size)
        return stored.camera, stored.covariance, corner_set
    corner_set = read_or_search(options, console)
    with (
        explain_solve(console, corner_set),
        console.show_progress("looking for the best camera", "step") as advance,
    ):
        count = itertools.count(1)

        def tell(*_: int) -> None:
            advance(next(count), 0)

        search = not is_corners_file(options.paths)
        *_, best = calibrate_best(corner_set, Settings(), search=search, progress=tell, check=tell)
    return best.result
