"""A sheet over the desk: what is under it does not move."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent, QPalette
from PySide6.QtWidgets import QFrame, QWidget

from calibgui.gui.widgets import theme
from calibgui.gui.widgets.overlay import Overlay


class Sheet(QFrame):
    """Lies over the desk until Escape closes it; `heightForWidth` is the height that it asks for.

    Args:
        desk: the widget that it lies over.
        width: of a sheet at the right; 0 for one along the desk's upper edge.
        fills: whether it is as high as the desk.
    """

    closed = Signal()
    """The user has closed it by Escape."""

    def __init__(self, desk: QWidget, width: int = 0, *, fills: bool = False) -> None:
        super().__init__(desk)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.hide()
        self._overlay = Overlay(self, desk, width=width, fills=fills)
        desk.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        if event.type() == QEvent.Type.PaletteChange and watched is self.parentWidget():
            self.setPalette(QPalette())  # Qt tells no sheet that fills its desk of the new colours
        return False

    def fit(self) -> None:
        """Take the height that the content needs now."""
        self._overlay.place()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        if event.key() == Qt.Key.Key_Escape:
            self.hide()
            self.closed.emit()
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        colours, painter = theme.current(), QPainter(self)
        painter.fillRect(self.rect(), QColor(colours.base))
        painter.setPen(QColor(colours.line))
        painter.drawRect(self.rect().adjusted(0, -1, -1, -1))
