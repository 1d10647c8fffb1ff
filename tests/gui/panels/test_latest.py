"""Of a panel's work only the newest counts, and what is not wanted any more is not begun."""

from __future__ import annotations

from PySide6.QtCore import QObject
from pytestqt.qtbot import QtBot

from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.latest import Latest


def test_what_is_replaced_at_once_is_not_begun(qtbot: QtBot, jobs: Jobs) -> None:
    owner = QObject()
    latest, begun, found = Latest(jobs, owner), list[int](), list[int]()

    def work(number: int) -> int:
        begun.append(number)
        return number

    for number in (1, 2, 3):
        latest.start("", lambda _, n=number: work(n), found.append, lambda _: None)
    qtbot.waitUntil(lambda: not jobs.running)
    assert begun == found == [3]
