"""The photographs of an instant beside each other, or rectified so that rows belong together."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QImage, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from calibgui.engine.images import Pixels
from calibgui.gui.widgets import theme

_GAP = 8
"""Between two photographs, device-independent px."""


class InstantView(QWidget):
    """Shows photographs as large as there is room for; a line follows the cursor across them."""

    def __init__(self) -> None:
        super().__init__()
        self._images: list[QImage] = []
        self._names: Sequence[str] = ()
        self._words = ""
        self._columns: int | None = None
        self._line: float | None = None
        """Place of the line in the first photograph, of its height (or width); None for none."""
        self.setMouseTracking(True)
        self.setMinimumSize(240, 180)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName(self.tr("Photographs of an instant"))

    def show_images(
        self, images: Sequence[Pixels], names: Sequence[str], columns: int | None = None
    ) -> None:
        """Show photographs, grey (h, w) or RGB (h, w, 3), with their names.

        Args:
            images, names: the photographs.
            columns: number of columns that they stand in; None for as many as make them largest.
                One if the columns of rectified ones belong together.
        """
        self._images, self._names = [_make_image(image) for image in images], names
        self._columns, self._words = columns, ""
        self.setAccessibleDescription(", ".join(names))
        self.update()

    def show_words(self, words: str) -> None:
        """Show words in place of photographs."""
        self._images, self._words = [], words
        self.setAccessibleDescription(words)
        self.update()

    def place_images(self) -> list[QRectF]:
        """Return the rectangles that the photographs fill."""
        count = len(self._images)
        tried = [self._columns] if self._columns else range(1, count + 1)
        arranged = [self._arrange(columns) for columns in tried]
        return max(arranged, key=lambda places: sum(place.width() for place in places), default=[])

    def _arrange(self, columns: int) -> list[QRectF]:
        """Place the photographs in so many columns."""
        rows = -(-len(self._images) // columns)
        w = (self.width() - _GAP * (columns - 1)) / columns
        h = (self.height() - _GAP * (rows - 1)) / rows
        places = []
        for k, image in enumerate(self._images):
            scale = min(w / image.width(), h / image.height())
            place = QRectF(0, 0, scale * image.width(), scale * image.height())
            row, column = divmod(k, columns)
            place.moveCenter(
                QPointF((column + 0.5) * w + column * _GAP, (row + 0.5) * h + row * _GAP)
            )
            places.append(place)
        return places

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        at, self._line = event.position(), None
        for place in self.place_images():
            if place.contains(at):
                along = (at.x() - place.x()) / place.width()
                down = (at.y() - place.y()) / place.height()
                self._line = along if self._columns == 1 else down
        self.update()

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().leaveEvent(event)
        self._line = None
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.fillRect(self.rect(), QColor(theme.current().canvas))
        if self._words:
            painter.setPen(QColor("#ffffff"))
            flags = int(Qt.AlignmentFlag.AlignCenter) | int(Qt.TextFlag.TextWordWrap)
            painter.drawText(QRectF(self.rect()).adjusted(32, 32, -32, -32), flags, self._words)
        places = self.place_images()
        for place, image, name in zip(places, self._images, self._names, strict=True):
            painter.drawImage(place, image)
            self._paint_name(painter, place, name)
            if self._line is not None:
                painter.setPen(QPen(theme.REGION, 1))
                x, y = (
                    place.x() + self._line * place.width(),
                    place.y() + self._line * place.height(),
                )
                if self._columns == 1:
                    painter.drawLine(QPointF(x, place.top()), QPointF(x, place.bottom()))
                else:
                    painter.drawLine(QPointF(place.left(), y), QPointF(place.right(), y))

    def _paint_name(self, painter: QPainter, place: QRectF, name: str) -> None:
        card = QRectF(painter.fontMetrics().boundingRect(name)).adjusted(-8, -4, 8, 4)
        card.moveTopLeft(place.topLeft() + QPointF(8, 8))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(0, 0, 0, 170))
        painter.drawRoundedRect(card, theme.SMALL_RADIUS, theme.SMALL_RADIUS)
        painter.setPen(QColor("#ffffff"))
        painter.drawText(card, int(Qt.AlignmentFlag.AlignCenter), name)


def _make_image(image: Pixels) -> QImage:
    """Return an image of Qt's, which owns its memory."""
    small = image if image.dtype == np.uint8 else image >> 8
    pixels = np.ascontiguousarray(small, dtype=np.uint8)
    kind = QImage.Format.Format_Grayscale8 if pixels.ndim == 2 else QImage.Format.Format_RGB888
    height, width = pixels.shape[:2]
    return QImage(pixels.data, width, height, pixels.strides[0], kind).copy()
