"""Write photographs without lens distortion, as an ideal camera would have taken them."""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.app.paths import find_images
from calibgui.app.resampling import undistort_files
from calibgui.cli.arguments import add_image_paths
from calibgui.cli.console import Console
from calibgui.cli.resampled import add_output_folder, report_written
from calibgui.cli.result import read_result_and_warn
from calibgui.engine.images import FieldOfView


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("result", type=Path, metavar="RESULT", help="result.json of the camera")
    add_image_paths(parser)
    add_output_folder(parser)
    parser.add_argument(
        "--view",
        choices=[view.value for view in FieldOfView],
        default=FieldOfView.ALL.value,
        help="show all of the photograph with some border (default), as much as fits without a "
        "border, or keep the scale in the middle",
    )


def run(options: argparse.Namespace, console: Console) -> None:
    """Read, undistort and write."""
    camera = read_result_and_warn(options.result, console).calibration.camera
    images = find_images(options.paths)
    with console.show_progress("undistorting") as advance:
        written = undistort_files(
            camera,
            images,
            options.output,
            FieldOfView(options.view),
            progress=lambda done, total, _: advance(done, total),
        )
    report_written(written, options.output, console)
