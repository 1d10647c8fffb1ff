"""The bar of modes over the desk."""

from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QTabBar

from calibgui.gui.panels.modes import Mode, describe_mode, name_mode
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.focus_ring import FocusRing

_PADDING = 11
"""Beside a name, device-independent px."""
_INSET = 3
"""From the bar's edge to the chosen mode, device-independent px."""


class ModeBar(QTabBar):
    """One name for each mode, the chosen one on a light ground."""

    chosen = Signal(Mode)
    """The user has chosen a mode, or the one that is chosen already."""

    def __init__(self) -> None:
        super().__init__()
        self.setAccessibleName(self.tr("What the desk shows"))
        self.setExpanding(False)
        self.setDrawBase(False)
        self.setUsesScrollButtons(False)
        self.setElideMode(Qt.TextElideMode.ElideNone)
        self.setSizePolicy(QSizePolicy.Policy.Maximum, QSizePolicy.Policy.Fixed)
        self.setMouseTracking(True)
        for mode in Mode:
            self.setTabToolTip(self.addTab(name_mode(mode)), describe_mode(mode))
        FocusRing(self)
        self.currentChanged.connect(lambda k: self.chosen.emit(list(Mode)[k]))

    @property
    def mode(self) -> Mode:
        """The chosen mode."""
        return list(Mode)[self.currentIndex()]

    def show_mode(self, mode: Mode) -> None:
        """Choose a mode."""
        self.setCurrentIndex(list(Mode).index(mode))

    def minimumSizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        return QSize(0, theme.CONTROL)  # the header has it elsewhere before it is narrower

    def tabSizeHint(self, index: int) -> QSize:  # noqa: N802 - Qt's name
        width = self.fontMetrics().horizontalAdvance(self.tabText(index))
        return QSize(width + 2 * _PADDING, theme.CONTROL)

    minimumTabSizeHint = tabSizeHint  # noqa: N815 - Qt's name

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter, colours = QPainter(self), theme.current()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(colours.window))
        painter.drawRoundedRect(QRectF(self.rect()), theme.RADIUS, theme.RADIUS)
        for k in range(self.count()):
            place, is_chosen = QRectF(self.tabRect(k)), k == self.currentIndex()
            if is_chosen:
                painter.setPen(QPen(QColor(colours.line), 1))
                painter.setBrush(QColor(colours.base))
                painter.drawRoundedRect(
                    place.adjusted(_INSET, _INSET, -_INSET, -_INSET),
                    theme.SMALL_RADIUS,
                    theme.SMALL_RADIUS,
                )
            painter.setPen(QColor(colours.accent if is_chosen else colours.text))
            painter.drawText(place, Qt.AlignmentFlag.AlignCenter, self.tabText(k))
