"""The search for corners in the background: its findings fill the document."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from calibgui.app.photographs.detection import Detection, find_views
from calibgui.app.photographs.shared_board import infer_grid_size, infer_pattern
from calibgui.app.projects.project import Project, change_views, remove_digests
from calibgui.dataset import View, ViewStatus, find_orientation
from calibgui.engine.arrays import Array
from calibgui.engine.features import Corners
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.session import Session


class Detector(QObject):
    """Searches the images that wait, one batch after the other."""

    finished = Signal(bool)
    """The search has ended: True if all images have been searched, False if the user cancelled."""

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._job: Job | None = None
        self._failed = False
        """True if the batch ended with an error."""
        self._has_more = False
        """True if images are waiting that the batch does not have."""
        self._batch: dict[str, Array | None] = {}
        """Images of the batch, with the regions that are searched."""
        self._found_in_batch: dict[str, Corners | None] = {}
        """Corners that the batch found in them so far."""
        self._demanded: set[str] = set()
        """Images that the user wants searched though boards are marked by hand."""
        self._search_key = _find_search_key(session.project)
        """What the batch searches for, and how."""
        self._told = ""
        """What was said of a search that was stopped."""
        session.changed.connect(self._drop_needless)

    @property
    def running(self) -> bool:
        """Return whether a search is under way."""
        return self._job is not None

    def search(self) -> None:
        """Search every image that waits, if that is not being done already.

        Where the user marks the boards by hand, only those are searched that were asked for.
        """
        project = self._session.project
        asked = tuple(
            view
            for view in project.views
            if view.status is ViewStatus.WAITING
            and (view.image in self._demanded or not project.by_hand)
        )
        if self._job is not None:
            if _find_search_key(project) != self._search_key:
                self._job.cancel()  # nobody asks for its findings any more
            self._has_more = self._job.cancelled or any(v.image not in self._batch for v in asked)
            return
        if not asked:
            self.finished.emit(True)
            return
        self._session.withdrawn.emit(self._told)
        self._batch = {view.image: view.roi for view in asked}
        self._found_in_batch = dict.fromkeys(self._batch)
        grid_size = project.grid_size or infer_grid_size(project.views)
        self._search_key = _find_search_key(project)
        pattern = infer_pattern(project.views, project.pattern)
        rois = {Path(image): roi for image, roi in self._batch.items() if roi is not None}

        def work(job: Job) -> Detection:
            def progress(done: int, total: int, view: View) -> None:
                job.advance(done, total)
                job.send([view])

            images = [Path(view.image) for view in asked]
            return find_views(
                images,
                grid_size,
                rois,
                progress,
                job.cancelling,
                project.confirmed_image_size,
                orientation=find_orientation(project.views),
                method=project.method,
                pattern=pattern,
                field=project.field,
            )

        self._job = self._session.jobs.start(
            self.tr("Finding corners"),
            work,
            self._done,
            received=self._learn,
            failed=self._fail,
            ended=self._ended,
        )

    def stop(self) -> None:
        """End the search; what has been found stays."""
        if self._job is not None:
            self._job.cancel()

    def search_again(self, images: Iterable[str]) -> None:
        """Forget what was found in `images`, and search them anew."""

        def forget(view: View) -> View:
            return replace(view, status=ViewStatus.WAITING, reason="", corners=None, points=None)

        chosen = list(images)
        self._demanded.update(chosen)

        def change(project: Project) -> Project:
            return remove_digests(change_views(project, chosen, forget), chosen)

        self._session.edit(self.tr("Detect again"), change)
        self.search()

    def _drop_needless(self) -> None:
        """End a search of images that are no longer in the project."""
        if self._job is not None and not self._batch_views:
            self._job.cancel()

    @property
    def _batch_views(self) -> list[View]:
        """The views of the batch that are in the project as it is now."""
        return [view for view in self._session.project.views if view.image in self._batch]

    def _learn(self, found: Iterable[View]) -> None:
        """Write findings into every snapshot in which the question is still open."""
        news = {view.image: view for view in found}

        def answered(view: View) -> View:
            new = news.get(view.image)
            if new is None or (view.status is new.status and view.corners is new.corners):
                return view
            asked = view.roi is self._batch[view.image]
            if not asked or view.corners is not self._found_in_batch[view.image]:
                return view  # changed by the user meanwhile, or of a time before the question
            return replace(
                view,
                status=new.status,
                reason=new.reason,
                note=new.note,
                corners=new.corners,
                orientation=new.orientation,
            )

        def change(project: Project) -> Project:
            if _find_search_key(project) != self._search_key:
                return project  # another question
            views = tuple(map(answered, project.views))
            same = all(a is b for a, b in zip(views, project.views, strict=True))
            return project if same else replace(project, views=views)

        self._session.document.learn(change)
        self._found_in_batch.update({view.image: view.corners for view in news.values()})
        for view in news.values():
            shown = self._session.images.kept(view.image)
            if shown is not None and view.orientation not in (None, shown.orientation):
                self._session.renew(view.image)

    def _done(self, detection: Detection) -> None:
        self._learn(detection.views)
        if detection.remark:
            self._session.notified.emit(detection.remark)
        if detection.size is not None:
            self._session.document.learn(
                lambda p: replace(p, size=detection.size) if self._is_size_open(p) else p
            )

    def _is_size_open(self, project: Project) -> bool:
        """Return whether the batch decides on the images' size: all boards are known from it."""
        if project.size is None:
            return bool(project.views)
        batch = self._found_in_batch
        found = [view for view in project.views if view.status is ViewStatus.FOUND]
        return bool(found) and all(
            view.image in batch and view.corners is batch[view.image] for view in found
        )

    def _fail(self, error: Exception) -> None:
        """Report it, and do not try again: it would fail in the same way."""
        self._failed = True
        self._session.failed.emit(error)

    def _ended(self) -> None:
        cancelled = self._job is not None and self._job.cancelled
        again, self._has_more, self._job = self._has_more, False, None
        failed, self._failed = self._failed, False
        if failed or (cancelled and not again):
            if cancelled:
                self._tell_what_waits()
            self.finished.emit(False)
        else:
            self.search()  # what was added meanwhile

    def _tell_what_waits(self) -> None:
        """Say what a search that was stopped has left, unless nobody would miss it."""
        views = self._batch_views
        waiting = sum(view.status is ViewStatus.WAITING for view in views)
        if waiting:
            self._told = self.tr(
                "The search was stopped: {0} of {1} images have been searched. Calibrate "
                "searches the others."
            ).format(len(views) - waiting, len(views))
            self._session.notified.emit(self._told)


def _find_search_key(project: Project) -> Hashable:
    """Return what is searched for, and how."""
    return project.pattern, project.grid_size, project.method, project.by_hand, project.field
