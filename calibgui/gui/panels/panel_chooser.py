"""The names of a group's panels, of which one is chosen."""

from __future__ import annotations

import math
from collections.abc import Sequence

from PySide6.QtCore import QCoreApplication, Signal
from PySide6.QtWidgets import QButtonGroup, QGridLayout, QSizePolicy, QToolButton, QWidget

from calibgui.gui.panels.panel import Panel

_MAX_PER_ROW = 3
_ROWS = 2
"""Of every group, so that choosing another one moves nothing."""


class PanelChooser(QWidget):
    """Shows every name at once, in two rows of equally many, or nearly so."""

    chosen = Signal(object)
    """The kind of panel that the user chose."""

    def __init__(self, kinds: Sequence[type[Panel]]) -> None:
        super().__init__()
        per_row = math.ceil(len(kinds) / _ROWS)
        assert per_row <= _MAX_PER_ROW
        self.buttons: dict[type[Panel], QToolButton] = {}
        group = QButtonGroup(self)
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(2)
        for k, kind in enumerate(kinds):
            button = QToolButton()
            button.setText(QCoreApplication.translate(kind.__name__, kind.title))
            button.setCheckable(True)
            button.setAutoRaise(True)
            button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
            button.clicked.connect(lambda _=False, kind=kind: self.chosen.emit(kind))
            group.addButton(button)
            grid.addWidget(button, k // per_row, k % per_row)
            self.buttons[kind] = button
        height = next(iter(self.buttons.values())).sizeHint().height()
        for row in range(_ROWS):
            grid.setRowMinimumHeight(row, height)
        for column in range(per_row):
            grid.setColumnStretch(column, 1)

    def show_chosen(self, kind: type[Panel]) -> None:
        """Show which panel is chosen, without announcing it."""
        self.buttons[kind].setChecked(True)
