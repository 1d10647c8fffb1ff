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
    """Write `content` as the file `path`, completely or not at all.

    Raises:
        CalibrationError: as `open_replacement`.
    """
    with open_replacement(path) as file:
        file.write(content)


@contextmanager
def open_replacement(path: str | os.PathLike[str]) -> Iterator[IO[bytes]]:
    """Open a file beside `path`; at the end of the `with` block it takes the place of `path`.

    The file is flushed to the disk before. If `path` is a link, the file that it leads to is
    replaced.

    Raises:
        CalibrationError: if the disk is full, the folder cannot be written, or `path` is a
            device or a pipe; the file is as before.
    """
    path = Path(path)
    temporary: Path | None = None
    try:
        refuse_special_file(path)
        target = Path(os.path.realpath(path))
        with tempfile.NamedTemporaryFile(
            dir=target.parent, prefix=".calibgui.", suffix=".tmp", delete=False
        ) as file:
            temporary = Path(file.name)
            yield file
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(_find_mode(target))
        temporary.replace(target)
        temporary = None
    except OSError as error:
        raise describe_write_error(path, error) from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def refuse_special_file(path: Path) -> None:
    """Refuse a path that a file must not replace, such as /dev/null.

    Raises:
        CalibrationError: if `path` is a device, a pipe or a socket.
        OSError: if its kind cannot be read.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise CalibrationError(
            f"{path} cannot be written: it is a device or a pipe.", "Name a file."
        )


def describe_write_error(path: Path, error: OSError) -> CalibrationError:
    """Return the error that tells the user why `path` cannot be written."""
    return CalibrationError(
        f"{path} cannot be written: {error.strerror or error}.",
        "Free some space, or choose another name or folder that you may write to.",
    )


def _find_mode(path: Path) -> int:
    """Return the permissions of the file to replace, or those that a new file would get."""
    if path.exists():
        return path.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask
