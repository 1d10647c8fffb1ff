"""The projects and folders that were opened or saved lately."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path

from calibgui.app.system.state_folder import find_state_folder
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.formats.json_document import read_json
from calibgui.formats.node import Node

_MAX_RECENT = 10
"""Number of projects and folders that are remembered."""
_MAX_SIZE = 1 << 20
"""Size of the largest notes that are read, bytes: ten names have some kB."""


@dataclass(frozen=True, slots=True)
class Recent:
    """A project file or a folder of images that was opened lately."""

    path: Path
    image: str
    """Its first image, by which the user knows it again; empty if it has none."""


def list_recent() -> list[Recent]:
    """Return the projects and folders opened or saved lately that still exist, the newest first.

    There are none as long as the notes are missing or damaged.
    """
    try:
        recent = [_decode_note(note) for note in read_json(_find_file(), _MAX_SIZE).items()]
    except (OSError, CalibrationError):
        return []
    # A name that is too long for the system is of nothing that exists.
    return [entry for entry in recent if os.path.exists(entry.path)]  # noqa: PTH110


def _decode_note(note: Node) -> Recent:
    """Return what a note is of; notes of earlier versions are names of projects alone."""
    if isinstance(note.value, str):
        return Recent(Path(note.file_name()), "")
    return Recent(Path(note["path"].file_name()), note["image"].text())


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
