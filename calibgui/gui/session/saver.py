"""Files of the document: open, save, autosave, recover."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QLockFile, QObject, QTimer, Signal

from calibgui.app.autosave import (
    AUTOSAVE_DELAY_S,
    autosave,
    discard_autosave,
    find_unsaved_work,
    get_autosave_path,
)
from calibgui.app.document import Document
from calibgui.app.project import Project
from calibgui.app.project_file import read_project, write_project
from calibgui.app.recent import find_state_folder, remember_project
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.session import Session

_SLOTS = 20
"""Programs without a project file that may run at the same time."""


class Saver(QObject):
    """Keeps the document in its file, and what is not saved in another beside it.

    A document without a file is kept in the program's own folder, in the first empty slot whose
    lock no other running program holds; what is found in a free slot is left from a crash.
    Work that is found, there or beside a file, stays as it is until the user has decided about it.
    """

    opened = Signal()
    """A document from a file is there to be worked on."""
    recoverable = Signal(Path)
    """Unsaved work was found for this project file (or slot)."""

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._autosaved: Project | None = None
        self._saving: Job | None = None
        self._save_next: Path | None = None
        self._undecided: Path | None = None
        """The project file beside which unsaved work was found."""
        self._locks, self._slot, self._left = _free_slots()
        self._timer = QTimer(self, interval=round(1000 * AUTOSAVE_DELAY_S), singleShot=True)
        self._timer.timeout.connect(self._autosave)
        session.changed.connect(self._schedule)

    @property
    def file(self) -> Path:
        """The document's file; its slot if it has no file yet, or other work is kept beside it."""
        path = self._session.document.path
        return self._slot if path is None or path == self._undecided else path

    def check_slot(self) -> None:
        """Announce work left from a crash before it had a file."""
        if self._left is not None:
            self.recoverable.emit(self._left)

    def open(self, path: Path) -> None:
        """Open a project file; announces unsaved work on it."""

        def done(project: Project) -> None:
            self._undecided = path if find_unsaved_work(path) else None
            self._session.begin(Document(project, path))
            if self._undecided is None:
                self.opened.emit()
            else:
                self.recoverable.emit(path)

        self._session.jobs.start(
            self.tr("Opening {0}").format(path.name), lambda _: _read(path), done
        )

    def recover(self, path: Path) -> None:
        """Go on with the unsaved work on the project file (or slot) `path`."""

        def done(project: Project) -> None:
            self._decided()
            file = None if path == self._left else path
            self._session.begin(Document(project, file, saved=False))
            if file is None:
                source.replace(get_autosave_path(self._slot))
            self.opened.emit()

        source = get_autosave_path(path)
        self._session.jobs.start(
            self.tr("Recovering {0}").format(path.name), lambda _: read_project(source), done
        )

    def forget(self, path: Path) -> None:
        """Throw the unsaved work on `path` away."""
        discard_autosave(path)
        self._decided()
        self.opened.emit()

    def _decided(self) -> None:
        """Keep beside the file from now on what was kept in the slot meanwhile."""
        if self._undecided is not None:
            self._undecided = self._autosaved = None
            discard_autosave(self._slot)
            self._timer.start()

    def save(self, path: Path) -> None:
        """Write the document to `path`, now.

        Raises:
            CalibrationError: if it cannot be written.
        """
        project = self._session.project
        _write(project, path)
        self._wrote(project, path)

    def save_beside(self, path: Path) -> None:
        """Write the document to `path` beside the main thread, once if asked for repeatedly."""
        if self._saving is not None:
            self._save_next = path
            return
        project = self._session.project
        self._saving = self._session.jobs.start(
            self.tr("Saving {0}").format(path.name),
            lambda _: _write(project, path),
            lambda _: self._wrote(project, path),
            ended=self._save_ended,
        )

    def _save_ended(self) -> None:
        path, self._saving, self._save_next = self._save_next, None, None
        if path is not None:
            self.save_beside(path)

    def _wrote(self, project: Project, path: Path) -> None:
        before = self.file
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
        for lock in self._locks:
            lock.unlock()

    def autosave_now(self) -> None:
        """Write the unsaved state at once: something went wrong."""
        if not self._session.document.saved:
            autosave(self._session.project, self.file)

    def _schedule(self, before: Project, after: Project) -> None:
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


def _read(path: Path) -> Project:
    project = read_project(path)
    remember_project(path)
    return project


def _write(project: Project, path: Path) -> None:
    write_project(project, path)
    remember_project(path)


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
