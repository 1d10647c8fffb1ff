"""The projects that were opened or saved lately."""

from __future__ import annotations

import json
from pathlib import Path

from calibgui.app.state_folder import find_state_folder
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically

_MAX_PROJECTS = 10
"""Number of projects that are remembered."""


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
