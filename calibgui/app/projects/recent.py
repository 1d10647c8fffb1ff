"""The projects and folders that were opened or saved lately."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from calibgui.app.system.state_folder import find_state_folder
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically

_MAX_RECENT = 10
"""Number of projects and folders that are remembered."""


@dataclass(frozen=True, slots=True)
class Recent:
    """A project file or a folder of images that was opened lately."""

    path: Path
    image: str
    """Its first image, by which the user knows it again; empty if it has none."""


def list_recent() -> list[Recent]:
    """Return the projects and folders opened or saved lately that still exist, the newest first."""
    try:
        noted = json.loads(_find_file().read_text(encoding="utf-8"))
        entries = [
            # Notes of earlier versions are names of projects alone.
            (note, "") if isinstance(note, str) else (note["path"], note["image"])
            for note in noted
        ]
        recent = [Recent(Path(path), str(image)) for path, image in entries]
        return [entry for entry in recent if entry.path.exists()]
    except (OSError, ValueError, TypeError, KeyError):  # no notes yet, or damaged ones
        return []


def remember_project(path: Path, image: str = "") -> None:
    """Put a project, or a folder of images, first among the recent ones.

    On a full disk nothing is remembered.

    Args:
        path: the project's file or the folder.
        image: its first image.
    """
    path = path.absolute()
    recent = [Recent(path, image), *(entry for entry in list_recent() if entry.path != path)]
    notes = [{"path": str(entry.path), "image": entry.image} for entry in recent[:_MAX_RECENT]]
    try:
        write_atomically(_find_file(), json.dumps(notes).encode())
    except (OSError, CalibrationError):
        return  # a full disk must not keep anybody from working


def _find_file() -> Path:
    return find_state_folder() / "recent.json"
