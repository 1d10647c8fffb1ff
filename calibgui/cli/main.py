"""Entry point: choose the subcommand, run it, and return an exit code.

The exit codes are 0 success; 1 the task is impossible, for the reason on stderr, or a check has
failed; 2 wrong usage; 3 a camera has changed, or one of a fleet fails; 70 a bug; 130 interrupted
(Ctrl-C); 141 the program that read our output has ended; 143 asked to end (SIGTERM).

To add a subcommand, write a module in this folder with `configure(parser)` and
`run(options, console)`, which may return an exit code, and name it in `COMMANDS` of ``parser``.
"""

from __future__ import annotations

import contextlib
import gc
import json
import os
import shlex
import sys
import traceback
import warnings
from collections.abc import Iterator, Sequence
from importlib import import_module
from typing import Any

from calibgui.cli.parser import COMMANDS, build_parser, configure, describe_misuse
from calibgui.cli.termination import TerminationRequest
from calibgui.version import __version__

_WINDOW_PACKAGES = ("PySide6", "shiboken6", "pyqtgraph", "contourpy")
"""Packages that the window alone needs: the extra "gui"."""
_PACKAGES = (
    "numpy",
    "scipy",
    "opencv-python-headless",
    "pillow",
    "PyYAML",
    "matplotlib",
    "jinja2",
    "markdown-it-py",
    "numba",
    "threadpoolctl",
    "platformdirs",
    "shtab",
    "tqdm",
    "PySide6-Essentials",
    "pyqtgraph",
    "contourpy",
    "distributed",
    "fsspec",
    "aiohttp",
    "pillow-heif",
    "rawpy",
    "typst",
)
"""Packages whose versions --version --json names: what pyproject.toml lists for users."""
_ALONE = ("-h", "--help", "--version")
"""Options that need no command."""
_CANNOT, _USAGE, _BUG, _INTERRUPTED, _NO_READER, _TERMINATED = 1, 2, 70, 130, 141, 143


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
    request = TerminationRequest()
    try:
        code = _run(arguments, request)
        if sys.stdout is not None:  # it may be closed
            sys.stdout.flush()
        return code
    except KeyboardInterrupt:
        return _print_interruption(request)
    except BrokenPipeError:
        import_module("calibgui.cli.console").discard_stdout()
        return _NO_READER
    except Exception:
        if request.is_made:  # a library has raised it in place of the request
            return _print_interruption(request)
        _report_bug()
        return _BUG


def _print_interruption(request: TerminationRequest) -> int:
    print("calibgui: interrupted.", file=sys.stderr)
    return _TERMINATED if request.is_made else _INTERRUPTED


def _run(arguments: list[str], request: TerminationRequest) -> int:
    parser, parsers = build_parser()
    chosen = arguments[0] if arguments else ""
    if chosen not in COMMANDS:
        if sorted(arguments) == ["--json", "--version"]:
            print(json.dumps(_list_versions(), indent=1))
            return 0
        if chosen.startswith("-") and (chosen in _ALONE or not COMMANDS.keys() & arguments):
            parser.parse_args(arguments[:1])
        if not all(os.path.exists(name) for name in arguments):  # noqa: PTH110 - no import
            parser.error(describe_misuse(arguments))
        if not arguments and not _has_display():
            parser.print_help()
        return _open_window(arguments)

    # One thread is the fastest on small matrices; OpenBLAS reads this as NumPy is imported.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with _keep_what_is_loaded():
        command = configure(chosen, parsers[chosen])
        console_module = import_module("calibgui.cli.console")
    options = parsers[chosen].parse_args(arguments[1:])
    console = console_module.Console(options.quiet, options.json)
    errors = import_module("calibgui.engine.errors")
    try:
        # While the command is loaded SIGTERM ends the program at once: there is nothing to remove.
        with request.heed(), _print_our_warnings_plainly():
            code = int(command.run(options, console) or 0)
            if import_module("calibgui.engine.kernels").was_any_missed():
                console.print_notice(
                    "Faster from now on: calibgui prepare (once, about a minute) compiles what is "
                    "slow in Python."
                )
            return code
    except errors.CalibrationError as error:
        console.print_problem(f"calibgui: {error}")
        return _CANNOT


@contextlib.contextmanager
def _print_our_warnings_plainly() -> Iterator[None]:
    """Print warnings of this project without the line of code, which tells a user nothing."""
    usual = warnings.formatwarning

    def print_plainly(
        message: Warning | str, category: type[Warning], *place: Any, **line: Any
    ) -> str:
        if category.__module__.startswith("calibgui."):
            return f"calibgui: {message}\n"
        return usual(message, category, *place, **line)

    warnings.formatwarning = print_plainly
    try:
        yield
    finally:
        warnings.formatwarning = usual


@contextlib.contextmanager
def _keep_what_is_loaded() -> Iterator[None]:
    """Look for no garbage among what is loaded in the `with` block, neither there nor later.

    It is tens of thousands of objects of which none is, and the search takes a tenth of the time.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        if was_enabled:
            gc.enable()


def _list_versions() -> dict[str, str | None]:
    """Return the versions of this program, of Python, the system and all packages that it may use;
    None for a package that is not installed."""
    platform, metadata = import_module("platform"), import_module("importlib.metadata")
    found: dict[str, str | None] = {
        "calibgui": __version__,
        "python": platform.python_version(),
        "system": platform.platform(),
    }
    for name in _PACKAGES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            found[name] = None
    return found


def open_window() -> int:
    """Open the window on the files that the command line names; return the exit code."""
    return _open_window(sys.argv[1:])


def _open_window(arguments: list[str]) -> int:
    if not _has_display():
        return _print_missing_display(arguments)
    try:
        with _keep_what_is_loaded():
            app = import_module("calibgui.gui.app")
    except ImportError as error:
        missing = import_module("calibgui.app.system.missing_library")
        library = missing.describe_missing_library(str(error))
        # The error of a library that Qt lacks may name no package.
        if not library and (error.name or "").partition(".")[0] not in _WINDOW_PACKAGES:
            raise
        if isinstance(error, ModuleNotFoundError):
            reason = f"the window is not installed. {missing.describe_missing_extra('gui')}"
        else:
            reason = f"the window cannot be loaded. {library or error}"
        print(f"calibgui: {reason}", file=sys.stderr)
        return _CANNOT
    return int(app.run(arguments))


def _has_display() -> bool:
    """Return whether there seems to be a screen to show a window on."""
    return sys.platform in ("win32", "darwin") or any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    )


def _print_missing_display(arguments: list[str]) -> int:
    """Print that no window can be opened, and what works without one; return the exit code."""
    paths = " ".join(map(shlex.quote, arguments)) or "PHOTOGRAPHS"
    print(
        "calibgui: there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set. Without a "
        f"window:\n  calibgui calibrate {paths} --square MM",
        file=sys.stderr,
    )
    return _CANNOT if arguments else _USAGE


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
