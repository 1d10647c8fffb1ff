"""Work beside the window of which only the newest counts."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from PySide6.QtCore import QObject

from calibgui.gui.jobs.job import Job, nothing
from calibgui.gui.jobs.jobs import PICTURE, Jobs

T = TypeVar("T")


class Latest:
    """A panel's work: what is asked for anew replaces what was asked for before.

    Args:
        jobs: that do the work.
        owner: after whose end nobody wants it.
    """

    def __init__(self, jobs: Jobs, owner: QObject) -> None:
        self._jobs, self._owner = jobs, owner
        self._job: Job | None = None

    def start(
        self,
        label: str,
        work: Callable[[Job], T],
        done: Callable[[T], None],
        failed: Callable[[Exception], None],
        cancelled: Callable[[], None] = nothing,
        keeps_best: bool = False,
    ) -> None:
        """Run `work` in a thread, once what the panel shows by now is on the screen.

        What it returns or raises is handed on unless it is outdated.

        Args:
            label, work, done, failed, keeps_best: as for ``Jobs.start``.
            cancelled: called if the user wants none of it.
        """
        self.cancel()

        def ended() -> None:
            if job is self._job and job.cancelled:
                cancelled()

        job = self._job = self._jobs.start(
            label,
            work,
            done,
            delay=PICTURE,
            failed=failed,
            ended=ended,
            keeps_best=keeps_best,
            owner=self._owner,
        )

    def cancel(self) -> None:
        """Want nothing any more."""
        if self._job is not None:
            self._job.cancel()
        self._job = None
