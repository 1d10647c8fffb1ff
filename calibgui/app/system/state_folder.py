"""The folder for what the program keeps by itself: recent projects, and work that is not saved."""

from __future__ import annotations

import getpass
import os
import tempfile
from pathlib import Path

import platformdirs


def find_state_folder() -> Path:
    """Return the folder for the program's own files, made if it is missing.

    It is the place that the operating system provides: ``~/.local/state`` (or XDG_STATE_HOME) on
    Linux, the local AppData on Windows, ``~/Library/Application Support`` on macOS. Where that
    cannot be used, as where HOME does not exist, it is one among the temporary files.

    Raises:
        OSError: if that cannot be made either.
    """
    return _find_lasting_folder() or _make_temporary_folder()


def is_state_lasting() -> bool:
    """Return whether the program's own files outlast a restart of the computer."""
    return _find_lasting_folder() is not None


def _find_lasting_folder() -> Path | None:
    """Return the system's folder for state, made if missing; None if it cannot be written."""
    folder = platformdirs.user_state_path("calibgui", appauthor=False)
    if not folder.is_absolute():  # a user without a home
        return None
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None


def _make_temporary_folder() -> Path:
    """Return this user's folder among the temporary files, which nobody else can write to."""
    user = str(os.getuid()) if hasattr(os, "getuid") else getpass.getuser()
    folder = Path(tempfile.gettempdir()) / f"calibgui-{user}"
    folder.mkdir(mode=0o700, exist_ok=True)
    if hasattr(os, "getuid") and folder.lstat().st_uid != os.getuid():
        return Path(tempfile.mkdtemp(prefix="calibgui-"))
    return folder
