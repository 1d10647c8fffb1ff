"""The row of thumbnails, each over a bar for its error, with one threshold across all bars."""

from __future__ import annotations

from pathlib import PurePath

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
from PySide6.QtGui import (
    QColor,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
    QPixmap,
    QPixmapCache,
    QResizeEvent,
)
from PySide6.QtWidgets import QListView, QStyle, QStyledItemDelegate, QStyleOptionViewItem

from calibgui.engine.numbers import format_two_digits
from calibgui.gui.images.image_model import ImageModel, Role
from calibgui.gui.images.thumbnails import THUMBNAIL
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.focus_ring import FocusRing
from calibgui.gui.widgets.scrolling import SCROLL_BAR_WIDTH, make_thin

_PAD, _GAP = 4, 5
"""Around what stands in a cell, and between picture, chart and words, px."""
_CHART, _WORDS = 28, 16
"""Least height of the bars' place, which is higher without a scroll bar, and of the words, px."""
_HEADROOM = 1.15
"""Height of the chart, in largest errors."""
_GRAB = 4
"""Distance from which the threshold is dragged, px."""
_STEPS = 40
"""Steps by which keys move the threshold through the chart."""
_FADED = 0.35
"""Opacity of what has no part in the calibration."""
_WIDEST = 2.2
"""Ratio of width to height up to which a picture fills its place, cut at two sides."""
Index = QModelIndex | QPersistentModelIndex


class Cell:
    """Says where in a cell its parts stand; all cells are alike."""

    SIZE = QSize(
        THUMBNAIL.width() + 2 * _PAD, THUMBNAIL.height() + _CHART + _WORDS + 2 * _GAP + 2 * _PAD
    )

    def __init__(self, rect: QRect) -> None:
        left, top = rect.left() + _PAD, rect.top() + _PAD
        self.thumbnail = QRect(QPoint(left, top), THUMBNAIL)
        below = self.thumbnail.bottom() + 1 + _GAP
        height = max(_CHART, rect.bottom() + 1 - _PAD - _WORDS - _GAP - below)
        self.chart = QRect(left, below, THUMBNAIL.width(), height)
        self.words = QRect(left, below + height + 1, THUMBNAIL.width(), _WORDS)


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
        self.setFrameShape(QListView.Shape.NoFrame)
        make_thin(self)
        FocusRing(self)
        self.setFixedHeight(Cell.SIZE.height() + SCROLL_BAR_WIDTH)
        self.words = Button("", Kind.LINK)
        """What the threshold is good for, at its right end; a button that does it."""
        self.words.setParent(self.viewport())
        self.words.setFont(theme.make_font(theme.CAPTION))
        self.words.setAutoFillBackground(True)
        self.words.setBackgroundRole(self.backgroundRole().Base)
        self.words.hide()

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
        self.place_words()
        self.viewport().update()

    def place_words(self) -> None:
        """Put the words at the right end of the threshold, and show them once it was moved."""
        self.words.setVisible(self._threshold is not None and self.top > 0)
        self.words.adjustSize()
        y = round(self.place_of(self.threshold)) - self.words.height()
        self.words.move(self.viewport().width() - self.words.width() - _PAD, y)

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
            self._move_threshold(self._error_at(event.position().y()))
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

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        """Let the keys that go nowhere in a row move the threshold."""
        step = {Qt.Key.Key_Up: 1, Qt.Key.Key_Down: -1}.get(Qt.Key(event.key()))
        if step is None or self.top <= 0:
            super().keyPressEvent(event)
        else:
            error = self.threshold + step * self.top / _STEPS
            self._move_threshold(min(max(error, 0.0), self.top))

    def _move_threshold(self, error: float) -> None:
        self.set_threshold(error)
        self.threshold_dragged.emit(error)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self.place_words()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 - Qt's name
        super().paintEvent(event)
        if self.top <= 0:
            return
        painter, colours = QPainter(self.viewport()), theme.current()
        y = round(self.place_of(self.threshold)) + 0.5
        colour = colours.muted if self._threshold is None else colours.bad
        painter.setPen(QPen(QColor(colour), 1, Qt.PenStyle.DashLine))
        painter.drawLine(QPointF(0, y), QPointF(self.viewport().width(), y))
        painter.end()


class _Delegate(QStyledItemDelegate):
    """Draws a thumbnail over the bar of its error, with its name and the number below."""

    def __init__(self, view: FilmView) -> None:
        super().__init__(view)
        self._view = view

    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:  # noqa: N802, ARG002
        return Cell.SIZE

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colours, cell = theme.current(), Cell(option.rect)
        painter.setFont(theme.make_font(theme.CAPTION))
        if option.state & QStyle.StateFlag.State_Selected:
            tint = QColor(colours.accent)
            tint.setAlphaF(_FADED / 2)
            painter.fillRect(option.rect, tint)
        self._draw_thumbnail(painter, cell.thumbnail, index)
        is_current = index == self._view.currentIndex()
        if is_current or index.data(Role.PATH) == self._view.hovered:
            painter.setPen(QPen(QColor(colours.accent), 3 if is_current else 1))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(cell.thumbnail, theme.SMALL_RADIUS, theme.SMALL_RADIUS)
        rms = index.data(Role.RMS)
        if rms is None:
            painter.setPen(QColor(colours.muted))
            flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
            painter.drawText(cell.chart, int(flags), index.data(Role.STATUS))
        else:
            self._draw_error(painter, cell, rms)
        self._draw_words(painter, cell.words, "" if rms is None else format_two_digits(rms), index)
        painter.restore()

    def _draw_thumbnail(self, painter: QPainter, frame: QRect, index: Index) -> None:
        """Draw a picture with round corners, which is made once for its size."""
        pixmap, enabled = index.data(Qt.ItemDataRole.DecorationRole), index.data(Role.ENABLED)
        ratio, ground = painter.device().devicePixelRatioF(), theme.current().line
        key = f"{pixmap and pixmap.cacheKey()} {enabled} {ratio} {ground}"
        drawn = QPixmap()
        if not QPixmapCache.find(key, drawn):
            drawn = QPixmap(frame.size() * ratio)
            drawn.setDevicePixelRatio(ratio)
            drawn.fill(Qt.GlobalColor.transparent)
            within = QPainter(drawn)
            within.setRenderHint(QPainter.RenderHint.Antialiasing)
            self._shape_thumbnail(within, QRect(QPoint(), frame.size()), pixmap, enabled)
            within.end()
            QPixmapCache.insert(key, drawn)
        painter.drawPixmap(frame.topLeft(), drawn)

    def _shape_thumbnail(
        self, painter: QPainter, frame: QRect, pixmap: QPixmap | None, enabled: bool
    ) -> None:
        shape = QPainterPath()
        shape.addRoundedRect(QRectF(frame), theme.SMALL_RADIUS, theme.SMALL_RADIUS)
        painter.setClipPath(shape)
        painter.fillRect(frame, QColor(theme.current().line))
        if pixmap is not None:
            size = pixmap.size()
            is_usual = size.height() <= size.width() <= _WIDEST * size.height()
            mode = Qt.AspectRatioMode
            scaled = size.scaled(
                frame.size(), mode.KeepAspectRatioByExpanding if is_usual else mode.KeepAspectRatio
            )
            board = QRect(QPoint(), scaled)
            board.moveCenter(frame.center())
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            painter.setOpacity(1.0 if enabled else _FADED)
            painter.drawPixmap(board, pixmap)

    def _draw_words(self, painter: QPainter, words: QRect, number: str, index: Index) -> None:
        """Write the name, with a dot for the state and one in the view's colour, and the error."""
        colours, metrics = theme.current(), painter.fontMetrics()
        painter.setPen(QColor(colours.muted))
        painter.drawText(words, int(_RIGHT), number)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(index.data(Role.VIEW_COLOUR if number else Role.COLOUR))
        dot = QRectF(words.left() + 1, words.center().y() - 2.5, 6, 6)
        painter.drawEllipse(dot)
        painter.setPen(QColor(colours.text))
        rest = words.adjusted(10, 0, -metrics.horizontalAdvance(number) - _PAD, 0)
        name = metrics.elidedText(
            PurePath(index.data()).stem, Qt.TextElideMode.ElideLeft, rest.width()
        )
        painter.drawText(rest, int(_LEFT), name)

    def _draw_error(self, painter: QPainter, cell: Cell, rms: float) -> None:
        colours, view, chart = theme.current(), self._view, cell.chart
        height = round(chart.height() * min(rms / view.top, 1.0))
        bar = QRect(chart.left(), chart.bottom() + 1 - height, chart.width(), height)
        colour = QColor(colours.bad if rms > view.threshold else colours.bar)
        painter.fillRect(bar, colour)


_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
