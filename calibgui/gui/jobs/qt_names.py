"""Qt's classes made known before a second thread asks for them.

PySide makes a class, with its enumerations, when its name is first asked for. Two threads that do
so at once can meet in a class half made, and the process crashes: what imports Qt beside the main
thread, as pyqtgraph does with every class there is, waits until all are made.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from time import perf_counter
from types import ModuleType

from PySide6 import QtCore, QtGui, QtSvg, QtWidgets
from PySide6.QtCore import QObject, QTimer

_SLICE = 0.008
"""Longest time that a turn takes of the main thread, s."""


def make_classes(parent: QObject, then: Callable[[], object]) -> None:
    """Ask for every name of Qt, a few in each turn of the event loop; calls `then` at the end.

    Args:
        parent: takes the timer with it if it is deleted before.
    """
    names = _names()
    timer = QTimer(parent, interval=0)

    def turn() -> None:
        end = perf_counter() + _SLICE
        for module, name in names:
            getattr(module, name)
            if perf_counter() > end:
                return
        timer.stop()
        timer.deleteLater()
        then()

    timer.timeout.connect(turn)
    timer.start()


def _names() -> Iterator[tuple[ModuleType, str]]:
    for module in (QtCore, QtGui, QtSvg, QtWidgets):
        for name in dir(module):
            yield module, name
