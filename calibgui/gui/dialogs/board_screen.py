"""A board on a whole screen, for whoever has no printer: flat, and as true as its ruler is read."""

from __future__ import annotations

from collections.abc import Iterator

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent, QResizeEvent, QScreen
from PySide6.QtWidgets import QLabel, QWidget

from calibgui.engine.boards import (
    Board,
    PrintedDiscs,
    PrintedRectangles,
    PrintedSquaresAndDots,
)
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.number_box import NumberBox

_RULER_MM = 100.0
"""Length that the ruler has if the screen tells its size right, mm."""
_TICK, _RULER_HEIGHT = 10, 14
"""Number of parts of the ruler, and its height, device-independent px."""
_WHITE = 1.0
"""Width of the white around the board, squares: half of one is needed."""


class BoardScreen(QWidget):
    """Shows a board as large as the screen holds it, its squares in whole pixels of the screen.

    Args:
        board: whose pattern, rows and columns are shown.
        parent: the window above which it opens.
    """

    def __init__(self, board: Board, parent: QWidget | None = None) -> None:
        super().__init__(parent, Qt.WindowType.Window)
        self.setWindowTitle(self.tr("Board on the screen"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._ink = board.pattern.draw(board.grid_size)
        self.measured = NumberBox(decimals=1, minimum=20.0, maximum=500.0)
        self.measured.setSuffix(self.tr(" mm"))
        self.measured.setSingleStep(0.1)
        self.measured.setValue(_RULER_MM)
        self.measured.setAccessibleName(self.tr("Length of the line"))
        self.words = QLabel()
        self.leave = Button(self.tr("&Close (Esc)"))
        self.leave.clicked.connect(self.close)
        self.measured.valueChanged.connect(self._tell)
        self._bar = QWidget(self)
        self._bar.setAutoFillBackground(True)
        make_row(
            QLabel(self.tr("Measure the line above with a ruler:")),
            self.measured,
            (self.words, 1),
            self.leave,
            of=self._bar,
            margins=(theme.MARGIN, theme.SPACING, theme.MARGIN, theme.SPACING),
        )

    @property
    def side_px(self) -> int:
        """The side of a square (or the distance of circles), pixels of the screen."""
        left, top, right, bottom = self._ink.extent
        room = self._room
        ratio = self.devicePixelRatioF()
        across = ratio * room.width() / (right - left + 2 * _WHITE)
        down = ratio * room.height() / (bottom - top + 2 * _WHITE)
        return max(1, int(min(across, down)))

    @property
    def side_mm(self) -> float:
        """The same, mm, by the length of the line as it was measured."""
        pitch = _measure_pitch(self.screen()) * self.measured.value() / _RULER_MM
        return self.side_px * pitch

    @property
    def _room(self) -> QRectF:
        """The rectangle in which the board is shown."""
        foot = self._bar.sizeHint().height() + 3 * _RULER_HEIGHT
        return QRectF(0, 0, self.width(), self.height() - foot)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        height = self._bar.sizeHint().height()
        self._bar.setGeometry(0, self.height() - height, self.width(), height)
        self._tell()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        if event.key() == Qt.Key.Key_Escape:
            self.close()
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        painter.fillRect(self.rect(), Qt.GlobalColor.white)
        self._paint_ruler(painter)
        # In pixels of the screen from here on: the edges of squares lie between them.
        ratio = self.devicePixelRatioF()
        painter.scale(1 / ratio, 1 / ratio)
        left, top, right, bottom = self._ink.extent
        side, room = self.side_px, self._room
        x = round((ratio * room.width() - side * (right - left)) / 2)
        y = round((ratio * room.height() - side * (bottom - top)) / 2)
        painter.translate(x - side * left, y - side * top)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor("black"))
        for rectangle in self._list_rectangles(side):
            painter.drawRect(rectangle)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for middle, radius, is_dark in self._list_discs(side):
            painter.setBrush(QColor("black" if is_dark else "white"))
            painter.drawEllipse(middle, radius, radius)

    def _list_rectangles(self, side: float) -> Iterator[QRectF]:
        ink = self._ink
        if isinstance(ink, PrintedSquaresAndDots):
            ink = ink.rectangles
        if isinstance(ink, PrintedRectangles):
            for u, v, w, z in (side * ink.list_rectangles()).tolist():
                yield QRectF(u, v, w - u, z - v)

    def _list_discs(self, side: float) -> Iterator[tuple[QPointF, float, bool]]:
        ink = self._ink
        if isinstance(ink, PrintedDiscs | PrintedSquaresAndDots):
            dark = ink.dark.tolist() if isinstance(ink, PrintedSquaresAndDots) else None
            for k, (u, v) in enumerate((side * ink.centres).tolist()):
                yield QPointF(u, v), side * ink.radius, dark is None or dark[k]

    def _paint_ruler(self, painter: QPainter) -> None:
        """Draw the line that is to be measured, with tenths of it."""
        pitch = _measure_pitch(self.screen()) * self.devicePixelRatioF()
        length = _RULER_MM / pitch
        x, y = (self.width() - length) / 2, self._room.bottom() + _RULER_HEIGHT
        painter.setPen(QColor("black"))
        painter.drawLine(QPointF(x, y), QPointF(x + length, y))
        for k in range(_TICK + 1):
            at = x + k * length / _TICK
            height = _RULER_HEIGHT if k in (0, _TICK) else _RULER_HEIGHT / 2
            painter.drawLine(QPointF(at, y), QPointF(at, y + height))

    def _tell(self) -> None:
        """Say how long the sides of the squares are."""
        self.words.setText(
            self.tr("A square is {0} pixels: {1} mm. State this length.").format(
                self.side_px, f"{self.side_mm:.3f}"
            )
            if isinstance(self._ink, PrintedRectangles | PrintedSquaresAndDots)
            else self.tr("Circles are {0} pixels apart: {1} mm. State this length.").format(
                self.side_px, f"{self.side_mm:.3f}"
            )
        )


def _measure_pitch(screen: QScreen) -> float:
    """Return the distance of a screen's pixels, mm, as it tells it."""
    return float(
        screen.physicalSize().width() / (screen.size().width() * screen.devicePixelRatio())
    )
