"""A ring around what has the focus, for buttons that the style draws without one."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QRectF, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPalette, QPen
from PySide6.QtWidgets import QWidget

_WIDTH = 2.0
"""Width of the line, px."""
_RADIUS = 6.0
"""Radius of its corners, px."""


class FocusRing(QWidget):
    """Lies over a widget, and is seen while that has the focus."""

    def __init__(self, widget: QWidget) -> None:
        super().__init__(widget)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.hide()
        widget.installEventFilter(self)

    def eventFilter(self, widget: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        if isinstance(widget, QWidget) and event.type() in _CHANGES:
            self.setGeometry(widget.rect())
            self.setVisible(widget.hasFocus())
            self.raise_()
        return False

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002, N802 - Qt's name
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(self.palette().color(QPalette.ColorRole.Highlight), _WIDTH))
        inset = _WIDTH / 2
        ring = QRectF(self.rect()).adjusted(inset, inset, -inset, -inset)
        painter.drawRoundedRect(ring, _RADIUS, _RADIUS)
        painter.end()


_CHANGES = (QEvent.Type.FocusIn, QEvent.Type.FocusOut, QEvent.Type.Resize)
"""Events after which the ring may have to be elsewhere, or nowhere."""
