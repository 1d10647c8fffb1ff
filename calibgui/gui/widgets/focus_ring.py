"""A ring around what has the focus by the keyboard, where the style draws none."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QRectF, Qt
from PySide6.QtGui import QColor, QFocusEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from calibgui.gui.widgets import theme

_WIDTH = 2.0
"""Width of the line, px."""
_RADIUS = 6.0
"""Radius of its corners, px."""


class FocusRing(QObject):
    """Draws a ring over a widget while that has the focus, unless the mouse gave it."""

    def __init__(self, widget: QWidget) -> None:
        super().__init__(widget)
        self._by_keys = False
        self._ring: _Ring | None = None
        """Made when it is first seen."""
        widget.installEventFilter(self)

    @property
    def is_seen(self) -> bool:
        """Return whether the ring is there now."""
        return self._ring is not None and self._ring.isVisible()

    def eventFilter(self, widget: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        if isinstance(widget, QWidget) and event.type() in _CHANGES:
            # Coming back from another window or a menu, it is as it was.
            if isinstance(event, QFocusEvent) and event.gotFocus() and event.reason() in _HOW:
                self._by_keys = event.reason() is not Qt.FocusReason.MouseFocusReason
            self._place(widget)
        return False

    def _place(self, widget: QWidget) -> None:
        is_seen = self._by_keys and widget.hasFocus()
        if self._ring is None:
            if not is_seen:
                return
            self._ring = _Ring(widget)
        self._ring.setGeometry(widget.rect())
        self._ring.setVisible(is_seen)
        self._ring.raise_()


class _Ring(QWidget):
    """The line itself, over a widget."""

    def __init__(self, widget: QWidget) -> None:
        super().__init__(widget)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: ARG002, N802 - Qt's name
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(theme.current().accent), _WIDTH))
        inset = _WIDTH / 2
        ring = QRectF(self.rect()).adjusted(inset, inset, -inset, -inset)
        painter.drawRoundedRect(ring, _RADIUS, _RADIUS)
        painter.end()


_CHANGES = (QEvent.Type.FocusIn, QEvent.Type.FocusOut, QEvent.Type.Resize)
"""Events after which the ring may have to be elsewhere, or nowhere."""
_HOW = (
    Qt.FocusReason.TabFocusReason,
    Qt.FocusReason.BacktabFocusReason,
    Qt.FocusReason.ShortcutFocusReason,
    Qt.FocusReason.MouseFocusReason,
)
"""Ways in which the user gives the focus."""
