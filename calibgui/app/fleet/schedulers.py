"""The tasks of a fleet are done by processes here, or by workers of a scheduler of Dask.

Both do the same function to every item and yield what comes back in the order of completion. The
workers are reached when the first item is there: if nothing is to be done, nothing is started.

Processes here are reached by pipes that no other process has. A scheduler of Dask is reached over
the network, and what comes from it is unpickled: `describe_trust` says what that means.
"""

from __future__ import annotations

import importlib.util
import logging
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
_TLS = "tls://"


class Scheduler(Protocol):
    """Something that does tasks."""

    def run(self, task: Callable[[T], R], items: Sequence[T]) -> Iterator[tuple[int, R | Crashed]]:
        """Yield the index and task(item) of each item, `Crashed` where its process died.

        Raises:
            CalibrationError: if no tasks can be done, or no more.
        """


@contextmanager
def open_scheduler(workers: int | None = None, address: str | None = None) -> Iterator[Scheduler]:
    """Give what does tasks: a pool of processes, or a scheduler of Dask that runs.

    Args:
        workers: number of processes here; that of the processors if None.
        address: of a scheduler of Dask that runs, such as tls://host:8786.

    Raises:
        CalibrationError: if an address is given, and Dask is not installed.
    """
    if address is None:
        yield _Pool(workers)
        return
    if not has_dask():
        raise CalibrationError(
            f"The scheduler {address} needs Dask.", f"{describe_missing_extra('batch')}."
        )
    scheduler = _Dask(address)
    try:
        yield scheduler
    finally:
        scheduler.close()


def describe_trust(address: str) -> str:
    """Say in a sentence who can run code as whom where work goes to a scheduler of Dask."""
    if address.startswith(_TLS):
        return (
            f"The scheduler {address} is trusted: who has a certificate that Dask's settings "
            "accept can run code as you, and you as whoever runs its workers."
        )
    return (
        f"The scheduler {address} is trusted, without TLS: whoever can reach it can run code as "
        "you, and you as whoever runs its workers."
    )


def has_dask() -> bool:
    """Return whether Dask distributed is installed."""
    return importlib.util.find_spec("distributed") is not None


class _Pool:
    """Processes on this machine."""

    def __init__(self, count: int | None) -> None:
        self._count = count

    def run(self, task: Callable[[T], R], items: Sequence[T]) -> Iterator[tuple[int, R | Crashed]]:
        return map_in_processes(task, items, prepare=prepare_finder, count=self._count)


class _Dask:
    """Workers of Dask, wherever its scheduler has some."""

    def __init__(self, address: str) -> None:
        self._address = address
        self._client: Client | None = None

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
        """Let go of the workers."""
        if self._client is not None:
            self._client.close()

    def _connect(self) -> Client:
        """Connect to the scheduler, with the certificates that Dask's own settings name."""
        import dask
        from distributed import Client

        # What ends the work is raised; the log would tell it again, with a traceback.
        logging.getLogger("distributed").setLevel(logging.CRITICAL)
        settings = {}
        if self._address.startswith(_TLS):
            # Workers could be named by addresses without TLS: nothing is sent to those.
            settings["distributed.comm.require-encryption"] = True
        try:
            with dask.config.set(settings):
                return Client(self._address, timeout=_SCHEDULER_SECONDS)
        except (OSError, ValueError, TimeoutError) as error:
            raise CalibrationError(
                f"Dask's scheduler {self._address} does not answer: {error}.",
                "Start it, and check its address.",
            ) from error
        except TypeError as error:  # how Dask tells that it has no certificates
            raise CalibrationError(
                f"Dask's scheduler {self._address} cannot be reached with TLS: {error}.",
                "Name the certificates in Dask's settings, distributed.comm.tls.ca-file and "
                "distributed.comm.tls.client.cert and key (docs.dask.org).",
            ) from error

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
                f"Dask's scheduler {self._address} is gone.",
                "Start it again and repeat the command: what is done is kept.",
            ) from error
