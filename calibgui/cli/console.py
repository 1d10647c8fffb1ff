"""Printing of a subcommand: tables on stdout, progress and problems on stderr."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from calibgui.engine.errors import CalibrationError
from calibgui.formats.json_document import dumps
from calibgui.report.names import make_printable

Advance = Callable[[int, int], None]
"""Function that is called with the number of finished items and the number of all."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options that all subcommands have."""
    parser.add_argument(
        "-q", "--quiet", action="store_true", help="print only problems and at most one line"
    )
    parser.add_argument(
        "--json", action="store_true", help="print the result as JSON, and nothing else, on stdout"
    )


class Console:
    """The output of a subcommand: tables, JSON or nothing, as the user wants."""

    def __init__(self, quiet: bool = False, json: bool = False) -> None:
        self.quiet = quiet
        self.json = json

    def print_text(self, text: str, otherwise: str = "") -> None:
        """Print text for people; with --quiet, print `otherwise` as a problem instead."""
        if not (self.quiet or self.json):
            _print(escape_controls(text))
        elif otherwise and not self.json:
            self.print_problem(otherwise)

    def print_line(self, text: str) -> None:
        """Print with --quiet, in place of all text, the one line that matters."""
        if self.quiet and not self.json:
            _print(make_printable(text))

    def take_output(self, path: Path | None) -> Path | None:
        """Return the file to write the result to; for "-" print it as with --json instead."""
        if path != Path("-"):
            return path
        self.json = True
        return None

    def print_json(self, value: Any) -> None:
        """Print the result for programs, with --json only."""
        if self.json:
            _print(dumps(value))

    def print_problem(self, text: str) -> None:
        """Print on stderr a problem that does not end the program."""
        print(escape_controls(text), file=sys.stderr)

    def print_notice(self, text: str) -> None:
        """Print on stderr the reason for a wait, unless nobody watches."""
        if not self._is_unwatched:
            _load_tqdm().write(escape_controls(text), file=sys.stderr)

    @property
    def _is_unwatched(self) -> bool:
        """True with --quiet, or if stderr is no terminal."""
        return self.quiet or sys.stderr is None or not sys.stderr.isatty()

    @contextlib.contextmanager
    def show_progress(self, what: str, unit: str = "image") -> Iterator[Advance]:
        """Show a progress bar on stderr, unless nobody watches.

        Until a number of all is known the bar says what is done and for how long: a count without
        an end tells nobody anything.
        """
        if self._is_unwatched:
            yield lambda done, total: None  # noqa: ARG005 - nobody is told
            return
        endless = "{desc}: {elapsed}"
        with _load_tqdm()(
            desc=what, unit=unit, leave=False, file=sys.stderr, bar_format=endless
        ) as bar:

            def advance(done: int, total: int) -> None:
                if total != bar.total:
                    bar.total = total
                    bar.bar_format = None if total else endless
                    bar.refresh()
                bar.update(done - bar.n)

            yield advance


def _load_tqdm() -> Any:
    """Load progress bars, where somebody watches: it takes as long as all our files of formats."""
    from tqdm import tqdm

    tqdm.monitor_interval = 0  # its thread would keep workers from being forked (app.workers)
    return tqdm


def escape_controls(text: str) -> str:
    """Escape characters that control the terminal, which the name of a file may contain."""
    return "\n".join(map(make_printable, text.split("\n")))


def discard_stdout() -> None:
    """Discard what is still to be printed on stdout, so that nothing fails when Python exits."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _print(text: str) -> None:
    """Print to stdout at once.

    Raises:
        CalibrationError: if stdout cannot be written, as on a full disk.
        BrokenPipeError: if the program that reads it has ended.
    """
    try:
        print(text, flush=True)
    except BrokenPipeError:
        raise
    except OSError as error:
        discard_stdout()
        raise CalibrationError(
            f"Standard output cannot be written: {error.strerror}.",
            "Free some space, or send the output elsewhere.",
        ) from error
