"""The image's name and what is under the cursor, in a corner of the picture."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QPoint, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QLabel

from calibgui.gui.canvas.canvas import Canvas
from calibgui.gui.widgets import theme

_AWAY = 24
"""Distance from the cursor at which it gives way, device-independent px."""
_INSET = 12
"""From the picture's edge, device-independent px."""


class Caption(QLabel):
    """Lies over the picture at its upper left, and at its upper right while the cursor is there.

    The first line says what the picture is, the second what is under the cursor.
    """

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas)
        self._canvas = canvas
        self._cursor = QPoint(-1, -1)
        self._name = self._facts = self._reading = self._world = ""
        self.setMargin(theme.SPACING)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        halo = theme.HALO
        self.setStyleSheet(
            f"color: #ffffff; border-radius: {theme.SMALL_RADIUS}px;"
            f" background: rgba({halo.red()}, {halo.green()}, {halo.blue()}, {halo.alpha()})"
        )
        canvas.viewport().installEventFilter(self)

    def show_name(self, name: str, facts: str = "") -> None:
        """Show the name of the image and what is known of it; nothing if it is empty."""
        self._name, self._facts = name, facts
        self._show()

    def show_reading(self, reading: str, world: str = "") -> None:
        """Show what is under the cursor, below the name, and what of the world is there."""
        self._reading, self._world = reading, world
        self._show()

    def _show(self) -> None:
        room = self._canvas.viewport().width() - 2 * (self.margin() + _INSET)
        name = " — ".join(filter(None, (self._name, self._facts)))
        lines = filter(None, (name, self._reading, self._world))
        elide = Qt.TextElideMode.ElideLeft
        self.setText("\n".join(self.fontMetrics().elidedText(line, elide, room) for line in lines))
        self.setVisible(bool(name))
        self.adjustSize()
        self._place()

    def _place(self) -> None:
        """Stand where the cursor is not."""
        reach = _AWAY + _INSET
        is_in_the_way = self.rect().adjusted(0, 0, reach, reach).contains(self._cursor)
        right = self._canvas.viewport().width() - self.width() - _INSET
        self.move(max(right, 0) if is_in_the_way else _INSET, _INSET)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        if isinstance(event, QMouseEvent):
            self._cursor = event.position().toPoint()
            self._place()
        elif event.type() == QEvent.Type.Resize:
            self._show()
        return super().eventFilter(watched, event)
