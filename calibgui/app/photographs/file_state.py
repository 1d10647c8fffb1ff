"""The content of a file at one time, and the test of whether the file still has it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from calibgui.app.photographs.image_store import Signature, compute_file_digest, read_signature
from calibgui.engine.errors import CalibrationError


@dataclass(frozen=True, slots=True)
class FileState:
    """The content of a file when it was looked at."""

    path: Path
    signature: Signature
    digest: str
    """SHA-256 of its content."""

    @property
    def holds(self) -> bool:
        """Return whether the file is there with the same content, whenever it was written."""
        if read_signature(self.path) == self.signature:
            return True
        try:
            return compute_file_digest(self.path) == self.digest
        except (OSError, CalibrationError):
            return False


def read_file_state(path: Path) -> FileState | None:
    """Return what the file `path` holds now; None if it cannot be read."""
    signature = read_signature(path)
    try:
        return FileState(path, signature, compute_file_digest(path)) if path.is_file() else None
    except OSError:
        return None
