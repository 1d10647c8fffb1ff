"""Unsaved work in a file beside the project's, for the case that the program is killed."""

from __future__ import annotations

from pathlib import Path

from calibgui.app.project import Project
from calibgui.app.project_file import write_project

DELAY = 2.0
"""From an edit until it is in the file, s."""


def autosave_path(project_file: Path) -> Path:
    """The file that holds the unsaved state of the project in `project_file`."""
    return project_file.with_name(f".{project_file.name}.autosave")


def autosave(project: Project, project_file: Path) -> None:
    """Write the unsaved state of `project`.

    Paths in it are relative to the same folder as in the project's own file.

    Raises:
        CalibrationError: if it cannot be written.
    """
    write_project(project, autosave_path(project_file))


def unsaved_work(project_file: Path) -> Path | None:
    """The autosave of `project_file` if there is one newer than the file itself."""
    candidate = autosave_path(project_file)
    if not candidate.exists():
        return None
    if project_file.exists() and project_file.stat().st_mtime_ns > candidate.stat().st_mtime_ns:
        return None
    return candidate


def discard(project_file: Path) -> None:
    """Remove the autosave of `project_file`: its content is saved, or not wanted."""
    autosave_path(project_file).unlink(missing_ok=True)
