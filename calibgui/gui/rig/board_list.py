"""The boards of a rig: which there are, and what is known of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QAbstractSpinBox,
    QCheckBox,
    QFormLayout,
    QLabel,
    QListWidget,
    QWidget,
)

from calibgui.app.projects.lengths import scale_pattern
from calibgui.app.rig.boards import StatedBoard
from calibgui.app.rig.rig_setup import state_board, suggest_board
from calibgui.dataset import DEFAULT_SQUARE
from calibgui.engine.boards import Board, ListedCircles, Pattern
from calibgui.engine.geometry import Pose
from calibgui.gui.settings.pattern_choice import PatternChoice
from calibgui.gui.settings.size_boxes import UNKNOWN, make_size_boxes
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.number_box import NumberBox
from calibgui.gui.widgets.pattern_texts import list_pattern_texts, name_points, name_side

_MOST_SEEN = 4
"""Number of boards that are seen at once, at most."""
_PLACE_WIDTH = 72
"""Least width of a number of a board's place, device-independent px."""


class BoardList(QWidget):
    """A list of boards, and below it the fields of the chosen one; one board needs no list."""

    changed = Signal()
    """The user states other `boards`."""

    def __init__(self) -> None:
        super().__init__()
        self.boards: tuple[StatedBoard, ...] = (StatedBoard(),)
        """The boards as stated."""
        self._seen: Sequence[Board | None] = ()
        self.list = QListWidget()
        self.list.setAccessibleName(self.tr("Boards"))
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setTextElideMode(Qt.TextElideMode.ElideRight)
        self.add, self.remove = Button(self.tr("Add a &board")), Button(self.tr("Re&move"))
        self.add.setToolTip(
            self.tr(
                "A further board that stands fast to the first and is told from it by its markers "
                "or tags"
            )
        )
        self.recognised = QCheckBox(self.tr("As the photo&graphs show it"))
        self.recognised.setToolTip(
            self.tr("Take the board that the photographs show; turn it off to state it.")
        )
        self.pattern = PatternChoice(self.tr("not stated"))
        self.rows, self.cols = make_size_boxes()
        self.square = NumberBox(decimals=3, minimum=0.0, maximum=100_000.0)
        self.square.setSuffix(self.tr(" mm"))
        self.square.setSpecialValueText(self.tr("taken as {0} mm").format(f"{DEFAULT_SQUARE:g}"))
        self.square.setToolTip(
            self.tr("Not measured if 0: all lengths then hold for squares so long")
        )
        self.square.setAccessibleName(self.tr("Side of a square"))
        self.is_placed = QCheckBox(self.tr("Stands where I &know"))
        self.is_placed.setToolTip(
            self.tr(
                "State where the board stands beside the first one; turn it off to have that "
                "estimated with the rig."
            )
        )
        self.place = [self._make_place_box(axis) for axis in range(6)]
        self._lay_out()
        self.list.currentRowChanged.connect(self._show_fields)
        self.add.clicked.connect(self._add)
        self.remove.clicked.connect(self._remove)
        self.recognised.clicked.connect(self._choose_recognition)
        self.pattern.changed.connect(lambda: self._state(pattern=self.pattern.pattern))
        self.pattern.listed.connect(self._take_list)
        for box in (self.rows, self.cols):
            box.valueChanged.connect(self._edit_size)
        self.square.valueChanged.connect(self._edit_square)
        self.is_placed.clicked.connect(self._edit_place)
        for value in self.place:
            value.valueChanged.connect(self._edit_place)
        for field in (self.rows, self.cols, self.square, *self.place):
            field.setKeyboardTracking(False)  # a number that is being typed is not meant yet
        self.show_boards(self.boards, ())

    def _make_place_box(self, axis: int) -> NumberBox:
        """Make the box of one of X, Y, Z, mm, and the rotation vector about them, degrees."""
        largest = 100_000.0 if axis < 3 else 180.0
        box = NumberBox(decimals=3, minimum=-largest, maximum=largest)
        box.setButtonSymbols(QAbstractSpinBox.ButtonSymbols.NoButtons)
        box.setMinimumWidth(_PLACE_WIDTH)
        box.setPrefix(f"{'' if axis < 3 else 'r'}{'XYZ'[axis % 3]} ")
        box.setSuffix("" if axis < 3 else "°")
        name = self.tr("{0}, mm") if axis < 3 else self.tr("rotation vector, {0}, degrees")
        box.setAccessibleName(name.format("XYZ"[axis % 3]))
        box.setToolTip(box.accessibleName())
        return box

    def _lay_out(self) -> None:
        self.counted, self.side = QLabel(), QLabel()
        self.fields = QFormLayout()
        self.fields.setSpacing(theme.SPACING)
        self._sizes = make_row((self.rows, 1), QLabel("×"), (self.cols, 1))
        self._places = make_column(
            QLabel(self.tr("Beside board 1, in mm and degrees:")),
            *(make_row(*((box, 1) for box in three)) for three in (self.place[:3], self.place[3:])),
            spacing=theme.SPACING // 2,
        )
        self.fields.addRow(self.recognised)
        self.fields.addRow(self.pattern)
        self.fields.addRow(self.counted, self._sizes)
        self.fields.addRow(self.side, self.square)
        self.fields.addRow(self.is_placed)
        self.fields.addRow(self._places)
        make_column(self.list, make_row(self.add, self.remove, None), self.fields, of=self)
        for label in (self.counted, self.side):
            label.setMinimumWidth(self.pattern.label.minimumWidth())  # fields begin alike

    def show_boards(self, boards: Sequence[StatedBoard], seen: Sequence[Board | None]) -> None:
        """Show what is stated, without announcing it.

        Args:
            boards: the boards as stated.
            seen: the boards as the photographs show them; none if they were not searched.
        """
        row = max(self.list.currentRow(), 0)
        self.boards, self._seen = tuple(boards), seen
        with QSignalBlocker(self.list):
            self.list.clear()
            self.list.addItems([self._describe(b) for b in range(len(boards))])
            self.list.setCurrentRow(min(row, len(boards) - 1))
        height = max(self.list.sizeHintForRow(0), 1) * min(len(boards), _MOST_SEEN)
        self.list.setFixedHeight(height + 2 * self.list.frameWidth())
        self._show_fields()

    def _describe(self, b: int) -> str:
        """Describe a board in a line."""
        stated, seen = self.boards[b], self._find_seen(b)
        pattern = stated.pattern or (seen and seen.pattern)
        size = stated.grid_size or (seen and seen.grid_size)
        parts = [self.tr("Board {0}").format(b + 1)]
        if pattern:
            parts.append(list_pattern_texts()[pattern.kind].name)
        if size:
            parts.append("{}×{}".format(*size))
        return ", ".join(parts)

    def _find_seen(self, b: int) -> Board | None:
        return self._seen[b] if b < len(self._seen) else None

    def _show_fields(self) -> None:
        """Show the fields of the chosen board that it leaves to be stated."""
        b = self.list.currentRow()
        board, seen, is_only = self.boards[b], self._find_seen(b), len(self.boards) == 1
        is_recognised = board.pattern is None
        shown = state_board(board, seen)
        assert shown.pattern is not None
        self.list.setVisible(not is_only)
        self.remove.setVisible(not is_only)
        self.fields.setRowVisible(self.recognised, is_only)
        self.recognised.setChecked(is_recognised)
        self.fields.setRowVisible(self.pattern, not is_recognised)
        is_listed = isinstance(shown.pattern, ListedCircles)
        self.fields.setRowVisible(self._sizes, not (is_recognised or is_listed))
        self.fields.setRowVisible(self.is_placed, b > 0)
        self.fields.setRowVisible(self._places, b > 0 and board.pose is not None)
        self.pattern.show_pattern(shown.pattern, board.square or DEFAULT_SQUARE)
        self.counted.setText(name_points(shown.pattern))
        self.side.setText(name_side(shown.pattern))
        size = board.grid_size or (UNKNOWN, UNKNOWN)
        for box, value in zip((self.rows, self.cols), size, strict=True):
            with QSignalBlocker(box):
                box.setValue(value)
        self.square.show_value(board.square or 0.0)
        self.is_placed.setChecked(board.pose is not None)
        pose = board.pose or Pose(np.zeros(3), np.zeros(3))
        values = [*pose.tvec, *np.degrees(pose.rvec)]
        for field, number in zip(self.place, values, strict=True):
            field.show_value(float(number))

    def _state(self, **changes: Any) -> None:
        """State something else of the chosen board."""
        b = self.list.currentRow()
        board = replace(self.boards[b], **changes)
        if board != self.boards[b]:
            self._take((*self.boards[:b], board, *self.boards[b + 1 :]))

    def _take(self, boards: Sequence[StatedBoard]) -> None:
        self.show_boards(boards, self._seen)
        self.changed.emit()

    def _add(self) -> None:
        """Add a board, and choose it; the only one before it is stated from now on."""
        stated = [state_board(board, self._find_seen(b)) for b, board in enumerate(self.boards)]
        boards = [*stated, suggest_board(stated)]
        with QSignalBlocker(self.list):
            self.list.addItem("")
            self.list.setCurrentRow(len(stated))
        self._take(boards)

    def _remove(self) -> None:
        """Remove the chosen board; places are stated beside the first, and go with it."""
        b = self.list.currentRow()
        boards = [*self.boards[:b], *self.boards[b + 1 :]]
        if b == 0:
            boards = [replace(board, pose=None) for board in boards]
        self._take(boards)

    def _choose_recognition(self, is_recognised: bool) -> None:
        if is_recognised:
            self._state(pattern=None, grid_size=None)
        else:
            stated = state_board(self.boards[0], self._find_seen(0))
            self._state(pattern=stated.pattern, grid_size=stated.grid_size)

    def _edit_size(self) -> None:
        """State the rows and columns once both are known."""
        size = self.rows.value(), self.cols.value()
        if UNKNOWN not in size:
            self._state(grid_size=size)

    def _edit_square(self, side: float) -> None:
        """State the side of a square; markers and circles keep their size."""
        board = self.boards[self.list.currentRow()]
        pattern = board.pattern
        if pattern is not None:
            ratio = (board.square or DEFAULT_SQUARE) / (side or DEFAULT_SQUARE)
            pattern = scale_pattern(pattern, ratio)
        self._state(square=side or None, pattern=pattern)

    def _take_list(self, pattern: Pattern, pitch: float) -> None:
        """Take a board of listed circles, whose lengths the list states."""
        self._state(pattern=pattern, square=pitch)

    def _edit_place(self) -> None:
        values = np.array([box.value() for box in self.place])
        is_stated = self.is_placed.isChecked()
        self._state(pose=Pose(np.radians(values[3:]), values[:3]) if is_stated else None)
