"""The marking bar guides the user in the inspector while corners are marked by hand."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import (
    QFrame,
    QLabel,
    QPushButton,
    QSpinBox,
    QWidget,
)

from calibgui.engine.arrays import GridSize
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.reserved_label import ReservedLabel

_LINES = 3
"""Lines of the words: nothing must move between two clicks."""


class _Bar(QFrame):
    """Words over buttons; Enter and Esc mean what they mean on the image."""

    def __init__(self, accept: QPushButton, leave: QPushButton) -> None:
        super().__init__()
        self.accept, self.leave = accept, leave
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.words = ReservedLabel(_LINES)
        self._rows = make_column(self.words, of=self)
        self.hide()

    def add_row(self, *widgets: QWidget) -> None:
        """Add a row of widgets below the others."""
        row = make_row(None, *widgets)
        self._rows.addLayout(row)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 - Qt's name
        match event.key():
            case Qt.Key.Key_Return | Qt.Key.Key_Enter:
                self.accept.click()
            case Qt.Key.Key_Escape:
                self.leave.click()
            case _:
                super().keyPressEvent(event)


class RoiBar(_Bar):
    """Says what to click next, and how many corners there are."""

    board_changed = Signal()

    def __init__(self) -> None:
        super().__init__(Button(self.tr("&Accept"), Kind.MAIN), Button(self.tr("Lea&ve")))
        self.counts = tuple(QSpinBox(minimum=2, maximum=200) for _ in range(2))
        names = (self.tr("rows of inner corners"), self.tr("columns of inner corners"))
        for box, name in zip(self.counts, names, strict=True):
            box.setAccessibleName(name)
            box.setToolTip(
                self.tr(
                    "As counted between the clicks, with those clicked. State it if the count is "
                    "wrong."
                )
            )
            box.valueChanged.connect(self.board_changed)
        self.accept.setToolTip(self.tr("Keep these corners and go on (Enter)"))
        self.leave.setToolTip(self.tr("Leave the image as it was (Esc)"))
        self.counted = QLabel()
        self.add_row(self.counted, self.counts[0], QLabel("×"), self.counts[1])
        self.add_row(self.accept, self.leave)

    @property
    def grid_size(self) -> GridSize:
        """Rows and columns of inner corners."""
        return self.counts[0].value(), self.counts[1].value()

    def show_board(self, grid_size: GridSize) -> None:
        """Show a board's size without announcing it."""
        for box, count in zip(self.counts, grid_size, strict=True):
            blocked = box.blockSignals(True)
            box.setValue(count)
            box.blockSignals(blocked)


class CornerBar(_Bar):
    """The buttons for single corners, and for the numbering of all."""

    turn_wanted = Signal()
    flip_wanted = Signal()
    left = Signal()

    def __init__(self) -> None:
        done = Button(self.tr("&Done"))
        super().__init__(done, done)
        self.words.setText(
            self.tr(
                "Drag a corner to move it, Delete removes it, a click on a red ring finds it "
                "again. Ctrl: do not snap."
            )
        )
        self.turn = Button(self.tr("&Turn 90°"))
        self.turn.setToolTip(self.tr("Count from the board's next corner"))
        self.flip = Button(self.tr("F&lip"))
        self.flip.setToolTip(self.tr("Count columns from the other end: for mirrored images"))
        self.turn.clicked.connect(self.turn_wanted)
        self.flip.clicked.connect(self.flip_wanted)
        self.leave.clicked.connect(self.left)
        self.add_row(self.turn, self.flip, self.leave)
