"""Arguments that several subcommands share, and what they stand for."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from calibgui.app.detection import Detection, find_views
from calibgui.app.paths import find_images
from calibgui.app.regions import read_regions
from calibgui.cli.console import Console
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import CHECKERBOARD, Pattern
from calibgui.engine.detection import METHODS, MIN_LINES
from calibgui.engine.kernels import FINDER_SECONDS


def grid_size(text: str) -> GridSize:
    """Rows and columns of inner corners from "12x13"."""
    match = re.fullmatch(r"(\d+)[x×*,](\d+)", text.strip())
    if match is None:
        raise argparse.ArgumentTypeError(f"{text!r} is not ROWSxCOLS, as 12x13")
    size = int(match[1]), int(match[2])
    if min(size) < MIN_LINES:
        raise argparse.ArgumentTypeError(
            f"a board needs at least {MIN_LINES}x{MIN_LINES} inner corners"
        )
    return size


def positive(text: str) -> float:
    """A positive, finite number."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number above 0")
    return value


def add_images(parser: argparse.ArgumentParser, nargs: str = "+") -> None:
    """The images to work on."""
    parser.add_argument(
        "paths", nargs=nargs, metavar="PATH", help="image, folder of images or pattern"
    )


def is_corners_file(paths: Sequence[str]) -> bool:
    """Whether corners to read are named, rather than photographs to search."""
    return [Path(path).suffix.lower() for path in paths] == [".json"]


def meant_files(paths: Sequence[str]) -> Sequence[str | Path]:
    """The files that will be read."""
    return paths if is_corners_file(paths) else find_images(paths)


def add_search(parser: argparse.ArgumentParser) -> None:
    """How the board is to be searched."""
    parser.add_argument(
        "--board",
        type=grid_size,
        metavar="ROWSxCOLS",
        help="inner corners of the board (squares minus one each way), inferred if left out; or "
        "circles of a grid",
    )
    parser.add_argument(
        "--roi",
        type=Path,
        metavar="FILE",
        help="JSON file {image name: [[u, v] x 4]}: the board's four outermost corners, px",
    )

    add_method(parser)


def add_method(parser: argparse.ArgumentParser) -> None:
    """How corners are to be located."""
    parser.add_argument(
        "--corners",
        choices=METHODS,
        default=METHODS[0],
        help="locate corners by their edges (default), or as the paper does, by the saddle point "
        "of the grey levels",
    )


def add_map(parser: argparse.ArgumentParser, points: str) -> None:
    """The distance of the `points` that a map over the image is for, and its file."""
    parser.add_argument(
        "--distance",
        type=positive,
        default=math.inf,
        metavar="MM",
        help=f"of the points that {points} (default: far away)",
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="draw the map (.png, .svg, .pdf)"
    )


def search(
    console: Console,
    paths: Iterable[str],
    grid_size: GridSize | None = None,
    roi: Path | None = None,
    corners: str = METHODS[0],
    pattern: Pattern = CHECKERBOARD,
) -> Detection:
    """Find the images that are meant and search them for the board, showing progress.

    Raises:
        CalibrationError: if a path stands for nothing, or the regions in `roi` are no good.
    """
    images = find_images(paths)
    rois = read_regions(roi, images) if roi else {}
    with console.progress("searching") as advance:
        return find_views(
            images,
            grid_size,
            rois,
            lambda done, total, _: advance(done, total),
            method=corners,
            pattern=pattern,
            preparing=lambda: console.notice(
                f"Preparing the corner finder for its first use (once, about {FINDER_SECONDS} s)…"
            ),
        )
