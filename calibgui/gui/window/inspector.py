"""The inspector: the verdict, what was done, and the camera's values."""

from __future__ import annotations

from typing import ClassVar

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import (
    QBoxLayout,
    QGridLayout,
    QLabel,
    QPushButton,
    QStackedWidget,
    QWidget,
)

from calibgui.gui.canvas.image_page import ImagePage
from calibgui.gui.session.session import Session
from calibgui.gui.verdict.camera_values import CameraValues
from calibgui.gui.verdict.done_list import DoneList
from calibgui.gui.verdict.verdict_bar import ROOMY, VerdictBar
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.scrolling import make_scrollable
from calibgui.gui.window.progress import Progress

_BAR = 8
"""Room for a scroll bar in the margin, device-independent px."""


class Inspector(QWidget):
    """A column beside the desk, or three columns below the strip.

    While a tool is used on the photograph, what it says stands in the place of what was done.

    Args:
        session: whose result is shown.
        verdict: what stands first.
        page: the photograph, whose tools have words and buttons.
        progress, calibrate: what stands last.
    """

    WIDTH: ClassVar[int] = 340
    """Width beside the desk, device-independent px."""

    def __init__(
        self,
        session: Session,
        verdict: VerdictBar,
        page: ImagePage,
        progress: Progress,
        calibrate: QPushButton,
    ) -> None:
        super().__init__()
        self._verdict = verdict
        self.done, self.camera = DoneList(session), CameraValues(session)
        self._lists = QBoxLayout(QBoxLayout.Direction.TopToBottom)
        self._lists.setContentsMargins(0, 0, _BAR, 0)
        self._lists.setSpacing(theme.MARGIN)
        first = make_column(verdict.action_row, self.done)
        self._lists.addLayout(first)
        self._lists.addWidget(self.camera, 1)
        inside = QWidget()
        inside.setLayout(self._lists)
        tools = QWidget()
        make_column(
            page.marker.roi_bar, page.marker.corner_bar, None, of=tools, margins=(0, 0, _BAR, 0)
        )
        self._lower = QStackedWidget()
        area = make_scrollable(inside)
        self._bar = area.verticalScrollBar()
        self._bar.rangeChanged.connect(self._leave_margin)
        self._lower.addWidget(area)
        self._lower.addWidget(tools)
        page.tool_changed.connect(self._lower.setCurrentIndex)
        self._foot = QWidget()
        make_row((progress, 1), calibrate, of=self._foot, margins=(0, 0, _BAR, 0))
        self._hint = self._make_hint()
        self._grid = QGridLayout(self)
        verdict.setContentsMargins(0, 0, _BAR, 0)
        self._grid.setHorizontalSpacing(theme.MARGIN)
        self._is_row: bool | None = None
        self.stand_in_row(False)

    def stand_in_row(self, is_row: bool) -> None:
        """Arrange the parts in columns below the strip, or in one beside the desk."""
        if is_row is self._is_row:
            return
        self._is_row = is_row
        if is_row:
            self._verdict.fit_height(ROOMY)
        direction = QBoxLayout.Direction
        self._lists.setDirection(direction.LeftToRight if is_row else direction.TopToBottom)
        self._lists.setStretch(0, int(is_row))
        top = Qt.AlignmentFlag.AlignTop
        if is_row:
            self._grid.addWidget(self._verdict, 0, 0, top)
            self._grid.addWidget(self._lower, 0, 1, 2, 1)
            self._grid.addWidget(self._foot, 1, 0)
        else:
            self._grid.addWidget(self._verdict, 0, 0)
            self._grid.addWidget(self._lower, 1, 0)
            self._grid.addWidget(self._foot, 2, 0)
        edge = theme.SPACING if is_row else 12
        self._grid.setContentsMargins(theme.MARGIN, edge, theme.MARGIN - _BAR, edge)
        self._grid.setVerticalSpacing(4 if is_row else 12)
        for row in range(3):
            self._grid.setRowStretch(row, int(row == (0 if is_row else 1)))
        for column in range(2):
            self._grid.setColumnStretch(column, column if is_row else 1 - column)
        self._grid.setColumnMinimumWidth(0, self.WIDTH - 2 * theme.MARGIN if is_row else 0)

    def _leave_margin(self, _: int, most: int) -> None:
        """Let the lists end where the verdict does, whether a scroll bar stands beside them."""
        self._lists.setContentsMargins(0, 0, 0 if most else _BAR, 0)

    def _make_hint(self) -> QLabel:
        """Return what lies over the inspector while photographs are dragged over the window."""
        hint = QLabel(
            self.tr(
                "Is the camera still good?\n\nDrop new photographs of the board here: they check "
                "it and change nothing.\n\nDropped on the left they join the project."
            ),
            self,
        )
        hint.setWordWrap(True)
        hint.setAlignment(Qt.AlignmentFlag.AlignCenter)
        hint.setMargin(theme.MARGIN)
        hint.setStyleSheet(
            "background: palette(window); border: 2px dashed palette(highlight);border-radius: 8px;"
        )
        hint.hide()
        return hint

    def invite(self, invited: bool) -> None:
        """Say that photographs can be dropped here, which only check the camera; or no longer."""
        self._hint.setVisible(invited)
        self._hint.raise_()

    def is_inviting_at(self, place: QPoint) -> bool:
        """Return whether photographs that are dropped at a place of the screen check the camera."""
        return self._hint.isVisible() and self.rect().contains(self.mapFromGlobal(place))

    def find_row_height(self) -> int:
        """Return the height that the inspector takes below the strip."""
        margins, parts = self._grid.contentsMargins(), self._verdict.layout()
        assert parts is not None
        parts.invalidate()
        needed = parts.sizeHint().height() + self._foot.sizeHint().height()
        return needed + margins.top() + self._grid.verticalSpacing() + margins.bottom()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._hint.setGeometry(self.rect().adjusted(8, 8, -8, -8))
        if not self._is_row:
            self._verdict.fit_height(event.size().height())

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        colours, painter = theme.current(), QPainter(self)
        painter.fillRect(self.rect(), QColor(colours.base))
        edge = (self.width(), 1) if self._is_row else (1, self.height())
        painter.fillRect(0, 0, *edge, QColor(colours.line))
