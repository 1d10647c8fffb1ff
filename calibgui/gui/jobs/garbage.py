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


class Collector(QObject):
    """Collects in place of the interpreter, in turns of the event loop."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
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
        if due:
            gc.collect(due[-1])
