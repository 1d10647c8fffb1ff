"""Unsaved work in a file beside the project's, in case the program is killed.

Where nothing can be written beside the project, it is kept in the folder for the program's own
files. The clock does not decide what is offered for recovery: saving removes the autosave, so what
is there has not been saved, whichever of both files seems to be older.

What the user gives up is kept there, too, until newer work that was given up takes its place.
"""

from __future__ import annotations

import contextlib
import filecmp
import hashlib
import os
from datetime import datetime
from pathlib import Path

from calibgui.app.projects.project import Project
from calibgui.app.projects.project_file import read_project, write_project
from calibgui.app.system.state_folder import find_state_folder
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import (
    describe_read_error,
    describe_write_error,
    read_regular,
    write_atomically,
)
from calibgui.formats.json_document import MAX_JSON_SIZE

AUTOSAVE_DELAY_S = 2.0
"""Time from an edit until it is in the file, s."""
MAX_DISCARDED = 20
"""Number of projects that are kept of those that the user gave up."""


def get_autosave_path(project_file: Path) -> Path:
    """Return the file that holds the unsaved state of the project in `project_file`."""
    return project_file.with_name(f".{project_file.name}.autosave")


def get_substitute_path(project_file: Path) -> Path:
    """Return the file for the unsaved state where none can be written beside `project_file`."""
    place = hashlib.sha256(os.fsencode(project_file.absolute())).hexdigest()[:16]
    return find_state_folder() / f"{project_file.name}.{place}.autosave"


def autosave(project: Project, project_file: Path) -> None:
    """Write the unsaved state of `project`.

    Paths are relative to the same folder as in the project's own file.

    Raises:
        CalibrationError: if it can be written nowhere.
    """
    folder = project_file.parent
    try:
        write_project(project, get_autosave_path(project_file), folder)
    except CalibrationError:
        write_project(project, get_substitute_path(project_file), folder)


def read_unsaved_work(work: Path, project_file: Path) -> Project:
    """Read an autosave of `project_file`. Raises as ``read_project``."""
    return read_project(work, project_file.parent)


def find_unsaved_work(project_file: Path) -> Path | None:
    """Return the autosave of `project_file` that was written last, else None.

    An autosave that holds what the file holds is none.
    """
    places = get_autosave_path(project_file), get_substitute_path(project_file)
    unsaved = [path for path in places if path.is_file() and not _are_alike(path, project_file)]
    return max(unsaved, key=lambda path: path.stat().st_mtime_ns, default=None)


def _are_alike(work: Path, project_file: Path) -> bool:
    return project_file.is_file() and filecmp.cmp(work, project_file, shallow=False)


def discard_autosave(project_file: Path) -> None:
    """Remove the autosaves of `project_file`, whose content is saved or kept elsewhere.

    One that cannot be removed is offered again.
    """
    for path in (get_autosave_path(project_file), get_substitute_path(project_file)):
        with contextlib.suppress(OSError):
            path.unlink(missing_ok=True)


def get_discarded_folder() -> Path:
    """Return the folder that keeps what the user gave up."""
    return find_state_folder() / "discarded"


def keep_discarded(project: Project, name: str) -> Path:
    """Keep a project that the user gives up, in a file that can be opened like any other.

    Args:
        project: the project.
        name: what its file's name begins with.

    Raises:
        CalibrationError: if it cannot be written.
    """
    path = _make_place(name)
    write_project(project, path)
    return path


def keep_discarded_work(work: Path, project_file: Path) -> Path:
    """Keep an autosave of `project_file` that the user gives up, even if it cannot be read.

    Raises:
        CalibrationError: if it cannot be written.
    """
    name = project_file.stem
    try:
        return keep_discarded(read_unsaved_work(work, project_file), name)
    except CalibrationError:
        path = _make_place(name)
        try:
            write_atomically(path, read_regular(work, MAX_JSON_SIZE))
        except OSError as error:
            raise describe_read_error(work, error) from error
        return path


def _make_place(name: str) -> Path:
    """Return the path for one more project that was given up; the oldest ones make room.

    Raises:
        CalibrationError: if there can be none.
    """
    folder = get_discarded_folder()
    try:
        folder.mkdir(exist_ok=True)
        newest_first = sorted(folder.iterdir(), key=lambda file: -file.stat().st_mtime_ns)
        for old in newest_first[MAX_DISCARDED - 1 :]:
            old.unlink()
    except OSError as error:
        raise describe_write_error(folder, error) from error
    return folder / f"{name} {datetime.now():%Y-%m-%d %H-%M-%S.%f}.json"
