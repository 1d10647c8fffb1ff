"""Whoever works with the keyboard sees where it is."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QPushButton
from pytestqt.qtbot import QtBot

from calibgui.app.recent import Recent
from calibgui.gui.window.main_window import MainWindow


def test_the_welcome_page_shows_which_of_its_entries_has_the_focus(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    window.welcome.show_recent([Recent(tmp_path / "camera.json", "")])
    QApplication.processEvents()
    window.activateWindow()
    qtbot.waitUntil(lambda: QApplication.activeWindow() is window)
    buttons = [b for b in window.welcome.findChildren(QPushButton) if b.isVisible()]
    assert len(buttons) == 5
    for button in buttons:
        button.clearFocus()
        before = button.grab().toImage()
        button.setFocus(Qt.FocusReason.TabFocusReason)
        assert button.grab().toImage() != before, button.text()
        button.clearFocus()
        assert button.grab().toImage() == before, button.text()
