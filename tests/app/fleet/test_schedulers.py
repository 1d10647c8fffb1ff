"""Schedulers: what is done, what a death costs, and that a rerun gives the same bytes."""

from __future__ import annotations

import gc
import json
import multiprocessing
import os
import random
import shutil
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
def start_cluster(folder: Path, *options: str) -> Iterator[tuple[str, subprocess.Popen[bytes]]]:
    """Run a scheduler of Dask with a worker; give its address and its process.

    The worker is started anew when it dies, and its tasks are not.
    """
    # A client that could not connect ends when it is collected: if that is while another one
    # starts, Dask waits for ever.
    gc.collect()
    file = folder / "scheduler.json"
    file.unlink(missing_ok=True)
    common = ["--no-dashboard", "--scheduler-file", str(file), *options]
    python = [sys.executable, "-m"]
    environment = os.environ | {"DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "0"}
    scheduler = subprocess.Popen(
        [*python, "distributed.cli.dask_scheduler", *common, "--host", "127.0.0.1", "--port", "0"],
        stderr=subprocess.DEVNULL,
        env=environment,
    )
    while not file.exists():
        assert scheduler.poll() is None
        time.sleep(0.05)
    worker = subprocess.Popen(
        [*python, "distributed.cli.dask_worker", *common, "--nthreads", "1"],
        stderr=subprocess.DEVNULL,
        env=environment,
        start_new_session=True,
    )
    try:
        yield json.loads(file.read_text())["address"], scheduler
    finally:
        os.killpg(worker.pid, signal.SIGKILL)
        scheduler.kill()
        for process in (worker, scheduler):
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
    with open_scheduler(2) as scheduler:
        assert list(scheduler.run(abs, [])) == []
        assert dict(scheduler.run(abs, [-1, -2, -3])) == {0: 1, 1: 2, 2: 3}


def test_a_worker_of_the_pool_that_is_killed_costs_nothing(
    tasks: Sequence[CameraTask], calibrated: Path, tmp_path: Path
) -> None:
    def choose_worker() -> int | None:
        return multiprocessing.active_children()[0].pid

    with open_scheduler(2) as scheduler:
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
def test_daskss_workers_may_be_killed(tmp_path: Path) -> None:
    with (
        start_cluster(tmp_path) as (address, _),
        open_scheduler(address=address) as scheduler,
    ):
        # A worker that dies while it starts is not started anew: this one has started.
        assert dict(scheduler.run(time.sleep, [1])) == {0: None}
        # A task that kills its worker is told, and others are done.
        deadly = "__import__('os').kill(__import__('os').getpid(), 9)"
        assert isinstance(dict(scheduler.run(eval, [deadly]))[0], Crashed)
        assert dict(scheduler.run(eval, ["1", "2"])) == {0: 1, 1: 2}
        with pytest.raises(ZeroDivisionError):
            list(scheduler.run(eval, ["1 / 0"]))
        # What is done and waits in the memory of a worker that dies is computed again.
        results = scheduler.run(eval, ["__import__('os').getpid()"] * 3)
        worker = int(str(next(results)[1]))
        time.sleep(1)
        os.kill(worker, signal.SIGKILL)
        time.sleep(0.1)  # the scheduler knows; a new worker takes longer
        assert all(isinstance(number, int) and number != worker for _, number in results)


@needs_dask
@pytest.mark.slow
@pytest.mark.skipif(shutil.which("openssl") is None, reason="needs openssl for certificates")
def test_a_scheduler_with_tls_is_reached_with_a_certificate_only(tmp_path: Path) -> None:
    import dask

    ours, others = make_certificate(tmp_path, "ours"), make_certificate(tmp_path, "others")
    options = [f"--tls-{name}={file}" for name, file in ours.items()]
    with start_cluster(tmp_path, "--protocol", "tls", *options) as (address, _):
        assert address.startswith("tls://")

        def ask(files: dict[str, Path]) -> int | Crashed:
            own = {"cert": str(files["cert"]), "key": str(files["key"])} if files else {}
            settings = {"ca-file": str(files["ca-file"]), "client": own} if files else {}
            with (
                dask.config.set({"distributed.comm.tls": {**EMPTY, **settings}}),
                open_scheduler(address=address) as scheduler,
            ):
                return dict(scheduler.run(abs, [-3]))[0]

        assert ask(ours) == 3
        with pytest.raises(CalibrationError, match="cannot be reached with TLS") as caught:
            ask({})
        assert "distributed.comm.tls" in caught.value.hint
        with pytest.raises(CalibrationError, match="does not answer"):
            ask(others)


EMPTY = {
    "ciphers": None,
    "min-version": 1.2,
    "max-version": None,
    "ca-file": None,
    "client": {"cert": None, "key": None},
    "scheduler": {"cert": None, "key": None},
    "worker": {"cert": None, "key": None},
}
"""Dask's settings of TLS where nobody has made any."""


def make_certificate(folder: Path, name: str) -> dict[str, Path]:
    """Make a certificate that vouches for itself; return its files by Dask's names for them."""
    cert, key = folder / f"{name}.crt", folder / f"{name}.key"
    command = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "1"]
    command += ["-subj", "/CN=fleet", "-keyout", str(key), "-out", str(cert)]
    subprocess.run(command, check=True, capture_output=True)
    return {"ca-file": cert, "cert": cert, "key": key}


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
    run(tasks, ledger, Here())
    check_same(ledger, calibrated)


@needs_dask
def test_a_scheduler_that_does_not_answer_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(schedulers, "_SCHEDULER_SECONDS", 1)
    with (
        open_scheduler(address="tcp://127.0.0.1:9") as scheduler,
        pytest.raises(CalibrationError, match=r"127\.0\.0\.1:9 does not answer"),
    ):
        list(scheduler.run(abs, [1]))
