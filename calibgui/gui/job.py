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


def nothing(*_: Any) -> None:
    """Default of callbacks that nobody needs."""


@dataclass(eq=False, kw_only=True)
class Job:
    """One piece of work on each of some items."""

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
    def stopping(self) -> bool:
        """Whether `stop` or `cancel` was called."""
        return self._stop.is_set()

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
        return not self.stopping

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

    def outcome(self, item: Any) -> Outcome:
        """For the worker: what returns the item's result, or raises what the work raised."""
        try:
            self.check()
            result = self.work(item)
        except Exception as raised:
            return partial(_raise, raised)
        return lambda: result

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


def _raise(error: Exception) -> None:
    raise error
