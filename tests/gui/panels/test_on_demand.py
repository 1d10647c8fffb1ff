"""A button starts a panel's work, and what was found is kept while it holds."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.engine.errors import CalibrationError
from calibgui.gui.jobs.job import Job
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.on_demand import OnDemandPanel, have_same_views
from calibgui.gui.panels.services import Services
from calibgui.gui.window.progress import Progress as ProgressBar
from tests.gui.panels.conftest import Shown

LEFT = Qt.MouseButton.LeftButton


class CountingPanel(OnDemandPanel[int]):
    """Counts the views of the result, once it is let."""

    def __init__(self, services: Services) -> None:
        super().__init__(
            services, button="&Count", tip="Counts.", label="Counting", working="Counting…"
        )
        self.may_end, self.fails = threading.Event(), False
        self.content, self.use = QLabel(), QPushButton("&Use")
        self._lay_out(self.content, self.use)

    def _invite(self, result: Result) -> str:  # noqa: ARG002 - the same for all
        return "How many?"

    def _holds_for(self, asked: Result, result: Result) -> bool:
        return have_same_views(asked, result)

    def _find(self, result: Result, job: Job) -> int:
        while not self.may_end.wait(0.005):
            job.advance(1, 2)
        if self.fails:
            raise CalibrationError("There are few views.", "Take more.")
        return len(result.used)

    def _show_found(self, result: Result, found: int) -> None:
        self.words.setText(f"{found} views")
        self.content.setText(f"{found} of {len(result.views)}")


@pytest.fixture
def panel(shown: Shown[CountingPanel], result: Result) -> Iterator[CountingPanel]:
    panel = shown(CountingPanel, result)
    yield panel
    panel.may_end.set()


def test_before_anything_is_found_there_is_nothing_to_scroll_to(panel: CountingPanel) -> None:
    panel.content.setMinimumHeight(900)
    assert panel.body.minimumSizeHint().height() < 300


def state(panel: CountingPanel) -> tuple[bool, str, bool]:
    """Whether the button can be pressed, the words, and whether what was found is on screen."""
    visible = panel.content.isVisible()
    assert panel.use.isVisible() is visible
    return panel.run.isEnabled(), panel.words.text(), visible


IDLE, WORKING, DONE = (
    (True, "How many?", False),
    (False, "Counting…", False),
    (True, "9 views", True),
)


def test_the_button_starts_the_work(panel: CountingPanel, jobs: Jobs, qtbot: QtBot) -> None:
    assert state(panel) == IDLE
    qtbot.mouseClick(panel.run, LEFT)
    assert state(panel) == WORKING
    assert [job.label for job in jobs.running] == ["Counting"]
    panel.may_end.set()
    qtbot.waitUntil(lambda: panel.found == 9)
    assert state(panel) == DONE
    assert panel.content.text() == "9 of 10"


def test_the_focus_is_the_buttons_again(panel: CountingPanel, qtbot: QtBot) -> None:
    """It goes nowhere else meanwhile: a ring would be drawn around what nobody chose."""
    panel.run.setFocus()
    qtbot.waitUntil(panel.run.hasFocus)
    qtbot.keyClick(panel.run, Qt.Key.Key_Space)
    assert QApplication.focusWidget() is None
    panel.may_end.set()
    qtbot.waitUntil(lambda: panel.found == 9)
    assert panel.run.hasFocus()


def test_the_work_can_be_cancelled(panel: CountingPanel, jobs: Jobs, qtbot: QtBot) -> None:
    """By the progress bar alone: two buttons that cancel would be one too many."""
    qtbot.mouseClick(panel.run, LEFT)
    bar = ProgressBar(jobs)
    qtbot.addWidget(bar)
    bar.show()
    qtbot.mouseClick(bar.cancel, LEFT)
    qtbot.waitUntil(lambda: not jobs.running)
    assert state(panel) == IDLE
    qtbot.mouseClick(panel.run, LEFT)
    panel.may_end.set()
    qtbot.waitUntil(lambda: panel.found == 9)
    assert state(panel) == DONE


def test_the_reason_of_a_failure_stays_until_the_next_try(
    panel: CountingPanel, qtbot: QtBot
) -> None:
    panel.fails = True
    panel.may_end.set()
    qtbot.mouseClick(panel.run, LEFT)
    failed = (True, "There are few views. Take more.", False)
    qtbot.waitUntil(lambda: state(panel) == failed)
    panel.hide()
    panel._refresh_now()
    panel.show()
    assert state(panel) == failed
    panel.may_end.clear()
    qtbot.mouseClick(panel.run, LEFT)
    assert state(panel) == WORKING


def test_what_was_found_is_kept_for_results_that_it_holds_for(
    panel: CountingPanel, result: Result, other: Result, qtbot: QtBot
) -> None:
    panel.may_end.set()
    qtbot.mouseClick(panel.run, LEFT)
    qtbot.waitUntil(lambda: panel.found == 9)
    panel.show_result(replace(result))
    assert state(panel) == DONE
    panel.show_result(other)
    assert panel.found is None
    assert state(panel) == IDLE
    panel.show_result(result)
    assert state(panel) == IDLE, "it would have to be found again"


@pytest.mark.parametrize("nothing", [False, True])
def test_another_result_cancels_the_work(
    panel: CountingPanel, result: Result, other: Result, jobs: Jobs, qtbot: QtBot, nothing: bool
) -> None:
    qtbot.mouseClick(panel.run, LEFT)
    panel.show_result(None if nothing else other)
    panel.may_end.set()
    qtbot.waitUntil(lambda: not jobs.running)
    assert panel.found is None
    panel.show_result(result)
    assert state(panel) == IDLE
