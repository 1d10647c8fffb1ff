"""Find the rays that pixels look along, or the points of a board's plane that they see.

The pixels are rows of a CSV table with the columns u and v, px, and perhaps sigma_px, the standard
deviation of each; 0, 0 is the centre of the upper left pixel. With --pose or --plane each pixel
becomes a place on that plane, mm, with one standard deviation, which counts the errors of pixel,
camera and pose. Pixels that the camera does not image, or that do not look at the plane, are named;
the exit code is 1 if all are such.
"""

from __future__ import annotations

import argparse
from collections import Counter
from pathlib import Path

import numpy as np

from calibgui.app.outputs.output_files import check_outputs, check_suffix
from calibgui.cli.arguments import parse_positive
from calibgui.cli.camera import CAMERA_FILE, add_camera_options, read_camera_and_warn
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.cli.sensor_mode import adapt_to_images, add_mode_options
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import BoardPose
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import Pose
from calibgui.engine.uncertainty import BoardPoints, PixelRays, find_board_points, find_rays
from calibgui.formats.origin import RAYS_CSV
from calibgui.formats.points_csv import read_points, write_rays
from calibgui.formats.poses_json import read_pose
from calibgui.report.numbers import format_count
from calibgui.report.rays import explain_lack, tabulate_rays
from calibgui.report.tables import format_bullet


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.set_defaults(usage_error=parser.error)
    parser.add_argument("camera_file", type=Path, metavar="CAMERA", help=CAMERA_FILE)
    parser.add_argument("points", type=Path, metavar="POINTS", help="CSV table of pixels")
    add_camera_options(parser)
    add_mode_options(parser, "the images of the pixels")
    plane = parser.add_mutually_exclusive_group()
    plane.add_argument(
        "--pose",
        type=Path,
        metavar="FILE",
        help="the plane of the board as calibgui pose -o FILE.json has located it",
    )
    plane.add_argument(
        "--plane",
        type=_parse_plane,
        metavar="X,Y,Z,RX,RY,RZ",
        help="the plane z = 0 of a frame whose origin is at X, Y, Z mm from the camera (right, "
        "down, ahead) and which is turned by the rotation vector RX, RY, RZ, degrees",
    )
    parser.add_argument(
        "--image", metavar="NAME", help="the photograph whose pose it is, of several in FILE"
    )
    parser.add_argument(
        "--sigma",
        type=parse_positive,
        metavar="PX",
        help="standard deviation of a pixel along each axis, where the table has none (0)",
    )
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="write the table (.csv)")
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Read, trace, write and print."""
    if options.image and not options.pose:
        options.usage_error("--image chooses a pose of --pose FILE")
    _check_output(options)
    stored = read_camera_and_warn(options.camera_file, console, options.camera, options.size)
    stored = adapt_to_images(stored, options, console)
    camera, covariance = stored.camera, stored.covariance
    if covariance is not None and not np.isfinite(covariance).all():
        covariance = None
    table = read_points(options.points)
    sigma = table.sigma if table.sigma is not None else options.sigma or 0.0
    plane: BoardPose | Pose | None = options.plane
    if options.pose:
        plane = read_pose(options.pose, camera, options.image)
    if plane is None:
        on_plane, rays = None, find_rays(table.uv, camera, covariance, sigma)
    else:
        on_plane = find_board_points(table.uv, camera, plane, covariance, sigma)
        rays = on_plane.rays
    reasons = explain_lack(rays, on_plane)
    if all(reasons):
        raise CalibrationError(
            f"None of the {len(reasons)} pixels can be traced: {reasons[0]}.",
            "Check the size of the images that the pixels are of, and the plane.",
        )
    if options.output:
        write_rays(table, rays, on_plane, reasons, options.output)
    console.print_json(_encode(table.uv, rays, on_plane, reasons))
    console.print_text(tabulate_rays(table.uv, rays, on_plane, reasons))
    for reason, count in Counter(filter(None, reasons)).items():
        remark = f"{format_count(count, 'pixel')} without an answer: {reason}."
        console.print_text(format_bullet(remark), otherwise=remark)
    if covariance is None:
        console.print_text(format_bullet("The camera counts as exact: its file has no errors."))
    if options.output:
        console.print_text(f"Wrote {options.output}.")


def _check_output(options: argparse.Namespace) -> None:
    """Refuse an output that is named as no table, or would replace what is kept."""
    if options.output is None:
        return
    check_suffix(options.output, (".csv",), "a table")
    read = [options.camera_file, options.points, *([options.pose] if options.pose else [])]
    check_outputs([(options.output, RAYS_CSV)], read, options.overwrite)


def _encode(
    uv: Array, rays: PixelRays, on_plane: BoardPoints | None, reasons: list[str]
) -> dict[str, object]:
    """Return the answer for JSON."""
    answer: dict[str, object] = {"uv_px": uv, "rays": rays.rays, "ray_covariance": rays.covariance}
    if on_plane is not None:
        answer |= {"xy_mm": on_plane.points, "xy_covariance_mm2": on_plane.covariance}
    return answer | {"reasons": reasons}


def _parse_plane(text: str) -> Pose:
    """Read a pose such as "0,0,500,30,0,0", mm and degrees."""
    try:
        numbers = np.array([float(part) for part in text.split(",")])
    except ValueError:
        numbers = np.empty(0)
    if numbers.shape != (6,) or not np.isfinite(numbers).all():
        raise argparse.ArgumentTypeError(f"{text!r} is not X,Y,Z,RX,RY,RZ, as 0,0,500,30,0,0")
    return Pose(np.radians(numbers[3:]), numbers[:3])
