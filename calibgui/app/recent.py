"""The program's own notes, which are not the user's files: the projects opened lately."""

from __future__ import annotations

import json
from pathlib import Path

import platformdirs

from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically

_MAX_PROJECTS = 10
"""Number of projects that are remembered."""


def find_state_folder() -> Path:
    """Return the folder for the program's own notes, made if it is missing.

    It is the place that the operating system provides: ``~/.local/state`` (or XDG_STATE_HOME) on
    Linux, the local AppData on Windows, ``~/Library/Application Support`` on macOS.

    Raises:
        OSError: if the folder cannot be made.
    """
    return platformdirs.user_state_path("calibgui", appauthor=False, ensure_exists=True)


def list_recent_projects() -> list[Path]:
    """Return the projects opened or saved lately that still exist, the newest first."""
    try:
        names = json.loads(_find_file().read_text(encoding="utf-8"))
        return [path for path in map(Path, names) if path.is_file()]
    except (OSError, ValueError, TypeError):  # no notes yet, or damaged ones
        return []


def remember_project(path: Path) -> None:
    """Put `path` first among the recent projects; on a full disk nothing is remembered."""
    path = path.absolute()
    paths = [path, *(other for other in list_recent_projects() if other != path)]
    try:
        write_atomically(_find_file(), json.dumps([str(p) for p in paths[:_MAX_PROJECTS]]).encode())
    except (OSError, CalibrationError):
        return  # a full disk must not keep anybody from working


def _find_file() -> Path:
    return find_state_folder() / "recent.json"
