"""What the banner shows, and what comes back after it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.engine.errors import CalibrationError
from calibgui.gui.widgets import theme
from calibgui.gui.window.banner import Banner
from calibgui.gui.window.main_window import MainWindow


@pytest.fixture
def banner() -> Iterator[Banner]:
    banner = Banner()
    yield banner
    banner.close()
    banner.deleteLater()


def test_a_question_comes_back_until_it_is_answered(banner: Banner) -> None:
    answers: list[str] = []
    banner.show_text("Recover?", {"Yes": lambda: answers.append("yes")})
    banner.show_text("Stopped.")
    assert banner.text.text() == "Stopped." and not banner.buttons
    banner.dismiss.click()
    assert banner.text.text() == "Recover?" and banner.isVisible()
    banner.show_error(CalibrationError("It cannot be.", ""))
    banner.hide_failure()
    assert banner.text.text() == "Recover?" and banner.isVisible()
    banner.buttons[0].click()
    assert answers == ["yes"] and not banner.isVisible()
    banner.show_text("Stopped.")
    banner.dismiss.click()
    assert not banner.isVisible()


def test_a_dismissed_question_is_gone(banner: Banner) -> None:
    banner.show_text("Recover?", {"Yes": lambda: None})
    banner.dismiss.click()
    assert not banner.isVisible()
    banner.show_text("Stopped.")
    banner.dismiss.click()
    assert not banner.isVisible()


def test_a_message_that_a_question_covers_comes_back(banner: Banner) -> None:
    banner.show_text("It is open in another window.")
    banner.show_text("Locate the images?", {"Locate": lambda: None})
    banner.dismiss.click()
    assert banner.text.text() == "It is open in another window." and banner.isVisible()
    assert not banner.buttons
    banner.dismiss.click()
    assert not banner.isVisible()


def test_choices_leave_the_width_of_a_narrow_window_to_the_message(
    window: MainWindow, qtbot: QtBot
) -> None:
    banner = window.banner
    text = "The program ended without saving. Its state of 1 January 2026 has been kept."
    banner.show_text(text, {"&Recover": lambda: None, "Go on &without": lambda: None})
    qtbot.waitUntil(lambda: banner.buttons[0].y() == banner.buttons[1].y())
    assert banner.buttons[0].mapTo(banner, QPoint()).y() < banner.text.geometry().bottom()
    window.resize(600, 720)
    qtbot.waitUntil(lambda: banner.width() == window.pages.width() < 640)
    qtbot.waitUntil(lambda: banner.text.width() > 500)
    button = banner.buttons[0]
    assert button.mapTo(banner, QPoint()).y() > banner.text.geometry().bottom()
    qtbot.waitUntil(lambda: button.mapTo(banner, button.rect().bottomLeft()).y() < banner.height())


def test_a_first_message_of_two_lines_is_not_cut(window: MainWindow, qtbot: QtBot) -> None:
    window.show_failure(CalibrationError("There is no such folder.", "Check its spelling."))
    text = window.banner.text
    qtbot.waitUntil(lambda: text.height() >= text.heightForWidth(text.width()) > 0)


def test_the_banner_takes_other_colours(banner: Banner, qapp: QApplication) -> None:
    banner.show_text("Something is to be said.")
    try:
        theme.apply(qapp, theme.Scheme.DARK)
        assert theme.DARK.warning_base in banner.styleSheet()
    finally:
        theme.apply(qapp, theme.Scheme.LIGHT)


def test_a_message_leaves_the_tools_free_that_it_may_ask_for(
    full: MainWindow, qtbot: QtBot
) -> None:
    banner, tools = full.banner, full.page.bar
    full.show_failure(CalibrationError("There is no board.", "Mark its corners."))
    qtbot.waitUntil(lambda: 0 < tools.width() == banner.x())
    assert banner.geometry().right() == full.pages.rect().right()
    qtbot.mouseClick(full.inspector.camera.all, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: full.page.isHidden() and banner.x() == 0)
