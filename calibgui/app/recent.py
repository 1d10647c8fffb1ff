"""Where the program keeps what is not the user's: recent projects, unsaved work."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically

_MOST = 10


def state_folder() -> Path:
    """The folder for the program's own notes, made if it is missing."""
    home = Path.home()
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = home / "Library" / "Application Support"
    else:
        base = Path(os.environ.get("XDG_STATE_HOME") or home / ".local" / "state")
    folder = base / "calibgui"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def recent_projects() -> list[Path]:
    """Projects opened or saved lately that still exist, the newest first."""
    try:
        names = json.loads(_file().read_text(encoding="utf-8"))
        return [path for path in map(Path, names) if path.is_file()]
    except (OSError, ValueError, TypeError):  # no notes yet, or damaged ones
        return []


def remember_project(path: Path) -> None:
    """Put `path` first among the recent projects, as far as the disk allows."""
    path = path.absolute()
    paths = [path, *(other for other in recent_projects() if other != path)]
    try:
        write_atomically(_file(), json.dumps([str(p) for p in paths[:_MOST]]).encode())
    except (OSError, CalibrationError):
        return  # a full disk must not keep anybody from working


def _file() -> Path:
    return state_folder() / "recent.json"
