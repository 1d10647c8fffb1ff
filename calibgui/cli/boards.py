"""Which target the photographs show."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import Any

from calibgui.cli.arguments import positive
from calibgui.engine.boards import KINDS, Pattern
from calibgui.engine.errors import CalibrationError

_OWN = {"dictionary": "charuco", "marker": "charuco", "legacy": "charuco", "diameter": "circles"}
"""The option that describes a pattern, and what kinds of pattern it is for."""
_LENGTHS = ("marker", "diameter")
"""Options in mm, kept over the side of a square."""


def add_target(parser: argparse.ArgumentParser) -> None:
    """What the target is."""
    parser.set_defaults(usage_error=parser.error)
    group = parser.add_argument_group(
        "target", "What is not stated of a ChArUco board is inferred from the photographs."
    )
    group.add_argument(
        "--target",
        choices=list(KINDS),
        default="checkerboard",
        metavar="KIND",
        help=f"what is printed, one of {', '.join(KINDS)}; --board counts inner corners or "
        "circles, and --square is the side of a square, the distance of circles, or that of the "
        "rows of an asymmetric grid",
    )
    group.add_argument(
        "--dictionary",
        type=str.upper,
        metavar="NAME",
        help="of the markers of a ChArUco board, as DICT_4X4_50",
    )
    group.add_argument(
        "--marker", type=positive, metavar="MM", help="side of a marker of a ChArUco board"
    )
    group.add_argument(
        "--legacy",
        action="store_true",
        default=None,
        help="the ChArUco board was made before OpenCV 4.6: with an even number of rows of "
        "squares its first square is white",
    )
    group.add_argument(
        "--diameter", type=positive, metavar="MM", help="of a circle; measured if left out"
    )


def pattern_of(options: argparse.Namespace) -> Pattern:
    """The pattern that the options of `add_target`, --board, --square and --corners state.

    Exits with a usage error if they do not go together.
    """
    usual: Any = KINDS[options.target]
    stated = {name: getattr(options, name) for name in _OWN if getattr(options, name) is not None}
    for name in stated:
        if not hasattr(usual, name):
            options.usage_error(f"--{name} is for --target {_OWN[name]}, not for {options.target}")
        if name in _LENGTHS:
            if options.square is None:
                options.usage_error(f"--{name} needs --square MM as well")
            stated[name] /= options.square
    if not usual.squared and options.corners != "edges":
        options.usage_error(f"--corners {options.corners} is for corners, not for circles")
    try:
        pattern: Pattern = replace(usual, **stated)
    except CalibrationError as error:
        options.usage_error(str(error))
    return pattern
