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
    """The drawing of an icon: its lines, each through points of the grid."""

    FOLDER = (((3, 19), (3, 5), (9, 5), (11, 8), (21, 8), (21, 19), (3, 19)), ((3, 11), (21, 11)))
    PICTURE = (
        ((3, 5), (21, 5), (21, 19), (3, 19), (3, 5)),
        ((3, 17), (9, 11), (13, 15), (16, 12), (21, 17)),
        ((16, 8), (17, 8), (17, 9), (16, 9), (16, 8)),
    )
    CAMERA = (
        ((3, 8), (7, 8), (9, 5), (15, 5), (17, 8), (21, 8), (21, 19), (3, 19), (3, 8)),
        ((12, 9), (15, 11), (15, 15), (12, 17), (9, 15), (9, 11), (12, 9)),
    )
    BOARD = (((4, 4), (20, 4), (20, 20), (4, 20), (4, 4)), ((12, 4), (12, 20)), ((4, 12), (20, 12)))
    MARK = (
        ((5, 7), (19, 4), (20, 20), (3, 17), (5, 7)),
        *[
            ((x - 1.5, y), (x, y - 1.5), (x + 1.5, y), (x, y + 1.5), (x - 1.5, y))
            for x, y in ((5, 7), (19, 4), (20, 20), (3, 17))
        ],
    )
    EDIT = (
        ((12, 3), (12, 21)),
        ((3, 12), (21, 12)),
        ((9.5, 5.5), (12, 3), (14.5, 5.5)),
        ((9.5, 18.5), (12, 21), (14.5, 18.5)),
        ((5.5, 9.5), (3, 12), (5.5, 14.5)),
        ((18.5, 9.5), (21, 12), (18.5, 14.5)),
    )
    FIT = (
        ((3, 8), (3, 4), (8, 4)),
        ((16, 4), (21, 4), (21, 8)),
        ((21, 16), (21, 20), (16, 20)),
        ((8, 20), (3, 20), (3, 16)),
    )
    ACTUAL_SIZE = (
        ((3, 8), (6, 5), (6, 19)),
        ((12, 10), (12, 10.1)),
        ((12, 15), (12, 15.1)),
        ((17, 8), (20, 5), (20, 19)),
    )
    PRINTER = (
        ((7, 9), (7, 3), (17, 3), (17, 9)),
        ((7, 17), (3, 17), (3, 9), (21, 9), (21, 17), (17, 17)),
        ((7, 14), (17, 14), (17, 21), (7, 21), (7, 14)),
    )
    LAYERS = (((12, 4), (21, 9), (12, 14), (3, 9), (12, 4)), ((3, 13), (12, 18), (21, 13)))
    MORE = (((6, 9), (12, 15), (18, 9)),)
    PLAY = (((7, 4), (20, 12), (7, 20), (7, 4)),)
    CROSS = (((4, 4), (20, 20)), ((4, 20), (20, 4)))


_SQUARES = (QRectF(4, 4, 8, 8), QRectF(12, 12, 8, 8))
"""The dark squares of the board."""


def draw_icon(icon: Icon, ink: str = "") -> QIcon:
    """Draw an icon in a colour, by default in the theme's accent."""
    pixmap = QPixmap(_FINEST * _SIDE, _FINEST * _SIDE)
    pixmap.setDevicePixelRatio(_FINEST)
    pixmap.fill(Qt.GlobalColor.transparent)
    colour = QColor(ink or theme.current().accent)
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
