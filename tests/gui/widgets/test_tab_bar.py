"""Tabs show their texts whole."""

from __future__ import annotations

from PySide6.QtCore import QSize
from pytestqt.qtbot import QtBot

from calibgui.gui.widgets.tab_bar import TabBar


class HighTabBar(TabBar):
    """Has more room than its texts can need."""

    def tabSizeHint(self, index: int) -> QSize:  # noqa: N802 - Qt's name
        return super().tabSizeHint(index) + QSize(0, 10)


def count_ink(bar: TabBar, qtbot: QtBot) -> int:
    """Return the number of dark pixels in the tab that is not chosen."""
    qtbot.addWidget(bar)
    bar.addTab("Chosen")
    bar.addTab("gypqj")
    bar.show()
    image = bar.grab(bar.tabRect(1).adjusted(4, 4, -4, -1)).toImage()
    pixels = (image.pixelColor(x, y) for x in range(image.width()) for y in range(image.height()))
    return sum(pixel.lightness() < 120 for pixel in pixels)


def test_letters_below_the_line_are_whole_where_a_tab_is_not_chosen(qtbot: QtBot) -> None:
    whole = count_ink(HighTabBar(), qtbot)
    assert count_ink(TabBar(), qtbot) == whole > 20
