"""While jobs run, garbage is collected on the main thread only.

Python collects cycles in whichever thread allocates next. In a job's thread that takes apart the
connections of widgets that are gone: Qt holds a lock meanwhile and waits for the interpreter,
which the main thread may hold while it waits for Qt's lock, and the window stands still for good.
"""

from __future__ import annotations

import gc

from PySide6.QtCore import QObject, QTimer

_EVERY = 100
"""Time between two looks at what has gathered, ms."""
_OLDEST = 2
"""The generation of objects that have outlived two collections."""
_GROWTH = 1.25
"""Ratio by which the number of these must have grown since they were collected last, as in Python's
own rule: to go through those of a window with 300 photographs takes 40 ms."""


class Collector(QObject):
    """Collects in place of the interpreter, in turns of the event loop."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._most_left = 0.0
        """Number of old objects above which they are collected."""
        self._timer = QTimer(self, interval=_EVERY)
        self._timer.timeout.connect(self._collect)

    def start(self) -> None:
        """Before a thread begins to work."""
        gc.disable()
        self._timer.start()

    def stop(self) -> None:
        """No thread works beside the main one."""
        self._timer.stop()
        gc.enable()

    def _collect(self) -> None:
        gathered = zip(gc.get_count(), gc.get_threshold(), strict=True)
        due = [age for age, (count, most) in enumerate(gathered) if count > most]
        if not due:
            return
        if due[-1] < _OLDEST:
            gc.collect(due[-1])
        elif len(gc.get_objects(_OLDEST)) > self._most_left:
            gc.collect()
            self._most_left = _GROWTH * len(gc.get_objects(_OLDEST))
        else:
            gc.collect(_OLDEST - 1)
