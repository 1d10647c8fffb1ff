"""The widget is as high as its text, up to some lines."""

from __future__ import annotations

import math

from PySide6.QtWidgets import QApplication, QVBoxLayout, QWidget
from pytestqt.qtbot import QtBot

from calibgui.gui.widgets.scrolling_text import ScrollingText


def test_it_is_as_high_as_its_text_up_to_some_lines(qtbot: QtBot) -> None:
    shown = ScrollingText(3)
    qtbot.addWidget(shown)
    shown.resize(300, 50)
    shown.show()
    line = math.ceil(shown.fontMetrics().lineSpacing())
    shown.show_text("One line.")
    assert abs(shown.height() - line) <= 2
    shown.show_text("Words that take more than the lines that there are. " * 20)
    assert shown.height() == 3 * shown.fontMetrics().lineSpacing()
    assert shown.verticalScrollBar().maximum() > 0
    shown.resize(5000, 50)
    QApplication.processEvents()
    assert shown.height() < 3 * line


def test_a_high_window_has_room_for_more(qtbot: QtBot) -> None:
    window = QWidget()
    qtbot.addWidget(window)
    shown = ScrollingText(3)
    QVBoxLayout(window).addWidget(shown)
    window.resize(300, 1000)
    window.show()
    shown.show_text("Words that take more than the lines that there are. " * 20)
    line = shown.fontMetrics().lineSpacing()
    assert 100 - line < shown.height() <= 100 and shown.height() % line == 0


def test_numbers_stay_with_their_units(qtbot: QtBot) -> None:
    shown = ScrollingText(3)
    qtbot.addWidget(shown)
    text = "Within 2 % of 0.14 px, " * 9
    shown.show_text(text)
    assert shown.toPlainText() == text
    block = shown.document().firstBlock().text()
    assert "2\N{NO-BREAK SPACE}%" in block and "0.14\N{NO-BREAK SPACE}px" in block
