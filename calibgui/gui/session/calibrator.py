"""Calibrating in the background, once every image has been searched.

Where the camera then lets more be found, the corners come with the result, in one edit."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from PySide6.QtCore import QObject, Signal

from calibgui.app.calibrating.redetection import calibrate_twice
from calibgui.app.projects.project import Project, find_free_name, record_result
from calibgui.dataset import CornerSet, Result, ViewStatus
from calibgui.engine.calibration import Iteration, Status
from calibgui.engine.errors import CalibrationError
from calibgui.engine.kernels import SOLVER_SECONDS, when_compiling
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.detector import Detector
from calibgui.gui.session.session import Session


class Calibrator(QObject):
    """Does what is still to do: searches the images that wait, then solves."""

    began = Signal()
    """Stage I and II start."""
    advanced = Signal(Iteration)
    """An iteration of Stage II is done."""
    ended = Signal()
    """There is a result, or a reason why not."""

    def __init__(self, session: Session, detector: Detector) -> None:
        super().__init__(session)
        self._session = session
        self._detector = detector
        self._job: Job | None = None
        self._wanted = False
        detector.finished.connect(self._searched)

    @property
    def running(self) -> bool:
        """Return whether a calibration is under way, or waits for the search to end."""
        return self._wanted or self._job is not None

    @property
    def stopping(self) -> bool:
        """Return whether the calibration under way has been asked to end."""
        return self._job is not None and self._job.stopping

    def is_cancelled_by_stop(self, job: Job) -> bool:
        """Return whether `stop` would cancel this very job: the search that is waited for."""
        return self._wanted and self._detector.is_search(job)

    def calibrate(self) -> None:
        """Search what has not been searched, and solve for a new result."""
        if not self.running:
            self._wanted = True
            self._detector.search()

    def stop(self) -> None:
        """End with the best camera so far; without one, end the search for corners."""
        self._wanted = False
        if self._job is None:
            self._detector.stop()
            self.ended.emit()
        else:
            self._job.stop()

    def _searched(self, everything: bool) -> None:
        wanted, self._wanted = self._wanted, False
        if wanted and everything:
            self._solve()
        elif wanted:
            self.ended.emit()

    def _solve(self) -> None:
        project = self._session.project
        if (error := self._find_what_is_missing(project)) is not None:
            self._session.failed.emit(error)
            self.ended.emit()
            return
        corner_set = project.corner_set
        assert corner_set is not None, "without images nothing can be calibrated"
        # Images that the user has not marked are not searched with the calibrated camera either.
        settings = replace(project.settings, once=project.settings.once or project.by_hand)

        preparing = self.tr("Preparing the solver (once, about {0} s)…").format(SOLVER_SECONDS)

        calibrating, comparing = self.tr("Calibrating"), self.tr("Comparing lens models")

        def work(job: Job) -> Result:
            def show_comparison(done: int, total: int) -> None:
                job.rename(calibrating if done == total else comparing)
                job.advance(*(0, 1) if done == total else (done, total))

            with when_compiling(lambda: job.rename(preparing)):
                return calibrate_twice(
                    corner_set, settings, job.send, job.cancelling, progress=show_comparison
                )

        self._job = self._session.jobs.start(
            calibrating,
            work,
            partial(self._done, corner_set),
            received=self.advanced.emit,
            ended=self._end,
            inputs=self._session.question,
        )
        self.began.emit()

    def _find_what_is_missing(self, project: Project) -> CalibrationError | None:
        """Return why a project cannot be calibrated, with the remedy; None if it can be tried."""
        if project.views and project.by_hand and not project.usable:
            return CalibrationError(
                self.tr("No board is marked yet, and the search is off."),
                self.tr(
                    "Mark the four outermost corners in at least three photographs (Mark board), "
                    "or turn “Mark all by hand” off."
                ),
            )
        is_any_readable = any(v.status is not ViewStatus.UNREADABLE for v in project.views)
        if project.views and (project.size is None or not is_any_readable):
            return CalibrationError(
                self.tr("None of the photographs can be read."),
                self.tr("Click on one to see why, or add others."),
            )
        if project.size is None:
            return CalibrationError(
                self.tr("There is no image to calibrate from."),
                self.tr("Add photographs of a board."),
            )
        return project.grid_size_doubt

    def _done(self, asked: CornerSet, result: Result) -> None:
        name = find_free_name(self._session.project, self.tr("Calibration"))
        self._session.edit(
            self.tr("Calibrate"), lambda p: record_result(p, name, asked.views, result)
        )
        self._session.show_result(name)
        if result.calibration.status is Status.STOPPED:
            self._session.notified.emit(
                self.tr("Stopped: “{0}” is the best so far, not the optimum.").format(name)
            )

    def _end(self) -> None:
        self._job = None
        self.ended.emit()
