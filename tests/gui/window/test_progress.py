"""The progress of what runs."""

from __future__ import annotations

from threading import Event

from PySide6.QtGui import QPaintEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget
from pytestqt.qtbot import QtBot

from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.window.progress import Progress


class Painted(QWidget):
    """Counts how often it is painted."""

    count = 0

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        self.count += 1


def test_a_job_has_nothing_painted_before_what_starts_it_ends(qtbot: QtBot) -> None:
    window, beside, jobs = QWidget(), Painted(), Jobs()
    qtbot.addWidget(window)
    beside.setMinimumSize(20, 20)
    progress = Progress(jobs)
    layout = QVBoxLayout(window)
    layout.addWidget(beside)
    layout.addWidget(progress)
    window.show()
    qtbot.waitUntil(lambda: beside.count > 0)
    go_on = Event()
    jobs.start("Working", lambda _: go_on.wait())
    qtbot.waitUntil(progress.bar.isVisible)
    qtbot.wait(50)
    before = beside.count
    beside.update()
    jobs.running[0].note_finished(1, 3)
    jobs.changed.emit()
    assert progress.bar.value() == 1 and progress.bar.maximum() == 3
    assert beside.count == before, "it waits for its turn"
    qtbot.waitUntil(lambda: beside.count > before)
    go_on.set()
    jobs.close()
