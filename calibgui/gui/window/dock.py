"""A part of the window that can be moved, taken out and closed."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPen, QPixmap
from PySide6.QtWidgets import QAbstractButton, QDockWidget, QMainWindow, QWidget

from calibgui.gui.widgets import theme

_SIDE = 10


class Dock(QDockWidget):
    """Qt's dock, whose buttons show on a dark title as well."""

    def __init__(self, title: str, name: str, content: QWidget, parent: QMainWindow) -> None:
        super().__init__(title, parent)
        self.setObjectName(name)
        self.setWidget(content)
        self._icons: dict[QObject, QIcon] = {}
        """Icons of the buttons; Qt takes its own again when a layout is restored."""
        self._restyle()
        for button in self._icons:
            button.installEventFilter(self)

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._restyle()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        if event.type() == QEvent.Type.Paint and isinstance(watched, QAbstractButton):
            icon = self._icons[watched]
            if watched.icon().cacheKey() != icon.cacheKey():
                watched.setIcon(icon)
        return super().eventFilter(watched, event)

    def _restyle(self) -> None:
        for name, tip, icon in (
            ("qt_dockwidget_floatbutton", self.tr("Take out or put back"), _icon(cross=False)),
            ("qt_dockwidget_closebutton", self.tr("Close; View opens it again"), _icon(cross=True)),
        ):
            button = self.findChild(QAbstractButton, name)
            if isinstance(button, QAbstractButton):
                self._icons[button] = icon
                button.setIcon(icon)
                button.setToolTip(tip)


def _icon(*, cross: bool) -> QIcon:
    """A cross, or a frame, in the colour of text."""
    pixmap = QPixmap(4 * _SIDE, 4 * _SIDE)
    pixmap.setDevicePixelRatio(4)
    pixmap.fill(Qt.GlobalColor.transparent)
    painter = QPainter(pixmap)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QPen(QColor(theme.current().muted), 1.4))
    low, high = 2.0, _SIDE - 2.0
    if cross:
        painter.drawLine(QPointF(low, low), QPointF(high, high))
        painter.drawLine(QPointF(low, high), QPointF(high, low))
    else:
        painter.drawRect(QRectF(low, low, high - low, high - low))
    painter.end()
    return QIcon(pixmap)
