"""Carrying out the action on a finding: another calibration, which is kept or taken back."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from PySide6.QtCore import QObject, Signal

from calibgui.app.calibrating.redetection import calibrate_twice
from calibgui.app.calibrating.settings import state_board_shape
from calibgui.app.projects.project import Project, find_free_name, record_result
from calibgui.dataset import Result, View
from calibgui.dataset.judging import judge_result
from calibgui.engine.assessment import Verdict
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.session import Session


class CarriedOut(NamedTuple):
    """The outcome of an action."""

    label: str
    """Its name."""
    before: Result
    after: Result
    verdict_before: Verdict
    verdict_after: Verdict
    project: Project
    """The project with it."""


class RemedyRunner(QObject):
    """Runs one action at a time beside the window; its outcome is one edit."""

    began = Signal()
    ended = Signal()
    """The action is carried out, has failed or is unwanted."""
    done = Signal(object)
    """The action is carried out: a `CarriedOut`."""

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._job: Job | None = None

    @property
    def running(self) -> bool:
        """Return whether an action is being carried out."""
        return self._job is not None

    def run(self, label: str, change: Callable[[Project], Project], result: Result) -> None:
        """Calibrate with an action carried out.

        Args:
            label: name of the action.
            change: what it does to the project.
            result: what it is about.
        """
        if self.running:
            return
        project = change(self._session.project)
        corner_set = project.corner_set
        if corner_set is None:
            return

        def work(job: Job) -> tuple[Result, Verdict, Verdict]:
            settings = state_board_shape(project.settings, result.calibration)
            found = calibrate_twice(corner_set, settings, job.send, job.cancelling)
            found_verdict = judge_result(found, job.check)
            return found, judge_result(result, job.check), found_verdict

        self._job = self._session.jobs.start(
            label,
            work,
            partial(self._finish, label, change, result, corner_set.views),
            ended=self._end,
            inputs=self._session.question,
        )
        self.began.emit()

    def take_back(self, carried_out: CarriedOut) -> None:
        """Undo an action, unless work has gone on since."""
        if self._session.project is carried_out.project:
            self._session.document.undo()

    def _finish(
        self,
        label: str,
        change: Callable[[Project], Project],
        before: Result,
        inputs: tuple[View, ...],
        answer: tuple[Result, Verdict, Verdict],
    ) -> None:
        after, verdict_before, verdict_after = answer
        session = self._session
        name = find_free_name(session.project, self.tr("Calibration"))
        session.edit(label, lambda p: record_result(change(p), name, inputs, after))
        session.show_result(name)
        kept = session.project.results[name]
        self.done.emit(
            CarriedOut(label, before, kept, verdict_before, verdict_after, session.project)
        )

    def _end(self) -> None:
        self._job = None
        self.ended.emit()
