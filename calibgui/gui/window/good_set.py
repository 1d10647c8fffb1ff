"""Pictures of the welcome page: where to drop photographs, and what a good set of them is like."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import (
    QColor,
    QImage,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
    QPixmap,
    QPolygonF,
    QShowEvent,
    QTransform,
)
from PySide6.QtWidgets import QGridLayout, QLabel, QSizePolicy, QWidget

from calibgui.app.photographs.image_store import read_thumbnail
from calibgui.app.system.resources import find_resource
from calibgui.gui.jobs.jobs import PICTURE, Jobs
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import make_column
from calibgui.gui.widgets.picture import make_qimage, shrink_picture
from calibgui.gui.widgets.wrapped_label import WrappedLabel

_SHOT = QSize(112, 84)
"""Size of a picture, device-independent px."""
_COLUMNS = 3
_HEIGHT, _BOARD = 128, QSize(132, 96)
"""Height of the place to drop at, and size of the board that is drawn in it."""
_ROWS, _COLS = 4, 5
"""Squares of that board."""


class DropPlace(QWidget):
    """A board with its corners found, beside words on what can be dropped."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.setMinimumHeight(_HEIGHT)
        words = WrappedLabel(text)
        make_column(
            words, of=self, margins=(_BOARD.width() + 3 * theme.MARGIN, 12, theme.MARGIN, 12)
        )

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        colours, painter = theme.current(), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(colours.border), 1.5, Qt.PenStyle.DashLine))
        painter.setBrush(QColor(colours.base))
        frame = QRectF(self.rect()).adjusted(1, 1, -1, -1)
        painter.drawRoundedRect(frame, theme.RADIUS, theme.RADIUS)
        top = (self.height() - _BOARD.height()) / 2
        _draw_board(painter, QRectF(QPointF(1.5 * theme.MARGIN, top), _BOARD.toSizeF()))


def _draw_board(painter: QPainter, room: QRectF) -> None:
    """Draw a tilted board in a rectangle, with a mark at each of its corners."""
    tilted = [(0.16, 0.04), (0.93, 0.0), (1.0, 0.97), (0.0, 0.86)]
    there = QPolygonF(
        [QPointF(room.x() + x * room.width(), room.y() + y * room.height()) for x, y in tilted]
    )
    right, bottom = _COLS + 1, _ROWS + 1
    whole = [QPointF(-1, -1), QPointF(right, -1), QPointF(right, bottom), QPointF(-1, bottom)]
    to_page = QTransform()
    QTransform.quadToQuad(QPolygonF(whole), there, to_page)
    colours = theme.current()
    painter.setPen(QPen(QColor(colours.line), 1))
    painter.setBrush(QColor("#ffffff"))
    painter.drawPolygon(there)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor("#22262e"))
    for k in range(_ROWS * _COLS):
        row, col = divmod(k, _COLS)
        if (row + col) % 2 == 0:
            painter.drawPolygon(to_page.map(QPolygonF(QRectF(col, row, 1, 1))))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(QPen(theme.RESIDUAL, 1.5))
    for row in range(1, _ROWS):
        places = [to_page.map(QPointF(col, row)) for col in range(1, _COLS)]
        painter.drawPolyline(QPolygonF(places))
        for place in places:
            painter.drawEllipse(place, 2.5, 2.5)


class GoodSet(QWidget):
    """Six photographs of the sample, each with what it is for.

    Args:
        jobs: that read the pictures, once the page is on the screen.
    """

    def __init__(self, jobs: Jobs) -> None:
        super().__init__()
        self._jobs = jobs
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        shots = {
            "view01": self.tr("filling the image"),
            "view03": self.tr("tilted back"),
            "view04": self.tr("tilted to a side"),
            "view06": self.tr("in one corner"),
            "view09": self.tr("in the others"),
            "view14": self.tr("turned upright"),
        }
        self.shots: dict[str, QLabel] = {}
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(theme.SPACING)
        grid.setVerticalSpacing(2)
        heading = make_heading(self.tr("A good set of photographs"))
        grid.addWidget(heading, 0, 0, 1, _COLUMNS)
        grid.setRowMinimumHeight(0, heading.sizeHint().height() + theme.SPACING)
        for k, (name, text) in enumerate(shots.items()):
            shot, caption = QLabel(), WrappedLabel(text)
            shot.setFixedSize(_SHOT)
            shot.setAccessibleName(text)
            caption.setFont(theme.make_font(theme.CAPTION))
            caption.setForegroundRole(caption.palette().ColorRole.PlaceholderText)
            caption.setContentsMargins(0, 0, 0, theme.SPACING)
            row, column = divmod(k, _COLUMNS)
            grid.addWidget(shot, 1 + 2 * row, column)
            grid.addWidget(caption, 2 + 2 * row, column, Qt.AlignmentFlag.AlignTop)
            self.shots[name] = shot
        advice = WrappedLabel(
            self.tr(
                "10 to 20 of one flat board: sharp, evenly lit, with the focus and zoom that the "
                "camera will have at work."
            )
        )
        grid.addWidget(advice, 5, 0, 1, _COLUMNS)

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 - Qt's name
        super().showEvent(event)
        if next(iter(self.shots.values())).pixmap().isNull():
            self._jobs.each(
                "",
                list(self.shots),
                _read_shot,
                self._show_shot,
                failed=leave_as_it_is,
                owner=self,
                delay=PICTURE,
                is_about_document=False,
            )

    def _show_shot(self, name: str, picture: QImage) -> None:
        ratio = self.devicePixelRatio()
        small = shrink_picture(picture, _SHOT, ratio)
        rounded = QPixmap(small.size())
        rounded.setDevicePixelRatio(ratio)
        rounded.fill(Qt.GlobalColor.transparent)
        painter, shape = QPainter(rounded), QPainterPath()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        shape.addRoundedRect(QRectF(QPointF(), small.deviceIndependentSize()), 6, 6)
        painter.setClipPath(shape)
        painter.drawPixmap(0, 0, small)
        painter.end()
        self.shots[name].setPixmap(rounded)


def _read_shot(name: str) -> QImage:
    """Read a photograph of the sample; in a worker. Raises CalibrationError if it is missing."""
    file = find_resource("sample") / f"{name}.png"
    return make_qimage(read_thumbnail(str(file)).grey)


def make_heading(text: str) -> QLabel:
    """Return the heading of a part of the page."""
    heading = QLabel(text)
    heading.setFont(theme.make_font(bold=True))
    return heading


def leave_as_it_is(_: Exception) -> None:
    """A picture that is gone, or cannot be read, is not missed here."""
