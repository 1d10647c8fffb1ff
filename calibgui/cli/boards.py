"""The options that describe the board which the photographs show."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import Any

from calibgui.cli.arguments import parse_positive
from calibgui.engine.boards import KINDS, Pattern
from calibgui.engine.errors import CalibrationError

_PATTERN_OPTIONS = {
    "dictionary": "charuco",
    "marker": "charuco",
    "legacy": "charuco",
    "diameter": "circles",
}
"""Options that describe a pattern, each with the kind of pattern that it is for."""
_LENGTH_OPTIONS = ("marker", "diameter")
"""Names of the options in mm, which a pattern keeps as fractions of the side of a square."""


def add_board_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that describe the board."""
    parser.set_defaults(usage_error=parser.error)
    group = parser.add_argument_group(
        "board", "Properties of a ChArUco board that are not given are read from the photographs."
    )
    group.add_argument(
        "--target",
        choices=list(KINDS),
        default="checkerboard",
        metavar="KIND",
        help=f"the printed pattern, one of {', '.join(KINDS)}; --board counts inner corners or "
        "circles, and --square is the side of a square, the distance of circles, or the distance "
        "of the rows of an asymmetric grid",
    )
    group.add_argument(
        "--dictionary",
        type=str.upper,
        metavar="NAME",
        help="dictionary of the markers of a ChArUco board, as DICT_4X4_50",
    )
    group.add_argument(
        "--marker", type=parse_positive, metavar="MM", help="side of a marker of a ChArUco board"
    )
    group.add_argument(
        "--legacy",
        action="store_true",
        default=None,
        help="the ChArUco board was made before OpenCV 4.6: with an even number of rows of "
        "squares its first square is white",
    )
    group.add_argument(
        "--diameter",
        type=parse_positive,
        metavar="MM",
        help="diameter of a circle; measured if left out",
    )


def read_pattern_options(options: argparse.Namespace) -> Pattern:
    """Return the pattern that `add_board_options`, --board, --square and --corners describe.

    The program ends with a usage error if they do not go together.
    """
    usual: Any = KINDS[options.target]
    stated = {
        name: getattr(options, name)
        for name in _PATTERN_OPTIONS
        if getattr(options, name) is not None
    }
    for name in stated:
        if not hasattr(usual, name):
            options.usage_error(
                f"--{name} is for --target {_PATTERN_OPTIONS[name]}, not for {options.target}"
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
