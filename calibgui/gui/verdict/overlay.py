"""A frame that lies over the desk, below the bar: what is under it does not move."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QPoint, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QFrame, QWidget

from calibgui.gui.widgets import theme


class Overlay(QFrame):
    """Hangs from a widget, as wide as it is; Escape closes it.

    Args:
        bar: the widget that it hangs from.
        share: share of the room below that it may take.
    """

    closed = Signal()
    """The user has closed it by Escape."""

    def __init__(self, bar: QWidget, share: float) -> None:
        super().__init__(bar)
        self._bar, self._share = bar, share
        self.setObjectName("overlay")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.hide()

    def open_up(self) -> None:
        """Lie over the desk."""
        window = self._bar.window()
        if self.parentWidget() is not window:
            self.setParent(window)
            window.installEventFilter(self)
        self._restyle()
        self.place()
        self.show()
        self.raise_()

    def place(self) -> None:
        """Keep to the place below the bar, no higher than the content asks for."""
        window = self._bar.window()
        corner = self._bar.mapTo(window, QPoint(0, self._bar.height()))
        room = window.height() - corner.y() - theme.SPACING
        width = self._bar.width()
        height = min(self.measure_height(width), round(self._share * room))
        self.setGeometry(corner.x(), corner.y(), width, height)

    def measure_height(self, width: int) -> int:  # noqa: ARG002 - subclasses need it
        """Return the height that the content asks for."""
        return self.sizeHint().height()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        if self.isVisible() and event.type() in (QEvent.Type.Resize, QEvent.Type.LayoutRequest):
            self.place()
        return super().eventFilter(watched, event)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        if event.key() == Qt.Key.Key_Escape:
            self.hide()
            self.closed.emit()
        else:
            super().keyPressEvent(event)

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._restyle()

    def _restyle(self) -> None:
        colours = theme.current()
        style = (
            f"#overlay {{ background: {colours.base}; border: 1px solid {colours.line};"
            f" border-top: none; border-bottom: 2px solid {colours.accent}; }}"
        )
        if style != self.styleSheet():
            self.setStyleSheet(style)
