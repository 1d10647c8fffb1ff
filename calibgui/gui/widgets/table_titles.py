"""Titles over the columns of a table."""

from __future__ import annotations

from PySide6.QtCore import QRect, QSize, Qt
from PySide6.QtGui import QColor, QPainter
from PySide6.QtWidgets import QHeaderView, QStyle, QWidget

from calibgui.gui.widgets import theme

MEASURED_ROWS = 100
"""Rows below those in sight whose texts have room in the columns as well, at least."""
_INSET = 3
"""Room beside a title, as beside the texts below it, device-independent px."""


class Titles(QHeaderView):
    """Titles of columns; only the one that the rows are sorted by has room for its arrow."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.setFont(theme.make_font(theme.CAPTION))
        self.setSectionsClickable(True)
        self.setHighlightSections(False)  # every row is selected as a whole
        # Measuring thousands of rows would be felt; a table of values is measured whole.
        self.setResizeContentsPrecision(MEASURED_ROWS)
        # The table measures its columns when that is due: Qt would at every change.
        self.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)

    def paintSection(self, painter: QPainter, rect: QRect, column: int) -> None:  # noqa: N802
        """Paint a title over a line, with an arrow if the rows are sorted by its column."""
        model, colours = self.model(), theme.current()
        role, side = Qt.ItemDataRole, Qt.Orientation.Horizontal
        place = model.headerData(column, side, role.TextAlignmentRole) or Qt.AlignmentFlag.AlignLeft
        text = model.headerData(column, side, role.DisplayRole)
        if column == self.sortIndicatorSection():
            is_falling = self.sortIndicatorOrder() is Qt.SortOrder.DescendingOrder
            text = f"{'▴▾'[is_falling]} {text}"
        painter.setPen(QColor(colours.muted))
        flags = int(Qt.AlignmentFlag(place) | Qt.AlignmentFlag.AlignVCenter)
        painter.drawText(rect.adjusted(_INSET, 0, -_INSET, -1), flags, text)
        painter.fillRect(rect.x(), rect.bottom(), rect.width(), 1, QColor(colours.line))

    def sectionSizeFromContents(self, column: int) -> QSize:  # noqa: N802 - Qt's name
        size = super().sectionSizeFromContents(column)
        if column != self.sortIndicatorSection():
            metric, style = QStyle.PixelMetric, self.style()
            arrow = style.pixelMetric(metric.PM_HeaderMarkSize, None, self)
            size -= QSize(arrow + style.pixelMetric(metric.PM_HeaderMargin, None, self), 0)
        return size
