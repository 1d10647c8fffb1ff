"""Work off the main thread.

A worker never touches a widget: it puts what it has to say on a queue, which one timer empties on
the main thread while anything runs. A job names the inputs that it answers; if they have changed
by the time it ends (or one of its parts does), what it found is dropped.

    jobs.start("Calibrating", lambda job: calibrate(report=job.tell), done=show, told=draw)
    jobs.each("Finding corners", images, find, done=fill_in)
"""

from __future__ import annotations

import logging
import os
import queue
import threading
import time
from collections.abc import Callable, Hashable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any, TypedDict, Unpack

import shiboken6
from PySide6.QtCore import QObject, QTimer, Signal

from calibgui.engine.errors import Cancelled
from calibgui.engine.threads import one_blas_thread
from calibgui.gui.garbage import Collector

log = logging.getLogger(__name__)

_TICK = 33
"""Between two looks at the queue, ms."""
_SLICE = 0.02
"""Longest time spent on the queue's content at once, s: the rest waits for the next tick."""

Queue = queue.SimpleQueue[Callable[[], None]]


def nothing(*_: Any) -> None:
    """Default of callbacks that nobody needs."""


@dataclass(eq=False, kw_only=True)
class Job:
    """One piece of work on each of some items, as its workers and the window see it."""

    label: str
    """What is being done, for the user; empty if it need not be mentioned."""
    items: Sequence[Any]
    work: Callable[[Any], Any]
    """In a worker: from an item to its result."""
    done: Callable[[Any, Any], None] = nothing
    """Takes an item and its result, on the main thread like all that follow."""
    told: Callable[[Any], None] = nothing
    """Takes each record that the work tells."""
    failed: Callable[[Exception], None]
    """Takes what the work or `done` raised; `Cancelled` is no failure."""
    ended: Callable[[], None] = nothing
    """Called after it all, whatever happened."""
    owner: QObject | None = None
    """After whose end nobody wants to hear of the job."""
    inputs: Callable[[Any], Hashable] = nothing
    """Digest of what an item's result depends on."""
    queue: Queue
    total: int = field(init=False)
    """Parts of the work, as far as known."""
    finished: int = field(default=0, init=False)
    cancelling: threading.Event = field(default_factory=threading.Event, init=False)
    """Set by `cancel`."""
    settled: int = field(default=0, init=False)
    _begun: float = field(default_factory=time.monotonic, init=False)
    _stop: threading.Event = field(default_factory=threading.Event, init=False)

    def __post_init__(self) -> None:
        self.total = len(self.items)

    def stop(self) -> None:
        """Ask the work to end and keep the best so far."""
        self._stop.set()

    def cancel(self) -> None:
        """Ask the work to end and drop what it found."""
        self.cancelling.set()
        self._stop.set()

    @property
    def cancelled(self) -> bool:
        """Whether `cancel` was called."""
        return self.cancelling.is_set()

    def tell(self, record: Any) -> bool:
        """For the worker: pass a record on to the main thread; False if it should stop.

        Raises:
            Cancelled: the user wants none of it.
        """
        self.check()
        self.queue.put(lambda: self.told(record) if self.wanted else None)
        return not self._stop.is_set()

    def advance(self, finished: int, total: int) -> None:
        """For the worker of a single item: how many of its parts are finished."""

        def note() -> None:
            self.finished, self.total = finished, total

        self.check()
        self.queue.put(note)

    def rename(self, label: str) -> None:
        """For the worker: what is being done from now on."""

        def note() -> None:
            if label != self.label:
                self.label, self._begun = label, time.monotonic()

        self.check()
        self.queue.put(note)

    def check(self) -> None:
        """For the worker: raise `Cancelled` if the user wants none of it."""
        if self.cancelled:
            raise Cancelled

    @property
    def wanted(self) -> bool:
        """Whether the owner, if there is one, still exists."""
        return self.owner is None or shiboken6.isValid(self.owner)

    @property
    def seconds_left(self) -> float | None:
        """Estimated from the parts that are finished; None before the first."""
        if self.total <= 1 or self.finished == 0:
            return None
        each = (time.monotonic() - self._begun) / self.finished
        return each * (self.total - self.finished)


class Callbacks(TypedDict, total=False):
    """Fields of `Job` that whoever starts one may leave out."""

    told: Callable[[Any], None]
    failed: Callable[[Exception], None]
    ended: Callable[[], None]
    owner: QObject


class Jobs(QObject):
    """Everything that runs beside the window."""

    changed = Signal()
    """A job began, advanced or ended."""
    failed = Signal(Exception)
    """What a job raised that has no `failed` of its own."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._pool = ThreadPoolExecutor(os.cpu_count(), "part", initializer=one_blas_thread)
        self._single = ThreadPoolExecutor(4, "job", initializer=one_blas_thread)
        self._queue: Queue = queue.SimpleQueue()
        self._running: list[Job] = []
        self._timer = QTimer(self, interval=_TICK)
        self._timer.timeout.connect(self._drain)
        self._collector = Collector(self)

    @property
    def running(self) -> tuple[Job, ...]:
        """The jobs that have not ended, oldest first."""
        return tuple(self._running)

    def start(
        self,
        label: str,
        work: Callable[[Job], Any],
        done: Callable[[Any], None] = nothing,
        *,
        inputs: Callable[[], Hashable] = nothing,
        **callbacks: Unpack[Callbacks],
    ) -> Job:
        """Run `work` in a thread; it is given the job, to tell and to learn when to stop.

        Args:
            label: what it does, for the progress bar.
            done: takes the result, if `inputs()` still is what it was at the start.
            callbacks: `told`, `failed`, `ended`, `owner` of `Job`.
        """
        job = Job(
            label=label,
            items=[None],
            work=lambda _: work(job),
            done=lambda _, result: done(result),
            inputs=lambda _: inputs(),
            queue=self._queue,
            **self._complete(callbacks),
        )
        return self._run(job, self._single)

    def each(
        self,
        label: str,
        items: Sequence[Any],
        work: Callable[[Any], Any],
        done: Callable[[Any, Any], None] = nothing,
        *,
        inputs: Callable[[Any], Hashable] = nothing,
        **callbacks: Unpack[Callbacks],
    ) -> Job:
        """Run `work` on every item, in parallel; `done` takes item and result as they come."""
        job = Job(
            label=label,
            items=items,
            work=work,
            done=done,
            inputs=inputs,
            queue=self._queue,
            **self._complete(callbacks),
        )
        return self._run(job, self._pool)

    def close(self) -> None:
        """Cancel everything and wait for the threads to end."""
        for job in self._running:
            job.cancel()
        self._timer.stop()
        for pool in (self._pool, self._single):
            pool.shutdown(wait=True, cancel_futures=True)
        self._collector.stop()

    def _complete(self, callbacks: Callbacks) -> Callbacks:
        return {"failed": self.failed.emit, **callbacks}

    def _run(self, job: Job, pool: ThreadPoolExecutor) -> Job:
        self._running.append(job)
        self._timer.start()
        self._collector.start()
        if not job.items:
            self._queue.put(lambda: self._end(job))
        for item in job.items:
            self._submit(job, item, pool)
        self.changed.emit()
        return job

    def _submit(self, job: Job, item: Any, pool: ThreadPoolExecutor) -> None:
        digest = job.inputs(item)

        def work() -> Any:
            job.check()
            return job.work(item)

        def settle(future: Future[Any]) -> None:
            self._settle(job, item, digest, future)

        pool.submit(work).add_done_callback(lambda future: self._queue.put(lambda: settle(future)))

    def _settle(self, job: Job, item: Any, digest: Hashable, future: Future[Any]) -> None:
        """Deliver what one item's work came to."""
        job.settled += 1
        if len(job.items) > 1:
            job.finished = job.settled
        try:
            result = future.result()
            if not job.cancelled and job.wanted and job.inputs(item) == digest:
                job.done(item, result)
        except Cancelled:
            pass
        except Exception as error:  # whatever a worker or a callback raised is shown
            log.debug("%s failed", job.label, exc_info=error)
            if job.wanted:
                job.failed(error)
        finally:
            if job.settled == len(job.items):
                self._end(job)

    def _end(self, job: Job) -> None:
        self._running.remove(job)
        if job.wanted:
            job.ended()

    def _drain(self) -> None:
        """Act on what the workers said, not longer than the user would notice."""
        limit = time.monotonic() + _SLICE
        acted = False
        while time.monotonic() < limit:
            try:
                act = self._queue.get_nowait()
            except queue.Empty:
                break
            act()
            acted = True
        if not self._running and self._queue.empty():
            self._timer.stop()
            self._collector.stop()
        if acted:
            self.changed.emit()
