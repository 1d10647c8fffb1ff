"""The fit that follows when images are excluded or included."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QObject

from calibgui.app.calibrating.calibration import calibrate_views, recall_lens_choice
from calibgui.app.calibrating.settings import state_board_shape
from calibgui.app.projects.project import record_result
from calibgui.dataset import Result
from calibgui.gui.jobs.job import Job
from calibgui.gui.jobs.jobs import PICTURE
from calibgui.gui.session.calibrator import Calibrator
from calibgui.gui.session.detector import Detector
from calibgui.gui.session.session import Session


class Refitter(QObject):
    """Calibrates once more from other views, in milliseconds, and replaces the shown result.

    It searches no image again, and keeps a lens model and a board shape that were chosen
    automatically. The first result is left to the button.
    """

    def __init__(self, session: Session, detector: Detector, calibrator: Calibrator) -> None:
        super().__init__(session)
        self._session, self._detector, self._calibrator = session, detector, calibrator
        self._job: Job | None = None

    def refit(self, label: str) -> None:
        """Calibrate from the views as they are now.

        Args:
            label: name of the edit that changed them, which the new result becomes a part of.
        """
        session = self._session
        project, result, name = session.project, session.result, session.result_name
        if self._job is not None:
            self._job.cancel()
        corner_set = project.corner_set
        if result is None or corner_set is None or not project.usable:
            return
        if self._detector.running or self._calibrator.running or project.is_current(result):
            return
        settings = state_board_shape(replace(project.settings, once=True), result.calibration)
        lens = recall_lens_choice(result) if settings.model is None else None
        if settings.model is None and lens is None:
            self._calibrator.calibrate()
            return

        def done(new: Result) -> None:
            session.edit(
                label, lambda p: record_result(p, name, corner_set.views, new), sliding=True
            )
            session.document.end_sliding_edit()

        self._job = session.jobs.start(
            "",
            lambda _: calibrate_views(corner_set, settings, lens=lens),
            done,
            delay=PICTURE,
            failed=session.failed.emit,
            inputs=session.question,
        )
