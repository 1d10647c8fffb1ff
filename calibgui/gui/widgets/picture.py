"""An image as an item of a scene, sharp at any zoom."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, log2

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QImage, QPainter, QPixmap
from PySide6.QtWidgets import QGraphicsItem, QStyleOptionGraphicsItem, QWidget

from calibgui.engine import opencv
from calibgui.engine.images import Image

_SMALLEST = 256
_PIXELS_SHOW = 3.0
"""Zoom from which pixels are drawn as squares."""

Levels = tuple[QImage, ...]


def make_qimage(grey: npt.NDArray[np.uint8]) -> QImage:
    """(h, w) grey levels as an image of Qt's, which owns its memory."""
    height, width = grey.shape
    data = np.ascontiguousarray(grey)
    return QImage(data.data, width, height, width, QImage.Format.Format_Grayscale8).copy()


def shrink_picture(picture: QImage, size: QSize, ratio: float) -> QPixmap:
    """Return a picture as large as fits a size, device-independent px, for a screen."""
    small = picture.scaled(
        size * ratio,
        Qt.AspectRatioMode.KeepAspectRatio,
        Qt.TransformationMode.SmoothTransformation,
    )
    pixmap = QPixmap.fromImage(small)
    pixmap.setDevicePixelRatio(ratio)
    return pixmap


def stretch_levels(image: Image) -> Levels:
    """The image, and halves of it for smaller zooms: made in a worker."""
    grey = image.grey
    found = [make_qimage(grey)]
    while min(grey.shape) > _SMALLEST:
        grey = np.asarray(opencv.halve_image(grey), dtype=np.uint8)
        found.append(make_qimage(grey))
    return tuple(found)


class Picture(QGraphicsItem):
    """Pixel (u, v) covers the square of side 1 around the point (u, v)."""

    def __init__(self) -> None:
        super().__init__()
        self._levels: Levels = ()
        self._pixmaps: dict[int, QPixmap] = {}

    def show_levels(self, images: Sequence[QImage]) -> None:
        """Show an image; none if empty."""
        self.prepareGeometryChange()
        self._levels, self._pixmaps = tuple(images), {}
        self.update()

    def boundingRect(self) -> QRectF:  # noqa: N802 - Qt's name
        if not self._levels:
            return QRectF()
        return QRectF(-0.5, -0.5, self._levels[0].width(), self._levels[0].height())

    def paint(
        self, painter: QPainter, option: QStyleOptionGraphicsItem, widget: QWidget | None = None
    ) -> None:
        if not self._levels:
            return
        ratio = 1.0 if widget is None else widget.devicePixelRatioF()
        zoom = option.levelOfDetailFromTransform(painter.worldTransform()) * ratio
        level = min(max(floor(-log2(zoom)), 0), len(self._levels) - 1)
        if level not in self._pixmaps:
            self._pixmaps[level] = QPixmap.fromImage(self._levels[level])
        smooth = QPainter.RenderHint.SmoothPixmapTransform
        painter.setRenderHint(smooth, zoom < _PIXELS_SHOW)
        # Halving drops odd edges: a level covers a whole number of its own pixels.
        image, size = self._levels[level], 2.0**level
        board = QRectF(-0.5, -0.5, image.width() * size, image.height() * size)
        painter.drawPixmap(board, self._pixmaps[level], QRectF(image.rect()))
