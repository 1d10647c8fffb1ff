"""What a subcommand prints, and where: tables to stdout, progress and problems to stderr."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Callable, Iterator
from typing import Any

from tqdm import tqdm

from calibgui.engine.errors import CalibrationError
from calibgui.formats.json_document import dumps
from calibgui.report.words import printable

Advance = Callable[[int, int], None]
"""Told how many are done, of how many."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options that every subcommand has."""
    parser.add_argument("-q", "--quiet", action="store_true", help="print problems only")
    parser.add_argument(
        "--json", action="store_true", help="print the result as JSON, and nothing else, on stdout"
    )


class Console:
    """Prints as the user asked: tables, JSON or nothing."""

    def __init__(self, quiet: bool = False, json: bool = False) -> None:
        self.quiet = quiet
        self.json = json

    def say(self, text: str, otherwise: str = "") -> None:
        """Print text for people, or if they want problems only, `otherwise`."""
        if not (self.quiet or self.json):
            _print(harmless(text))
        elif otherwise and not self.json:
            self.problem(otherwise)

    def answer(self, value: Any) -> None:
        """Print the result for programs, if they asked."""
        if self.json:
            _print(dumps(value))

    def problem(self, text: str) -> None:
        """Print what went wrong but ends nothing."""
        print(harmless(text), file=sys.stderr)

    def notice(self, text: str) -> None:
        """Tell on stderr why nothing seems to happen; nothing if quiet or no terminal."""
        if not self._alone:
            tqdm.write(harmless(text), file=sys.stderr)

    @property
    def _alone(self) -> bool:
        """Whether nobody watches."""
        return self.quiet or sys.stderr is None or not sys.stderr.isatty()

    @contextlib.contextmanager
    def progress(self, what: str, unit: str = "image") -> Iterator[Advance]:
        """A bar on stderr while things are worked on; nothing if quiet or no terminal."""
        with tqdm(desc=what, unit=unit, disable=self._alone, leave=False, file=sys.stderr) as bar:

            def advance(done: int, total: int) -> None:
                bar.total = total
                bar.update(done - bar.n)

            yield advance


def harmless(text: str) -> str:
    """`text` without what would command the terminal, which a file's name may hold."""
    return "\n".join(map(printable, text.split("\n")))


def leave_stdout() -> None:
    """Let what is still to be printed go nowhere, so that nothing fails when Python exits."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _print(text: str) -> None:
    """Print to stdout at once.

    Raises:
        CalibrationError: if it cannot be, as on a full disk.
        BrokenPipeError: if its reader is gone.
    """
    try:
        print(text, flush=True)
    except BrokenPipeError:
        raise
    except OSError as error:
        leave_stdout()
        raise CalibrationError(
            f"Standard output cannot be written: {error.strerror}.",
            "Free some space, or send it elsewhere.",
        ) from error
