"""Schedulers: what is done, what a death costs, and that a rerun gives the same bytes."""

from __future__ import annotations

import json
import multiprocessing
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pytest

from calibgui.app.fleet import schedulers
from calibgui.app.fleet.batch import run_batch
from calibgui.app.fleet.manifest import CameraTask
from calibgui.app.fleet.schedulers import Scheduler, open_scheduler
from calibgui.app.system.workers import Crashed
from calibgui.engine.errors import CalibrationError
from calibgui.formats.fleet_ledger import open_ledger
from tests.app.fleet.conftest import Here, read_results, read_rows, run

needs_dask = pytest.mark.skipif(not schedulers.has_dask(), reason="Dask is not installed")
pytestmark = pytest.mark.skipif(os.name == "nt", reason="needs SIGKILL")


@contextmanager
def open_pool(count: int) -> Iterator[Scheduler]:
    """Give a pool of processes, whether Dask is there or not."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(schedulers, "has_dask", lambda: False)
        with open_scheduler(count) as scheduler:
            yield scheduler


@contextmanager
def start_cluster(folder: Path) -> Iterator[tuple[str, subprocess.Popen[bytes]]]:
    """Run a scheduler of Dask with a worker; give its address and its process."""
    file = folder / "scheduler.json"
    file.unlink(missing_ok=True)
    common = ["--no-dashboard", "--scheduler-file", str(file)]
    python = [sys.executable, "-m"]
    scheduler = subprocess.Popen(
        [*python, "distributed.cli.dask_scheduler", *common, "--host", "127.0.0.1", "--port", "0"],
        stderr=subprocess.DEVNULL,
    )
    while not file.exists():
        assert scheduler.poll() is None
        time.sleep(0.05)
    worker = subprocess.Popen(
        [*python, "distributed.cli.dask_worker", *common, "--nthreads", "1", "--no-nanny"],
        stderr=subprocess.DEVNULL,
    )
    try:
        yield json.loads(file.read_text())["address"], scheduler
    finally:
        for process in (worker, scheduler):
            process.kill()
            process.wait()


def run_until_killed(
    tasks: Sequence[CameraTask], ledger: Path, scheduler: Scheduler, after: int, victim: object
) -> None:
    """Run a batch, and kill a process once some cameras are done."""

    def kill(done: int, _: int) -> None:
        if done == after:
            number = victim() if callable(victim) else victim
            os.kill(int(str(number)), signal.SIGKILL)

    with open_ledger(ledger, create=True) as opened:
        run_batch(tasks, opened, scheduler, progress=kill)


def check_same(ledger: Path, calibrated: Path) -> None:
    """Compare with a run that nothing disturbed, byte for byte."""
    assert read_rows(ledger) == read_rows(calibrated)
    assert read_results(ledger) == read_results(calibrated)


def test_a_pool_does_every_item() -> None:
    with open_pool(2) as scheduler:
        assert list(scheduler.run(abs, [])) == []
        assert dict(scheduler.run(abs, [-1, -2, -3])) == {0: 1, 1: 2, 2: 3}


def test_a_worker_of_the_pool_that_is_killed_costs_nothing(
    tasks: Sequence[CameraTask], calibrated: Path, tmp_path: Path
) -> None:
    def choose_worker() -> int | None:
        return multiprocessing.active_children()[0].pid

    with open_pool(2) as scheduler:
        run_until_killed(tasks, tmp_path / "fleet.db", scheduler, 1, choose_worker)
    check_same(tmp_path / "fleet.db", calibrated)


@pytest.mark.slow
def test_a_driver_that_is_killed_loses_what_was_in_flight(
    tasks: Sequence[CameraTask], calibrated: Path, tmp_path: Path
) -> None:
    """It is killed at a random moment of its work, and another one does the rest."""
    ledger = tmp_path / "fleet.db"
    command = [sys.executable, "-m", "calibgui", "batch", str(Path(tasks[0].paths[0]).parent)]
    command += ["-o", str(ledger), "--square", "30", "--board", "6x7", "--workers", "2"]
    driver = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while not (ledger.exists() and read_rows_of_any(ledger)):
        assert driver.poll() is None
        time.sleep(0.01)
    time.sleep(random.uniform(0, 0.3))
    driver.kill()
    driver.wait()
    rows = read_rows(ledger)
    expected = {row.id: row for row in read_rows(calibrated)}
    assert all(row == expected[row.id] for row in rows)
    assert run(tasks, ledger, Here()).worked_on == len(tasks) - len(rows)
    check_same(ledger, calibrated)


def read_rows_of_any(ledger: Path) -> bool:
    """Return whether a ledger has rows; it may be in the making."""
    try:
        return bool(read_rows(ledger))
    except CalibrationError:
        return False


@needs_dask
@pytest.mark.slow
def test_daskss_own_workers_may_be_killed(
    tasks: Sequence[CameraTask], calibrated: Path, tmp_path: Path
) -> None:
    told: list[str] = []
    with open_scheduler(2, announce=told.append) as scheduler:
        # A task that kills its worker is told, and others are done.
        deadly = ["1", "__import__('os').kill(__import__('os').getpid(), 9)", "2"]
        found = dict(scheduler.run(eval, deadly))
        assert (found[0], found[2]) == (1, 2)
        assert isinstance(found[1], Crashed)
        assert told
        assert told[0].startswith("Dask's dashboard: http://127.0.0.1:")
        with pytest.raises(ZeroDivisionError):
            list(scheduler.run(eval, ["1 / 0"]))
        # What they would keep of their stacks takes 0.4 MB a second.
        is_profiled = "__import__('dask').config.get('distributed.worker.profile.enabled')"
        assert dict(scheduler.run(eval, [is_profiled])) == {0: False}

        def choose_worker() -> object:
            return next(iter(dict(scheduler.run(eval, ["__import__('os').getpid()"])).values()))

        run_until_killed(tasks, tmp_path / "fleet.db", scheduler, 1, choose_worker)
    check_same(tmp_path / "fleet.db", calibrated)


@needs_dask
@pytest.mark.slow
def test_a_result_that_is_lost_with_daskss_worker_is_computed_again() -> None:
    with open_scheduler(1) as scheduler:
        results = scheduler.run(eval, ["__import__('os').getpid()"] * 3)
        worker = int(str(next(results)[1]))
        time.sleep(1)  # the others are done and wait in the worker's memory
        os.kill(worker, signal.SIGKILL)
        time.sleep(0.1)  # the scheduler knows; a new worker takes longer
        assert all(isinstance(number, int) and number != worker for _, number in results)


@needs_dask
@pytest.mark.slow
def test_a_scheduler_that_is_killed_is_named_and_the_rerun_does_the_rest(
    tasks: Sequence[CameraTask], calibrated: Path, tmp_path: Path
) -> None:
    ledger = tmp_path / "fleet.db"
    with (
        start_cluster(tmp_path) as (address, process),
        pytest.raises(CalibrationError, match=f"scheduler {address} is gone") as caught,
        open_scheduler(address=address) as scheduler,
    ):
        run_until_killed(tasks, ledger, scheduler, 1, process.pid)
    assert "repeat the command" in caught.value.hint
    assert 1 <= len(read_rows(ledger)) < len(tasks)
    with start_cluster(tmp_path) as (address, _), open_scheduler(address=address) as scheduler:
        run(tasks, ledger, scheduler)
    check_same(ledger, calibrated)


@needs_dask
def test_a_scheduler_that_does_not_answer_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(schedulers, "_SCHEDULER_SECONDS", 1)
    with (
        open_scheduler(address="tcp://127.0.0.1:9") as scheduler,
        pytest.raises(CalibrationError, match=r"127\.0\.0\.1:9 does not answer"),
    ):
        list(scheduler.run(abs, [1]))
