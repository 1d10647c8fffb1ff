"""Unsaved work in a file beside the project's, in case the program is killed."""

from __future__ import annotations

from pathlib import Path

from calibgui.app.project import Project
from calibgui.app.project_file import write_project

AUTOSAVE_DELAY_S = 2.0
"""Time from an edit until it is in the file, s."""


def get_autosave_path(project_file: Path) -> Path:
    """Return the file that holds the unsaved state of the project in `project_file`."""
    return project_file.with_name(f".{project_file.name}.autosave")


def autosave(project: Project, project_file: Path) -> None:
    """Write the unsaved state of `project`.

    Paths are relative to the same folder as in the project's own file.

    Raises:
        CalibrationError: if it cannot be written.
    """
    write_project(project, get_autosave_path(project_file))


def find_unsaved_work(project_file: Path) -> Path | None:
    """Return the autosave of `project_file` if it is newer than the file itself, else None."""
    candidate = get_autosave_path(project_file)
    if not candidate.exists():
        return None
    if project_file.exists() and project_file.stat().st_mtime_ns > candidate.stat().st_mtime_ns:
        return None
    return candidate


def discard_autosave(project_file: Path) -> None:
    """Remove the autosave of `project_file`, whose content is saved or not wanted."""
    get_autosave_path(project_file).unlink(missing_ok=True)
