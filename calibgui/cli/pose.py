"""Locate the board in photographs of a known camera: its pose in each, with its uncertainty.

The camera is read from result.json or the file of another program, and stays as it is. Where the
file says how uncertain the camera is, every ± includes that. The exit code is 1 if the board was
located in none of the photographs.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.app.calibrating.board_poses import locate_boards
from calibgui.app.outputs.output_files import check_outputs, check_suffix
from calibgui.app.outputs.pose_pictures import AXES_IN_SQUARES, draw_poses
from calibgui.cli.arguments import is_corners_file, list_input_files
from calibgui.cli.camera import CAMERA_FILE, add_camera_name_option, read_camera_and_warn
from calibgui.cli.console import Console
from calibgui.cli.corners import add_corner_options, check_corner_options, read_or_search
from calibgui.cli.outputs import add_overwrite_option
from calibgui.cli.sensor_mode import adapt_to_images, add_mode_options
from calibgui.dataset import DEFAULT_SQUARE, PoseSet
from calibgui.engine.errors import CalibrationError
from calibgui.formats.origin import POSES, POSES_CSV
from calibgui.formats.poses_csv import write_poses_csv
from calibgui.formats.poses_json import encode_poses, write_poses
from calibgui.report.board_poses import list_pose_remarks, tabulate_poses
from calibgui.report.numbers import format_count
from calibgui.report.tables import fill_lines, format_bullet

_WRITERS = {".json": (POSES, write_poses), ".csv": (POSES_CSV, write_poses_csv)}
"""Kind of file and function that writes it, by the suffix."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("camera_file", type=Path, metavar="CAMERA", help=CAMERA_FILE)
    add_corner_options(parser, f"all lengths depend on it ({DEFAULT_SQUARE:g})")
    add_camera_name_option(parser)
    add_mode_options(parser, "the photographs")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="write the poses as .json or .csv; may be repeated",
    )
    parser.add_argument(
        "--draw",
        type=Path,
        metavar="DIR",
        help="write copies of the photographs with the board's axes, "
        f"{AXES_IN_SQUARES} squares long: X red, Y green, Z blue and away from the viewer",
    )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Read, search, locate, write and print."""
    check_corner_options(options)
    _check_outputs(options)
    stored = read_camera_and_warn(options.camera_file, console, options.camera, options.size)
    corner_set = read_or_search(options, console)
    stored = adapt_to_images(stored, options, console, corner_set.size)
    poses = locate_boards(stored.camera, corner_set, stored.covariance)
    _require_located(poses, console)
    written = []
    for path in options.output:
        _WRITERS[path.suffix.lower()][1](poses, path)
        written.append(f"Wrote {path}.")
    if options.draw:
        with console.show_progress("drawing") as advance:
            drawn = draw_poses(poses, options.draw, advance, options.overwrite)
        written.append(
            f"Drew the axes into {format_count(len(drawn), 'picture')} in {options.draw}."
        )
    console.print_json(encode_poses(poses))
    console.print_text(tabulate_poses(poses))
    remarks = list_pose_remarks(poses)
    for remark in remarks:
        console.print_text(format_bullet(remark), otherwise=remark)
    for sentence in written:
        console.print_text(sentence)
    located = format_count(len(poses.located), "photograph")
    console.print_line(f"The board was located in {located} of {len(poses.views)}.")


def _check_outputs(options: argparse.Namespace) -> None:
    """Refuse outputs that are named as no table, could not be written or replace what is kept.

    Raises:
        CalibrationError: naming the first.
    """
    for path in options.output:
        check_suffix(path, _WRITERS, "a table of poses")
    if options.draw and is_corners_file(options.paths):
        raise CalibrationError(
            "--draw needs the photographs, not a corners file.", "Name the photographs."
        )
    outputs = [(path, _WRITERS[path.suffix.lower()][0]) for path in options.output]
    read = [options.camera_file, *list_input_files(options.paths)]
    check_outputs(outputs, [*read, *([options.roi] if options.roi else [])], options.overwrite)


def _require_located(poses: PoseSet, console: Console) -> None:
    """Say why boards were not located, and refuse if none was.

    Raises:
        CalibrationError: if the board was located in no photograph.
    """
    for view in poses.views:
        if view.found is None:
            named = view.reason.startswith(view.image) or view.reason.startswith(
                Path(view.image).name
            )
            reason = view.reason if named else f"{view.image}: {view.reason}"
            console.print_problem(fill_lines(f"calibgui: left out: {reason}", "", "  "))
    if not poses.located:
        raise CalibrationError(
            "The board was located in none of the photographs.",
            "See the reasons above. Photograph the whole board, sharp and evenly lit.",
        )
