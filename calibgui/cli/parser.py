"""Parsing of the command line: errors of two lines that name what was probably meant."""

from __future__ import annotations

import argparse
import difflib
import os
from collections.abc import Iterable, Sequence
from importlib import import_module
from typing import Any, NoReturn

from calibgui.version import __version__

COMMANDS = {
    "calibrate": "calibrate a camera from photographs of a checkerboard or another board",
    "batch": "calibrate many cameras from a list, on all processors or a cluster",
    "print": "write a board to print, in true size",
    "capture": "take the pictures live: what to do with the board is said",
    "detect": "locate the corners of the board in photographs",
    "undistort": "write photographs without lens distortion",
    "rectify": "write photographs of the board as seen from straight above",
    "pose": "locate the board in photographs of a camera that is known",
    "hand-eye": "find where a camera is in a robot's hand, or beside the robot",
    "rig": "calibrate several cameras that stand fast to each other",
    "triangulate": "find points in space from their pixels in the cameras of a rig",
    "stereo": "write pairs of photographs of a rig with the same points in the same rows",
    "rays": "find the rays that pixels look along, or the points of a plane that they see",
    "models": "compare lens models on photographs, and recommend one",
    "compare": "compare methods of calibration on photographs, side by side",
    "report": "write a report on a calibration, or a certificate, as HTML or PDF",
    "uncertainty": "show how far a calibration can be trusted",
    "noise": "measure how far corners scatter in frames of a board that stands still",
    "diff": "compare two calibrations of a camera",
    "series": "describe a camera whose zoom, focus or temperature varies",
    "fleet": "show a fleet of cameras as a page: distributions, outliers, drift",
    "check": "check with a few pictures whether a stored calibration is still good",
    "convert": "convert a camera file to another lens model or format",
    "views": "study how many views are enough, and where to hold the board next",
    "demo": "calibrate the bundled sample and write all results and figures",
    "paper": "reproduce the paper from its 25 images, with its printed numbers beside ours",
    "prepare": "compile what is slow in Python, once after an installation",
    "manual": "write the manual as one page for a browser",
    "completion": "print what completes these commands in a shell at the press of the tab key",
}
"""Subcommands, which but for hyphens are also the names of their modules, and their help texts."""


_FIRST = (
    *(
        "--square",
        "--board",
        "--target",
        "--exclude",
        "--model",
        "--as-asked",
        "--limits",
        "--scheduler",
    ),
    *("-o", "--export", "--for", "-v"),
)
"""Options that help lists first, of commands that have many."""
_MANY = 20
"""Number of options from which help lists the first ones alone: a screen's."""


class Parser(argparse.ArgumentParser):
    """A parser whose errors are two lines: what is wrong, and the usage in short."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings, add_help=False)
        self.add_argument(
            "-h",
            "--help",
            action=_Help,
            nargs="?",
            metavar="all",
            help="show this help message and exit; with all, that on every option",
        )

    def format_help(self) -> str:
        """Format the help on all options; of many the usage names those alone that are needed."""
        if len(self._list_options()) >= _MANY:
            self.usage = self.format_short_usage().partition(" (")[0].removeprefix("usage: ")
        return super().format_help()

    def format_short_help(self) -> str:
        """Format the help on the options that are used most; on all of them if they are few."""
        options = self._list_options()
        if len(options) < _MANY:
            return self.format_help()
        rank = {name: k for k, name in enumerate(_FIRST)}
        listed = [each for each in options if rank.keys() & set(each.option_strings)]
        listed.sort(key=lambda each: min(rank.get(name, len(rank)) for name in each.option_strings))
        required = [each for each in options if each.required and each not in listed]
        formatter = self._get_formatter()
        formatter.add_text(self.format_short_usage().partition(" (")[0])
        formatter.add_text(self.description)
        formatter.start_section("arguments")
        formatter.add_arguments([each for each in self._actions if not each.option_strings])
        formatter.end_section()
        formatter.start_section("options that are used most")
        formatter.add_arguments([*required, *listed])
        formatter.end_section()
        more = len(options) - len(required) - len(listed)
        formatter.add_text(f"{self.prog} --help all describes {more} more.")
        return formatter.format_help()

    def _list_options(self) -> list[argparse.Action]:
        """List the options but for --help."""
        return [each for each in self._actions if each.option_strings and each.dest != "help"]

    def parse_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Return the parsed arguments, or end the program and suggest what was probably meant."""
        options, unknown = self.parse_known_args(args, namespace)
        if unknown:
            self.error(self._describe_unknown(unknown[0]))
        return options

    def error(self, message: str) -> NoReturn:
        """End the program with exit code 2, the reason and a line on the usage."""
        self.exit(2, f"{self.prog}: {message}\n{self.format_short_usage()}\n")

    def _describe_unknown(self, argument: str) -> str:
        """Describe an argument that nothing accepts."""
        name = argument.partition("=")[0]
        if not name.startswith("-"):
            return f"{argument!r} is one argument too many."
        known = [option for action in self._actions for option in action.option_strings]
        return f"there is no option {name}.{suggest(name, known)}"

    def format_short_usage(self) -> str:
        """Format the usage in one line, with what is needed and no more."""
        needed = [a for a in self._actions if a.required or not a.option_strings]
        formatter = argparse.HelpFormatter(self.prog, width=1000)
        formatter.add_usage(None, needed, [])
        usage = formatter.format_help().strip()
        return f"{usage} [OPTION ...] (--help explains all)"


class _Help(argparse.Action):
    """Prints the help of a parser: of one with many options the first, or all with "all"."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,  # noqa: ARG002 - argparse's arguments
        values: Any,
        option_string: str | None = None,  # noqa: ARG002
    ) -> None:
        """Print, and end the program."""
        text = parser.format_help()
        if isinstance(parser, Parser) and values != "all":
            text = parser.format_short_help()
        print(text, end="")
        parser.exit()


def suggest(word: str, known: Iterable[str], before: str = "") -> str:
    """Return a sentence that asks whether the nearest of the `known` words was meant, or nothing.

    The sentence begins with a blank, and names the word after `before`.
    """
    near = difflib.get_close_matches(word, list(known), n=1)
    return f" Did you mean {before}{near[0]}?" if near else ""


def build_parser() -> tuple[Parser, dict[str, Parser]]:
    """Return the program's parser and those of the subcommands, which `configure` describes."""
    parser = Parser(
        prog="calibgui",
        description="Geometric camera calibration from photographs of a flat board.",
        epilog="calibgui COMMAND --help describes a command. Without one, calibgui [FOLDER | "
        "IMAGES | PROJECT] opens the window. To begin with squares of 25 mm: "
        "calibgui calibrate FOLDER --square 25 -o camera.json",
    )
    parser.add_argument(
        "--version",
        action="version",
        version=f"calibgui {__version__}",
        help="print the version and exit; with --json those of all packages as well",
    )
    choices = parser.add_subparsers(title="commands", metavar="COMMAND", dest="command")
    return parser, {name: choices.add_parser(name, help=text) for name, text in COMMANDS.items()}


def configure(name: str, parser: Parser) -> Any:
    """Describe the arguments of the subcommand `name` to its parser, and return its module."""
    command = import_module(f"calibgui.cli.{name.replace('-', '_')}")
    parser.description = command.__doc__
    import_module("calibgui.cli.console").configure(parser)
    command.configure(parser)
    return command


def describe_misuse(arguments: Sequence[str]) -> str:
    """Describe what is wrong with arguments that begin with no command, and are not only files."""
    first = arguments[0]
    command = next((word for word in arguments if word in COMMANDS), None)
    if first.startswith("-") and command is not None:
        return f"options follow the command: calibgui {command} {first} ..."
    if not os.path.exists(first):  # noqa: PTH110 - no import
        return _describe_missing(first)
    option = next((name for name in arguments if name.startswith("-")), None)
    if option is not None:
        return (
            f"{option} belongs to a command, and none is named."
            f" Did you mean calibgui calibrate {first} {option} ...?"
        )
    missing = next(name for name in arguments if not os.path.exists(name))  # noqa: PTH110
    return _describe_missing(missing)


def _describe_missing(name: str) -> str:
    """Describe a name that is that of no command, file or folder."""
    if near := suggest(name, COMMANDS, "calibgui "):
        return f"{name!r} is neither a command nor a file or folder.{near}"
    if name in ("help", "version"):
        return f"{name!r} is an option. Did you mean calibgui --{name}?"
    folder, base = os.path.split(name.rstrip("/" + os.sep))
    try:
        beside = os.listdir(folder or ".")  # noqa: PTH208 - no import
    except OSError:
        beside = []
    near = suggest(base, beside, os.path.join(folder, ""))  # noqa: PTH118 - no import
    return f"there is no such file or folder: {name}.{near}"
