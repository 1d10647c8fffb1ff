"""Dialogs open the same way everywhere."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QSize
from PySide6.QtWidgets import QDialog

from calibgui.gui.widgets.actions import show_dialog
from calibgui.gui.window.main_window import MainWindow


@pytest.mark.parametrize("share", [0.5, 2.0])
def test_a_dialog_is_no_larger_than_the_screen(window: MainWindow, share: float) -> None:
    dialog, screen = QDialog(window), window.screen().availableSize()
    dialog.resize(wanted := screen * share)
    show_dialog(dialog)
    shown = dialog.size()
    dialog.close()
    if share < 1:
        assert shown == wanted
    else:
        assert screen - QSize(100, 100) == shown.boundedTo(screen - QSize(100, 100))
        assert shown.width() < screen.width() and shown.height() < screen.height()
