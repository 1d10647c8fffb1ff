"""Notices that every subcommand that calibrates gives besides its answer."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from calibgui.cli.console import Console
from calibgui.dataset import CornerSet
from calibgui.engine.errors import CalibrationError
from calibgui.report import tables


@contextlib.contextmanager
def explain_solve(console: Console, corner_set: CornerSet) -> Iterator[None]:
    """Say which views a failure lacked.

    Raises:
        CalibrationError: that of the calibration in the body, after the photographs that could not
            be used are listed.
    """
    try:
        yield
    except CalibrationError:
        if unused := tables.list_unused_views(corner_set.views):
            console.print_problem(unused)
        raise
