"""The boards of a rig on the command line: the first by options, others by theirs in quotes."""

from __future__ import annotations

import argparse
import shlex
from typing import NoReturn

import numpy as np

from calibgui.app.rig.boards import StatedBoard
from calibgui.cli.arguments import add_grid_size_option, add_square_option
from calibgui.cli.boards import PATTERN_OPTIONS, add_board_options, read_pattern_options
from calibgui.engine.geometry import Pose


def add_another_option(parser: argparse.ArgumentParser) -> None:
    """Add the option that states a further board."""
    parser.add_argument(
        "--another",
        action="append",
        default=[],
        metavar="OPTIONS",
        help="a further board that stands fast to the first and is told from it by its markers: "
        "its options in quotes, as '--first-marker 24' or '--target aprilgrid --board 8x8 --family "
        "t36h11'; what is left out is as of the first one, if both are of one kind; --place "
        "X,Y,Z,RX,RY,RZ states where it stands beside the first, mm and a rotation vector in "
        "degrees; may be repeated",
    )


def read_stated_boards(options: argparse.Namespace) -> list[StatedBoard]:
    """Return the boards that the options of a rig state.

    The program ends with a usage error if some do not go together.
    """
    others = [_parse_another(text, options) for text in options.another]
    return [_state_board(options), *(_state_board(own, own.place) for own in others)]


def _state_board(options: argparse.Namespace, pose: Pose | None = None) -> StatedBoard:
    """Return the board that options state; its pattern is open if its kind is not stated."""
    is_open = options.target is None and options.layout is None
    pattern = read_pattern_options(options)
    return StatedBoard(options.board, None if is_open else pattern, options.square, pose)


class _AnotherParser(argparse.ArgumentParser):
    """A parser whose errors are those of the whole command line."""

    def __init__(self, text: str, options: argparse.Namespace) -> None:
        super().__init__(prog="--another", add_help=False)
        self._text, self._options = text, options

    def error(self, message: str) -> NoReturn:
        """End the program with a usage error that names the board."""
        self._options.usage_error(f"--another {self._text!r}: {message}")
        raise AssertionError("a usage error ends the program")


def _parse_another(text: str, options: argparse.Namespace) -> argparse.Namespace:
    """Read the options of a further board; what is left out is as of the first."""
    parser = _AnotherParser(text, options)
    add_grid_size_option(parser)
    add_board_options(parser)
    add_square_option(parser, "")
    parser.add_argument("--place", type=_parse_place)
    parser.set_defaults(usage_error=parser.error, corners=options.corners)
    try:
        own = parser.parse_args(shlex.split(text))
    except ValueError as error:  # quotes that do not end
        parser.error(str(error))
    is_alike = own.target in (None, options.target)
    for name in ("square", *(("target", "board", *PATTERN_OPTIONS) if is_alike else ())):
        if getattr(own, name) is None:
            setattr(own, name, getattr(options, name))
    return own


def _parse_place(text: str) -> Pose:
    """Read where a board stands, such as "300,0,0,0,90,0"."""
    try:
        values = np.array([float(part) for part in text.split(",")])
    except ValueError:
        values = np.zeros(0)
    if values.shape != (6,) or not np.isfinite(values).all():
        raise argparse.ArgumentTypeError(f"{text!r} is not X,Y,Z,RX,RY,RZ")
    return Pose(np.radians(values[3:]), values[:3])
