"""The camera that a subcommand works with, from result.json or a file of another program."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from calibgui.cli.arguments import open_camera_file
from calibgui.cli.console import Console
from calibgui.engine.arrays import Size
from calibgui.formats import ImportedCamera, read_camera

CAMERA_FILE = "result.json, or the camera file of another program"
"""Words for the help of an argument that names such a file."""


def add_camera_options(parser: argparse.ArgumentParser) -> None:
    """Add the options on files that hold several cameras, or do not state the images' size."""
    add_camera_name_option(parser)
    add_size_option(parser)


def add_camera_name_option(parser: argparse.ArgumentParser) -> None:
    """Add the option on files that hold several cameras."""
    parser.add_argument(
        "--camera", metavar="NAME", help="the camera to read from a file that holds several"
    )


def add_size_option(parser: argparse.ArgumentParser) -> None:
    """Add the option on files that do not state the images' size."""
    parser.add_argument(
        "--size",
        type=parse_size,
        metavar="WxH",
        help="width and height of the images, px, for a file that does not state them",
    )


def read_camera_and_warn(
    path: Path, console: Console, name: str | None = None, size: Size | None = None
) -> ImportedCamera:
    """Read a camera, and print what the user should know about it. Raises as `read_camera`."""
    with open_camera_file(path) as file:
        found = read_camera(file, name, size)
    for note in found.notes:
        console.print_problem(f"calibgui: {path}: {note}")
    return found


def parse_size(text: str) -> Size:
    """Read a width and a height such as "1920x1080"."""
    match = re.fullmatch(r"(\d{1,6})[x×*,](\d{1,6})", text.strip())
    if match is None or "0" in (match[1].lstrip("0") or "0", match[2].lstrip("0") or "0"):
        raise argparse.ArgumentTypeError(f"{text!r} is not WIDTHxHEIGHT, as 1920x1080")
    return int(match[1]), int(match[2])
