"""One piece of work beside the window, as its workers and the window see it; see ``jobs``."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import shiboken6
from PySide6.QtCore import QObject

from calibgui.engine.errors import Cancelled

Queue = queue.SimpleQueue[Callable[[], None]]
Outcome = Callable[[], Any]

_LEAST_PARTS = 4
"""Number of parts after the first whose mean time is told: of parts that take between half and
twice their mean, it is within a third in nine of ten cases."""
_LEAST_SECONDS = 1.0
"""Time that these take at least, s: who waits for less needs no estimate."""


def nothing(*_: Any) -> None:
    """Do nothing: the default of callbacks."""


@dataclass(eq=False, kw_only=True)
class Job:
    """One piece of work on each of some items."""

    label: str
    """Name of the work for the user; empty if it need not be mentioned."""
    items: Sequence[Any]
    work: Callable[[Any], Any]
    """Function from an item to its result; runs in a worker."""
    done: Callable[[Any, Any], None] = nothing
    """Callback that takes an item and its result, on the main thread like all that follow."""
    received: Callable[[Any], None] = nothing
    """Callback that takes each record that the work sends."""
    failed: Callable[[Exception], None]
    """Callback that takes what the work or `done` raised; `Cancelled` is no failure."""
    ended: Callable[[], None] = nothing
    """Callback at the end of the job, however it ended."""
    is_about_document: bool = True
    """False if it is wanted whichever document is open."""
    keeps_best: bool = False
    """True if the work returns the best so far when it is asked to stop."""
    owner: QObject | None = None
    """Object whose deletion makes the job unwanted: no callback is called after it."""
    inputs: Callable[[Any], Hashable] = nothing
    """Function from an item to a digest of what its result depends on."""
    queue: Queue
    total: int = field(init=False)
    """Number of parts of the work, as far as known."""
    finished: int = field(default=0, init=False)
    cancelling: threading.Event = field(default_factory=threading.Event, init=False)
    """Set by `cancel`."""
    settled: int = field(default=0, init=False)
    _first: tuple[float, int] | None = field(default=None, init=False)
    """When parts had been finished for the first time, and how many."""
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
    def stopping(self) -> bool:
        """Return whether `stop` or `cancel` was called."""
        return self._stop.is_set()

    @property
    def cancelled(self) -> bool:
        """Return whether `cancel` was called."""
        return self.cancelling.is_set()

    def send(self, record: Any) -> bool:
        """Pass a record from the worker to the main thread; return False if the work should stop.

        Raises:
            Cancelled: the user wants none of it.
        """
        self.check()
        self.queue.put(lambda: self.received(record) if self.wanted else None)
        return not self.stopping

    def advance(self, finished: int, total: int) -> None:
        """Report from the worker of a single item how many of its parts are finished."""

        self.check()
        self.queue.put(lambda: self.note_finished(finished, total))

    def note_finished(self, finished: int, total: int) -> None:
        """Note on the main thread how many parts of the work are finished."""
        self.finished, self.total = finished, total
        if self._first is None and finished > 0:
            self._first = time.monotonic(), finished

    def rename(self, label: str) -> None:
        """Report from the worker what is being done from now on, of which nothing is finished."""

        def note() -> None:
            if label != self.label:
                self.label, self._first = label, None
                self.finished = self.total = 0

        self.check()
        self.queue.put(note)

    def check(self) -> None:
        """Raise `Cancelled` in the worker if the user wants none of it."""
        if self.cancelled:
            raise Cancelled

    def check_stop(self) -> None:
        """Raise `Cancelled` in the worker if the user wants no more than what is done."""
        if self.stopping:
            raise Cancelled

    def outcome(self, item: Any) -> Outcome:
        """Do the work; return a function that returns its result or raises what the work raised."""
        try:
            self.check()
            result = self.work(item)
        except Exception as raised:
            return partial(_raise, raised)
        return lambda: result

    @property
    def wanted(self) -> bool:
        """Return whether the owner, if there is one, still exists."""
        return self.owner is None or shiboken6.isValid(self.owner)

    @property
    def seconds_left(self) -> float | None:
        """Estimated time left, s; None while it is not known.

        The time to the first finished part tells nothing: workers start in it. The parts after it
        differ, and are waited for until their mean is worth telling.
        """
        if self._first is None:
            return None
        begun, before = self._first
        parts, seconds = self.finished - before, time.monotonic() - begun
        if parts < _LEAST_PARTS or seconds < _LEAST_SECONDS:
            return None
        return seconds / parts * (self.total - self.finished)


def _raise(error: Exception) -> None:
    raise error
