"""Writing files so that a failure leaves the old file, or none, but never half of one."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from calibgui.engine.errors import CalibrationError


def write_atomically(path: str | os.PathLike[str], content: bytes) -> None:
    """Write `content` as the file `path`, completely or not at all; see `replacing`."""
    with replacing(path) as file:
        file.write(content)


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[IO[bytes]]:
    """A file beside `path` to write to, which is then flushed to the disk and takes its place.

    A link stays: the file that it leads to is replaced.

    Raises:
        CalibrationError: if the disk is full, the folder cannot be written, or `path` is a
            device or a pipe; it is as before.
    """
    path = Path(path)
    temporary: Path | None = None
    try:
        refuse_special(path)
        target = Path(os.path.realpath(path))
        with tempfile.NamedTemporaryFile(
            dir=target.parent, prefix=".calibgui.", suffix=".tmp", delete=False
        ) as file:
            temporary = Path(file.name)
            yield file
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(_mode(target))
        temporary.replace(target)
        temporary = None
    except OSError as error:
        raise unwritable(path, error) from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def refuse_special(path: Path) -> None:
    """Refuse what a file must not take the place of, as /dev/null.

    Raises:
        CalibrationError: if `path` is a device, a pipe or a socket.
        OSError: if nothing can be learnt about it.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise CalibrationError(
            f"{path} cannot be written: it is a device or a pipe.", "Name a file."
        )


def unwritable(path: Path, error: OSError) -> CalibrationError:
    """What `error` means to who wants to write `path`."""
    return CalibrationError(
        f"{path} cannot be written: {error.strerror or error}.",
        "Free some space, or choose another name or folder that you may write to.",
    )


def _mode(path: Path) -> int:
    """Permissions of the file to be replaced, or those that a new file would get."""
    if path.exists():
        return path.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
