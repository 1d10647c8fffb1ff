"""Two images in one place, with a divider that slides between them, to be looked at closely."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import (
    QColor,
    QImage,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QWheelEvent,
)
from PySide6.QtWidgets import QWidget

from calibgui.gui.widgets import theme
from calibgui.gui.widgets.plots import offer_picture

Grey = npt.NDArray[np.uint8]

_STEP = 1.25
"""Magnification by one notch of the wheel."""
_NEAREST = 16.0
"""Largest pixel of an image, device-independent px."""
_GRAB = 12.0
"""Distance within which the divider is meant, device-independent px."""


class DividedImages(QWidget):
    """The first image left of the divider, the second right of it.

    The divider is dragged or moved by the arrow keys; the wheel and the keys + and - magnify
    both images alike, dragging moves them then, and 0 shows them whole again.
    """

    def __init__(self, before: str, after: str) -> None:
        super().__init__()
        self._names = (before, after)
        self._images: tuple[QImage, ...] = ()
        self.divider = 0.5
        """Its place in the visible part of the images, 0 to 1."""
        self._zoom = 1.0
        self._middle = QPointF(0.5, 0.5)
        """Point of the image at the widget's centre, in widths and heights of the image."""
        self._pan_from: QPointF | None = None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName(self.tr("Image {0} and {1}").format(before, after))
        self.setMinimumSize(160, 120)
        offer_picture(self)
        self.setToolTip(
            self.tr(
                "Drag the divider, or move it by the arrow keys. The wheel magnifies (+ and −); "
                "drag to look around, double-click or 0 for the whole image."
            )
        )

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        return QSize(640, 480)

    def set_names(self, before: str, after: str) -> None:
        """Say anew what the two images are."""
        self._names = (before, after)
        self.update()

    def show_images(self, before: Grey | None, after: Grey | None) -> None:
        """Compare two images (h, w); without the first the second alone is shown, or nothing."""
        given = [image for image in (before, after) if image is not None]
        sizes = [image.size() for image in self._images[-1:]]
        self._images = tuple(_as_qimage(image) for image in given)
        if sizes != [image.size() for image in self._images[-1:]]:
            self.fit()
        self.update()

    def fit(self) -> None:
        """Show all of the images."""
        self._zoom, self._middle = 1.0, QPointF(0.5, 0.5)
        self.update()

    def zoom_at(self, factor: float, at: QPointF) -> None:
        """Magnify, keeping what is under `at` in its place."""
        if not self._images:
            return
        frame, before = self.frame, self._zoom
        nearest = _NEAREST * self._images[-1].width() * before / frame.width()
        self._zoom = min(max(before * factor, 1.0), max(nearest, 1.0))
        self._move_centre(at + (frame.center() - at) * (self._zoom / before))

    @property
    def frame(self) -> QRectF:
        """Rectangle of the images, in part outside the widget if they are magnified."""
        if not self._images:
            return QRectF()
        size = self._images[-1].size().scaled(self.size(), Qt.AspectRatioMode.KeepAspectRatio)
        width, height = self._zoom * size.width(), self._zoom * size.height()
        middle = QRectF(self.rect()).center()
        corner = middle - QPointF(self._middle.x() * width, self._middle.y() * height)
        return QRectF(corner.x(), corner.y(), width, height)

    @property
    def _visible(self) -> QRectF:
        return self.frame & QRectF(self.rect())

    @property
    def _line(self) -> float:
        """Place of the divider."""
        return self._visible.left() + self.divider * self._visible.width()

    def _move_centre(self, to: QPointF) -> None:
        """Move the images' centre, as far as no more of them is hidden than must be."""
        size, centre = self.frame.size(), QRectF(self.rect()).center()

        def place(shift: float, length: float, room: float) -> float:
            spare = max((length - room) / 2, 0.0)
            return 0.5 + min(max(shift, -spare), spare) / length

        self._middle = QPointF(
            place(centre.x() - to.x(), size.width(), self.width()),
            place(centre.y() - to.y(), size.height(), self.height()),
        )
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(theme.current().canvas))
        if not self._images:
            return
        frame = self.frame
        if frame.width() < 4 * self._images[-1].width():  # beyond, its pixels are looked at
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.drawImage(frame, self._images[-1])
        if len(self._images) == 2:
            self._paint_before(painter, frame, self._visible)

    def _paint_before(self, painter: QPainter, whole: QRectF, frame: QRectF) -> None:
        before, after = self._images[0], self._names[1]
        x = self._line
        painter.save()
        painter.setClipRect(
            QRectF(frame.topLeft(), frame.bottomLeft()).adjusted(0, 0, x - frame.left(), 0)
        )
        painter.drawImage(whole, before)
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
        at, left = event.position(), event.button() is Qt.MouseButton.LeftButton
        divides = len(self._images) == 2 and abs(at.x() - self._line) <= _GRAB
        if self._zoom > 1 and not (left and divides):
            self._pan_from = at
        elif left:
            self._move_to(at.x())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        at = event.position()
        if self._pan_from is not None:
            shift, self._pan_from = at - self._pan_from, at
            self._move_centre(self.frame.center() + shift)
        elif event.buttons() & Qt.MouseButton.LeftButton:
            self._move_to(at.x())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        self._pan_from = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        self.fit()

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802 - Qt's name
        if notches := event.angleDelta().y() / 120:
            self.zoom_at(_STEP**notches, event.position())
        event.accept()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        middle = QRectF(self.rect()).center()
        match event.key():
            case Qt.Key.Key_Left:
                self._slide(self.divider - 0.05)
            case Qt.Key.Key_Right:
                self._slide(self.divider + 0.05)
            case Qt.Key.Key_Plus | Qt.Key.Key_Equal:
                self.zoom_at(_STEP, middle)
            case Qt.Key.Key_Minus:
                self.zoom_at(1 / _STEP, middle)
            case Qt.Key.Key_0:
                self.fit()
            case _:
                super().keyPressEvent(event)

    def _move_to(self, x: float) -> None:
        visible = self._visible
        if visible.width() > 0:
            self._slide((x - visible.left()) / visible.width())

    def _slide(self, divider: float) -> None:
        self.divider = min(max(divider, 0.0), 1.0)
        self.update()


def _as_qimage(grey: Grey) -> QImage:
    """A copy of the pixels as Qt's image."""
    rows = np.ascontiguousarray(grey)
    height, width = rows.shape
    return QImage(rows.data, width, height, width, QImage.Format.Format_Grayscale8).copy()
