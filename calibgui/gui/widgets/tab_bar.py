"""Tabs whose texts are shown whole, and pages behind them."""

from __future__ import annotations

from PySide6.QtCore import QSize
from PySide6.QtWidgets import QTabBar, QTabWidget

_SUNK = 2
"""Distance by which the style draws the text of a tab that is not chosen lower, px."""


class TabBar(QTabBar):
    """Qt's tabs, with room for letters that reach below the line where a tab is not chosen."""

    def tabSizeHint(self, index: int) -> QSize:  # noqa: N802 - Qt's name
        """Return the size of a tab."""
        return super().tabSizeHint(index) + QSize(0, _SUNK)


class TabWidget(QTabWidget):
    """Pages behind such tabs, without a frame around them."""

    def __init__(self) -> None:
        super().__init__()
        self.setTabBar(TabBar())
        self.setDocumentMode(True)
