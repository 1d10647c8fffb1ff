"""Tabs give the height that their page does not need to their neighbours."""

from __future__ import annotations

from pytestqt.qtbot import QtBot

from calibgui.app.project import set_pattern
from calibgui.engine.boards.charuco import Charuco
from calibgui.gui.window.main_window import MainWindow
from calibgui.gui.window.page_tabs import PageTabs


def test_the_board_shows_all_its_fields_in_full(window: MainWindow, qtbot: QtBot) -> None:
    window.files.open_sample()
    tabs = window.findChildren(PageTabs)[0]
    qtbot.waitUntil(lambda: window.board.rows.isVisible())
    low = tabs.height()
    window.session.edit("Pattern", lambda p: set_pattern(p, Charuco()))
    qtbot.waitUntil(lambda: tabs.height() > low)
    for box in (window.board.rows, window.board.square, window.board.pattern):
        assert box.height() >= box.minimumSizeHint().height()
    window.session.document.undo()
    qtbot.waitUntil(lambda: tabs.height() == low)
    tabs.setCurrentIndex(1)
    qtbot.waitUntil(lambda: tabs.height() > low)
