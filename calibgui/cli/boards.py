"""The options that describe the board which the photographs show."""

from __future__ import annotations

import argparse
import re
from dataclasses import replace
from typing import Any

from calibgui.cli.arguments import parse_length, parse_positive
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import CHECKERBOARD, FAMILIES, KINDS, ListedCircles, Pattern
from calibgui.engine.errors import CalibrationError
from calibgui.formats.circle_list import read_circle_list

PATTERN_OPTIONS = {
    "dictionary": "charuco",
    "marker": "charuco",
    "legacy": "charuco",
    "first_marker": "charuco",
    "diameter": "circles",
    "layout": "listed-circles",
    "family": "aprilgrid or tagged-checkerboard",
    "border": "aprilgrid or tagged-checkerboard",
    "from_top": "aprilgrid or tagged-checkerboard",
    "spacing": "aprilgrid",
    "corner_squares": "aprilgrid",
    "first_tag": "aprilgrid",
    "step": "tagged-checkerboard",
    "origin": "puzzleboard",
}
"""Options that describe a pattern, each with the kind of pattern that it is for."""
_LENGTH_OPTIONS = ("marker", "diameter")
"""Names of the options in mm, which a pattern keeps as fractions of the side of a square."""


def add_board_options(
    parser: argparse.ArgumentParser,
    unstated: str = "Properties of markers and tags that are not given are read from the "
    "photographs.",
) -> None:
    """Add the options that describe the board; a sentence says what becomes of others."""
    parser.set_defaults(usage_error=parser.error)
    group = parser.add_argument_group("board", unstated)
    group.add_argument(
        "--target",
        choices=list(KINDS),
        metavar="KIND",
        help=f"the printed pattern, one of {', '.join(KINDS)}; if left out the photographs tell, "
        "and with --roi it is a checkerboard; --board counts inner corners or circles, of an "
        "AprilGrid two for each tag; --square is the side of a square or tag, the distance of "
        "circles, or the distance of the rows of an asymmetric grid",
    )
    group.add_argument(
        "--dictionary",
        type=str.upper,
        metavar="NAME",
        help="dictionary of the markers of a ChArUco board, as DICT_4X4_50",
    )
    group.add_argument(
        "--marker", type=parse_length, metavar="MM", help="side of a marker of a ChArUco board"
    )
    group.add_argument(
        "--legacy",
        action="store_true",
        default=None,
        help="the ChArUco board was made before OpenCV 4.6: with an even number of rows of "
        "squares its first square is white",
    )
    group.add_argument(
        "--first-marker",
        type=int,
        metavar="NUMBER",
        help="number of the first marker of a ChArUco board: 0 on most; markers before it are "
        "passed over, and with --board those after the board's last",
    )
    group.add_argument(
        "--diameter",
        type=parse_length,
        metavar="MM",
        help="diameter of a circle; measured if left out",
    )
    group.add_argument(
        "--layout",
        type=_read_layout,
        metavar="FILE",
        help="circles in places that no grid describes: a table of their x and y, mm, or JSON; "
        "--square and --board follow from it",
    )
    group.add_argument(
        "--family", choices=list(FAMILIES), metavar="NAME", help="family of AprilTags, as t36h11"
    )
    group.add_argument(
        "--spacing",
        type=parse_positive,
        metavar="RATIO",
        help="gap between the tags of an AprilGrid over the side of a tag, Kalibr's tagSpacing, "
        "at most 1; measured if left out",
    )
    group.add_argument(
        "--border",
        type=int,
        choices=(1, 2),
        metavar="CELLS",
        help="width of the black border of a tag: 2 on Kalibr's boards, else 1",
    )
    group.add_argument(
        "--step",
        type=int,
        metavar="SQUARES",
        help="squares from one tag to the next in a row of a checkerboard with tags",
    )
    group.add_argument(
        "--from-top",
        action="store_true",
        default=None,
        help="the tags are numbered from the top row, not from the bottom one as Kalibr's",
    )
    group.add_argument(
        "--corner-squares",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="small dark squares stand between the corners of the tags of an AprilGrid, as on "
        "Kalibr's, or do not",
    )
    group.add_argument(
        "--first-tag",
        type=int,
        metavar="NUMBER",
        help="number of the first tag of an AprilGrid, the lowest on the board: 0 on most",
    )
    group.add_argument(
        "--origin",
        type=_parse_origin,
        metavar="ROWxCOL",
        help="row and column of a PuzzleBoard's first corner on the whole pattern; 0x0 if left out",
    )


def _read_layout(text: str) -> tuple[ListedCircles, float]:
    """Read a list of circles, and their least distance, mm."""
    try:
        return read_circle_list(text)
    except CalibrationError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def _parse_origin(text: str) -> GridSize:
    """Read the row and column of a corner, such as "50x100"."""
    match = re.fullmatch(r"(\d+)[x×*,](\d+)", text.strip())
    if match is None:
        raise argparse.ArgumentTypeError(f"{text!r} is not ROWxCOL, as 50x100")
    return int(match[1]), int(match[2])


def read_pattern_options(options: argparse.Namespace) -> Pattern:
    """Return the pattern that `add_board_options`, --board, --square and --corners describe.

    What a list of circles says of --square and --board is set in `options`. The program ends with a
    usage error if they do not go together.
    """
    if options.layout is not None:
        return _take_layout(options)
    target = options.target or CHECKERBOARD.kind
    if target == ListedCircles().kind:
        options.usage_error(f"--target {target} needs --layout FILE, which lists the circles")
    usual: Any = KINDS[target]
    stated = {
        name: getattr(options, name)
        for name in PATTERN_OPTIONS
        if getattr(options, name) is not None
    }
    for name in stated:
        if not hasattr(usual, name):
            options.usage_error(
                f"--{name.replace('_', '-')} is for --target {PATTERN_OPTIONS[name]}, "
                f"not for {target}"
            )
        if name in _LENGTH_OPTIONS:
            if options.square is None:
                options.usage_error(f"--{name} needs --square MM as well")
            stated[name] /= options.square
    if not usual.has_squares and options.corners != "edges":
        options.usage_error(f"--corners {options.corners} is for corners, not for circles")
    try:
        pattern: Pattern = replace(usual, **stated)
    except CalibrationError as error:
        options.usage_error(str(error))
    return pattern


def _take_layout(options: argparse.Namespace) -> ListedCircles:
    """Return the pattern of --layout, with what else is stated of it."""
    pattern: ListedCircles = options.layout[0]
    pitch: float = options.layout[1]
    if options.target not in (None, pattern.kind):
        options.usage_error(f"--layout is for --target {pattern.kind}, not for {options.target}")
    if options.square is not None or options.board is not None:
        options.usage_error("--square and --board follow from --layout")
    options.square, options.board = pitch, pattern.grid_size
    try:
        if options.diameter is not None:
            pattern = replace(pattern, diameter=options.diameter / pitch)
    except CalibrationError as error:
        options.usage_error(str(error))
    return pattern


def is_pattern_open(options: argparse.Namespace) -> bool:
    """Return whether neither the board's pattern is stated nor its place, so that the photographs
    are to tell the pattern."""
    return options.target is None and options.layout is None and options.roi is None
