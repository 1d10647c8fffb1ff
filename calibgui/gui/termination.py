"""SIGTERM and Ctrl-C, which end the window without a question; unsaved work is kept for recovery.

Qt's loop runs no Python while it waits, and so no handler of Python's. But Python writes a signal's
number into a socket as it comes, and Qt wakes up when there is something to read.
"""

from __future__ import annotations

import os
import signal
import socket
import threading
from collections.abc import Callable

from PySide6.QtCore import QObject, QSocketNotifier

_SIGNALS = signal.SIGTERM, signal.SIGINT
_FIRST_EXIT_CODE = 128
"""The exit code of a program that a signal has ended, less the signal's number, as in a shell."""
_LONGEST_S = 5.0
"""Time after which the program ends whatever it is doing, s: what compiles cannot be stopped."""


class TerminationNotifier(QObject):
    """Calls `end` in Qt's loop, with the exit code, at the first signal to end."""

    def __init__(self, end: Callable[[int], None], parent: QObject) -> None:
        super().__init__(parent)
        self._end = end
        self._reader, self._writer = socket.socketpair()
        self._writer.setblocking(False)  # as Python demands
        self._notifier = QSocketNotifier(self._reader.fileno(), QSocketNotifier.Type.Read, self)
        self._notifier.activated.connect(self._hear)
        signal.set_wakeup_fd(self._writer.fileno())
        for number in _SIGNALS:
            signal.signal(number, lambda *_: None)  # heard below: a handler is what wakes Qt

    def _hear(self) -> None:
        self._notifier.setEnabled(False)
        code = _FIRST_EXIT_CODE + self._reader.recv(1)[0]
        patience = threading.Timer(_LONGEST_S, os._exit, (code,))
        patience.daemon = True
        patience.start()
        self._end(code)
