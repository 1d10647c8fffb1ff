"""Carrying out the action on a finding: another calibration, which is kept or taken back."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

from PySide6.QtCore import QObject, Signal

from calibgui.app.calibrating.redetection import calibrate_twice
from calibgui.app.projects.project import Project, find_free_name, record_result
from calibgui.app.projects.remedies import apply_action
from calibgui.dataset import Result, View
from calibgui.dataset.judging import judge_result
from calibgui.engine.assessment import Action, Verdict
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.session import Session


class Remedied(NamedTuple):
    """What an action has done."""

    label: str
    """Its name."""
    before: Result
    after: Result
    verdict_before: Verdict
    verdict_after: Verdict
    project: Project
    """The project with it."""


class Remedier(QObject):
    """Runs one action at a time beside the window; its outcome is one edit."""

    began = Signal()
    ended = Signal()
    """The action is carried out, has failed or is unwanted."""
    done = Signal(object)
    """The action is carried out: a `Remedied`."""

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._job: Job | None = None

    @property
    def running(self) -> bool:
        """Return whether an action is being carried out."""
        return self._job is not None

    def run(self, label: str, action: Action, result: Result) -> None:
        """Calibrate with an action on the result carried out."""
        if self.running:
            return
        project = apply_action(self._session.project, result, action)
        corner_set = project.corner_set
        if corner_set is None:
            return

        def work(job: Job) -> tuple[Result, Verdict, Verdict]:
            found = calibrate_twice(corner_set, project.settings, job.send, job.cancelling)
            found_verdict = judge_result(found, job.check)
            return found, judge_result(result, job.check), found_verdict

        self._job = self._session.jobs.start(
            label,
            work,
            partial(self._finish, label, action, result, corner_set.views),
            ended=self._end,
            inputs=self._session.question,
        )
        self.began.emit()

    def take_back(self, remedied: Remedied) -> None:
        """Undo an action, unless work has gone on since."""
        if self._session.project is remedied.project:
            self._session.document.undo()

    def _finish(
        self,
        label: str,
        action: Action,
        before: Result,
        inputs: tuple[View, ...],
        answer: tuple[Result, Verdict, Verdict],
    ) -> None:
        after, verdict_before, verdict_after = answer
        session = self._session
        name = find_free_name(session.project, self.tr("Calibration"))
        session.edit(
            label,
            lambda p: record_result(apply_action(p, before, action), name, inputs, after),
        )
        session.show_result(name)
        kept = session.project.results[name]
        self.done.emit(
            Remedied(label, before, kept, verdict_before, verdict_after, session.project)
        )

    def _end(self) -> None:
        self._job = None
        self.ended.emit()
