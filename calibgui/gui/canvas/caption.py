"""The image's name and what is under the cursor, in a corner of the picture."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QPoint, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QLabel

from calibgui.gui.canvas.canvas import Canvas
from calibgui.gui.widgets import theme

_AWAY = 24
"""Distance from the cursor at which it gives way, device-independent px."""


class Caption(QLabel):
    """Lies over the picture at its upper left, and at its upper right while the cursor is there."""

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas)
        self._canvas = canvas
        self._cursor = QPoint(-1, -1)
        self._name = self._reading = self._world = ""
        self.setFont(theme.fixed_font())
        self.setMargin(theme.SPACING // 2)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        halo = theme.HALO
        self.setStyleSheet(
            f"color: #ffffff; background: rgba({halo.red()}, {halo.green()}, {halo.blue()},"
            f" {halo.alpha()})"
        )
        canvas.viewport().installEventFilter(self)

    def show_name(self, name: str) -> None:
        """Show the name of the image; nothing if it is empty."""
        self._name = name
        self._show()

    def show_reading(self, reading: str, world: str = "") -> None:
        """Show what is under the cursor, behind the name, and what of the world is there, below."""
        self._reading, self._world = reading, world
        self._show()

    def _show(self) -> None:
        lines = "   ".join(filter(None, (self._name, self._reading))), self._world
        room = self._canvas.viewport().width() - 2 * self.margin()
        metrics, left = self.fontMetrics(), Qt.TextElideMode.ElideLeft
        self.setText("\n".join(metrics.elidedText(line, left, room) for line in lines if line))
        self.setVisible(bool(self.text()))
        self.adjustSize()
        self._place()

    def _place(self) -> None:
        """Stand where the cursor is not."""
        is_in_the_way = self.rect().adjusted(0, 0, _AWAY, _AWAY).contains(self._cursor)
        left = self._canvas.viewport().width() - self.width() if is_in_the_way else 0
        self.move(max(left, 0), 0)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        if isinstance(event, QMouseEvent):
            self._cursor = event.position().toPoint()
            self._place()
        elif event.type() == QEvent.Type.Resize:
            self._show()
        return super().eventFilter(watched, event)
