"""The progress of what runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence, QPaintEvent
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


def test_a_search_is_ended_where_its_progress_is_told(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Calibrate stays what it is: who presses it twice ends nothing."""

    def search(*arguments: Any, **_: Any) -> Detection:
        arguments[4].wait(60)
        return Detection((), None)

    monkeypatch.setattr("calibgui.gui.session.detector.find_views", search)
    cancel = window.progress.cancel
    project = examples.calibrated(tmp_path)
    waiting = tuple(replace(v, status=ViewStatus.WAITING, corners=None) for v in project.views)
    window.session.begin(Document(replace(project, views=waiting, results={})))
    window.detector.search()
    qtbot.waitUntil(cancel.isVisible)
    for _ in range(2):
        qtbot.mouseClick(window.calibrate, Qt.MouseButton.LeftButton)
    qtbot.wait(50)
    assert window.detector.running and window.calibrator.running
    assert window.calibrate.text() == "C&alibrate" and not window.calibrate.isEnabled()
    qtbot.mouseClick(cancel, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    assert "search was stopped" in window.banner.text.text() and window.banner.isVisible()
    qtbot.mouseClick(window.calibrate, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: window.detector.running)
    assert not window.banner.isVisible(), "it goes on"
    stop = next(act for act in window.findChildren(QAction) if act.text() == "S&top")
    assert stop.shortcut() == QKeySequence("Shift+F9")
    stop.trigger()
    qtbot.waitUntil(lambda: not window.session.jobs.running)


def test_the_longest_words_about_a_job_have_room(window: MainWindow, qtbot: QtBot) -> None:
    progress, jobs = window.progress, window.session.jobs
    window.resize(1120, 760)
    go_on = Event()
    compiling = "Compiling for speed, once"

    def work(job: Job) -> None:
        job.advance(3, 12)
        job.rename(compiling)
        go_on.wait(20)

    jobs.start("Comparing lens models", work)
    qtbot.waitUntil(lambda: progress.label.text() == compiling)  # of which 3 are not finished
    for words in (f"{compiling}: 3 of 7, 35 s left", "Comparing lens models: 3 of 12, 35 s left"):
        assert progress.label.fontMetrics().horizontalAdvance(words) <= progress.label.width()
    assert progress.height() <= window.calibrate.height()
    go_on.set()
    qtbot.waitUntil(lambda: not jobs.running)


def test_what_the_user_works_on_is_told_before_what_is_compiled(
    window: MainWindow, qtbot: QtBot
) -> None:
    progress, jobs = window.progress, window.session.jobs
    go_on = Event()
    jobs.start("Compiling", lambda _: go_on.wait(20), is_about_document=False)
    qtbot.waitUntil(lambda: progress.label.text() == "Compiling")
    job = jobs.start("Searching", lambda _: go_on.wait(20))
    qtbot.waitUntil(lambda: progress.label.text() == "Searching")
    window.session.begin(window.session.document)
    running = [each for each in jobs.running if each.label and not each.cancelled]
    assert [each.label for each in running] == ["Compiling"]
    assert job.cancelled
    go_on.set()
    qtbot.waitUntil(lambda: not jobs.running)
