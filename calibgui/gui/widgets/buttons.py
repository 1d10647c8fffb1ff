"""Buttons of one look: the main action in the accent's colour, plain ones, and links in text."""

from __future__ import annotations

from enum import Enum

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QPushButton, QSizePolicy, QStyle

from calibgui.gui.widgets import theme
from calibgui.gui.widgets.focus_ring import FocusRing

_PADDING, _ARROW = 12, 8
"""Beside a text, and the width of the arrow of a menu, device-independent px."""
_LEAST = 160
"""Width down to which a text is shown whole, device-independent px."""


class Kind(Enum):
    """The weight of a button."""

    MAIN = "main"
    PLAIN = "plain"
    LINK = "link"


class Button(QPushButton):
    """A button that paints itself, in the colours of the theme as it is now.

    Args:
        text: what stands on it.
        kind: its weight; the main one of a dialog is pressed by Enter from anywhere.
        takes_enter: whether Enter presses it in a dialog while it has the focus.
    """

    def __init__(
        self, text: str = "", kind: Kind = Kind.PLAIN, *, takes_enter: bool = True
    ) -> None:
        super().__init__(text)
        self._kind = kind
        self.setDefault(kind is Kind.MAIN)
        if not takes_enter:
            self.setAutoDefault(False)
        self.setSizePolicy(QSizePolicy.Policy.Maximum, QSizePolicy.Policy.Fixed)
        if kind is Kind.LINK:
            self.setCursor(Qt.CursorShape.PointingHandCursor)
        FocusRing(self)

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        metrics = self.fontMetrics()
        size = metrics.size(Qt.TextFlag.TextShowMnemonic, self.text())
        arrow = _ARROW + theme.SPACING // 2 if self.menu() is not None else 0
        if self._kind is Kind.LINK:
            return size + QSize(4 + arrow, 4)
        return QSize(size.width() + 2 * _PADDING + arrow, max(theme.CONTROL, size.height() + 8))

    def minimumSizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        return self.sizeHint().boundedTo(QSize(_LEAST, 1000))

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter, colours = QPainter(self), theme.current()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        ink = colours.accent if self._kind is Kind.LINK else colours.text
        if self._kind is not Kind.LINK:
            ground = QColor(colours.base)
            if self._kind is Kind.MAIN and self.isEnabled():
                ground, ink = QColor(colours.accent), colours.on_accent
            if self.isDown() or self.isChecked():
                ground = ground.darker(112)
            elif self.underMouse() and self.isEnabled():
                ground = ground.darker(104)
            edge = ground if ink == colours.on_accent else QColor(colours.line)
            painter.setPen(QPen(edge, 1))
            painter.setBrush(ground)
            rect = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
            painter.drawRoundedRect(rect, theme.SMALL_RADIUS, theme.SMALL_RADIUS)
        painter.setPen(QColor(ink if self.isEnabled() else colours.muted))
        flags = int(Qt.AlignmentFlag.AlignCenter) | int(
            Qt.TextFlag.TextShowMnemonic
            if self.style().styleHint(QStyle.StyleHint.SH_UnderlineShortcut, None, self)
            else Qt.TextFlag.TextHideMnemonic
        )
        room = self.rect()
        if self.menu() is not None:
            room.adjust(0, 0, -_ARROW - theme.SPACING // 2, 0)
            x, y = (
                self.width() - _ARROW - (4 if self._kind is Kind.LINK else _PADDING),
                room.center().y(),
            )
            painter.drawLine(x, y - 1, x + 4, y + 3)
            painter.drawLine(x + 4, y + 3, x + 8, y - 1)
        inside = room.width() - (0 if self._kind is Kind.LINK else _PADDING)
        elide = Qt.TextElideMode.ElideMiddle
        painter.drawText(room, flags, self.fontMetrics().elidedText(self.text(), elide, inside))
