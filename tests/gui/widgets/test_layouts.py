"""Rows and columns hold their parts in order, with the room that is said."""

from __future__ import annotations

from PySide6.QtWidgets import QLabel, QWidget
from pytestqt.qtbot import QtBot

from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import keep_place, make_column, make_row


def test_parts_stand_in_order_and_share_the_spare_room(qtbot: QtBot) -> None:
    whole, first, wide, last = QWidget(), QLabel("a"), QWidget(), QLabel("b")
    qtbot.addWidget(whole)
    row = make_row(first, (wide, 1), last)
    make_column(row, None, of=whole, margins=theme.MARGIN)
    whole.resize(400, 300)
    whole.show()
    assert first.x() == first.y() == theme.MARGIN, "what nothing takes is below"
    assert wide.x() == first.geometry().right() + 1 + theme.SPACING
    assert last.geometry().right() + 1 == 400 - theme.MARGIN
    assert last.width() == last.sizeHint().width()


def test_a_hidden_widget_keeps_its_place(qtbot: QtBot) -> None:
    whole, first, second = QWidget(), QLabel("first"), QLabel("second")
    qtbot.addWidget(whole)
    make_row(first, second, None, of=whole)
    keep_place(first)
    whole.show()
    before = second.x()
    first.hide()
    qtbot.wait(10)
    assert second.x() == before > 0
