"""A square matrix as coloured cells with numbers in them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QEvent, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QHelpEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QToolTip, QWidget

from calibgui.engine.arrays import Array
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.plots import offer_picture

_NEGATIVE, _POSITIVE = QColor("#0072B2"), QColor("#D55E00")


class Matrix(QWidget):
    """Correlations: the stronger, the deeper the colour; blue is negative, orange positive."""

    def __init__(self) -> None:
        super().__init__()
        self._names: tuple[str, ...] = ()
        self._values: Array = np.zeros((0, 0))
        offer_picture(self)

    def show_matrix(self, names: Sequence[str], values: Array) -> None:
        """Show `values` (n, n) in -1..1; NaN is left blank."""
        self._names, self._values = tuple(names), values
        self.update()

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        return QSize(420, 420)

    def text(self, row: int, column: int) -> str:
        """Return the text of a cell."""
        value = self._values[row, column]
        return "" if np.isnan(value) else f"{value:.2f}"

    def cell(self, row: int, column: int) -> QRectF:
        """Return the rectangle of a cell; row or column -1 are those of the names."""
        count = len(self._names) + 1
        width, height = self.width() / count, min(self.height() / count, self.width() / count)
        return QRectF((column + 1) * width, (row + 1) * height, width, height)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter = QPainter(self)
        colours = theme.current()
        font = painter.font()
        font.setPixelSize(round(max(8.0, min(theme.TEXT, self.cell(0, 0).width() / 4))))
        painter.setFont(font)
        centred = Qt.AlignmentFlag.AlignCenter
        for i, name in enumerate(self._names):
            painter.setPen(QColor(colours.text))
            painter.drawText(self.cell(-1, i), centred, name)
            painter.drawText(self.cell(i, -1), centred, name)
            for j in range(len(self._names)):
                self._paint(painter, i, j)

    def _paint(self, painter: QPainter, i: int, j: int) -> None:
        cell, value = self.cell(i, j).adjusted(0.5, 0.5, -0.5, -0.5), self._values[i, j]
        base = QColor(theme.current().base)
        if np.isnan(value):
            painter.fillRect(cell, base)
            return
        fill = _mixed(base, _POSITIVE if value > 0 else _NEGATIVE, min(abs(value), 1.0) ** 2)
        painter.fillRect(cell, fill)
        light = fill.lightnessF() < 0.5
        painter.setPen(QColor("#ffffff" if light else "#101418"))
        painter.drawText(cell, Qt.AlignmentFlag.AlignCenter, self.text(i, j))

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            QToolTip.showText(event.globalPos(), self._tip(event), self)
            return True
        return super().event(event)

    def _tip(self, event: QHelpEvent) -> str:
        count = len(self._names)
        for i in range(count):
            for j in range(count):
                if self.cell(i, j).contains(event.pos()) and not np.isnan(self._values[i, j]):
                    return self.tr("correlation of {0} and {1}: {2:+.4f}").format(
                        self._names[i], self._names[j], self._values[i, j]
                    )
        return self.toolTip()


def _mixed(a: QColor, b: QColor, share: float) -> QColor:
    """Colour between a and b."""
    one, other = ((c.redF(), c.greenF(), c.blueF()) for c in (a, b))
    return QColor.fromRgbF(*(p + share * (q - p) for p, q in zip(one, other, strict=True)))
