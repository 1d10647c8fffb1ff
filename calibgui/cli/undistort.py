"""Write photographs without lens distortion, as an ideal camera would have taken them."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from calibgui.app.outputs.resampling import Undistortion, undistort_files
from calibgui.app.photographs.paths import find_images
from calibgui.app.photographs.sensor_frame import find_common_size
from calibgui.cli.arguments import add_image_paths, parse_positive
from calibgui.cli.camera import CAMERA_FILE, add_camera_options, read_camera_and_warn
from calibgui.cli.console import Console
from calibgui.cli.resampled import add_output_folder, report_written
from calibgui.cli.sensor_mode import adapt_to_images, add_mode_options
from calibgui.engine.images import FieldOfView, Projection, describe_hidden_angles


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("result", type=Path, metavar="RESULT", help=CAMERA_FILE)
    add_camera_options(parser)
    add_mode_options(parser, "the photographs")
    add_image_paths(parser)
    add_output_folder(parser)
    parser.add_argument(
        "--projection",
        choices=[projection.value for projection in Projection],
        metavar="NAME",
        default=Projection.PERSPECTIVE.value,
        help="perspective (default): straight lines stay straight, for less than 180 degrees; "
        "cylindrical: a panorama whose upright lines stay straight; equirectangular: a map of "
        "longitude and latitude, for viewers of 360-degree images; stereographic: a wide view in "
        "which small things keep their shape; cube: perspective images of 90 degrees to all sides, "
        "NAME_front.png, NAME_left.png and so on",
    )
    shown = parser.add_mutually_exclusive_group()
    shown.add_argument(
        "--view",
        choices=[view.value for view in FieldOfView],
        default=FieldOfView.ALL.value,
        help="show all of the photograph with some border (default), as much as fits without a "
        "border, or keep the scale in the middle; a perspective image of a lens of 180 degrees and "
        "more shows at most 120 of them",
    )
    shown.add_argument(
        "--fov",
        type=parse_positive,
        metavar="DEGREES",
        help="field of view instead: the angle from the left edge of the new images to the right "
        "one, in degrees",
    )
    parser.add_argument(
        "--square-pixels",
        action="store_true",
        help="stretch the new images where the pixels of the photographs are not square, as those "
        "of anamorphic lenses and PAL video",
    )


def run(options: argparse.Namespace, console: Console) -> int:
    """Read, undistort and write; return the exit code."""
    found = read_camera_and_warn(options.result, console, options.camera, options.size)
    images = find_images(options.paths)
    size = find_common_size(images, found.camera.size, found.orientation)
    found = adapt_to_images(found, options, console, size)
    camera = found.camera
    if found.rectification is not None:
        console.print_problem(
            f"calibgui: {options.result} holds the rectification of a stereo pair (R, P), which is "
            "left out: the new images look where the camera does."
        )
    undistortion = Undistortion(
        Projection(options.projection),
        FieldOfView(options.view),
        None if options.fov is None else math.radians(options.fov),
        options.square_pixels,
    )
    shown = describe_hidden_angles(camera, undistortion.choose_cameras(camera))
    with console.show_progress("undistorting") as advance:
        written = undistort_files(
            camera,
            images,
            options.output,
            undistortion,
            progress=lambda done, total, _: advance(done, total),
            overwrite=options.overwrite,
            orientation=found.orientation,
        )
    return report_written(written, options.output, console, shown)
