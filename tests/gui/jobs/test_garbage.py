"""Cycles end on the main thread, wherever they were made."""

from __future__ import annotations

import gc
import threading

from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.gui.jobs.jobs import Jobs


def test_no_other_thread_collects(qtbot: QtBot, qapp: QApplication) -> None:
    ended: set[threading.Thread] = set()

    class Cycle:
        def __init__(self) -> None:
            self.itself = self

        def __del__(self) -> None:
            ended.add(threading.current_thread())

    jobs = Jobs(qapp)
    try:
        jobs.start(
            "Littering", lambda _: [None for _ in range(20 * gc.get_threshold()[0]) if Cycle()]
        )
        qtbot.waitUntil(lambda: bool(ended), timeout=5000)
    finally:
        jobs.close()
    assert ended == {threading.main_thread()}
    assert gc.isenabled()
