"""A magnifier beside the cursor."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen

from calibgui.engine.arrays import Array, GreyImage
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.picture import make_qimage

_RADIUS = 60.0
"""Device-independent px."""
_ZOOM = 8.0
_AWAY = 24.0
"""From the cursor to the loupe's edge."""


def paint_loupe(
    painter: QPainter,
    image: GreyImage,
    uv: Array,
    mark: Array | None,
    cursor: QPointF,
    port: QRectF,
) -> None:
    """Draw the neighbourhood of an image point in a circle.

    Args:
        painter: in the widget's coordinates.
        image: (h, w) grey levels, 8 bits.
        uv: (2,) px, the point in the circle's middle.
        mark: (2,) px, a point to be marked with a cross, or None.
        cursor: beside which the circle goes.
        port: within which it stays.
    """
    middle = QPointF(cursor.x() + _AWAY + _RADIUS, cursor.y() - _AWAY - _RADIUS)
    if middle.x() + _RADIUS > port.right():
        middle.setX(cursor.x() - _AWAY - _RADIUS)
    if middle.y() - _RADIUS < port.top():
        middle.setY(cursor.y() + _AWAY + _RADIUS)
    half = int(np.ceil(_RADIUS / _ZOOM)) + 1
    u, v = np.rint(uv).astype(int)
    rows, cols = np.arange(v - half, v + half + 1), np.arange(u - half, u + half + 1)
    height, width = image.shape
    part = image[np.clip(rows, 0, height - 1)[:, None], np.clip(cols, 0, width - 1)[None]]
    outside = ((rows < 0) | (rows >= height))[:, None] | ((cols < 0) | (cols >= width))[None]
    part = np.where(outside, 0, part).astype(np.uint8)

    def place(point: Array) -> QPointF:
        return middle + QPointF(*(_ZOOM * (point - uv)))

    painter.save()
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    circle = QPainterPath()
    circle.addEllipse(middle, _RADIUS, _RADIUS)
    painter.setClipPath(circle)
    corner = place(np.array([u - half - 0.5, v - half - 0.5]))
    side = _ZOOM * (2 * half + 1)
    painter.drawImage(QRectF(corner.x(), corner.y(), side, side), make_qimage(part))
    cross = theme.MUTED_MARK if mark is None else theme.REFINED
    at = place(uv if mark is None else mark)
    for pen in (QPen(theme.HALO, 3.4), QPen(cross, 1.4)):
        painter.setPen(pen)
        painter.drawLine(QPointF(at.x() - 14, at.y()), QPointF(at.x() + 14, at.y()))
        painter.drawLine(QPointF(at.x(), at.y() - 14), QPointF(at.x(), at.y() + 14))
    painter.setClipping(False)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for pen in (QPen(theme.HALO, 4), QPen(QColor("white"), 1.5)):
        painter.setPen(pen)
        painter.drawEllipse(middle, _RADIUS, _RADIUS)
    painter.restore()
