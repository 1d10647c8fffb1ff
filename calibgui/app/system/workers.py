"""Independent tasks on all processors, in processes that can be stopped at once.

The workers are processes, not threads: the corner search is many short numpy calls that hold the
interpreter's lock, so that two threads take as long as one; a process can be killed in the middle
of an image; and a crash costs only the image that was worked on.

A process with one thread on Linux is forked: its workers have every library and kernel that it has
loaded. Elsewhere they are spawned and load all anew: the threads of the window must not be copied,
and the libraries of other systems do not stand it.
"""

from __future__ import annotations

import contextlib
import gc
import multiprocessing
import os
import signal
import sys
import threading
import traceback
import warnings
from collections.abc import Callable, Generator, Iterator, Sequence
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from threading import Event
from typing import Any, TypeVar, cast

from calibgui.engine import opencv
from calibgui.engine.errors import CalibrationError, Cancelled
from calibgui.engine.kernels import NumbaWarning
from calibgui.engine.threads import limit_blas_threads

T = TypeVar("T")
R = TypeVar("R")

_POLL_SECONDS = 0.05
"""Time between two checks of `stop`, s."""
_NICENESS = 5
"""Niceness of a window's workers: what it paints and reads comes first where processors are few."""
_prepared: set[Callable[[], None]] = set()
"""The preparations that this process has made, and need not make again."""
_serial = threading.local()
"""True if a thread does all tasks itself (`do_tasks_here`)."""


class Crashed(Exception):  # noqa: N818 - a value, never raised
    """The result of a task whose process died."""


@contextlib.contextmanager
def do_tasks_here() -> Iterator[None]:
    """Let `map_in_processes` do the tasks of this thread in it, one after another.

    It is for a process that is one of many workers itself: more would only take turns with them,
    and some (Dask's) may start none.
    """
    _serial.is_on = True
    try:
        yield
    finally:
        _serial.is_on = False


def map_in_processes(
    task: Callable[[T], R],
    items: Sequence[T],
    stop: Event | None = None,
    prepare: Callable[[], None] | None = None,
    count: int | None = None,
) -> Generator[tuple[int, R | Crashed], None, None]:
    """Yield the index and task(item) of each item, in the order of completion.

    Closing the generator kills the workers.

    Args:
        task: a function of a module, or a partial of one, which is sent to other processes.
        items: arguments of the task.
        stop: ends the work at once when set.
        prepare: a function that loads the kernels of the task. It is called once, before the work
            is shared, if the processes are copies of this one and need not load them again.
        count: number of processes; that of the processors if None.

    Raises:
        Cancelled: if `stop` was set.
        CalibrationError: if a process could not be started, or two in a row ended before they
            could begin, or the first did.
        Exception: any that `task` raised, with the traceback in the worker as a note.
    """
    waiting = list(enumerate(items))[::-1]
    is_serial = getattr(_serial, "is_on", False)
    is_shared = bool(items) and (is_serial or _can_fork())
    if prepare is not None and prepare not in _prepared and is_shared:
        _prepare_here(prepare)
    if is_serial:
        yield from _do_here(task, items, stop)
        return
    team: list[tuple[Connection, BaseProcess]] = []
    # One that is killed before it begins costs nothing where others can begin.
    can_begin = False
    try:
        team.extend(
            _start_worker(task) for _ in range(min(len(items), count or os.cpu_count() or 1))
        )
        # The index of the item that each worker is busy with; None until it has started.
        busy: dict[Connection, int | None] = {connection: None for connection, _ in team}
        while busy:
            ready = cast(list[Connection], wait(list(busy), _POLL_SECONDS))
            if stop is not None and stop.is_set():
                raise Cancelled
            for connection in ready:
                index = busy.pop(connection)
                result, lost = _receive_result(connection)
                if index is None:
                    if lost and not can_begin:
                        raise _explain_failed_start()
                    can_begin = not lost
                if lost and waiting:
                    team.append(_start_worker(task))
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


def _do_here(
    task: Callable[[T], R], items: Sequence[T], stop: Event | None
) -> Iterator[tuple[int, R]]:
    """Yield the index and task(item) of each item. Raises Cancelled if `stop` was set."""
    for k, item in enumerate(items):
        if stop is not None and stop.is_set():
            raise Cancelled
        yield k, task(item)


def _can_fork() -> bool:
    """Return whether this process can be copied: it has one thread, and no window library's."""
    return sys.platform == "linux" and threading.active_count() == 1 and not _has_window()


def _has_window() -> bool:
    return any(name.startswith("PySide6") for name in sys.modules)


def _prepare_here(prepare: Callable[[], None]) -> None:
    """Prepare in this process what workers are then forked with."""
    with opencv.single_thread():
        prepare()
    gc.freeze()  # no process has to look for garbage among the libraries and kernels that it shares
    _prepared.add(prepare)


def _start_worker(task: Callable[[Any], Any]) -> tuple[Connection, BaseProcess]:
    """Start a worker; return it with the connection for items and results. Raises CalibrationError
    if the system starts no process."""
    forks = _can_fork()
    context: Any = multiprocessing.get_context("fork" if forks else "spawn")
    ours, theirs = context.Pipe()
    niceness = _NICENESS if _has_window() else 0
    process = context.Process(target=_run_worker, args=(task, theirs, niceness), daemon=True)
    if forks:
        with opencv.single_thread(), _block_interrupts(), warnings.catch_warnings():
            # Python counts the threads of BLAS, which stops them itself before a fork.
            warnings.filterwarnings("ignore", ".*multi-threaded.*fork", DeprecationWarning)
            _start_process(process)
    else:
        resource_tracker.ensure_running()  # it unblocks signals, and would be started within
        with _block_interrupts():
            _start_process(process)
    theirs.close()
    return ours, process


def _start_process(process: BaseProcess) -> None:
    """Start a process. Raises CalibrationError if the system refuses, or if it ended at once."""
    try:
        process.start()
    except OSError as error:
        raise _explain_failed_start() from error


def _explain_failed_start() -> CalibrationError:
    """Return the error that a worker could not be started; why stands on its standard error."""
    return CalibrationError(
        "A process that should do part of the work ended before it could begin.",
        "Try again. If that does not help, close other programs, as memory may be short, and start "
        "this program anew, as its files may have changed while it ran.",
    )


def _receive_result(connection: Connection) -> tuple[Any, bool]:
    """Return a message of a worker, and whether it has died. Raises an exception of its task."""
    try:
        error, result = connection.recv()
    except (EOFError, OSError):  # it died before a message, or within one
        return Crashed(), True
    if error is not None:
        raise error
    return result, False


def _run_worker(task: Callable[[Any], Any], connection: Connection, niceness: int) -> None:
    """Report that the worker has started, then do `task` until the connection is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # It was blocked at the start; what the parent does when it is asked to end is not for a worker.
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    if hasattr(signal, "pthread_sigmask"):  # not on Windows
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})
    if hasattr(os, "nice"):  # not on Windows
        os.nice(niceness)
    opencv.use_threads(1)
    warnings.simplefilter("ignore", NumbaWarning)  # the parent process says so, once
    with limit_blas_threads(), contextlib.suppress(EOFError, ConnectionError):
        connection.send((None, None))
        _serve_items(task, connection)


def _serve_items(task: Callable[[Any], Any], connection: Connection) -> None:
    """Do `task` to every item that arrives, and send the results, as long as the parent lives.

    Its death does not close the connection: workers that were forked later have copies of it.
    """
    parent = multiprocessing.parent_process()
    assert parent is not None
    while connection in wait([connection, parent.sentinel]):
        item = connection.recv()
        try:
            message: tuple[Exception | None, Any] = (None, task(item))
        except Exception as error:
            error.add_note(traceback.format_exc())
            message = (error, None)
        connection.send(message)


@contextlib.contextmanager
def _block_interrupts() -> Iterator[None]:
    """Block Ctrl-C and SIGTERM in processes started meanwhile; their parent receives the former and
    kills them."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
