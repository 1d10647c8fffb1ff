"""Print a script that completes commands, options, their values and names of files in a shell.

In ~/.bashrc or ~/.zshrc: eval "$(calibgui completion bash)", or zsh. In ~/.config/fish/config.fish:
calibgui completion fish | source. With many terminals a day, keep the script in a file and read
that: it is the same until calibgui is updated.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import shtab

from calibgui.app.calibrating.settings import AUTO_MODEL, MODEL_CHOICES
from calibgui.cli.console import Console
from calibgui.cli.parser import Parser, build_parser
from calibgui.cli.parser import configure as configure_command
from calibgui.engine import opencv
from calibgui.engine.boards import BoardShapeModel
from calibgui.formats import EXPORTERS

SHELLS = ("bash", "zsh", "fish")
"""Shells that a script can be printed for."""
_FOLDERS = ("DIR", "OUT")
"""Words that the help has for folders."""
_FORMATS = [f"{name}=camera{each.suffixes[0]}" for name, each in EXPORTERS.items()]
_WORDS = {
    "--model": [AUTO_MODEL, *MODEL_CHOICES],
    "--board-shape": ["auto", *BoardShapeModel],
    "--dictionary": opencv.list_dictionaries(),
    "--export": _FORMATS,
    "--for": _FORMATS,
}
"""Values of options that take others too, or whose parsers know them."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument(
        "shell", metavar="SHELL", choices=SHELLS, help=f"one of {', '.join(SHELLS)}"
    )


def run(options: argparse.Namespace, console: Console) -> None:
    """Print the script."""
    parser, parsers = build_parser()
    for name, each in parsers.items():
        configure_command(name, each)
        _complete_values(each)
    console.print_text(shtab.complete(parser, options.shell))


def _complete_values(parser: Parser) -> None:
    """Let values of arguments be completed: those that are known, files, and folders."""
    for action in parser._actions:
        words = next((_WORDS[name] for name in action.option_strings if name in _WORDS), None)
        if words is not None:
            action.choices = words
        elif action.metavar in _FOLDERS:
            action.complete = shtab.DIRECTORY  # type: ignore[attr-defined]
        elif action.type is Path or action.metavar == "PATH":
            action.complete = shtab.FILE  # type: ignore[attr-defined]
