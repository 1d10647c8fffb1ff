"""Ledgers whose writers are killed, or have no more room on the disk.

The ledger opens afterwards, holds what was written before, and takes more.
"""

from __future__ import annotations

import multiprocessing
import os
import random
import resource
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from calibgui.dataset.fleet import FleetEntry
from calibgui.engine.errors import CalibrationError
from calibgui.formats.fleet_ledger import open_ledger
from tests.formats.test_fleet_ledger import DONE, FIGURES

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="needs SIGKILL and limits of Linux"),
]

_KILLS = 20
_LONG = replace(FIGURES, reason="A long reason. " * 200)
"""Figures whose row takes some pages, so that kills fall within one."""


def write_on(path: Path, first: int) -> None:
    """Write rows without end, one by one, as a driver does."""
    with open_ledger(path, create=True) as ledger:
        for k in range(first, 1_000_000):
            time.sleep(0.002)  # some hundred rows are enough
            ledger.write([replace(DONE, entry=FleetEntry(f"{k:06}"), figures=_LONG)])


def check_whole(path: Path, count: int) -> None:
    """Fail unless a ledger has `count` whole rows, and SQLite finds nothing wrong with it."""
    with open_ledger(path) as ledger:
        assert [camera.id for camera in ledger.read()] == [f"{k:06}" for k in range(count)]
        assert all(camera.figures == _LONG for camera in ledger.read())
    with closing(sqlite3.connect(path)) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def count_rows(path: Path) -> int:
    """Count the rows of a ledger; 0 if it is being made."""
    with closing(sqlite3.connect(path, timeout=60)) as connection:
        try:
            return int(connection.execute("SELECT count(*) FROM cameras").fetchone()[0])
        except sqlite3.OperationalError:
            return 0


def test_a_writer_that_is_killed_leaves_a_ledger_that_goes_on(tmp_path: Path) -> None:
    """One ledger, and 20 writers that are killed one after another at random moments."""
    path = tmp_path / "fleet.db"
    count, processes = 0, multiprocessing.get_context("forkserver")
    processes.set_forkserver_preload([__name__])  # imported once, and not by every writer
    for seed in range(_KILLS):
        writer = processes.Process(target=write_on, args=(path, count))
        writer.start()
        assert writer.pid is not None
        while not path.exists() or (count_rows(path) == count and writer.is_alive()):
            time.sleep(0.02)
        time.sleep(random.Random(seed).uniform(0, 0.1))
        os.kill(writer.pid, signal.SIGKILL)
        writer.join()
        before, count = count, count_rows(path)
        assert count > before, "what was written is kept"
    check_whole(path, count)


@contextmanager
def limit_files(size: int) -> Iterator[None]:
    """Let no file of this process grow beyond a size, in bytes."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@contextmanager
def mount_small_disk(folder: Path) -> Iterator[None]:
    """Mount a disk of 1 MB in memory."""
    folder.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", str(folder)]
    if subprocess.run(command, capture_output=True, check=False).returncode:
        pytest.skip("no disk can be mounted here")
    try:
        yield
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def fill(path: Path) -> tuple[int, CalibrationError]:
    """Write rows until there is no more room; return how many were written, and the error."""
    count = 0
    with pytest.raises(CalibrationError) as caught, open_ledger(path, create=True) as ledger:
        while True:
            ledger.write([replace(DONE, entry=FleetEntry(f"{count:06}"), figures=_LONG)])
            count += 1
    return count, caught.value


def check_full(count: int, error: CalibrationError, path: Path) -> None:
    """Fail unless the error says what is the matter, and nothing that was written is lost."""
    assert count > 20
    assert str(path) in error.message
    assert "The disk takes or gives no more" in error.message
    assert "Free some space" in error.hint
    assert "what is done is kept" in error.hint
    check_whole(path, count)


def test_a_file_that_may_not_grow_loses_nothing(tmp_path: Path) -> None:
    path = tmp_path / "fleet.db"
    with limit_files(1 << 20):
        count, error = fill(path)
    check_full(count, error, path)
    assert count_rows(path) == count


def test_a_disk_that_is_full_loses_nothing(tmp_path: Path) -> None:
    with mount_small_disk(tmp_path / "disk"):
        path = tmp_path / "disk" / "fleet.db"
        count, error = fill(path)
        check_full(count, error, path)
        # Another program's file takes what is left, so that not even a lock finds room.
        with pytest.raises(OSError), (tmp_path / "disk" / "other").open("wb") as other:
            while True:
                other.write(bytes(1 << 16))
                other.flush()
        with pytest.raises(CalibrationError) as caught, open_ledger(path, create=True) as ledger:
            ledger.write([replace(DONE, entry=FleetEntry("z"))])
        assert str(path) in caught.value.message
        (tmp_path / "disk" / "other").unlink()
        check_whole(path, count)
