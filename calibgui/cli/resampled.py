"""The common part of undistort and rectify: a folder of new images."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from calibgui.app.resampling import GEOMETRY_FILE, WrittenImage
from calibgui.cli.console import Console
from calibgui.engine.errors import CalibrationError
from calibgui.report.numbers import format_count


def add_output_folder(parser: argparse.ArgumentParser) -> None:
    """Add the option that names the folder of the new images."""
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="DIR",
        help="folder for the new images, created if missing; not that of the photographs",
    )


def report_written(written: Sequence[WrittenImage], folder: Path, console: Console) -> None:
    """Print which images were written and which were not.

    Raises:
        CalibrationError: if no image was written.
    """
    failed = [image for image in written if image.path is None]
    for image in failed:
        console.print_problem(f"calibgui: skipped {image.source}: {image.reason}")
    done = len(written) - len(failed)
    if not done:
        raise CalibrationError("No image was written.", "See the reasons above.")
    console.print_json(
        {
            "folder": str(folder),
            "geometry": str(folder / GEOMETRY_FILE),
            "written": {str(image.source): str(image.path) for image in written if image.path},
            "skipped": {str(image.source): image.reason for image in failed},
        }
    )
    console.print_text(
        f"Wrote {format_count(done, 'image')} and their geometry, {GEOMETRY_FILE}, to {folder}."
    )
