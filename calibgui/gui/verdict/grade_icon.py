"""The mark of a grade: a sign of its own for each, beside its colour and its words."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from calibgui.engine.assessment import Grade
from calibgui.gui.widgets import theme

_SIDE = 28
"""Width and height, device-independent px."""
_SIGNS = {
    Grade.GOOD: [(0.28, 0.52), (0.44, 0.68), (0.73, 0.34)],
    Grade.USABLE: [(0.28, 0.52), (0.44, 0.68), (0.73, 0.34)],
    Grade.CAN_BE_BETTER: [(0.5, 0.82), (0.5, 0.36), (0.34, 0.54), (0.5, 0.36), (0.66, 0.54)],
    Grade.NOT_USABLE: [(0.33, 0.33), (0.67, 0.67), (0.5, 0.5), (0.67, 0.33), (0.33, 0.67)],
}
"""Lines of the signs, in the mark's width and height: a tick, an arrow upwards, a cross."""


def get_colour(grade: Grade | None) -> str:
    """Return the colour of a grade; the one of secondary text for none."""
    colours = theme.current()
    return {
        Grade.GOOD: colours.good,
        Grade.USABLE: colours.accent,
        Grade.CAN_BE_BETTER: colours.warning,
        Grade.NOT_USABLE: colours.bad,
        None: colours.muted,
    }[grade]


class GradeIcon(QWidget):
    """A circle with a sign for each grade: a tick, full or as a ring, an arrow, or a cross."""

    def __init__(self) -> None:
        super().__init__()
        self.grade: Grade | None = None
        self._is_dimmed = False
        self.setFixedSize(self.sizeHint())

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        return QSize(_SIDE, _SIDE)

    def show_grade(self, grade: Grade | None, dimmed: bool = False) -> None:
        """Show the mark of a grade, without its colour if it is dimmed; a ring for none."""
        self.grade, self._is_dimmed = grade, dimmed
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colour = QColor(get_colour(None if self._is_dimmed else self.grade))
        frame = QRectF(self.rect()).adjusted(2, 2, -2, -2)
        is_full = self.grade not in (None, Grade.USABLE)
        painter.setPen(QPen(colour, 2.5))
        painter.setBrush(colour if is_full else Qt.BrushStyle.NoBrush)
        painter.drawEllipse(frame)
        if self.grade is not None:
            on = QColor(theme.current().base) if is_full else colour
            painter.setPen(QPen(on, 2.5, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
            painter.drawPolyline(_place(_SIGNS[self.grade], frame))


def _place(points: list[tuple[float, float]], frame: QRectF) -> QPolygonF:
    """Return points that are given in a frame's width and height."""
    return QPolygonF(
        [QPointF(frame.x() + x * frame.width(), frame.y() + y * frame.height()) for x, y in points]
    )
