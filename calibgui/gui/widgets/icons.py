"""Icons of thin lines in the theme's colour: those of the system look different on each."""

from __future__ import annotations

from enum import Enum

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPen, QPixmap, QPolygonF

from calibgui.gui.widgets import theme

_SIDE = 24
"""Width and height, device-independent px; the icons are drawn on a grid of this many lines."""
_FINEST = 4
"""Pixels in a device-independent one on the finest screen."""
_LINE = 1.6
"""Width of a line, device-independent px."""


class Icon(Enum):
    """What an icon shows: its lines, each through points of the grid."""

    FOLDER = (
        ((3, 19), (3, 5), (9, 5), (11, 8), (21, 8), (21, 19), (3, 19)),
        ((3, 11), (21, 11)),
    )
    PICTURE = (
        ((3, 5), (21, 5), (21, 19), (3, 19), (3, 5)),
        ((3, 17), (9, 11), (13, 15), (16, 12), (21, 17)),
        ((16, 8), (17, 8), (17, 9), (16, 9), (16, 8)),
    )
    BOARD = (
        ((4, 4), (20, 4), (20, 20), (4, 20), (4, 4)),
        ((12, 4), (12, 20)),
        ((4, 12), (20, 12)),
    )
    PRINTER = (
        ((7, 9), (7, 3), (17, 3), (17, 9)),
        ((7, 17), (3, 17), (3, 9), (21, 9), (21, 17), (17, 17)),
        ((7, 14), (17, 14), (17, 21), (7, 21), (7, 14)),
    )


_SQUARES = (QRectF(4, 4, 8, 8), QRectF(12, 12, 8, 8))
"""The dark squares of the board."""


def draw_icon(icon: Icon) -> QIcon:
    """Draw an icon in the theme's accent."""
    pixmap = QPixmap(_FINEST * _SIDE, _FINEST * _SIDE)
    pixmap.setDevicePixelRatio(_FINEST)
    pixmap.fill(Qt.GlobalColor.transparent)
    colour = QColor(theme.current().accent)
    painter = QPainter(pixmap)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    join, cap = Qt.PenJoinStyle.RoundJoin, Qt.PenCapStyle.RoundCap
    painter.setPen(QPen(colour, _LINE, Qt.PenStyle.SolidLine, cap, join))
    for line in icon.value:
        painter.drawPolyline(QPolygonF([QPointF(*at) for at in line]))
    if icon is Icon.BOARD:
        for square in _SQUARES:
            painter.fillRect(square, colour)
    painter.end()
    return QIcon(pixmap)
