"""The row of thumbnails, each over a bar for its error, with one threshold across all bars."""

from __future__ import annotations

from PySide6.QtCore import (
    QEvent,
    QModelIndex,
    QPersistentModelIndex,
    QPoint,
    QPointF,
    QRect,
    QRectF,
    QSize,
    Qt,
    Signal,
)
from PySide6.QtGui import QColor, QFont, QMouseEvent, QPainter, QPaintEvent, QPen, QPixmap
from PySide6.QtWidgets import QListView, QStyle, QStyledItemDelegate, QStyleOptionViewItem

from calibgui.gui.images.image_model import ImageModel, Role
from calibgui.gui.images.thumbnails import THUMBNAIL
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.focus_ring import FocusRing

_PAD = 4
"""Around what stands in a cell, px."""
_CHART = 24
"""Least height of the bars' place, px; without a scroll bar there is more."""
_BAR = 24
"""Width of a bar, px."""
_HEADROOM = 1.15
"""Height of the chart, in largest errors."""
_GRAB = 4
"""Distance from which the threshold is dragged, px."""
_RIM = 2
"""Height of what the frame of the current image, which is drawn over it, covers below, px."""
_SMALL = 0.82
"""Size of the text in a cell, in sizes of the window's."""
_FADED = 0.35
"""Opacity of what has no part in the calibration."""
Index = QModelIndex | QPersistentModelIndex


class Cell:
    """Says where in a cell its parts stand; all cells are alike."""

    SIZE = QSize(THUMBNAIL.width() + 2 * _PAD, THUMBNAIL.height() + _CHART + 3 * _PAD)

    def __init__(self, rect: QRect) -> None:
        left, top = rect.left() + _PAD, rect.top() + _PAD
        self.thumbnail = QRect(QPoint(left, top), THUMBNAIL)
        below = self.thumbnail.bottom() + 1 + _PAD
        height = max(_CHART, rect.bottom() + 1 - _PAD - below)
        self.chart = QRect(left, below, THUMBNAIL.width(), height)


class FilmView(QListView):
    """Shows the images side by side; the threshold across their bars is dragged."""

    threshold_dragged = Signal(float)
    """The threshold was dragged to this error, px."""
    left = Signal()
    """The cursor is over no image any more."""

    def __init__(self, model: ImageModel) -> None:
        super().__init__()
        self._source = model
        self._threshold: float | None = None
        self.hovered = ""
        """Image that the cursor is over, here or elsewhere; its cell gets a frame."""
        self._drags = False
        self._pressed: QMouseEvent | None = None
        """The press on the threshold, until the mouse moves."""
        self.setItemDelegate(_Delegate(self))
        self.setFlow(QListView.Flow.LeftToRight)
        self.setWrapping(False)
        self.setUniformItemSizes(True)
        self.setSelectionMode(QListView.SelectionMode.ExtendedSelection)
        self.setHorizontalScrollMode(QListView.ScrollMode.ScrollPerPixel)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setMouseTracking(True)
        FocusRing(self)
        bar = self.style().pixelMetric(QStyle.PixelMetric.PM_ScrollBarExtent)
        self.setFixedHeight(Cell.SIZE.height() + bar + 2 * self.frameWidth())

    @property
    def top(self) -> float:
        """Error at the top of the chart, px; 0 without a result."""
        return _HEADROOM * self._source.worst

    @property
    def threshold(self) -> float:
        """Error from which on a view stands out, px."""
        return self.top if self._threshold is None else self._threshold

    def set_threshold(self, error: float | None) -> None:
        """Draw the threshold at an error, px; None is above all views."""
        self._threshold = error
        self.viewport().update()

    def show_hovered(self, image: str) -> None:
        """Frame the cell of an image that the cursor is over, here or elsewhere."""
        self.hovered = image
        self.viewport().update()

    def place_of(self, error: float) -> float:
        """Return the height of an error in the viewport, px from its upper edge."""
        chart = self._chart
        share = error / self.top if self.top else 0.0
        return chart.bottom() + 1 - min(share, 1.0) * chart.height()

    @property
    def _chart(self) -> QRect:
        """Place of the bars in the first cell; in all others it is as high."""
        return Cell(QRect(0, 0, Cell.SIZE.width(), self.viewport().height())).chart

    def _error_at(self, y: float) -> float:
        """Return the error whose place is `y`."""
        chart = self._chart
        share = (chart.bottom() + 1 - y) / chart.height()
        return min(max(share, 0.0), 1.0) * self.top

    def _is_at_threshold(self, event: QMouseEvent) -> bool:
        distance = abs(event.position().y() - self.place_of(self.threshold))
        return self.top > 0 and distance <= _GRAB

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().leaveEvent(event)
        self.left.emit()

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        self._drags = event.button() is Qt.MouseButton.LeftButton and self._is_at_threshold(event)
        if self._drags:
            self._pressed = event.clone()
        else:
            super().mousePressEvent(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        if self._drags:
            self._pressed = None
            self._threshold = self._error_at(event.position().y())
            self.viewport().update()
            self.threshold_dragged.emit(self._threshold)
            return
        shape = Qt.CursorShape.SizeVerCursor if self._is_at_threshold(event) else None
        if shape is None:
            self.viewport().unsetCursor()
        else:
            self.viewport().setCursor(shape)
        super().mouseMoveEvent(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 - Qt's name
        drags, self._drags = self._drags, False
        if drags and self._pressed is not None:  # the click meant the image behind the line
            super().mousePressEvent(self._pressed)
        if not drags or self._pressed is not None:
            super().mouseReleaseEvent(event)
        self._pressed = None

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 - Qt's name
        super().paintEvent(event)
        if self.top <= 0:
            return
        painter = QPainter(self.viewport())
        y = self.place_of(self.threshold)
        painter.setPen(QPen(QColor(theme.current().bad), 2))
        painter.drawLine(QPointF(0, y), QPointF(self.viewport().width(), y))
        painter.end()


class _Delegate(QStyledItemDelegate):
    """Draws a thumbnail with its name over the bar and the number of its error."""

    def __init__(self, view: FilmView) -> None:
        super().__init__(view)
        self._view = view

    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:  # noqa: N802, ARG002
        return Cell.SIZE

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colours, cell = theme.current(), Cell(option.rect)
        font = QFont(option.font)
        font.setPointSizeF(_SMALL * font.pointSizeF())
        painter.setFont(font)
        if option.state & QStyle.StateFlag.State_Selected:
            tint = QColor(colours.accent)
            tint.setAlphaF(_FADED)
            painter.fillRect(option.rect, tint)
        self._draw_thumbnail(painter, cell.thumbnail, index)
        is_current = index == self._view.currentIndex()
        if is_current or index.data(Role.PATH) == self._view.hovered:
            painter.setPen(QPen(QColor(colours.accent), 3 if is_current else 1))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(cell.thumbnail)
        rms = index.data(Role.RMS)
        if rms is None:
            painter.setPen(QColor(colours.text))
            flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
            painter.drawText(cell.chart, flags, index.data(Role.STATUS))
        else:
            self._draw_error(painter, cell.chart, rms, index)
        painter.restore()

    def _draw_thumbnail(self, painter: QPainter, frame: QRect, index: Index) -> None:
        painter.fillRect(frame, QColor(theme.current().line))
        pixmap: QPixmap | None = index.data(Qt.ItemDataRole.DecorationRole)
        if pixmap is not None:
            size = pixmap.size().scaled(frame.size(), Qt.AspectRatioMode.KeepAspectRatio)
            board = QRect(QPoint(), size)
            board.moveCenter(frame.center())
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            painter.setOpacity(1.0 if index.data(Role.ENABLED) else _FADED)
            painter.drawPixmap(board, pixmap)
            painter.setOpacity(1.0)
        metrics = painter.fontMetrics()
        # Higher than the name by the rim of the current image, which is drawn over it.
        patch = QRectF(frame).adjusted(0, frame.height() - metrics.height() - _RIM, 0, 0)
        painter.fillRect(patch, theme.HALO)
        painter.setPen(QColor("#ffffff"))
        dot = metrics.height() // 2
        name = metrics.elidedText(
            index.data(), Qt.TextElideMode.ElideLeft, frame.width() - dot - 3 * _PAD // 2
        )
        words = patch.adjusted(_PAD / 2, 0, 0, -_RIM)
        painter.drawText(words, _LEFT, name)
        painter.setPen(QPen(QColor("#ffffff"), 1))
        painter.setBrush(index.data(Role.COLOUR))
        centre = QPointF(patch.right() - dot / 2 - _PAD / 2, patch.center().y())
        painter.drawEllipse(centre, dot / 2, dot / 2)

    def _draw_error(self, painter: QPainter, chart: QRect, rms: float, index: Index) -> None:
        colours, view = theme.current(), self._view
        top = chart.bottom() + 1 - round(chart.height() * min(rms / view.top, 1.0))
        bar = QRect(chart.left(), min(top, chart.bottom()), _BAR, 0)
        bar.setBottom(chart.bottom())
        painter.fillRect(bar, index.data(Role.VIEW_COLOUR))
        stands_out = rms > view.threshold
        if stands_out:
            painter.setPen(QPen(QColor(colours.bad), 2))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(bar)
        painter.setPen(QColor(colours.bad if stands_out else colours.text))
        beside = chart.adjusted(_BAR + _PAD, 0, 0, 0)
        painter.drawText(
            beside, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignBottom, f"{rms:.3f}"
        )


_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
