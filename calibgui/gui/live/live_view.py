"""The live image, with the board that is seen and the place where it is wanted next."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSizeF, Qt, QTimer
from PySide6.QtGui import QColor, QFontMetricsF, QImage, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.capture import CaptureState
from calibgui.gui.canvas.layers import choose_arm_length, draw_rings
from calibgui.gui.live.frame_image import make_frame_image
from calibgui.gui.widgets import theme

_LETTERS = 24
"""Height of the words over the image, px: they are read from where the board is held."""
_MARGIN = 16
_FILL = 50
"""Opacity of the place where the board is wanted, of 255."""
_FLASH = 180
"""Time for which the frame of a taken image lights up, ms."""


class LiveView(QWidget):
    """Shows the newest image as large as there is room for.

    Args:
        name: what the camera is called, among several; empty for a single one.
    """

    def __init__(self, name: str = "") -> None:
        super().__init__()
        self._name = name
        self._image: QImage | None = None
        self._size = (1, 1)
        """Width and height of the camera's images, px."""
        self._state: CaptureState | None = None
        self._goal: Array | None = None
        self._words = ""
        self._flash = QTimer(self, singleShot=True, interval=_FLASH)
        self._flash.timeout.connect(self.update)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)  # what lies below is not painted
        self.setMinimumSize(240, 180)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName(name or self.tr("Live image"))

    def show_image(self, image: GreyImage) -> None:
        """Show an image, grey (h, w) or RGB (h, w, 3), of 8 bits or more."""
        self._size = image.shape[1], image.shape[0]
        self._image = make_frame_image(image, QSizeF(self.size()) * self.devicePixelRatioF())
        self.update()

    def show_state(self, state: CaptureState | None, words: str, goal: Array | None) -> None:
        """Show where the board is, what to do, and where its corners (rows, cols, 2) are wanted."""
        self._state, self._words, self._goal = state, words, goal
        self.setAccessibleDescription(words)
        if state is not None and state.taken is not None:
            self._flash.start()
        self.update()

    def show_words(self, words: str) -> None:
        """Show words in place of what to do."""
        self._words = words
        self.setAccessibleDescription(words)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        painter.setRenderHints(
            QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform
        )
        painter.fillRect(self.rect(), QColor(theme.current().canvas))
        if self._image is not None:
            painter.drawImage(self._place, self._image)
            if (state := self._state) is not None:
                self._paint_marks(painter, state)
            if self._flash.isActive():
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.setPen(QPen(QColor("#ffffff"), 10))
                painter.drawRect(self._place.adjusted(5, 5, -5, -5))
        if self._name:
            self._paint_text(painter, self._name, theme.HEADLINE, is_above=True)
        if self._words:
            self._paint_text(painter, self._words, _LETTERS, is_above=False)

    @property
    def _place(self) -> QRectF:
        """The rectangle that the image fills."""
        width, height = self._size
        scale = min(self.width() / width, self.height() / height)
        w, h = scale * width, scale * height
        return QRectF((self.width() - w) / 2, (self.height() - h) / 2, w, h)

    def _to_screen(self, uv: Array) -> Array:
        place = self._place
        return (uv + 0.5) * (place.width() / self._size[0]) + [place.x(), place.y()]

    def _paint_marks(self, painter: QPainter, state: CaptureState) -> None:
        painter.save()
        painter.setClipRect(self._place)
        if self._goal is not None:
            self._paint_goal(painter, self._to_screen(self._goal))
        if state.corners is not None:
            uv = self._to_screen(state.corners.uv)
            draw_rings(painter, uv, theme.PATH, min(3.0, choose_arm_length(uv)))
        painter.restore()

    def _paint_goal(self, painter: QPainter, goal: Array) -> None:
        """Draw the lattice of corners (rows, cols, 2) where it is wanted, and its shape filled."""
        lines = [*goal, *goal.transpose(1, 0, 2)]
        outline = np.concatenate([goal[0], goal[1:, -1], goal[-1, -2::-1], goal[-2:0:-1, 0]])
        fill = QColor(theme.REGION)
        fill.setAlpha(_FILL)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(fill)
        painter.drawPolygon(_make_polygon(outline))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        fine = QColor(theme.REGION)
        fine.setAlpha(3 * _FILL)
        painter.setPen(QPen(fine, 1))
        for line in lines:
            painter.drawPolyline(_make_polygon(line))
        painter.setPen(QPen(theme.REGION, 3))
        painter.drawPolygon(_make_polygon(outline))

    def _paint_text(self, painter: QPainter, text: str, letters: int, is_above: bool) -> None:
        """Write a text in the middle of the lower edge, or in the upper left corner, on dark
        ground."""
        font = theme.make_font(letters, bold=True)
        metrics = QFontMetricsF(font)
        room = QRectF(self.rect()).adjusted(2 * _MARGIN, _MARGIN, -2 * _MARGIN, -_MARGIN)
        flags = int(Qt.AlignmentFlag.AlignCenter) | int(Qt.TextFlag.TextWordWrap)
        needed = metrics.boundingRect(room, flags, text)
        card = QRectF(0, 0, needed.width() + 2 * _MARGIN, needed.height() + _MARGIN)
        if is_above:
            card.moveTopLeft(QPointF(_MARGIN, _MARGIN))
        else:
            middle = self.height() - _MARGIN - card.height() / 2
            card.moveCenter(QPointF(self.width() / 2, middle))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(0, 0, 0, 170))
        painter.drawRoundedRect(card, theme.RADIUS, theme.RADIUS)
        painter.setFont(font)
        painter.setPen(QColor("#ffffff"))
        painter.drawText(card, flags, text)


def _make_polygon(uv: Array) -> QPolygonF:
    return QPolygonF([QPointF(u, v) for u, v in uv])
