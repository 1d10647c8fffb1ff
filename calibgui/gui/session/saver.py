"""Files of the document: open, save, autosave, recover."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QLockFile, QObject, QTimer, Signal

from calibgui.app.photographs.file_state import FileState, read_file_state
from calibgui.app.projects.autosave import (
    AUTOSAVE_DELAY_S,
    autosave,
    discard_autosave,
    find_unsaved_work,
    get_autosave_path,
    keep_discarded,
    keep_discarded_work,
    read_unsaved_work,
)
from calibgui.app.projects.document import Document
from calibgui.app.projects.project import Project
from calibgui.app.projects.project_file import read_project, write_project
from calibgui.app.projects.recent import remember_project
from calibgui.app.system.state_folder import find_state_folder, is_state_lasting
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.project_lock import ProjectLock
from calibgui.gui.session.session import Session

_SLOTS = 20
"""Programs without a project file that may run at the same time."""


class Saver(QObject):
    """Keeps the document in its file, and what is not saved in another beside it.

    A document without a file is kept in the program's own folder, in the first empty slot whose
    lock no other running program holds; what is found in a free slot is left from a crash. So is a
    document whose file is open in another window, whose autosave is beside the file.
    Work that is found, there or beside a file, stays as it is until the user has decided about it.
    """

    opened = Signal()
    """A document from a file is there to be worked on."""
    recoverable = Signal(Path)
    """Unsaved work was found for this project file (or slot)."""
    discarded = Signal(Path, Path)
    """Unsaved work on this project file (or slot) was given up, and is kept in the other file."""

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._autosaved: Project | None = None
        self._saving: Job | None = None
        self._save_next: Path | None = None
        self._undecided: Path | None = None
        """The project file beside which unsaved work was found."""
        self._known: FileState | None = None
        """What the document's file held when it was read or written here."""
        self._lock = ProjectLock()
        self._locks, self._slot, self._left = _free_slots()
        self._timer = QTimer(self, interval=round(1000 * AUTOSAVE_DELAY_S), singleShot=True)
        self._timer.timeout.connect(self._autosave)
        session.changed.connect(self._follow)

    @property
    def file(self) -> Path:
        """The document's file; its slot if it has no file yet, or other work is kept beside it."""
        path = self._session.document.path
        elsewhere = path == self._undecided or self._lock.holder
        return self._slot if path is None or elsewhere else path

    @property
    def was_replaced(self) -> bool:
        """Return whether the document's file was written to, but not here, since it was read."""
        path, known = self._session.document.path, self._known
        return known is not None and known.path == path and path.is_file() and not known.holds

    def check_slot(self) -> None:
        """Announce work left from a crash before it had a file, and where nothing lasts."""
        if self._left is not None:
            self.recoverable.emit(self._left)
        if not is_state_lasting():
            self._session.notified.emit(
                self.tr(
                    "The program's own folder cannot be used: recent projects and work that is "
                    "not saved are kept in {0}, until the computer is started anew. Check HOME."
                ).format(find_state_folder())
            )

    def open(self, path: Path) -> None:
        """Open a project file; announces unsaved work on it."""

        opening = self.tr("Opening {0}").format(path.name)
        self._session.notified.emit(f"{opening}…")  # no progress is in sight without images

        def done(found: tuple[Project, FileState | None]) -> None:
            project, self._known = found
            self._lock.release()  # the window that held it may have been closed
            self._lock.take(path)
            left = not self._lock.holder and find_unsaved_work(path)
            self._undecided = path if left else None
            self._session.begin(Document(project, path))
            if self._undecided is None:
                self.opened.emit()
            else:
                self.recoverable.emit(path)
            if self._lock.holder:
                self._session.notified.emit(
                    self.tr(
                        "{0} is open in another window, too ({1}). What is saved there is not seen "
                        "here; before it is replaced you are asked."
                    ).format(path.name, self._lock.holder)
                )

        self._session.jobs.start(
            opening,
            lambda _: _read(path),
            done,
            ended=lambda: self._session.withdrawn.emit(f"{opening}…"),
        )

    def recover(self, path: Path, kept: Path | None = None) -> None:
        """Go on with the unsaved work on the project file (or slot) `path`.

        Args:
            path: the project file, or slot.
            kept: the file that holds the work, if it was given up before.
        """
        work = kept or find_unsaved_work(path) or get_autosave_path(path)

        def read(_: Job) -> tuple[Project, FileState | None]:
            project = read_project(work) if kept else read_unsaved_work(work, path)
            return project, read_file_state(path)

        def done(found: tuple[Project, FileState | None]) -> None:
            project, known = found
            self._decided()
            file = None if path == self._left else path
            self._known = known
            self._session.begin(Document(project, file, saved=False))
            if file is None and not kept:
                work.replace(get_autosave_path(self._slot))
            self.opened.emit()

        def failed(error: Exception) -> None:
            if not kept:
                self.recoverable.emit(path)  # it is still there
            self._session.failed.emit(error)

        self._session.jobs.start(
            self.tr("Recovering {0}").format(path.name), read, done, failed=failed
        )

    def forget(self, path: Path) -> None:
        """Give the unsaved work on `path` up; it is kept among what was given up."""
        work = find_unsaved_work(path)
        if work is None:
            self._forgotten(path)
            return

        def done(kept: Path) -> None:
            self._forgotten(path)
            self.discarded.emit(path, kept)

        def failed(error: Exception) -> None:
            self.recoverable.emit(path)
            self._session.failed.emit(error)

        self._session.jobs.start("", lambda _: keep_discarded_work(work, path), done, failed=failed)

    def _forgotten(self, path: Path) -> None:
        discard_autosave(path)
        self._decided()
        self.opened.emit()

    def _decided(self) -> None:
        """Keep beside the file from now on what was kept in the slot meanwhile."""
        if self._undecided is not None:
            self._undecided = self._autosaved = None
            discard_autosave(self._slot)
            self._timer.start()

    def give_up(self) -> None:
        """Keep the document as it is among what was given up: the user leaves it unsaved.

        Raises:
            CalibrationError: if it cannot be kept.
        """
        path = self._session.document.path
        keep_discarded(self._session.project, path.stem if path else self.tr("Untitled"))
        discard_autosave(self.file)
        self._autosaved = None
        self._timer.start()  # for the case that the user stays

    def save(self, path: Path) -> None:
        """Write the document to `path`, now.

        Raises:
            CalibrationError: if it cannot be written.
        """
        project = self._session.project
        self._wrote(project, path, _write(project, path))

    def save_beside(self, path: Path) -> None:
        """Write the document to `path` beside the main thread, once if asked for repeatedly."""
        if self._saving is not None:
            self._save_next = path
            return
        project = self._session.project
        self._saving = self._session.jobs.start(
            self.tr("Saving {0}").format(path.name),
            lambda _: _write(project, path),
            lambda known: self._wrote(project, path, known),
            ended=self._save_ended,
        )

    def _save_ended(self) -> None:
        path, self._saving, self._save_next = self._save_next, None, None
        if path is not None:
            self.save_beside(path)

    def _wrote(self, project: Project, path: Path, known: FileState | None) -> None:
        before, self._known = self.file, known
        if path == self._undecided:
            self._undecided = None
        self._session.document.mark_saved(project, path)
        if before != path:
            discard_autosave(before)
        if self._session.document.saved:
            self._timer.stop()
            self._autosaved = project
            discard_autosave(path)

    def close(self) -> None:
        """The user leaves, having saved or given up what there was."""
        self._timer.stop()
        discard_autosave(self.file)
        self._lock.release()
        for lock in self._locks:
            lock.unlock()

    def autosave_now(self) -> None:
        """Write the unsaved state at once: something went wrong."""
        if not self._session.document.saved:
            autosave(self._session.project, self.file)

    def _follow(self, before: Project, after: Project) -> None:
        self._lock.take(self._session.document.path)
        # Not restarted by further edits, or steady work would never be kept.
        if after is not before and not self._timer.isActive():
            self._timer.start()

    def _autosave(self) -> None:
        document, file = self._session.document, self.file
        project = document.project
        if document.saved or project is self._autosaved:
            return
        self._autosaved = project

        def done(_: None) -> None:
            if document.saved or self.file != file:  # saved while this was being written
                discard_autosave(file)

        self._session.jobs.start("", lambda _: autosave(project, file), done)


def _read(path: Path) -> tuple[Project, FileState | None]:
    known = read_file_state(path)  # first: what is written meanwhile is not what was read
    project = read_project(path)
    remember_project(path, _find_first_image(project))
    return project, known


def _write(project: Project, path: Path) -> FileState | None:
    write_project(project, path)
    remember_project(path, _find_first_image(project))
    return read_file_state(path)


def _find_first_image(project: Project) -> str:
    return project.views[0].image if project.views else ""


def _free_slots() -> tuple[list[QLockFile], Path, Path | None]:
    """An empty slot, and the first that holds work of a program that has ended, both locked."""
    folder = find_state_folder()
    locks: list[QLockFile] = []
    left = None
    for number in range(1, _SLOTS + 1):
        slot = folder / f"unsaved-{number}.json"
        lock = QLockFile(str(slot.with_suffix(".lock")))
        lock.setStaleLockTime(0)
        if not lock.tryLock(0):
            continue
        if find_unsaved_work(slot) is None:
            return [*locks, lock], slot, left
        if left is None:
            left, locks = slot, [lock]
    return locks, slot, left
