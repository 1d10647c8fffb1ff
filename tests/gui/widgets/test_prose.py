"""Prose is as high as its text, up to some lines."""

from __future__ import annotations

import math

from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.gui.widgets.prose import Prose


def test_it_is_as_high_as_its_text_up_to_some_lines(qtbot: QtBot) -> None:
    prose = Prose(3)
    qtbot.addWidget(prose)
    prose.resize(300, 50)
    prose.show()
    line = math.ceil(prose.fontMetrics().lineSpacing())
    prose.show_text("One line.")
    assert abs(prose.height() - line) <= 2
    prose.show_text("Words that take more than the lines that there are. " * 20)
    assert prose.height() == 3 * prose.fontMetrics().lineSpacing()
    assert prose.verticalScrollBar().maximum() > 0
    prose.resize(5000, 50)
    QApplication.processEvents()
    assert prose.height() < 3 * line


def test_numbers_stay_with_their_units(qtbot: QtBot) -> None:
    prose = Prose(3)
    qtbot.addWidget(prose)
    text = "Within 2 % of 0.14 px, " * 9
    prose.show_text(text)
    assert prose.toPlainText() == text
    block = prose.document().firstBlock().text()
    assert "2\N{NO-BREAK SPACE}%" in block and "0.14\N{NO-BREAK SPACE}px" in block
