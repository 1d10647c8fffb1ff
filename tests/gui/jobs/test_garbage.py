"""Cycles end on the main thread, wherever they were made."""

from __future__ import annotations

import gc
import threading

from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.gui.jobs.garbage import Collector
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


def test_the_old_are_gone_through_when_they_have_become_more(qapp: QApplication) -> None:
    collector = Collector(qapp)
    generations: list[int] = []

    def note(phase: str, info: dict[str, int]) -> None:
        if phase == "start":
            generations.append(info["generation"])

    gc.callbacks.append(note)
    kept = []
    collector.start()
    try:
        for _ in range(2):  # both times all generations are due, but nothing new has grown old
            for _ in range(gc.get_threshold()[2] + 1):
                gc.collect(1)
            generations.clear()
            collector._collect()
            kept.append(list(generations))
        more = [[None] for _ in range(2 * len(gc.get_objects(2)))]
        for _ in range(gc.get_threshold()[2] + 1):
            gc.collect(1)
        generations.clear()
        collector._collect()
        kept.append(list(generations))
    finally:
        collector.stop()
        gc.callbacks.remove(note)
    assert kept == [[2], [1], [2]]
    assert len(more) > 0
