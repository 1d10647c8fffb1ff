"""Notices that every subcommand that calibrates gives besides its answer."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from calibgui.cli.console import Console
from calibgui.dataset import CornerSet
from calibgui.engine.errors import CalibrationError
from calibgui.engine.kernels import SOLVER_SECONDS, when_compiling
from calibgui.report import tables


@contextlib.contextmanager
def explain_solve(console: Console, corner_set: CornerSet) -> Iterator[None]:
    """Say why an installation's first calibration takes long, and which views a failure lacked.

    Raises:
        CalibrationError: that of the calibration in the body, after the photographs that could not
            be used are listed.
    """
    preparing = f"Preparing the solver for its first use (once, about {SOLVER_SECONDS} s)…"
    try:
        with when_compiling(lambda: console.print_problem(preparing)):
            yield
    except CalibrationError:
        if unused := tables.list_unused_views(corner_set.views):
            console.print_problem(unused)
        raise
