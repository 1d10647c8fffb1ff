"""Who does the tasks of a fleet: Dask's workers where it is installed, else processes here.

Both do the same function to every item and yield what comes back in the order of completion. The
workers are started when the first item is there: if nothing is to be done, nothing is started.
"""

from __future__ import annotations

import importlib.util
import logging
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from calibgui.app.system.kernel_preparation import prepare_finder
from calibgui.app.system.missing_library import describe_missing_extra
from calibgui.app.system.workers import Crashed, map_in_processes
from calibgui.engine.errors import CalibrationError

if TYPE_CHECKING:
    from distributed import Client  # an extra, and slow to import

T = TypeVar("T")
R = TypeVar("R")

_MAX_IN_FLIGHT = 4096
"""Number of items that Dask's scheduler holds at a time: it keeps as many workers busy, and its
memory and that of the driver stay flat."""
_SCHEDULER_SECONDS = 10
"""Time after which a scheduler that does not answer counts as gone, s."""


class Scheduler(Protocol):
    """Something that does tasks."""

    def run(self, task: Callable[[T], R], items: Sequence[T]) -> Iterator[tuple[int, R | Crashed]]:
        """Yield the index and task(item) of each item, `Crashed` where its process died.

        Raises:
            CalibrationError: if no tasks can be done, or no more.
        """


@contextmanager
def open_scheduler(
    workers: int | None = None,
    address: str | None = None,
    announce: Callable[[str], None] = lambda _: None,
) -> Iterator[Scheduler]:
    """Give what does tasks: a scheduler of Dask that runs, one of our own, or a pool of processes.

    Args:
        workers: number of processes here; that of the processors if None.
        address: of a scheduler of Dask that runs, such as tcp://host:8786.
        announce: a function that is told in a sentence where the work can be watched.

    Raises:
        CalibrationError: if an address is given, and Dask is not installed.
    """
    count = workers or os.cpu_count() or 1
    if not has_dask():
        if address is not None:
            raise CalibrationError(
                f"The scheduler {address} needs Dask.", f"{describe_missing_extra('batch')}."
            )
        yield _Pool(count)
        return
    scheduler = _Dask(count, address, announce)
    try:
        yield scheduler
    finally:
        scheduler.close()


def has_dask() -> bool:
    """Return whether Dask distributed is installed."""
    return importlib.util.find_spec("distributed") is not None


class _Pool:
    """Processes on this machine."""

    def __init__(self, count: int) -> None:
        self._count = count

    def run(self, task: Callable[[T], R], items: Sequence[T]) -> Iterator[tuple[int, R | Crashed]]:
        return map_in_processes(task, items, prepare=prepare_finder, count=self._count)


class _Dask:
    """Workers of Dask, here or wherever its scheduler has some."""

    def __init__(self, count: int, address: str | None, announce: Callable[[str], None]) -> None:
        self._count = count
        self._address = address
        self._announce = announce
        self._client: Client | None = None
        self._cluster: Any = None

    def run(self, task: Callable[[T], R], items: Sequence[T]) -> Iterator[tuple[int, R | Crashed]]:
        if not items:
            return
        from distributed import as_completed

        client = self._client = self._client or self._connect()
        waiting = iter(enumerate(items))
        indices = {}
        running = as_completed()

        def submit() -> None:
            if (pair := next(waiting, None)) is not None:
                # Without pure=False equal items would be one task.
                future = client.submit(task, pair[1], pure=False)
                indices[future.key] = pair[0]
                running.add(future)

        for _ in range(_MAX_IN_FLIGHT):
            submit()
        for future in running:
            submit()
            yield indices.pop(future.key), self._take_result(future)

    def close(self) -> None:
        """Let go of the workers, and end those that were started here."""
        for part in (self._client, self._cluster):
            if part is not None:
                part.close()

    def _connect(self) -> Client:
        """Start workers here, or connect to a scheduler that has some."""
        import dask
        from distributed import Client, LocalCluster

        # A task whose worker died comes back as such: who asked decides what to do about it.
        dask.config.set({"distributed.scheduler.allowed-failures": 0})
        # What ends the work is raised; the log would tell it again, with a traceback.
        logging.getLogger("distributed").setLevel(logging.CRITICAL)
        try:
            if self._address is None:
                prepare_finder()  # compiled once: the workers load it
                # Workers would keep samples of their stacks for an hour: up to 2 GB of each.
                dask.config.set({"distributed.worker.profile.enabled": False})
                self._cluster = LocalCluster(
                    n_workers=self._count,
                    threads_per_worker=1,
                    host="127.0.0.1",
                    dashboard_address="127.0.0.1:0",
                    silence_logs=logging.CRITICAL,
                )
            client = Client(self._cluster or self._address, timeout=_SCHEDULER_SECONDS)
        except (OSError, ValueError, TimeoutError) as error:
            raise CalibrationError(
                f"Dask's scheduler {self._address or 'on this machine'} does not answer: {error}.",
                "Start it, and check its address.",
            ) from error
        self._announce(f"Dask's dashboard: {client.dashboard_link}")
        return client

    def _take_result(self, future: Any) -> Any:
        """Return the result of a task that has ended. Raises what it raised."""
        from distributed import CancelledError, KilledWorker

        try:
            # A result whose worker has died since is computed again: `future.status`, which says
            # "lost" meanwhile, is no answer.
            return future.result()
        except KilledWorker:
            return Crashed()
        except CancelledError as error:
            raise CalibrationError(
                f"Dask's scheduler {self._address or 'on this machine'} is gone.",
                "Start it again and repeat the command: what is done is kept.",
            ) from error
