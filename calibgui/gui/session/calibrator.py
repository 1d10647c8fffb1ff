"""Calibrating in the background, once every image has been searched.

A first answer is there at once, and better ones take its place as they are made. Where the camera
lets more be found, the corners come with the result, in one edit.
"""

from __future__ import annotations

from collections.abc import Hashable
from contextlib import suppress
from dataclasses import replace
from functools import partial

from PySide6.QtCore import QObject, Signal

from calibgui.app.calibrating.best_camera import Step, calibrate_at_once, calibrate_best
from calibgui.app.projects.lengths import scale_result
from calibgui.app.projects.project import Project, find_free_name, record_result
from calibgui.dataset import View, ViewStatus
from calibgui.engine.calibration import Iteration, Status
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError
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
    """There is a result, or a reason why not, and nothing more is done about it."""

    def __init__(self, session: Session, detector: Detector) -> None:
        super().__init__(session)
        self._session = session
        self._detector = detector
        self._job: Job | None = None
        self._wanted = False
        self._name = ""
        """Name of the result that the calibration under way gives."""
        self._camera: Camera | None = None
        """Its camera so far; a length that is stated meanwhile changes the result, but not this."""
        self._views: tuple[View, ...] = ()
        """The views that the next answer is made from."""
        self._is_recording = False
        """True if the project changes by an answer, which makes the calibration no less needed."""
        self._question: Hashable = None
        """What the calibration under way answers."""
        detector.finished.connect(self._searched)
        session.changed.connect(self._drop_needless)

    @property
    def running(self) -> bool:
        """Return whether a calibration is under way, or waits for the search to end."""
        return self._wanted or (self._job is not None and not self._job.cancelled)

    @property
    def waiting(self) -> bool:
        """Return whether a calibration waits for the search to end."""
        return self._wanted

    def calibrate(self) -> None:
        """Search what has not been searched, and solve for a new result."""
        if not self.running:
            self._wanted = True
            self._detector.search()

    def stop(self) -> None:
        """End the calibration, or the search for corners that it waits for.

        The last answer that is finished stays. Without any, it is the best camera so far.
        """
        self._wanted = False
        if self._job is None:
            self._detector.stop()
            self.ended.emit()
        else:
            self._session.jobs.end(self._job)

    def _searched(self, everything: bool) -> None:
        wanted, self._wanted = self._wanted, False
        if wanted and everything:
            self._solve()
        elif wanted:
            self.ended.emit()

    def _solve(self) -> None:
        if self._session.project.size is None:
            self._learn_size()
        project = self._session.project
        if (error := self._find_what_is_missing(project)) is not None:
            self._session.failed.emit(error)
            self.ended.emit()
            return
        corner_set = project.corner_set
        assert corner_set is not None, "without images nothing can be calibrated"
        # Images that the user has not marked are not searched with the calibrated camera either.
        settings = replace(project.settings, once=project.settings.once or project.by_hand)
        calibrating, comparing = self.tr("Calibrating"), self.tr("Comparing lens models")
        improving = self.tr("Making the camera better")

        def work(job: Job) -> None:
            def show_comparison(done: int, total: int) -> None:
                job.rename(calibrating if done == total else comparing)
                job.advance(*(0, 1) if done == total else (done, total))

            if (first := calibrate_at_once(corner_set, settings)) is not None:
                job.send(Step("", None, first))
            for step in calibrate_best(
                corner_set,
                settings,
                job.send,
                job.cancelling,
                progress=show_comparison,
                check=job.check,
            ):
                job.send(step)
                job.rename(improving)

        stem = self.tr("Calibration") if settings.known is None else self.tr("Known camera")
        self._name = find_free_name(project, stem)
        self._camera, self._views = None, corner_set.views
        self._question = self._session.question()
        self._session.document.end_sliding_edit()
        job = self._job = self._session.jobs.start(
            calibrating,
            work,
            received=lambda record: self._receive(job, record),
            ended=lambda: self._end() if job is self._job else None,
            keeps_best=self._session.result is None,
        )
        self.began.emit()

    def _learn_size(self) -> None:
        """Read the size of the images from one with a board: their search was ended before."""
        for view in self._session.project.usable:
            with suppress(CalibrationError):
                size = self._session.images.read(view.image).size
                self._session.document.learn(partial(replace, size=size))
                return

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
        if project.views and all(v.status is ViewStatus.UNREADABLE for v in project.views):
            return CalibrationError(
                self.tr("None of the photographs can be read."),
                self.tr("Click on one to see why, or add others."),
            )
        if not project.views or project.size is None:
            return CalibrationError(
                self.tr("There is no image to calibrate from."),
                self.tr("Add photographs of a board."),
            )
        return project.grid_size_doubt

    def _receive(self, job: Job, record: Step | Iteration) -> None:
        if job is not self._job or job.cancelled:
            return
        if isinstance(record, Step):
            job.keeps_best = False
            self._record(record)
        else:
            self.advanced.emit(record)

    def _record(self, step: Step) -> None:
        """Record an answer as an edit, which undo goes back on: the first answer and the one that
        is then made of it with care are one, each step from there is one of its own."""
        session, name = self._session, self._name
        inputs, result = self._views, step.result

        def change(project: Project) -> Project:  # a length may have been stated meanwhile
            scaled = scale_result(result, project.square, project.square_sigma)
            return record_result(project, name, inputs, scaled)

        label = self.tr("Make camera better") if step.action else self.tr("Calibrate")
        self._is_recording = True
        session.edit(label, change, sliding=step.action is None)
        session.show_result(name)
        self._is_recording, self._question = False, session.question()
        self._camera, self._views = result.calibration.camera, result.views
        if result.calibration.status is Status.STOPPED:
            session.notified.emit(
                self.tr("Stopped: “{0}” is the best so far, not the optimum.").format(name)
            )

    def _drop_needless(self) -> None:
        """End a calibration whose question is no longer asked, or whose answer was taken back."""
        if self._job is None or self._is_recording:
            return
        result = self._session.project.results.get(self._name)
        camera = None if result is None else result.calibration.camera
        if camera is not self._camera or self._session.question() != self._question:
            self._drop()

    def _drop(self) -> None:
        """End a calibration; the answers that it has given stay."""
        assert self._job is not None
        self._job.cancel()
        self._end()

    def _end(self) -> None:
        self._job = None
        self.ended.emit()
