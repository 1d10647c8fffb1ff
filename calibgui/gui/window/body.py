"""The desk, the strip of photographs and the inspector, each in the place that the window has."""

from __future__ import annotations

from enum import Enum

from PySide6.QtCore import QEvent, QRect, QSize, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QWidget

from calibgui.gui.widgets import theme
from calibgui.gui.window.inspector import Inspector

_SIDE = 1100
"""Width from which the inspector stands beside the desk, device-independent px."""
_ROW, _HIGH = 700, 820
"""Width and height from which it otherwise lies below the strip, device-independent px."""
_LOW_SIDE = 850
"""Width from which it stands beside the desk of a window that is low, device-independent px."""


class Place(Enum):
    """The place of the inspector."""

    SIDE = "beside the desk and the strip"
    ROW = "below the strip"
    SHEET = "over the desk, when it is wanted"


class Body(QWidget):
    """Gives each part its rectangle; the desk has what the others leave, 60 % of the width or more.

    Args:
        desk, strip, inspector: the parts.
    """

    inspector_moved = Signal(bool, bool)
    """Signal whether the inspector is a sheet or hidden now, and whether it is in sight."""

    def __init__(self, desk: QWidget, strip: QWidget, inspector: Inspector) -> None:
        super().__init__()
        self._desk, self._strip, self._inspector = desk, strip, inspector
        self._is_empty = self._is_alone = self._is_sheet_open = False
        for part in (desk, strip, inspector):
            part.setParent(self)
        self.place = Place.SIDE

    def show_parts(self, *, empty: bool) -> None:
        """Show the desk by itself while there are no photographs, and all parts otherwise."""
        self._is_empty, self._is_alone = empty, False
        self._arrange()

    def leave_desk_alone(self) -> None:
        """Hide the strip and the inspector, or show them again."""
        self._is_alone = not self._is_alone
        self._is_sheet_open = False
        self._arrange()

    def show_inspector(self, shown: bool = True) -> None:
        """Open or close the inspector where it is a sheet; elsewhere it is in sight."""
        self._is_sheet_open = shown
        self._arrange()

    @property
    def is_inspector_shown(self) -> bool:
        """Return whether the inspector is in sight."""
        return not self._is_empty and (
            self._is_sheet_open or (self.place is not Place.SHEET and not self._is_alone)
        )

    def minimumSizeHint(self) -> QSize:  # noqa: N802 - Qt's name
        return QSize(480, 240)  # with header and menus on a small screen at twice the scale

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._arrange()

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.LayoutRequest:  # the verdict needs another height
            self._arrange()
        return super().event(event)

    def _choose_place(self) -> Place:
        width, height = self.width(), self.height()
        if width >= _SIDE or (width >= _LOW_SIDE and height < _HIGH):
            return Place.SIDE
        return Place.ROW if width >= _ROW and height >= _HIGH else Place.SHEET

    def _arrange(self) -> None:
        self.place = self._choose_place()
        is_row = self.place is Place.ROW and not self._is_alone
        self._inspector.stand_in_row(is_row)
        shown = self.is_inspector_shown
        rest = QRect(0, 0, self.width(), self.height())
        if shown:
            rest = self._place_inspector(rest, is_row=is_row)
        has_strip = not (self._is_empty or self._is_alone)
        if has_strip:
            top = rest.bottom() + 1 - self._strip.minimumHeight()
            self._strip.setGeometry(rest.x(), top, rest.width(), self._strip.minimumHeight())
            rest.setBottom(top - 1)
        self._desk.setGeometry(rest)
        self._strip.setVisible(has_strip)
        self._inspector.setVisible(shown)
        if shown:
            self._inspector.raise_()
        is_sheet = self.place is Place.SHEET or self._is_alone
        self.inspector_moved.emit(is_sheet and not self._is_empty, shown)

    def _place_inspector(self, rest: QRect, *, is_row: bool) -> QRect:
        """Give the inspector its rectangle; return what it leaves to the others."""
        if is_row:
            height = self._inspector.find_row_height()
            self._inspector.setGeometry(0, rest.height() - height, rest.width(), height)
            return rest.adjusted(0, 0, 0, -height)
        width = min(Inspector.WIDTH, rest.width())
        self._inspector.setGeometry(rest.width() - width, 0, width, rest.height())
        is_beside = self.place is not Place.SHEET and not self._is_alone
        return rest.adjusted(0, 0, -width, 0) if is_beside else rest

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        QPainter(self).fillRect(self.rect(), QColor(theme.current().base))
