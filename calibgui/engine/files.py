"""Writing files so that a failure leaves the old file, or none, but never half of one."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from calibgui.engine.errors import CalibrationError


def write_atomically(path: str | os.PathLike[str], content: bytes) -> None:
    """Write `content` beside `path`, flush it to the disk, then put it in the place of `path`.

    Raises:
        CalibrationError: if the disk is full or the folder cannot be written; `path` is as before.
    """
    path = Path(path)
    temporary: Path | None = None
    try:
        with tempfile.NamedTemporaryFile(
            dir=path.parent, prefix=f".{path.name}.", suffix=".tmp", delete=False
        ) as file:
            temporary = Path(file.name)
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(_mode(path))
        temporary.replace(path)
        temporary = None
    except OSError as error:
        raise CalibrationError(
            f"{path} cannot be written: {error.strerror or error}.",
            "Free some space, or choose another folder that you may write to.",
        ) from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def _mode(path: Path) -> int:
    """Permissions of the file to be replaced, or those that a new file would get."""
    if path.exists():
        return path.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
