"""The inspector at the right: the image's layers, the set-up, and the panels on the result."""

from __future__ import annotations

from functools import partial
from typing import ClassVar

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QStackedWidget,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from calibgui.gui.canvas.image_page import ImagePage
from calibgui.gui.panels.groups import Group, Page, describe_group, name_group
from calibgui.gui.settings.board_panel import BoardPanel
from calibgui.gui.settings.settings_panel import SettingsPanel
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.tab_bar import TabBar
from calibgui.gui.window.progress import Progress


class Inspector(QWidget):
    """Follows what one does: shows one page at a time, over the button that calibrates.

    Args:
        page: the image, whose layers and tools are one page.
        board, settings: the sections of the page of the set-up.
        progress, calibrate: what stands below every page.
    """

    WIDTH: ClassVar[int] = 396
    """Least width, px: that of a panel with its margins."""
    group_wanted = Signal(Group)
    """The user chose the panels of this group."""
    room_wanted = Signal()
    """The user wants more room for the inspector, or the photograph's back."""

    def __init__(
        self,
        page: ImagePage,
        board: BoardPanel,
        settings: SettingsPanel,
        progress: Progress,
        calibrate: QPushButton,
    ) -> None:
        super().__init__()
        self.setMinimumWidth(self.WIDTH)
        self.tabs = TabBar(documentMode=True, expanding=False, drawBase=False)
        self.tabs.setUsesScrollButtons(False)
        self.tabs.setAccessibleName(self.tr("Inspector"))
        self._pages = QStackedWidget()
        self._before_tool = 0
        self._add_page(self.tr("Image"), self.tr("What is drawn over the image."), _stack(page))
        self._add_page(
            self.tr("Set-up"),
            self.tr("The board, and how to calibrate."),
            self._make_setup(board, settings),
        )
        self._groups = list(Group)
        for group in self._groups:
            self.tabs.addTab(name_group(group))
            self.tabs.setTabToolTip(self.tabs.count() - 1, describe_group(group))
        self._results = QStackedWidget()
        nothing = QLabel(self.tr("Nothing is calibrated yet."))
        nothing.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._results.addWidget(nothing)
        self._pages.addWidget(self._results)
        self.room = QToolButton()
        self.room.setText("↔")
        self.room.setAutoRaise(True)
        self.room.setToolTip(self.tr("More room for the inspector, or back (F8)"))
        self.room.setAccessibleName(self.room.toolTip())
        self.room.clicked.connect(self.room_wanted)
        head = QHBoxLayout()
        head.addWidget(self.tabs, 1)
        head.addWidget(self.room)
        foot = QHBoxLayout()
        foot.addWidget(progress, 1)
        foot.addWidget(calibrate)
        self.column = QVBoxLayout(self)
        """From top to bottom; the verdict can stand above."""
        self.column.setContentsMargins(theme.SPACING, 0, theme.SPACING, theme.SPACING // 2)
        self.column.setSpacing(theme.SPACING // 2)
        self.column.addLayout(head)
        self.column.addWidget(self._pages, 1)
        self.column.addLayout(foot)
        self.tabs.currentChanged.connect(self._show)
        page.tool_changed.connect(self._follow_tool)

    def show_image_page(self) -> None:
        """Show the layers of the image, and what its tools say."""
        self.tabs.setCurrentIndex(0)

    def show_setup(self) -> None:
        """Show the board and the settings."""
        self.tabs.setCurrentIndex(1)

    def list_pages(self) -> list[Page]:
        """Return the pages before the groups of panels."""
        tabs = self.tabs
        return [
            Page(tabs.tabText(k), tabs.tabToolTip(k), partial(tabs.setCurrentIndex, k))
            for k in range(_FIRST_GROUP)
        ]

    def show_group(self, group: Group) -> None:
        """Show the panels on the result; which of them is theirs to decide."""
        self.tabs.setCurrentIndex(_FIRST_GROUP + self._groups.index(group))

    def set_analysis(self, analysis: QWidget) -> None:
        """Show the panels on the result from now on."""
        self._results.addWidget(analysis)
        self._results.setCurrentWidget(analysis)

    @property
    def group(self) -> Group | None:
        """The group whose panels are shown; None on the other pages."""
        k = self.tabs.currentIndex() - _FIRST_GROUP
        return self._groups[k] if k >= 0 else None

    def _show(self, tab: int) -> None:
        self._pages.setCurrentIndex(min(tab, _FIRST_GROUP))
        if self.group is not None:
            self.group_wanted.emit(self.group)

    def _follow_tool(self, taken: bool) -> None:
        """Show what a tool on the image says while it is used, then what was there before."""
        if taken:
            self._before_tool = self.tabs.currentIndex()
            self.show_image_page()
        elif self.tabs.currentIndex() == 0:
            self.tabs.setCurrentIndex(self._before_tool)

    def _add_page(self, title: str, tip: str, page: QWidget) -> None:
        area = QScrollArea()
        area.setWidget(page)
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._pages.addWidget(area)
        self.tabs.setTabToolTip(self.tabs.addTab(title), tip)

    def _make_setup(self, board: BoardPanel, settings: SettingsPanel) -> QWidget:
        page = QWidget()
        column = QVBoxLayout(page)
        column.setContentsMargins(0, theme.SPACING // 4, 0, 0)
        for title, section in ((self.tr("Board"), board), (self.tr("Calibration"), settings)):
            column.addWidget(_make_heading(title))
            column.addWidget(section)
        column.addStretch(1)
        return page


def _make_heading(text: str) -> QLabel:
    heading = QLabel(text)
    font = heading.font()
    font.setBold(True)
    heading.setFont(font)
    return heading


def _stack(page: ImagePage) -> QWidget:
    """Put the bars of the image's tools, of which one is shown at most, above facts and layers."""
    whole = QWidget()
    column = QVBoxLayout(whole)
    column.setContentsMargins(0, theme.SPACING, 0, 0)
    for part in (page.marker.roi_bar, page.marker.corner_bar, page.facts, page.layer_list):
        column.addWidget(part)
    column.addStretch(1)
    return whole


_FIRST_GROUP = 2
"""Tab of the first group of panels."""
