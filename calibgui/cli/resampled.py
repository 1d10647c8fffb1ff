"""The common part of undistort and rectify: a folder of new images."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from calibgui.app.outputs.resampling import GEOMETRY_FILE, WrittenImage
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import FORMATS
from calibgui.report.numbers import format_count
from calibgui.report.tables import fill_lines


def add_output_folder(parser: argparse.ArgumentParser) -> None:
    """Add the options on the folder of the new images."""
    parser.add_argument(
        "-o",
        "--output",
        type=_parse_folder,
        required=True,
        metavar="DIR",
        help="folder for the new images, created if missing; not that of the photographs",
    )
    add_overwrite_option(parser)


def _parse_folder(text: str) -> Path:
    """Return the folder of that name, unless it is that of an image."""
    folder = Path(text)
    if folder.suffix.lower() in FORMATS and not folder.is_dir():
        raise argparse.ArgumentTypeError(
            f"{text!r} is an image's name: name a folder for the new ones"
        )
    return folder


def report_written(
    written: Sequence[WrittenImage], folder: Path, console: Console, shown: str = ""
) -> int:
    """Print which images were written and which were not, and what they show of the lens's view;
    return the exit code, 1 if an image was not written.

    The JSON object names one new image by its path, and the faces of a cube by an object.

    Raises:
        CalibrationError: if no image was written.
    """
    failed = [image for image in written if not image.paths]
    for image in failed:
        named = image.reason.startswith(str(image.source))  # as errors of reading do
        reason = image.reason if named else f"{image.source}: {image.reason}"
        console.print_problem(f"calibgui: skipped: {reason}")
    done = len(written) - len(failed)
    if not done:
        raise CalibrationError("No image was written.", "See the reasons above.")
    paths = {
        str(image.source): {face: str(path) for face, path in image.paths.items()}
        for image in written
        if image.paths
    }
    console.print_json(
        {
            "folder": str(folder),
            "geometry": str(folder / GEOMETRY_FILE),
            "written": {source: faces.get("", faces) for source, faces in paths.items()},
            "skipped": {str(image.source): image.reason for image in failed},
            **({"shown": shown} if shown else {}),
        }
    )
    if shown:
        console.print_text(fill_lines(shown, "", "  "))
    count = format_count(sum(map(len, paths.values())), "image")
    console.print_text(f"Wrote {count} and their geometry, {GEOMETRY_FILE}, to {folder}.")
    return int(bool(failed))
