"""The progress of a capture: a ring, the sensor with the corners seen on it, and the tilts."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from calibgui.app.photographs.recording import CaptureProgress
from calibgui.engine.arrays import Array, Size
from calibgui.engine.capture import Picture
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.widgets import theme

_SIDE = 308
"""Width and height, device-independent px."""
_RING, _LINE = 148, 12
"""Diameter and width of the ring, device-independent px."""
_SENSOR = (168, 112)
"""Room for the picture of the sensor, device-independent px."""
_DIAL = 112
"""Diameter of the dial of tilts, whose rim is a tilt of 60 degrees, device-independent px."""
_RIM = np.sin(np.deg2rad(60.0))
_FACTOR = 100.0
"""Uncertainty, over the one that is asked for, at which the ring is empty; it fills by factors."""
_WHOLE_TURN = 5760
"""A turn, in the sixteenths of a degree of Qt."""


class ProgressFigure(QWidget):
    """Three figures of what was taken.

    Args:
        limit: uncertainty of the worst pixel that is asked for, px.
    """

    def __init__(self, limit: float) -> None:
        super().__init__()
        self.limit = limit
        self._progress: CaptureProgress | None = None
        self._shown: tuple[Mapping[Path, Picture], float, float] | None = None
        """The values last painted: pictures, uncertainty and limit, px; None if none were."""
        self._size: Size = (4, 3)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName(self.tr("How far the capture has come"))
        self.setToolTip(
            self.tr(
                "The ring: the uncertainty of the worst pixel, one standard deviation, and the one "
                "that is asked for.\nThe rectangle: the corners in all pictures, over the sensor."
                "\nThe circle: how the boards were tilted; the middle is facing the camera, the "
                "rim 60 degrees."
            )
        )

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        return QSize(_SIDE, _SIDE)

    def show_progress(self, progress: CaptureProgress | None) -> None:
        """Show what was taken; None for nothing."""
        shown = None if progress is None else (progress.pictures, progress.worst, self.limit)
        if shown is not None and shown == self._shown:
            return
        self._progress, self._shown = progress, shown
        for picture in progress.pictures.values() if progress else ():
            height, width = picture.frame.image.shape[:2]
            self._size = width, height
        self.setAccessibleDescription(self.describe())
        self.update()

    def describe(self) -> str:
        """Say in words how far the capture has come."""
        progress = self._progress
        if progress is None or not progress.pictures:
            return self.tr("nothing taken")
        if not np.isfinite(progress.worst):
            return self.tr("{0} taken, not determined yet").format(len(progress.pictures))
        return self.tr("{0} taken, worst pixel ±{1} px of {2}").format(
            len(progress.pictures), format_two_digits(progress.worst), f"{self.limit:g}"
        )

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._paint_ring(painter, QRectF((self.width() - _RING) / 2, 8, _RING, _RING))
        top = _RING + 24
        left = (self.width() - _SENSOR[0] - theme.MARGIN - _DIAL) / 2
        self._paint_sensor(painter, QRectF(left, top, *_SENSOR))
        self._paint_dial(painter, QRectF(left + _SENSOR[0] + theme.MARGIN, top, _DIAL, _DIAL))

    def _paint_ring(self, painter: QPainter, place: QRectF) -> None:
        progress, colours = self._progress, theme.current()
        worst = np.inf if progress is None else progress.worst
        share = 1.0 - np.log(max(1.0, worst / self.limit)) / np.log(_FACTOR)
        inside = place.adjusted(_LINE / 2, _LINE / 2, -_LINE / 2, -_LINE / 2)
        painter.setPen(QPen(QColor(colours.line), _LINE))
        painter.drawArc(inside, 0, _WHOLE_TURN)
        colour = colours.good if share >= 1 else colours.accent
        painter.setPen(QPen(QColor(colour), _LINE, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        if share > 0:
            painter.drawArc(inside, _WHOLE_TURN // 4, -round(share * _WHOLE_TURN))
        known = np.isfinite(worst)
        figure = self.tr("±{0} px").format(format_two_digits(worst)) if known else "–"
        self._write(painter, place.center(), figure, theme.HEADLINE, colours.text)
        below = place.center() + QPointF(0, 22)
        goal = self.tr("of {0} px").format(f"{self.limit:g}")
        self._write(painter, below, goal, theme.CAPTION, colours.muted)

    def _paint_sensor(self, painter: QPainter, room: QRectF) -> None:
        """Draw the corners of all pictures in the sensor's rectangle."""
        width, height = self._size
        scale = min(room.width() / width, room.height() / height)
        sensor = QRectF(0, 0, scale * width, scale * height)
        sensor.moveCenter(room.center())
        colours = theme.current()
        painter.setPen(QPen(QColor(colours.line), 1))
        painter.setBrush(QColor(colours.window))
        painter.drawRect(sensor)
        corners = self._list_corners()
        self._paint_points(painter, scale * (corners + 0.5) + [sensor.x(), sensor.y()], 1.2)
        self._caption(painter, room, self.tr("corners on the sensor"))

    def _paint_dial(self, painter: QPainter, place: QRectF) -> None:
        """Draw towards where the boards were tilted."""
        colours = theme.current()
        painter.setPen(QPen(QColor(colours.line), 1))
        painter.setBrush(QColor(colours.window))
        painter.drawEllipse(place)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawEllipse(place.center(), _DIAL / 4, _DIAL / 4)
        if self._progress is not None and len(self._progress.tilts):
            tilts = self._progress.tilts[:, :2] / _RIM
            tilts /= np.maximum(1.0, np.linalg.norm(tilts, axis=1))[:, None]
            middle = np.array([place.center().x(), place.center().y()])
            self._paint_points(painter, middle + _DIAL / 2 * tilts, 3.5)
        self._caption(painter, place, self.tr("tilts"))

    def _list_corners(self) -> Array:
        pictures = () if self._progress is None else self._progress.pictures.values()
        corners = [picture.corners.uv for picture in pictures]
        return np.concatenate(corners) if corners else np.empty((0, 2))

    def _paint_points(self, painter: QPainter, at: Array, radius: float) -> None:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(theme.current().bar))
        for x, y in at:
            painter.drawEllipse(QPointF(x, y), radius, radius)

    def _caption(self, painter: QPainter, place: QRectF, text: str) -> None:
        below = QPointF(place.center().x(), place.bottom() + 12)
        self._write(painter, below, text, theme.CAPTION, theme.current().muted)

    def _write(self, painter: QPainter, middle: QPointF, text: str, size: int, colour: str) -> None:
        """Write a text around a point."""
        font = theme.make_font(size, bold=size == theme.HEADLINE)
        room = QFontMetricsF(font).boundingRect(text)
        place = QRectF(0, 0, room.width() + 8, room.height() + 4)
        place.moveCenter(middle)
        painter.setFont(font)
        painter.setPen(QColor(colour))
        painter.drawText(place, int(Qt.AlignmentFlag.AlignCenter), text)
