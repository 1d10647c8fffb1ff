"""The names of a group's panels, of which one is chosen."""

from __future__ import annotations

import math
from collections.abc import Sequence

from PySide6.QtCore import QCoreApplication, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QButtonGroup, QGridLayout, QSizePolicy, QToolButton, QWidget

from calibgui.gui.panels.panel import Panel

_MAX_PER_ROW = 3
_ROWS = 2
"""Of every group, so that choosing another one moves nothing."""
_WIDE = 640
"""Width from which one row has room for every group, device-independent px."""


def name_panel(kind: type[Panel]) -> str:
    """Return the name of a kind of panel for the user."""
    return QCoreApplication.translate(kind.__name__, kind.title)


def describe_panel(kind: type[Panel]) -> str:
    """Return in a sentence what a kind of panel shows."""
    return QCoreApplication.translate(kind.__name__, kind.purpose)


class PanelChooser(QWidget):
    """Shows every name at once, in two rows of equally many, or nearly so; in one if it is wide."""

    chosen = Signal(object)
    """The kind of panel that the user chose."""

    def __init__(self, kinds: Sequence[type[Panel]]) -> None:
        super().__init__()
        assert len(kinds) <= _ROWS * _MAX_PER_ROW
        self.buttons: dict[type[Panel], QToolButton] = {}
        group = QButtonGroup(self)
        for kind in kinds:
            button = QToolButton()
            button.setText(name_panel(kind))
            button.setToolTip(describe_panel(kind))
            button.setCheckable(True)
            button.setAutoRaise(True)
            button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
            button.clicked.connect(lambda _=False, kind=kind: self.chosen.emit(kind))
            group.addButton(button)
            self.buttons[kind] = button
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setSpacing(2)
        self._rows = 0
        self._arrange(_ROWS)

    def _arrange(self, rows: int) -> None:
        if rows == self._rows:
            return
        self._rows = rows
        buttons = list(self.buttons.values())
        per_row = math.ceil(len(buttons) / rows)
        for k, button in enumerate(buttons):
            self._grid.addWidget(button, k // per_row, k % per_row)
        height = buttons[0].sizeHint().height()
        for row in range(_ROWS):
            self._grid.setRowMinimumHeight(row, height if row < rows else 0)
        for column in range(len(buttons)):
            self._grid.setColumnStretch(column, 1 if column < per_row else 0)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._arrange(1 if event.size().width() >= _WIDE else _ROWS)

    def show_chosen(self, kind: type[Panel]) -> None:
        """Show which panel is chosen, without announcing it."""
        self.buttons[kind].setChecked(True)
