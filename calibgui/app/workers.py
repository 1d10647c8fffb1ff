"""Independent pieces of work on all processors, in processes that can be stopped at once.

Processes rather than threads: the corner search is many short numpy calls, which hold the
interpreter's lock, so that two threads take as long as one; a process can be ended in the
middle of an image that takes too long; and one that crashes takes only its own image along.
Workers are spawned, not forked, because the window's threads must not be copied.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import traceback
from collections.abc import Callable, Generator, Iterator, Sequence
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from threading import Event
from typing import Any, TypeVar, cast

from calibgui.engine import opencv
from calibgui.engine.errors import Cancelled
from calibgui.engine.kernels import when_compiling
from calibgui.engine.threads import one_blas_thread

T = TypeVar("T")
R = TypeVar("R")

_POLL = 0.05
"""Seconds between looks at `stop`."""
_CONTEXT = multiprocessing.get_context("spawn")


class Crashed(Exception):  # noqa: N818 - a value, never raised
    """Stands for the result of a piece of work whose process died."""


class _Compiling:
    """Sent before a result that will be long in coming."""


def spread(
    task: Callable[[T], R],
    items: Sequence[T],
    stop: Event | None = None,
    preparing: Callable[[], None] | None = None,
) -> Generator[tuple[int, R | Crashed], None, None]:
    """Index and task(item) of each item, as they are completed; closing it ends the work.

    Args:
        task: a module's function, or a partial of one: it is sent to other processes.
        items: what to do it to.
        stop: ends the work at once when set.
        preparing: called, once, if kernels have to be compiled first.

    Raises:
        Cancelled: if `stop` was set.
        Exception: whatever `task` raised, with the worker's traceback as a note.
    """
    waiting = list(enumerate(items))[::-1]
    team = [_start(task) for _ in range(min(len(items), os.cpu_count() or 1))]
    # What each worker is busy with: an item's index, or None until it has reported for work.
    busy: dict[Connection, int | None] = {connection: None for connection, _ in team}
    try:
        while busy:
            ready = cast(list[Connection], wait(list(busy), _POLL))
            if stop is not None and stop.is_set():
                raise Cancelled
            for connection in ready:
                index = busy.pop(connection)
                result, lost = _receive(connection)
                if isinstance(result, _Compiling):
                    busy[connection] = index
                    if preparing is not None:
                        preparing()
                        preparing = None
                    continue
                if lost and index is None:
                    raise RuntimeError("A worker process could not be started.")
                if lost and waiting:
                    team.append(_start(task))
                    busy[team[-1][0]] = None
                elif waiting:
                    busy[connection], item = waiting.pop()
                    with contextlib.suppress(ConnectionError):  # receiving will tell
                        connection.send(item)
                if index is not None:
                    yield index, result
    finally:
        for _, process in team:
            process.kill()
        for connection, process in team:
            process.join()
            connection.close()


def _start(task: Callable[[Any], Any]) -> tuple[Connection, SpawnProcess]:
    """A worker and the connection on which it takes items and returns results."""
    ours, theirs = _CONTEXT.Pipe()
    process = _CONTEXT.Process(target=_work, args=(task, theirs), daemon=True)
    with _interrupts_kept_off():
        process.start()
    theirs.close()
    return ours, process


def _receive(connection: Connection) -> tuple[Any, bool]:
    """What a worker answers, and whether it died instead. Raises what its task raised."""
    try:
        error, result = connection.recv()
    except (EOFError, ConnectionError):
        return Crashed(), True
    if error is not None:
        raise error
    return result, False


def _work(task: Callable[[Any], Any], connection: Connection) -> None:
    """Report for work, then do `task` to what arrives until the other end is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    opencv.use_threads(1)
    with one_blas_thread(), contextlib.suppress(EOFError, ConnectionError):
        connection.send((None, None))
        with when_compiling(lambda: connection.send((None, _Compiling()))):
            _answer(task, connection)


def _answer(task: Callable[[Any], Any], connection: Connection) -> None:
    """Do `task` to what arrives."""
    while True:
        item = connection.recv()
        try:
            answer: tuple[Exception | None, Any] = (None, task(item))
        except Exception as error:
            error.add_note(traceback.format_exc())
            answer = (error, None)
        connection.send(answer)


@contextlib.contextmanager
def _interrupts_kept_off() -> Iterator[None]:
    """Block Ctrl-C in processes started within: it is for their parent, which ends them."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    resource_tracker.ensure_running()  # which unblocks it, and would be started within
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
