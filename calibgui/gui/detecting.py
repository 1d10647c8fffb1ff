"""Finding corners in the background: what it finds fills the document in."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from calibgui.app.detection import Detection, find_views, usual_board, usual_pattern
from calibgui.app.project import Project, with_each, without_digests
from calibgui.dataset.view import View, ViewStatus
from calibgui.engine.arrays import Array
from calibgui.engine.boards import Pattern
from calibgui.engine.detection import Corners
from calibgui.engine.kernels import FINDER_SECONDS
from calibgui.gui.job import Job
from calibgui.gui.session import Session


class Detector(QObject):
    """Searches the images that wait, one batch after the other."""

    finished = Signal(bool)
    """Whether all images have been searched; false if the user cancelled."""

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._job: Job | None = None
        self._failed = False
        """Whether the batch ended without an answer."""
        self._again = False
        """Whether images are waiting that the batch does not have."""
        self._asked: dict[str, Array | None] = {}
        """Images of the batch, with the regions that are searched."""
        self._given: dict[str, Corners | None] = {}
        """What the batch found in them so far."""
        self._sought = _sought(session.project)
        """What the batch searches for."""

    @property
    def running(self) -> bool:
        """Whether a search is under way."""
        return self._job is not None

    def search(self) -> None:
        """Search every enabled image that waits, if that is not being done already."""
        project = self._session.project
        asked = tuple(view for view in project.views if view.status is ViewStatus.WAITING)
        if self.running:
            other = _sought(project) != self._sought
            self._again = other or any(view.image not in self._asked for view in asked)
            return
        if not asked:
            self.finished.emit(True)
            return
        self._asked = {view.image: view.roi for view in asked}
        self._given = dict.fromkeys(self._asked)
        grid_size = project.grid_size or usual_board(project.views)
        self._sought = _sought(project)
        pattern = usual_pattern(project.views, project.pattern)
        rois = {Path(image): roi for image, roi in self._asked.items() if roi is not None}

        searching = self.tr("Finding corners")
        preparing = self.tr(
            "Preparing the corner finder for its first use (once, about {0} s)…"
        ).format(FINDER_SECONDS)

        def work(job: Job) -> Detection:
            def progress(done: int, total: int, view: View) -> None:
                job.rename(searching)
                job.advance(done, total)
                job.tell([view])

            images = [Path(view.image) for view in asked]
            return find_views(
                images,
                grid_size,
                rois,
                progress,
                job.cancelling,
                project.size,
                method=project.method,
                pattern=pattern,
                preparing=lambda: job.rename(preparing),
            )

        self._job = self._session.jobs.start(
            searching,
            work,
            self._done,
            told=self._learn,
            failed=self._fail,
            ended=self._ended,
        )

    def search_again(self, images: Iterable[str]) -> None:
        """Forget what was found in `images`, and search them anew."""

        def forget(view: View) -> View:
            return replace(view, status=ViewStatus.WAITING, reason="", corners=None, points=None)

        chosen = list(images)

        def change(project: Project) -> Project:
            return without_digests(with_each(project, chosen, forget), chosen)

        self._session.edit(self.tr("Detect again"), change)
        self.search()

    def _learn(self, found: Iterable[View]) -> None:
        """Write findings into every snapshot in which the question is still open."""
        news = {view.image: view for view in found}

        def answered(view: View) -> View:
            new = news.get(view.image)
            if new is None or (view.status is new.status and view.corners is new.corners):
                return view
            asked = view.roi is self._asked[view.image]
            if not asked or view.corners is not self._given[view.image]:
                return view  # changed by the user meanwhile, or of a time before the question
            return replace(view, status=new.status, reason=new.reason, corners=new.corners)

        def change(project: Project) -> Project:
            if _sought(project) != self._sought:
                return project  # another question
            views = tuple(map(answered, project.views))
            same = all(a is b for a, b in zip(views, project.views, strict=True))
            return project if same else replace(project, views=views)

        self._session.document.learn(change)
        self._given.update({view.image: view.corners for view in news.values()})

    def _done(self, detection: Detection) -> None:
        self._learn(detection.views)
        if detection.size is not None:
            self._session.document.learn(
                lambda p: replace(p, size=detection.size) if p.views and p.size is None else p
            )

    def _fail(self, error: Exception) -> None:
        """Report it, and do not try again: it would fail in the same way."""
        self._failed = True
        self._session.failed.emit(error)

    def _ended(self) -> None:
        cancelled = self._job is not None and self._job.cancelled
        again, self._again, self._job = self._again, False, None
        failed, self._failed = self._failed, False
        if failed or (cancelled and not again):
            self.finished.emit(False)
        else:
            self.search()  # what was added meanwhile


def _sought(project: Project) -> tuple[Pattern, str]:
    """What corners are looked for, and how they are located."""
    return project.pattern, project.method
