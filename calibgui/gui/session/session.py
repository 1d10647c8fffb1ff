"""The session that all parts share: the document, the selection and the running jobs."""

from __future__ import annotations

from collections.abc import Hashable

from PySide6.QtCore import QObject, Signal

from calibgui.app.calibrating.settings import BEST_SETTINGS
from calibgui.app.photographs.image_store import ImageStore
from calibgui.app.photographs.sensor_frame import choose_orientation
from calibgui.app.projects.document import Change, Document
from calibgui.app.projects.project import Project
from calibgui.dataset import Result, View, find_orientation
from calibgui.engine.boards import BoardShape
from calibgui.engine.images import Field, read_image_header
from calibgui.gui.jobs.jobs import Jobs


class Session(QObject):
    """One project being worked on. Widgets listen to it, and tell it what the user does."""

    changed = Signal(object, object)
    """The project before and after an edit, an undo, a finding, or opening another one."""
    selected = Signal(str, int)
    """The image chosen to be looked at ("" for none), and one of its corners or -1."""
    hovered = Signal(str)
    """The image that the cursor is over now, in whatever shows it; "" for none."""
    renewed = Signal(str)
    """The file of an image holds another picture than before."""
    result_changed = Signal(object)
    """The result that is shown, or None."""
    judged = Signal()
    """The verdict on the result that is shown is known now."""
    failed = Signal(Exception)
    """An operation could not be done (a CalibrationError), or met a bug (anything else)."""
    notified = Signal(str)
    """There is a message for the user."""
    withdrawn = Signal(str)
    """This message for the user holds no longer."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.jobs = Jobs(self)
        self.jobs.failed.connect(self.failed)
        self.images = ImageStore(
            find_orientation=self._find_orientation, find_field=self._find_field
        )
        self.document = make_empty_document()
        self.document.listeners.append(self._document_changed)
        self.image = ""
        self.corner = -1
        self.hovered_image = ""
        """The image that the cursor is over; "" for none."""
        self._chosen_results: list[str] = []
        """Names of the results that were chosen to be shown, the latest last; empty ones stand for
        the newest result."""
        self._announced: Result | None = None

    @property
    def project(self) -> Project:
        """The project as it is now."""
        return self.document.project

    @property
    def view(self) -> View | None:
        """The view that is selected."""
        return next((view for view in self.project.views if view.image == self.image), None)

    @property
    def result_name(self) -> str:
        """Name of the result that is shown: of those that there are the one chosen last.

        What undo takes away gives place to what was shown before it, and redo brings it back.
        """
        results = self.project.results
        newest = list(results)[-1] if results else ""
        chosen = (name for name in reversed(self._chosen_results) if name in results or not name)
        return next(chosen, "") or newest

    @property
    def result(self) -> Result | None:
        """The result that is shown."""
        return self.project.results.get(self.result_name)

    def describe_age(self, result: Result | None) -> str:
        """Say that a result is out of date, why, and what to do; "" if it is not."""
        if result is None or self.project.is_current(result):
            return ""
        if self.project.has_settings_of(result):
            return self.tr("Out of date, as images or board have changed: calibrate again.")
        return self.tr("Out of date, as settings have changed: calibrate again.")

    def show_result(self, name: str) -> None:
        """Show another result; the empty name stands for the newest."""
        self._chosen_results = [*(n for n in self._chosen_results if n != name), name]
        self._announce_result()

    def edit(self, label: str, change: Change, *, sliding: bool = False) -> None:
        """Apply an edit of the user's; see ``Document.edit``."""
        self.document.edit(label, change, sliding=sliding)

    def select(self, image: str, corner: int = -1) -> None:
        """Look at an image, and at one of its corners."""
        if (image, corner) != (self.image, self.corner):
            self.image, self.corner = image, corner
            self.selected.emit(image, corner)

    def hover(self, image: str) -> None:
        """Tell everybody which image the cursor is over; "" for none."""
        if image != self.hovered_image:
            self.hovered_image = image
            self.hovered.emit(image)

    def _find_orientation(self, image: str) -> int | None:
        """Return the orientation by which an image is turned, None for that which it states.

        Raises:
            CalibrationError: if the image cannot be read.
        """
        project = self.project
        view = next((view for view in project.views if view.image == image), None)
        if view is None or view.orientation is not None or project.size is None:
            return None if view is None else view.orientation
        usual = find_orientation(project.views)
        return choose_orientation(read_image_header(image), project.size, usual)

    def _find_field(self, image: str) -> Field | None:
        """Return the field of an interlaced frame that is shown, None for all rows."""
        views = self.project.views
        return next((view.field for view in views if view.image == image), None)

    def renew(self, image: str) -> None:
        """Forget the picture of an image: its file holds another one."""
        self.images.forget(image)
        self.renewed.emit(image)

    def select_next(self, step: int) -> None:
        """Look at the next image in the project's order, or the one before."""
        views = self.project.views
        place = self.project.find(self.image) + step
        if 0 <= place < len(views):
            self.select(views[place].image)

    def begin(self, document: Document) -> None:
        """Work on another document."""
        before = self.project
        for job in self.jobs.running:
            if job.is_about_document:
                job.cancel()
        self.document.listeners.remove(self._document_changed)
        self.document = document
        document.listeners.append(self._document_changed)
        self._chosen_results = []
        self._document_changed(before, document.project)

    def question(self) -> Hashable:
        """Return what a calibration depends on: a camera holds as long as this stays the same.

        How long the squares are is a part of it only where other lengths were stated as well.
        """
        project = self.project
        board, settings = project.board, project.settings
        drawn = None if board is None else (board.grid_size, board.pattern.kind)
        has_lengths = settings.prior is not None or isinstance(settings.board_shape, BoardShape)
        square = project.square if has_lengths else None
        return (project.usable, drawn, square, project.size, settings)

    def _document_changed(self, before: Project, after: Project) -> None:
        if after.find(self.image) < 0:
            self.image, self.corner = (after.views[0].image if after.views else ""), -1
            self.changed.emit(before, after)
            self.selected.emit(self.image, self.corner)
        else:
            self.changed.emit(before, after)
        self._announce_result()

    def _announce_result(self) -> None:
        if self.result is not self._announced:
            self._announced = self.result
            self.result_changed.emit(self.result)


def make_empty_document() -> Document:
    """Return a document to begin with."""
    return Document(Project(settings=BEST_SETTINGS))
