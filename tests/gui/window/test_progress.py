"""The progress of what runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QPaintEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget
from pytestqt.qtbot import QtBot

from calibgui.app.photographs.detection import Detection
from calibgui.app.projects.document import Document
from calibgui.dataset import ViewStatus
from calibgui.gui.jobs.job import Job
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.window.main_window import MainWindow
from calibgui.gui.window.progress import Progress
from tests.app import examples


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


def test_one_button_ends_a_search(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Stop and Cancel would do the same while a calibration waits for the search."""

    def search(*arguments: Any, **_: Any) -> Detection:
        arguments[4].wait(60)
        return Detection((), None)

    monkeypatch.setattr("calibgui.gui.session.detector.find_views", search)
    cancel = window.inspector.findChildren(Progress)[0].cancel
    project = examples.calibrated(tmp_path)
    waiting = tuple(replace(v, status=ViewStatus.WAITING, corners=None) for v in project.views)
    window.session.begin(Document(replace(project, views=waiting, results={})))
    window.detector.search()
    qtbot.waitUntil(cancel.isVisible)
    place = cancel.geometry()
    qtbot.mouseClick(window.calibrate, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not cancel.isVisible())
    assert (
        window.calibrate.text() == "&Stop" and "what has been found" in window.calibrate.toolTip()
    )
    assert cancel.geometry() == place
    qtbot.mouseClick(window.calibrate, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    assert "search was stopped" in window.banner.text.text() and window.banner.isVisible()
    qtbot.mouseClick(window.calibrate, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: window.detector.running)
    assert not window.banner.isVisible(), "it goes on"
    qtbot.mouseClick(window.calibrate, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    job = window.session.jobs.start("Working", lambda job: job.cancelling.wait(60))
    qtbot.waitUntil(cancel.isVisible)
    job.cancel()


def test_the_longest_words_about_a_job_have_room(window: MainWindow, qtbot: QtBot) -> None:
    progress, jobs = window.inspector.findChildren(Progress)[0], window.session.jobs
    window.resize(1120, 760)
    go_on = Event()
    preparing = "Preparing the search (once, about 35 s)…"

    def work(job: Job) -> None:
        job.advance(3, 12)
        job.rename(preparing)
        go_on.wait(20)

    jobs.start("Comparing lens models", work)
    qtbot.waitUntil(lambda: progress.label.text() == preparing)  # of which 3 are not finished
    for words in (preparing, "Comparing lens models: 3 of 12, 35 s left"):
        assert progress.label.fontMetrics().horizontalAdvance(words) <= progress.label.width()
    assert progress.height() <= window.calibrate.height()
    go_on.set()
    qtbot.waitUntil(lambda: not jobs.running)
