"""Tabs as words in a row, a line below the chosen one, and pages behind them."""

from __future__ import annotations

from PySide6.QtCore import QRect, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QTabBar, QTabWidget

from calibgui.gui.widgets import theme
from calibgui.gui.widgets.focus_ring import FocusRing

_LINE = 2
"""Width of the line below the chosen word, device-independent px."""


class TabBar(QTabBar):
    """Qt's tabs without frames, in the colours of the theme as it is now."""

    def __init__(self) -> None:
        super().__init__()
        self.setDrawBase(False)
        self.setExpanding(False)
        FocusRing(self)

    def tabSizeHint(self, index: int) -> QSize:  # noqa: N802 - Qt's name
        """Return the size of a tab."""
        metrics = self.fontMetrics()
        width = metrics.horizontalAdvance(self.tabText(index)) + 2 * theme.SPACING
        return QSize(width, metrics.height() + theme.SPACING + 2 * _LINE)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter, colours = QPainter(self), theme.current()
        for k in range(self.count()):
            place, is_chosen = self.tabRect(k), k == self.currentIndex()
            painter.setPen(QColor(colours.accent if is_chosen else colours.muted))
            inside = place.adjusted(theme.SPACING, 0, -theme.SPACING, -_LINE)
            text = self.fontMetrics().elidedText(self.tabText(k), self.elideMode(), inside.width())
            painter.drawText(inside, Qt.AlignmentFlag.AlignCenter, text)
            if is_chosen:
                line = QRect(inside.x(), place.bottom() + 1 - _LINE, inside.width(), _LINE)
                painter.fillRect(line, QColor(colours.accent))


class TabWidget(QTabWidget):
    """Pages behind such tabs, without a frame around them."""

    def __init__(self) -> None:
        super().__init__()
        self.setTabBar(TabBar())
        self.setDocumentMode(True)
