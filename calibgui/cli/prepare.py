"""Compile what is slow in Python, once after an installation: all later commands are faster.

Without it every command gives the same answers, in about twice the time. Set-up scripts and the
window do the same by themselves.
"""

from __future__ import annotations

import argparse

from calibgui.app.system.kernel_preparation import compile_kernels
from calibgui.cli.console import Console
from calibgui.engine.errors import CalibrationError
from calibgui.engine.kernels import are_all_kept, can_compile


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments, of which there are none."""


def run(options: argparse.Namespace, console: Console) -> None:  # noqa: ARG001
    """Compile what is not compiled yet, and say so."""
    if not can_compile():
        raise CalibrationError("numba cannot be used.", "pip install --upgrade numba")
    if are_all_kept():
        console.print_text("Everything is compiled already.")
        return
    with console.show_progress("compiling", "part") as advance:
        compile_kernels(advance)
    console.print_text("Everything is compiled.")
