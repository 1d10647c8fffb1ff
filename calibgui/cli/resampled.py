"""What undistort and rectify have in common: a folder of new images."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from calibgui.app.resampling import GEOMETRY, Written
from calibgui.cli.console import Console
from calibgui.engine.errors import CalibrationError
from calibgui.report.numbers import counted


def add_output(parser: argparse.ArgumentParser) -> None:
    """The folder of the new images."""
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="DIR",
        help="folder for the new images, created if missing; not that of the photographs",
    )


def show_written(written: Sequence[Written], folder: Path, console: Console) -> None:
    """Say what was written and what was not.

    Raises:
        CalibrationError: if nothing was.
    """
    failed = [one for one in written if one.path is None]
    for one in failed:
        console.problem(f"calibgui: skipped {one.source}: {one.reason}")
    done = len(written) - len(failed)
    if not done:
        raise CalibrationError("No image was written.", "See the reasons above.")
    console.answer(
        {
            "folder": str(folder),
            "geometry": str(folder / GEOMETRY),
            "written": {str(one.source): str(one.path) for one in written if one.path},
            "skipped": {str(one.source): one.reason for one in failed},
        }
    )
    console.say(f"Wrote {counted(done, 'image')} and their geometry, {GEOMETRY}, to {folder}.")
