"""Entry point: choose the subcommand, run it, and return an exit code.

The exit codes are 0 success; 1 the task is impossible, for the reason on stderr, or a check has
failed; 2 wrong usage; 70 a bug; 130 interrupted (Ctrl-C, SIGTERM); 141 the program that read our
output has ended.

To add a subcommand, write a module in this folder with `configure(parser)` and
`run(options, console)`, which may return an exit code, and name it in `COMMANDS`.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import signal
import sys
import traceback
from collections.abc import Sequence
from importlib import import_module

from calibgui import __version__

COMMANDS = {
    "calibrate": "calibrate a camera from photographs of a checkerboard or another board",
    "detect": "locate the corners of the board in photographs",
    "undistort": "write photographs without lens distortion",
    "rectify": "write photographs of the board as seen from straight above",
    "models": "compare lens models on photographs, and recommend one",
    "compare": "compare methods of calibration on photographs, side by side",
    "uncertainty": "show how far a calibration can be trusted",
    "diff": "compare two calibrations of a camera",
    "check": "check with a few pictures whether a stored calibration is still good",
    "convert": "convert a camera file to another lens model or format",
    "views": "study how many views are enough, and where to hold the board next",
    "demo": "calibrate the bundled sample and write all results and figures",
    "paper": "reproduce the paper from its 25 images, with its printed numbers beside ours",
}
"""Subcommands, which are also the names of their modules, and their help texts."""

_CANNOT, _USAGE, _BUG, _INTERRUPTED, _NO_READER = 1, 2, 70, 130, 141


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line `argv` (``sys.argv`` by default) and return the exit code.

    Raises:
        SystemExit: from argparse, for --help, --version and wrong usage.
    """
    arguments = list(sys.argv[1:] if argv is None else argv)
    for stream in (sys.stdout, sys.stderr):
        # Characters that the terminal cannot show must not raise errors.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        code = _run(arguments)
        if sys.stdout is not None:  # it may be closed
            sys.stdout.flush()
        return code
    except KeyboardInterrupt:
        print("calibgui: interrupted.", file=sys.stderr)
        return _INTERRUPTED
    except BrokenPipeError:
        import_module("calibgui.cli.console").discard_stdout()
        return _NO_READER
    except Exception:
        _report_bug()
        return _BUG


def _run(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(
        prog="calibgui",
        description="Geometric camera calibration from photographs of a flat board.",
        epilog="calibgui COMMAND --help describes a command. Without one, calibgui [FOLDER | "
        "IMAGES | PROJECT] opens the window.",
    )
    parser.add_argument("--version", action="version", version=f"calibgui {__version__}")
    choices = parser.add_subparsers(title="commands", metavar="COMMAND", dest="command")
    parsers = {name: choices.add_parser(name, help=text) for name, text in COMMANDS.items()}
    chosen = next((name for name in arguments[:1] if name in COMMANDS), None)
    if chosen is None:
        if _should_open_window(arguments):
            return int(import_module("calibgui.gui.app").run(arguments))
        parser.parse_args(arguments)
        parser.print_help()
        return _USAGE

    command = import_module(f"calibgui.cli.{chosen}")
    console = import_module("calibgui.cli.console")
    errors = import_module("calibgui.engine.errors")
    parsers[chosen].description = command.__doc__
    console.configure(parsers[chosen])
    command.configure(parsers[chosen])
    options = parser.parse_args(arguments)
    output = console.Console(options.quiet, options.json)
    with contextlib.suppress(ValueError):  # only the main thread may
        # SIGTERM ends the program as Ctrl-C does: workers and temporary files are removed.
        signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return int(command.run(options, output) or 0)
    except errors.CalibrationError as error:
        output.print_problem(f"calibgui: {error}")
        return _CANNOT


def _should_open_window(arguments: list[str]) -> bool:
    """Return whether only files and folders are named, and there is a screen to show them on."""
    screen = sys.platform in ("win32", "darwin") or any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")
    )
    return screen and all(os.path.exists(name) for name in arguments)  # noqa: PTH110 - no import


def _report_bug() -> None:
    """Print the traceback and all versions, for a bug report."""
    traceback.print_exc()
    with contextlib.suppress(Exception):
        from calibgui.dataset import list_installed_versions

        versions = ", ".join(f"{name} {v}" for name, v in list_installed_versions().items())
        print(
            f"calibgui: this is a bug; please report the lines above. {versions}, {sys.platform}.",
            file=sys.stderr,
        )
