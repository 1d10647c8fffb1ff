"""Text in a place that is as high for one word as for many: nothing below it moves."""

from __future__ import annotations

import math
import sys

from PySide6.QtCore import QEvent, QPointF, QSize, Qt
from PySide6.QtGui import (
    QFontMetricsF,
    QPainter,
    QPaintEvent,
    QResizeEvent,
    QTextLayout,
    QTextOption,
)
from PySide6.QtWidgets import QSizePolicy

from calibgui.gui.widgets.wrapped_label import WrappedLabel, typeset


class ReservedLabel(WrappedLabel):
    """As high as some lines, whatever it says; "…" stands for the rest, which the tooltip has.

    Args:
        lines: the number of lines.
    """

    _lines, _tip = 1, ""  # Qt asks for them while the label is made

    def __init__(self, lines: int) -> None:
        super().__init__()
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.reserve(lines)

    def reserve(self, lines: int) -> None:
        """Take the height of so many lines from now on."""
        self._lines = lines
        self.setFixedHeight(lines * self.line_height)
        self._show_rest()

    def setText(self, text: str) -> None:  # noqa: N802 - Qt's name
        """Show a text."""
        super().setText(text)
        self._show_rest()

    def explain(self, tip: str) -> None:
        """Say this in the tooltip, below the text if there is too little room for that."""
        self._tip = tip
        self._show_rest()

    def count_lines(self) -> int:
        """Return how many lines the whole text takes in the width that there is."""
        return len(self._break_lines(sys.maxsize))

    @property
    def line_height(self) -> int:
        """The height of a line, px, as Qt's labels have it."""
        return math.ceil(QFontMetricsF(self.font()).lineSpacing())

    @property
    def is_cut(self) -> bool:
        """Return whether there is too little room for the text."""
        return self.count_lines() > self._lines

    def heightForWidth(self, _: int) -> int:  # noqa: N802 - Qt's name
        """Return the height, which no width changes."""
        return self.height()

    def sizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        """Return the size of the place."""
        return QSize(0, self.height())

    minimumSizeHint = sizeHint  # noqa: N815 - Qt's name

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self.reserve(self._lines)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._show_rest()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter, metrics = QPainter(self), self.fontMetrics()
        painter.setPen(self.palette().color(self.foregroundRole()))
        for k, line in enumerate(self._break_lines(self._lines)):
            painter.drawText(QPointF(0, k * self.line_height + metrics.ascent()), line)

    def _show_rest(self) -> None:
        """Have the tooltip say what there is no room for."""
        rest = self.text() if self.is_cut and self.text() not in self._tip else ""
        self.setToolTip("\n\n".join(filter(None, (rest, self._tip))))

    def _break_lines(self, most: int) -> list[str]:
        """Break the text into lines, at most so many; the last one ends in "…" if it is cut."""
        width, metrics, lines = max(self.width(), 1), self.fontMetrics(), list[str]()
        rest = typeset(self.text())
        while rest:
            paragraph, _, after = rest.partition("\n")
            taken = self._measure_line(paragraph, width)
            left = paragraph[taken:]
            if len(lines) == most - 1 and (left or after):
                whole = paragraph if left else f"{paragraph} …"
                return [*lines, metrics.elidedText(whole, Qt.TextElideMode.ElideRight, width)]
            lines.append(paragraph[:taken].rstrip(" "))
            rest = f"{left}\n{after}" if left and after else left or after
        return lines

    def _measure_line(self, paragraph: str, width: int) -> int:
        """Return how many letters of a paragraph stand in its first line."""
        layout = QTextLayout(paragraph, self.font())
        layout.setTextOption(QTextOption(Qt.AlignmentFlag.AlignLeft))
        layout.beginLayout()
        line = layout.createLine()
        line.setLineWidth(width)
        layout.endLayout()
        return max(line.textLength(), 1) if paragraph else 0
