"""The reason for a verdict, over its figures, in a place whose height no sentence changes."""

from __future__ import annotations

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from calibgui.gui.widgets import theme
from calibgui.gui.widgets.reserved_label import ReservedLabel

_LEAST_REASON = 2
"""Lines that the reason has at least, or half of all."""
_SIZE_OF_FIGURES = 0.9
"""Size of the figures' letters, of the others': each figure has one line in the least width."""


class ReasonAndFigures(QWidget):
    """Shows the reason over the figures; a long reason takes lines of the figures."""

    def __init__(self) -> None:
        super().__init__()
        self._lines = 1
        self.reason, self.figures = ReservedLabel(1), ReservedLabel(1)
        font = self.figures.font()
        font.setPointSizeF(_SIZE_OF_FIGURES * font.pointSizeF())
        self.figures.setFont(font)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(theme.SPACING // 2)
        for label in (self.reason, self.figures):
            column.addWidget(label)
        column.addStretch(1)

    def reserve(self, lines: int) -> None:
        """Take the height of so many lines from now on."""
        self._lines = lines
        line = self.reason.fontMetrics().lineSpacing()
        self.setFixedHeight(lines * line + theme.SPACING // 2)
        self._share_lines()

    def give_reason(self, reason: str) -> None:
        """Show a reason, and as much of the figures as it leaves room for."""
        self.reason.setText(reason)
        self._share_lines()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._share_lines()

    def _share_lines(self) -> None:
        least = min(_LEAST_REASON, self._lines // 2)
        needed = max(self.reason.count_lines(), least)
        self.reason.reserve(min(needed, max(self._lines - 1, 1)))
        self.figures.reserve(max(self._lines - needed, 1))
