"""Reading regular files, and writing so that a failure leaves the old file, or none, never half.

A new file is written beside the one that it replaces. A program that is killed while it writes
leaves that behind; the next one that writes to the folder removes it.
"""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import stat
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from io import BufferedReader
from pathlib import Path
from typing import IO, BinaryIO

from calibgui.engine.errors import CalibrationError, WriteError

_TEMPORARY = re.compile(r"\.calibgui\.[0-9a-z_]{8}\.tmp")
"""Names of files that are being written."""
_ABANDONED_S = 3600.0
"""Age from which such a file counts as left by a program that was killed, s: no write takes as
long, and the clocks of computers that share a folder differ by less."""
_swept: set[str] = set()
"""Folders from which abandoned files have been removed already."""


def open_regular(path: str | os.PathLike[str]) -> BufferedReader:
    """Open a file to read its bytes.

    Raises:
        CalibrationError: if `path` is a device, a pipe or a socket, whose reading may never end,
            or no name that a file can have.
        OSError: if it cannot be opened.
    """
    try:
        file = open(path, "rb", opener=_open_at_once)  # noqa: SIM115
    except ValueError as error:  # a NUL
        raise CalibrationError(
            f"{os.fspath(path)!r} is no name of a file: {error}.", "Correct the name."
        ) from error
    if stat.S_ISREG(os.fstat(file.fileno()).st_mode):
        return file
    file.close()
    raise CalibrationError(
        f"{os.fspath(path)} is a device or a pipe, not a file.", "Name a regular file."
    )


def read_regular(path: str | os.PathLike[str], max_size: int) -> bytes:
    """Return the content of a file.

    Raises:
        CalibrationError: as `open_regular`, or if it has more than `max_size` bytes.
        OSError: if it cannot be read.
    """
    with open_regular(path) as file:
        content = file.read(max_size + 1) if _read_size(file) <= max_size else None
    if content is None or len(content) > max_size:
        raise CalibrationError(
            f"{os.fspath(path)} is too large: more than {max_size >> 20} MB.",
            "Choose another file.",
        )
    return content


def _open_at_once(path: str, flags: int) -> int:
    """Open a file; a pipe that nobody writes to is opened as well, in place of waiting."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _read_size(file: BinaryIO) -> int:
    return os.fstat(file.fileno()).st_size


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

    The file is flushed to the disk before, and its folder afterwards. If `path` is a link, the file
    that it leads to is replaced.

    Raises:
        CalibrationError: if the disk is full, the folder cannot be written, or `path` is a
            device or a pipe; the file is as before.
    """
    path = Path(path)
    temporary: Path | None = None
    try:
        refuse_special_file(path)
        target = Path(os.path.realpath(path))
        _remove_abandoned(target.parent)
        # The system applies the user's mask to a new file: to read it would set it for all threads.
        mode = target.stat().st_mode & 0o777 if target.exists() else None
        temporary = target.with_name(f".calibgui.{secrets.token_hex(4)}.tmp")
        with open(temporary, "xb", opener=partial(os.open, mode=mode or 0o666)) as file:
            if mode is not None:
                temporary.chmod(mode)
            yield file
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(target)
        temporary = None
        _flush_folder(target.parent)
    except OSError as error:
        raise describe_write_error(path, error) from error
    finally:
        if temporary is not None:
            # Where nothing can be written it was never made, nor can it be removed.
            with contextlib.suppress(OSError):
                temporary.unlink()


def _remove_abandoned(folder: Path) -> None:
    """Remove files that killed programs began to write in a folder, once in each process."""
    if str(folder) in _swept:
        return
    _swept.add(str(folder))
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            # Another program may have just removed it, or it may not be ours to remove.
            with contextlib.suppress(OSError):
                if (
                    _TEMPORARY.fullmatch(entry.name)
                    and entry.is_file(follow_symlinks=False)
                    and time.time() - entry.stat(follow_symlinks=False).st_mtime > _ABANDONED_S
                ):
                    Path(entry.path).unlink()


def _flush_folder(folder: Path) -> None:
    """Flush to the disk which files a folder has, where the system can."""
    if os.name != "posix":
        return
    # The file has its name by now, and some network drives cannot flush folders.
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


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


def describe_read_error(path: str | os.PathLike[str], error: OSError) -> CalibrationError:
    """Return the error that tells the user why the file `path` cannot be read."""
    if isinstance(error, FileNotFoundError):
        return CalibrationError(f"{os.fspath(path)} does not exist.", "Check its spelling.")
    if isinstance(error, IsADirectoryError):
        return CalibrationError(f"{os.fspath(path)} is a folder.", "Name a file.")
    return CalibrationError(
        f"{os.fspath(path)} cannot be read: {error.strerror or error}.",
        "Check its name and permissions.",
    )


def describe_write_error(path: Path, error: OSError) -> WriteError:
    """Return the error that tells the user why `path` cannot be written."""
    return WriteError(
        f"{path} cannot be written: {error.strerror or error}.",
        "Free some space, or choose another name or folder that you may write to.",
    )
