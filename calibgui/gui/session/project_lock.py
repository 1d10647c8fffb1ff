"""A lock beside a project file: tells other windows, here and on other computers, of this one."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QLockFile


class ProjectLock:
    """Holds the lock of one project file at a time; one left by a killed program is taken over."""

    def __init__(self) -> None:
        self.path: Path | None = None
        """The project file that was asked for last."""
        self._lock: QLockFile | None = None
        self.holder = ""
        """The program that holds the lock of `path`, as "calibgui, process 7 on host"; empty if
        none but this one does, or if locks cannot be made there."""

    def take(self, path: Path | None) -> None:
        """Release the lock that is held, and try for that of `path`."""
        if path == self.path:
            return
        self.release()
        self.path = path
        if path is None:
            return
        lock = QLockFile(str(path.with_name(f".{path.name}.lock")))
        lock.setStaleLockTime(0)  # the age of a lock tells nothing: projects are open for days
        if lock.tryLock(0):
            self._lock = lock
        elif lock.error() == QLockFile.LockError.LockFailedError:
            process, host, program = lock.getLockInfo()[-3:]
            self.holder = f"{program}, process {process} on {host}"

    def release(self) -> None:
        """Release the lock that is held, if any."""
        if self._lock is not None:
            self._lock.unlock()
        self.path, self._lock, self.holder = None, None, ""
