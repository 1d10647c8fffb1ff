"""Two images in one place, with a divider that slides between them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QImage, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from calibgui.gui import theme

Grey = npt.NDArray[np.uint8]


class BeforeAfter(QWidget):
    """The first image left of the divider, the second right of it; drag it, or use the arrows."""

    def __init__(self, before: str, after: str) -> None:
        super().__init__()
        self._names = (before, after)
        self._images: tuple[QImage, ...] = ()
        self.divider = 0.5
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumSize(160, 120)
        self.setToolTip(self.tr("Drag to slide the divider."))

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        return QSize(640, 480)

    def show_images(self, before: Grey | None, after: Grey | None) -> None:
        """Compare two images (h, w); without the first the second alone is shown, or nothing."""
        given = [image for image in (before, after) if image is not None]
        self._images = tuple(_as_qimage(image) for image in given)
        self.update()

    @property
    def frame(self) -> QRectF:
        """Where the images are."""
        if not self._images:
            return QRectF()
        size = self._images[-1].size().scaled(self.size(), Qt.AspectRatioMode.KeepAspectRatio)
        frame = QRectF(0, 0, size.width(), size.height())
        frame.moveCenter(QRectF(self.rect()).center())
        return frame

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.fillRect(self.rect(), QColor(theme.current().canvas))
        if not self._images:
            return
        frame = self.frame
        painter.drawImage(frame, self._images[-1])
        if len(self._images) == 2:
            self._paint_before(painter, frame)

    def _paint_before(self, painter: QPainter, frame: QRectF) -> None:
        before, after = self._images[0], self._names[1]
        x = frame.left() + self.divider * frame.width()
        painter.save()
        painter.setClipRect(
            QRectF(frame.topLeft(), frame.bottomLeft()).adjusted(0, 0, x - frame.left(), 0)
        )
        painter.drawImage(frame, before)
        painter.restore()
        for pen in (QPen(theme.HALO, 4), QPen(QColor(theme.current().accent), 2)):
            painter.setPen(pen)
            painter.drawLine(round(x), round(frame.top()), round(x), round(frame.bottom()))
        left, right = (
            frame.adjusted(0, 0, x - frame.right(), 0),
            frame.adjusted(x - frame.left(), 0, 0, 0),
        )
        self._label(painter, left, self._names[0], Qt.AlignmentFlag.AlignLeft)
        self._label(painter, right, after, Qt.AlignmentFlag.AlignRight)

    def _label(self, painter: QPainter, part: QRectF, text: str, side: Qt.AlignmentFlag) -> None:
        """The name of an image in a lower corner of its part, if that is wide enough."""
        metrics = painter.fontMetrics()
        box = QRectF(0, 0, metrics.horizontalAdvance(text) + 12, metrics.height() + 6)
        if box.width() + 8 > part.width():
            return
        box.moveBottom(part.bottom() - 4)
        if side is Qt.AlignmentFlag.AlignLeft:
            box.moveLeft(part.left() + 4)
        else:
            box.moveRight(part.right() - 4)
        painter.fillRect(box, theme.HALO)
        painter.setPen(QColor("#ffffff"))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        self._move_to(event.position().x())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._move_to(event.position().x())

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        step = {Qt.Key.Key_Left: -0.05, Qt.Key.Key_Right: 0.05}.get(Qt.Key(event.key()))
        if step is None:
            super().keyPressEvent(event)
        else:
            self._slide(self.divider + step)

    def _move_to(self, x: float) -> None:
        frame = self.frame
        if frame.width() > 0:
            self._slide((x - frame.left()) / frame.width())

    def _slide(self, divider: float) -> None:
        self.divider = min(max(divider, 0.0), 1.0)
        self.update()


def _as_qimage(grey: Grey) -> QImage:
    """A copy of the pixels as Qt's image."""
    rows = np.ascontiguousarray(grey)
    height, width = rows.shape
    return QImage(rows.data, width, height, width, QImage.Format.Format_Grayscale8).copy()
