"""The line above the image while corners are being put right by hand."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from calibgui.engine.types import Board
from calibgui.gui import theme


class _Bar(QFrame):
    """Words over buttons."""

    def __init__(self) -> None:
        super().__init__()
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setAutoFillBackground(True)
        self.setBackgroundRole(self.backgroundRole().AlternateBase)
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.row = QHBoxLayout()
        self.row.addStretch(1)
        column = QVBoxLayout(self)
        column.setContentsMargins(theme.SPACING, 4, theme.SPACING, 4)
        column.addWidget(self.words)
        column.addLayout(self.row)
        self.hide()

    def add(self, *widgets: QWidget) -> None:
        for widget in widgets:
            self.row.addWidget(widget)


class RoiBar(_Bar):
    """Says what to click next, and how many squares there are."""

    board_changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.squares = tuple(QSpinBox(minimum=3, maximum=201) for _ in range(2))
        for box, name in zip(
            self.squares, (self.tr("Squares down"), self.tr("Squares across")), strict=True
        ):
            box.setAccessibleName(name)
            box.setToolTip(
                self.tr("Squares between the clicks and one more on each side, as counted.")
            )
            box.valueChanged.connect(self.board_changed)
        self.accept = QPushButton(self.tr("&Accept"))
        self.accept.setToolTip(self.tr("Keep these corners and go on (Enter)"))
        self.leave = QPushButton(self.tr("Lea&ve"))
        self.leave.setToolTip(self.tr("Leave the image as it was (Esc)"))
        self.add(
            QLabel(self.tr("Squares")),
            self.squares[0],
            QLabel("×"),
            self.squares[1],
            self.accept,
            self.leave,
        )

    @property
    def board(self) -> Board:
        """Rows and columns of inner corners: one fewer than squares."""
        return self.squares[0].value() - 1, self.squares[1].value() - 1

    def show_board(self, board: Board) -> None:
        """Show a board's size without announcing it."""
        for box, count in zip(self.squares, board, strict=True):
            box.blockSignals(True)
            box.setValue(count + 1)
            box.blockSignals(False)


class CornerBar(_Bar):
    """What can be done to single corners, and to the numbering of all."""

    turn_wanted = Signal()
    flip_wanted = Signal()
    left = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.words.setText(
            self.tr(
                "Drag a corner to move it, Delete removes it, a click on a red ring finds it "
                "again. Ctrl: do not snap."
            )
        )
        self.turn = QPushButton(self.tr("&Turn 90°"))
        self.turn.setToolTip(self.tr("Count from the board's next corner"))
        self.flip = QPushButton(self.tr("F&lip"))
        self.flip.setToolTip(self.tr("Count columns from the other end: for mirrored images"))
        self.leave = QPushButton(self.tr("&Done"))
        self.turn.clicked.connect(self.turn_wanted)
        self.flip.clicked.connect(self.flip_wanted)
        self.leave.clicked.connect(self.left)
        self.add(self.turn, self.flip, self.leave)
