"""Arguments that several subcommands share, and the reading of their values."""

from __future__ import annotations

import argparse
import contextlib
import math
import re
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields
from functools import cache
from pathlib import Path
from typing import Any, BinaryIO

from calibgui.app.calibrating.settings import read_model_choice
from calibgui.app.photographs.board_recognition import explain_missing_board, find_any_board
from calibgui.app.photographs.detection import (
    Detection,
    find_views,
)
from calibgui.app.photographs.paths import find_images
from calibgui.app.photographs.regions import read_regions
from calibgui.app.photographs.videos import (
    DEFAULT_CHOICE,
    DEFAULT_FRAMES,
    FrameChoice,
    search_photographs,
)
from calibgui.cli.console import Console
from calibgui.dataset import LENS_TYPES, Hardware
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import CHECKERBOARD, Pattern
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features import METHODS, MIN_LINES
from calibgui.engine.images import FORMATS, Field
from calibgui.formats import EXPORTERS, find_exporter
from calibgui.formats.corner_import import SUFFIXES
from calibgui.report.tables import list_unused_views

_UNITS_MM = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}
"""Units of lengths, mm."""
_MAX_FRAMES = 10_000
_MIN_LENGTH_MM = 0.5
"""Length from which a number without a unit is taken for millimetres."""


def parse_grid_size(text: str) -> GridSize:
    """Read rows and columns of inner corners such as "12x13"."""
    match = re.fullmatch(r"(\d+)[x×*,](\d+)", text.strip())
    if match is None:
        raise argparse.ArgumentTypeError(f"{text!r} is not ROWSxCOLS, as 12x13")
    size = int(match[1]), int(match[2])
    if min(size) < MIN_LINES:
        raise argparse.ArgumentTypeError(
            f"a board needs at least {MIN_LINES}x{MIN_LINES} inner corners"
        )
    return size


def parse_positive(text: str) -> float:
    """Read a finite number above 0."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number above 0")
    return value


def add_square_option(parser: argparse.ArgumentParser, need: str) -> None:
    """Add --square, the length that scales the board; `square_sigma` is 0.

    Args:
        parser: the parser to add it to.
        need: what the help says of when the length is needed.
    """
    parser.set_defaults(square_sigma=0.0)
    parser.add_argument(
        "--square",
        type=parse_length,
        metavar="MM",
        help=f"side of a square, or distance of circles, mm, or with a unit as 0.025m; {need}",
    )


def add_scale_option(parser: argparse.ArgumentParser, need: str) -> None:
    """Add --square with its uncertainty: the options `square` and `square_sigma`, mm.

    Args:
        parser: the parser to add it to.
        need: what the help says of when the length is needed.
    """
    parser.set_defaults(square_sigma=0.0)
    parser.add_argument(
        "--square",
        type=parse_square,
        action=_StoreSquare,
        metavar="MM",
        help="side of a square, or distance of circles, mm, or with a unit as 0.025m; with one "
        "standard deviation as 30+-0.02, or as a certificate states 10 squares: '300+-0.05 "
        f"(k=2)/10'; {need}",
    )


class _StoreSquare(argparse.Action):
    """Keeps the side of a square and its standard deviation as two options."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        """Set both options."""
        del parser, option_string
        namespace.square, namespace.square_sigma = values


def parse_square(text: str) -> tuple[float, float]:
    """Read the side of a square and its standard deviation, mm.

    The text is a length, "30"; one with a standard deviation, "30+-0.02" or "30±0.02"; or that of
    several squares together, "300+-0.05/10". "(k=2)" says that the uncertainty is expanded.
    """
    match = re.fullmatch(
        r"(?P<length>[^±/]+?)(?:\s*(?:±|\+-|\+/-)\s*(?P<sigma>[^±/(]+?))?"
        r"\s*(?:\(\s*k\s*=\s*(?P<k>[\d.]+)\s*\))?\s*(?:/\s*(?P<count>\d+))?\s*",
        text,
    )
    if match is None or (match["k"] and not match["sigma"]) or match["count"] == "0":
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a length above 0, as 30, 30+-0.02 or, of 10 squares, 300+-0.05/10"
        )
    count = int(match["count"] or 1)
    square = parse_length(match["length"]) / count
    if match["sigma"] is None:
        return square, 0.0
    unit = next((unit for unit in _UNITS_MM if match["length"].rstrip().endswith(unit)), "mm")
    has_unit = any(match["sigma"].endswith(each) for each in _UNITS_MM)
    sigma = parse_length(match["sigma"] if has_unit else match["sigma"] + unit) / count
    sigma /= parse_positive(match["k"] or "1")
    if sigma >= square:
        raise argparse.ArgumentTypeError(f"{text!r} is less certain than it is long")
    return square, sigma


def parse_length(text: str) -> float:
    """Read a length of a board, mm, with a unit or without one.

    Other programs take metres. So a number without a unit that would be less than a board has, mm,
    is refused: told nothing, a user would get poses a thousand times too small.
    """
    unit = next((unit for unit in _UNITS_MM if text.rstrip().endswith(unit)), "")
    try:
        length = parse_positive(text.rstrip().removesuffix(unit)) * _UNITS_MM.get(unit, 1.0)
    except argparse.ArgumentTypeError as error:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a length above 0, as 25, 25mm or 0.025m; the units are "
            f"{', '.join(_UNITS_MM)}"
        ) from error
    if not unit and length < _MIN_LENGTH_MM:
        raise argparse.ArgumentTypeError(
            f"{text} would be millimetres: say {text}m if it is metres, {text}mm if it is not"
        )
    return length


def add_image_paths(parser: argparse.ArgumentParser, nargs: str = "+") -> None:
    """Add the paths of the images to work on."""
    parser.add_argument(
        "paths", nargs=nargs, metavar="PATH", help="image, folder of images, pattern or video"
    )


def is_corners_file(paths: Sequence[str]) -> bool:
    """Return whether the paths name a file of corners to read, not photographs to search."""
    return list(paths) == ["-"] or (len(paths) == 1 and Path(paths[0]).suffix.lower() in SUFFIXES)


@contextlib.contextmanager
def open_input(path: str | Path) -> Iterator[Path]:
    """Give the file to read; for "-" a temporary one with what comes on standard input."""
    if str(path) != "-":
        yield Path(path)
        return
    with tempfile.TemporaryDirectory(prefix="calibgui-") as folder:
        file = Path(folder) / "standard-input"
        file.write_bytes(_read_once(sys.stdin.buffer))
        yield file


@cache
def _read_once(stream: BinaryIO) -> bytes:
    """Return the content of a stream, also where a command reads its file several times."""
    return stream.read()


@contextlib.contextmanager
def open_camera_file(path: str | Path) -> Iterator[Path]:
    """Give a camera's file as `open_input` does.

    Raises:
        CalibrationError: if `path` holds photographs, which commands on a camera name after it.
    """
    if Path(path).is_dir() or Path(path).suffix.lower() in FORMATS:
        raise CalibrationError(
            f"{path} holds photographs, where a camera's file is expected.",
            "Commands that take both expect the camera's file first.",
        )
    with open_input(path) as file:
        yield file


def list_input_files(paths: Sequence[str]) -> Sequence[str | Path]:
    """Return the files that will be read."""
    return paths if is_corners_file(paths) else find_images(paths)


def add_search_options(parser: argparse.ArgumentParser) -> None:
    """Add the options on how the board is searched."""
    add_grid_size_option(parser)
    parser.add_argument(
        "--roi",
        type=Path,
        metavar="FILE",
        help="JSON file {image name: [[u, v] x 4]}: the board's four outermost corners, px",
    )

    add_corner_method(parser)
    parser.add_argument(
        "--field",
        type=Field,
        choices=list(Field),
        metavar="FIELD",
        help="use one field of interlaced frames, odd (the first row, the third ...) or even; the "
        "rows between are interpolated",
    )
    parser.add_argument(
        "--frames",
        type=_parse_count,
        default=DEFAULT_FRAMES,
        metavar="N",
        help="frames to take of each video, sharp ones with the board in different poses "
        f"(default {DEFAULT_FRAMES})",
    )
    parser.add_argument(
        "--frames-folder",
        type=Path,
        metavar="DIR",
        help="where the frames of VIDEO are written, in a folder VIDEO-frames (default: beside the "
        "output)",
    )


def _parse_count(text: str) -> int:
    """Read a whole number above 0."""
    if not text.isdecimal() or not 0 < int(text) <= _MAX_FRAMES:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of frames, 1 to {_MAX_FRAMES}")
    return int(text)


def add_grid_size_option(parser: argparse.ArgumentParser) -> None:
    """Add the option on the size of the board."""
    parser.add_argument(
        "--board",
        type=parse_grid_size,
        metavar="ROWSxCOLS",
        help="inner corners of the board (one fewer than squares each way), or circles of a grid; "
        "inferred from the photographs if left out",
    )


def add_corner_method(parser: argparse.ArgumentParser) -> None:
    """Add the option on how corners are located."""
    parser.add_argument(
        "--corners",
        choices=METHODS,
        default=METHODS[0],
        help="locate corners by their edges (default) or, as the paper does, by the saddle point "
        "of the grey levels",
    )


def add_map_options(parser: argparse.ArgumentParser, points: str) -> None:
    """Add the options of a map over the image: the distance of the `points`, and its file."""
    parser.add_argument(
        "--distance",
        type=parse_positive,
        default=math.inf,
        metavar="MM",
        help=f"distance of the points that {points} (default: far away)",
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="draw the map (.png, .svg, .pdf)"
    )


def add_reader_option(parser: argparse.ArgumentParser) -> None:
    """Add the option that calibrates for a program that has not all lens models."""
    parser.add_argument(
        "--for",
        dest="reader",
        type=parse_export,
        metavar="FORMAT=FILE",
        help="write another format, and choose the lens model among those that it has, so that the "
        "file holds the camera as it was calibrated and not a refit of it",
    )


def add_export_option(parser: argparse.ArgumentParser, purpose: str) -> None:
    """Add the option on files of other formats, whose help begins with its `purpose`.

    Its value is a list of pairs of a format's name and a file.
    """
    parser.add_argument(
        "--export",
        type=parse_export,
        action="append",
        default=[],
        metavar="FORMAT=FILE",
        help=f"{purpose}, may be repeated: {', '.join(EXPORTERS)}",
    )


def add_export_folder_option(parser: argparse.ArgumentParser) -> None:
    """Add the option on a folder for all formats."""
    parser.add_argument(
        "--export-all",
        type=Path,
        metavar="FOLDER",
        help="write every format into a folder, with a page that tells who reads which file",
    )


def add_hardware_option(parser: argparse.ArgumentParser) -> None:
    """Add the option that names camera and lens, whose value is a list of pairs of texts."""
    parser.add_argument(
        "--hardware",
        type=_parse_hardware,
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="name the camera or the lens for exports that do, may be repeated: "
        f"{', '.join(field.name for field in fields(Hardware))} (rectilinear or fisheye); what is "
        "left out is taken from EXIF",
    )


def read_hardware_options(options: argparse.Namespace) -> Hardware:
    """Return the camera and the lens that the options of `add_hardware_option` name."""
    return Hardware(**dict(options.hardware))


def _parse_hardware(text: str) -> tuple[str, str | float]:
    """Read what is known of camera or lens such as "maker=Canon"."""
    key, equals, value = text.partition("=")
    if not equals or not value or key not in {field.name for field in fields(Hardware)}:
        raise argparse.ArgumentTypeError(f"{text!r} is not KEY=VALUE")
    if key == "type" and value not in LENS_TYPES:
        raise argparse.ArgumentTypeError(f"{value!r} is not {' or '.join(LENS_TYPES)}")
    return key, parse_positive(value) if key == "crop" else value


def search_images(
    console: Console,
    paths: Iterable[str],
    grid_size: GridSize | None = None,
    roi: Path | None = None,
    corners: str = METHODS[0],
    pattern: Pattern | None = CHECKERBOARD,
    choice: FrameChoice = DEFAULT_CHOICE,
    field: Field | None = None,
) -> Detection:
    """Find the images that `paths` name and search them for the board, showing progress.

    Without a `pattern` they are searched for a checkerboard, and if they show another board than a
    plain one, for that.

    Raises:
        CalibrationError: if a path names no image, or the regions in `roi` cannot be used.
    """

    def search_files(images: Sequence[Path]) -> Detection:
        rois = read_regions(roi, images) if roi else {}

        def search(pattern: Pattern, grid_size: GridSize | None) -> Detection:
            with console.show_progress("searching") as advance:
                return find_views(
                    images,
                    grid_size,
                    rois,
                    lambda done, total, _: advance(done, total),
                    method=corners,
                    pattern=pattern,
                    field=field,
                )

        return search(pattern, grid_size) if pattern else find_any_board(search, grid_size)

    return search_photographs(list(paths), choice, search_files, console.show_progress)


def require_board(
    detection: Detection,
    grid_size: GridSize | None,
    console: Console,
    is_any_looked_for: bool = False,
) -> None:
    """Refuse photographs none of which shows the board, and say what they show instead.

    Args:
        detection: what was found of the pattern that was looked for.
        grid_size: of the board, if stated.
        console: takes the list of images with other faults.
        is_any_looked_for: True if boards of all other patterns were looked for as well.

    Raises:
        CalibrationError: if there are such, after a list of the images that have other faults.
    """
    error, faults = explain_missing_board(detection, grid_size, is_any_looked_for)
    if error is None:
        return
    if unused := list_unused_views(faults):
        console.print_problem(unused)
    raise error


def parse_model(text: str) -> str | None:
    """Read the name of a lens model; None for one that is chosen automatically."""
    try:
        return read_model_choice(text)
    except CalibrationError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def parse_export(text: str) -> tuple[str, Path]:
    """Read the name of a format and a file such as "ros=camera.yaml"."""
    name, equals, file = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"{text!r} is not FORMAT=FILE")
    try:
        find_exporter(name, file)
    except CalibrationError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
    return name, Path(file)
