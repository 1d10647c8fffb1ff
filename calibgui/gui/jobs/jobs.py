"""Work off the main thread.

A worker never touches a widget: it puts what it has to say on a queue, which one timer empties on
the main thread while anything runs. A job names the inputs that it answers; if they have changed
by the time it ends (or one of its parts does), what it found is dropped.

    jobs.start("Calibrating", lambda job: calibrate(report=job.send), done=show, received=draw)
    jobs.each("Finding corners", images, find, done=fill_in)
"""

from __future__ import annotations

import logging
import os
import queue
import sys
import time
from collections import deque
from collections.abc import Callable, Hashable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import partial
from typing import Any, TypedDict, Unpack

from PySide6.QtCore import QObject, QTimer, Signal

from calibgui.app.system.memory import return_large_blocks
from calibgui.engine.errors import Cancelled
from calibgui.engine.threads import limit_blas_threads
from calibgui.gui.jobs.garbage import Collector
from calibgui.gui.jobs.job import Job, Outcome, Queue, nothing

log = logging.getLogger(__name__)

PICTURE = 100
"""Time in which the window shows what has changed of 300 images, ms. Work that is begun meanwhile
takes turns with it at the interpreter and the processors, and the picture comes twice as late."""
_TICK = 33
"""Time between two looks at the queue, ms."""
_SLICE = 0.02
"""Longest time spent on the queue's content at once, s: the rest waits for the next tick."""
_TURN = 0.00005
"""Time after which a worker hands the interpreter over to the window, s.

Python's own 5 ms are lost at every call into Qt that lets go of the interpreter, some twenty of
them in one picture of a plot. Leaving out one of 300 images while a thread saves them stops the
window for up to 135 ms with turns of 0.2 ms, and 70 ms with these.
"""

_PROCESSORS = os.cpu_count() or 1


class Callbacks(TypedDict, total=False):
    """The fields of `Job` that may be left out when a job is started."""

    received: Callable[[Any], None]
    failed: Callable[[Exception], None]
    ended: Callable[[], None]
    is_about_document: bool
    keeps_best: bool
    owner: QObject


class Jobs(QObject):
    """Runs everything that runs beside the window."""

    changed = Signal()
    """A job began, advanced or ended."""
    failed = Signal(Exception)
    """The exception of a job that has no `failed` of its own."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        sys.setswitchinterval(_TURN)
        return_large_blocks()
        self._pool = ThreadPoolExecutor(_PROCESSORS, "part", initializer=limit_blas_threads)
        self._single = ThreadPoolExecutor(4, "job", initializer=limit_blas_threads)
        self._queue: Queue = queue.SimpleQueue()
        self._running: list[Job] = []
        self._is_closed = False
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
        delay: int = 0,
        **callbacks: Unpack[Callbacks],
    ) -> Job:
        """Run `work` in a thread; it is given the job, to tell and to learn when to stop.

        Args:
            label: what it does, for the progress bar.
            done: takes the result, if `inputs()` still is what it was at the start.
            delay: time after which the work begins, ms: `PICTURE` where something changes on the
                screen.
            callbacks: `received`, `failed`, `ended`, `is_about_document`, `keeps_best`, `owner` of
                `Job`.
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
        return self._run(job, self._single, delay)

    def each(
        self,
        label: str,
        items: Sequence[Any],
        work: Callable[[Any], Any],
        done: Callable[[Any, Any], None] = nothing,
        *,
        inputs: Callable[[Any], Hashable] = nothing,
        delay: int = 0,
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
        return self._run(job, self._pool, delay)

    def end(self, job: Job) -> None:
        """End a job as the user wants it: with the best so far, where it keeps that."""
        if job.keeps_best:
            job.stop()
        else:
            job.cancel()
        self.changed.emit()

    def close(self) -> None:
        """Cancel everything and wait for the threads to end."""
        self._is_closed = True
        for job in self._running:
            job.cancel()
        self._timer.stop()
        for pool in (self._pool, self._single):
            pool.shutdown(wait=True, cancel_futures=True)
        self._collector.stop()

    def _complete(self, callbacks: Callbacks) -> Callbacks:
        return {"failed": self.failed.emit, **callbacks}

    def _run(self, job: Job, pool: ThreadPoolExecutor, delay: int = 0) -> Job:
        self._running.append(job)
        self._timer.start()
        self._collector.start()
        if not job.items:
            self._queue.put(lambda: self._end(job))
        waiting = deque((item, job.inputs(item)) for item in job.items)

        def begin() -> None:
            if not self._is_closed:
                for _ in range(min(len(waiting), _PROCESSORS)):
                    pool.submit(self._work_off, job, waiting)

        if delay:
            QTimer.singleShot(delay, self, begin)
        else:
            begin()
        self.changed.emit()
        return job

    def _work_off(self, job: Job, waiting: deque[tuple[Any, Hashable]]) -> None:
        """Work on the items that wait until none is left; runs in a worker."""
        with suppress(IndexError):
            while True:
                item, digest = waiting.popleft()
                self._queue.put(partial(self._settle, job, item, digest, job.outcome(item)))

    def _settle(self, job: Job, item: Any, digest: Hashable, outcome: Outcome) -> None:
        """Deliver the outcome of the work on one item."""
        job.settled += 1
        if len(job.items) > 1:
            job.note_finished(job.settled, len(job.items))
        try:
            result = outcome()
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
                self._queue.put(lambda: self._end(job))

    def _end(self, job: Job) -> None:
        self._running.remove(job)
        if job.wanted:
            job.ended()

    def _drain(self) -> None:
        """Act on what the workers have put on the queue, no longer than the user would notice."""
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
