"""The choice of what is printed on the board: the kind of pattern, and the fields of that kind."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QFileDialog,
    QFormLayout,
    QLabel,
    QSpinBox,
    QWidget,
)

from calibgui.engine import opencv
from calibgui.engine.boards import (
    CODE_LINES,
    FAMILIES,
    KINDS,
    AprilGrid,
    Charuco,
    Circles,
    ListedCircles,
    Pattern,
    PuzzleBoard,
    TaggedCheckerboard,
)
from calibgui.engine.errors import CalibrationError
from calibgui.formats.circle_list import read_circle_list
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.number_box import NumberBox
from calibgui.gui.widgets.pattern_texts import list_pattern_texts


class PatternChoice(QWidget):
    """A list of kinds, and below it the fields of the chosen kind.

    Fields that are left empty are read from the images.

    Args:
        undecided: the text of a field that is left empty.
    """

    changed = Signal()
    """The user has chosen another `pattern`."""
    listed = Signal(object, float)
    """The user has chosen a file that lists the circles: their pattern, and the pitch, mm."""
    failed = Signal(Exception)
    """The fields do not make a pattern."""

    def __init__(self, undecided: str) -> None:
        super().__init__()
        texts = list_pattern_texts()
        self.kind = QComboBox()
        self.kind.setAccessibleName(self.tr("Pattern"))
        self.kind.setToolTip(self.tr("What is printed on the board."))
        for kind in KINDS:
            self.kind.addItem(texts[kind].name, kind)
        self.dictionary = _make_choice(
            self.tr("The set of markers on the board, by OpenCV's name."),
            (undecided, None),
            *((name.removeprefix("DICT_"), name) for name in opencv.list_dictionaries()),
        )
        self.layout_used = _make_choice(
            self.tr("Boards with an even number of rows of squares changed with OpenCV 4.6."),
            (undecided, None),
            (self.tr("first square dark"), False),
            (self.tr("as before OpenCV 4.6"), True),
        )
        self.marker, self.diameter = (
            NumberBox(decimals=3, minimum=0.0, maximum=100_000.0) for _ in range(2)
        )
        for box in (self.marker, self.diameter):
            box.setSpecialValueText(undecided)
            box.setKeyboardTracking(False)
        self.layout_file = Button()
        self.layout_file.setToolTip(
            self.tr("A table (CSV) of the circles' x and y in mm, or the same as JSON.")
        )
        self.layout_file.clicked.connect(self._ask_for_layout)
        self.family = _make_choice(
            self.tr("The family of the AprilTags on the board."),
            (undecided, None),
            *((name, name) for name in FAMILIES),
        )
        self.spacing = NumberBox(decimals=3, minimum=0.0, maximum=1.0, singleStep=0.05)
        self.spacing.setToolTip(
            self.tr("The gap between tags over the side of a tag, at most 1: Kalibr's tagSpacing.")
        )
        self.spacing.setSpecialValueText(undecided)
        self.spacing.setKeyboardTracking(False)
        self.border = _make_choice(
            self.tr("The width of a tag's black border; 2 cells on Kalibr's."),
            (undecided, None),
            (self.tr("2 cells"), 2),
            (self.tr("1 cell"), 1),
        )
        self.order = _make_choice(
            self.tr("The row of tags that holds the lowest numbers."),
            (undecided, None),
            (self.tr("from the bottom, as Kalibr"), False),
            (self.tr("from the top"), True),
        )
        self.corner_squares = _make_choice(
            self.tr("Small dark squares between the corners of the tags, as on Kalibr's."),
            (undecided, None),
            (self.tr("between the tags"), True),
            (self.tr("none"), False),
        )
        self.first_tag = QSpinBox(minimum=-1, maximum=9999)
        self.first_tag.setToolTip(
            self.tr("The lowest number of a marker or tag on the board: 0 on most.")
        )
        self.first_tag.setSpecialValueText(undecided)
        self.first_tag.setKeyboardTracking(False)
        self.step = QSpinBox(minimum=0, maximum=64, singleStep=2)
        self.step.setToolTip(self.tr("The number of squares from one tag to the next in its row."))
        self.step.setSpecialValueText(undecided)
        self.step.setKeyboardTracking(False)
        self.first_row, self.first_col = (
            QSpinBox(minimum=0, maximum=CODE_LINES - 1) for _ in range(2)
        )
        for line in (self.first_row, self.first_col):
            line.setKeyboardTracking(False)
        self.first_row.setAccessibleName(self.tr("Row of the first corner"))
        self.first_col.setAccessibleName(self.tr("Column of the first corner"))
        self.origin = QWidget()
        self.origin.setToolTip(
            self.tr("Row and column of the board's first corner on the whole PuzzleBoard pattern.")
        )
        make_row((self.first_row, 1), QLabel("×"), (self.first_col, 1), of=self.origin)
        self.form = QFormLayout(self)
        self.form.setSpacing(theme.SPACING)
        self.form.setContentsMargins(0, 0, 0, 0)
        self.label = QLabel(self.tr("Pattern"))
        """The first label; the fields begin where the widest one of any pattern ends."""
        widest = (self.tr("Inner corners"), self.tr("Small squares"))
        self.label.setMinimumWidth(max(QLabel(text).sizeHint().width() for text in widest))
        self.form.addRow(self.label, self.kind)
        self.form.addRow(self.tr("List"), self.layout_file)
        self.form.addRow(self.tr("Dictionary"), self.dictionary)
        self.form.addRow(self.tr("Marker"), self.marker)
        self.form.addRow(self.tr("Layout"), self.layout_used)
        self.form.addRow(self.tr("Diameter"), self.diameter)
        self.form.addRow(self.tr("Tag family"), self.family)
        self.form.addRow(self.tr("Gap / side"), self.spacing)
        self.form.addRow(self.tr("Tag border"), self.border)
        self.form.addRow(self.tr("Tag step"), self.step)
        self.form.addRow(self.tr("Numbered"), self.order)
        self.form.addRow(self.tr("Small squares"), self.corner_squares)
        self.first_label = QLabel()
        self._show_first_number(self.tr("First marker"), None)
        self.form.addRow(self.first_label, self.first_tag)
        self.form.addRow(self.tr("First corner"), self.origin)
        self._pattern: Pattern = KINDS["checkerboard"]
        self._side = 1.0
        for combo in (
            self.kind,
            self.dictionary,
            self.layout_used,
            self.family,
            self.border,
            self.order,
            self.corner_squares,
        ):
            combo.setSizeAdjustPolicy(
                QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
            )
            combo.activated.connect(self._edit)
        for length in (self.marker, self.diameter, self.spacing):
            length.valueChanged.connect(self._edit)
        for count in (self.step, self.first_tag, self.first_row, self.first_col):
            count.valueChanged.connect(self._edit)
        self.show_pattern(self._pattern, 1.0)

    @property
    def pattern(self) -> Pattern:
        """The pattern as chosen."""
        return self._pattern

    def show_pattern(self, pattern: Pattern, side: float) -> None:
        """Show a pattern on squares of `side`, in the unit that lengths are to be in."""
        self._pattern, self._side = pattern, side
        charuco, circles = isinstance(pattern, Charuco), isinstance(pattern, Circles)
        grid, tagged = isinstance(pattern, AprilGrid), isinstance(pattern, TaggedCheckerboard)
        for field, shown in (
            (self.dictionary, charuco),
            (self.marker, charuco),
            (self.layout_used, charuco),
            (self.diameter, circles or isinstance(pattern, ListedCircles)),
            (self.layout_file, isinstance(pattern, ListedCircles)),
            (self.family, grid or tagged),
            (self.spacing, grid),
            (self.border, grid or tagged),
            (self.step, tagged),
            (self.order, grid or tagged),
            (self.corner_squares, grid),
            (self.first_tag, grid or charuco),
            (self.origin, isinstance(pattern, PuzzleBoard)),
        ):
            self.form.setRowVisible(field, shown)
        self.kind.setCurrentIndex(self.kind.findData(pattern.kind))
        if isinstance(pattern, Charuco):
            self.dictionary.setCurrentIndex(self.dictionary.findData(pattern.dictionary))
            self.layout_used.setCurrentIndex(self.layout_used.findData(pattern.legacy))
            self.marker.show_value((pattern.marker or 0.0) * side)
            self._show_first_number(self.tr("First marker"), pattern.first_marker)
        if isinstance(pattern, ListedCircles):
            text = self.tr("Choose a file…")
            if pattern.places is not None:
                text = self.tr("{0} circles…").format(len(pattern.places))
            self.layout_file.setText(text)
        if isinstance(pattern, Circles | ListedCircles):
            self.diameter.show_value((pattern.diameter or 0.0) * side)
        if isinstance(pattern, AprilGrid | TaggedCheckerboard):
            self.family.setCurrentIndex(self.family.findData(pattern.family))
            self.border.setCurrentIndex(self.border.findData(pattern.border))
            self.order.setCurrentIndex(self.order.findData(pattern.from_top))
        if isinstance(pattern, AprilGrid):
            self.spacing.show_value(pattern.spacing or 0.0)
            self.corner_squares.setCurrentIndex(
                self.corner_squares.findData(pattern.corner_squares)
            )
            self._show_first_number(self.tr("First tag"), pattern.first_tag)
        if isinstance(pattern, TaggedCheckerboard):
            with QSignalBlocker(self.step):
                self.step.setValue(pattern.step or 0)
        if isinstance(pattern, PuzzleBoard):
            for line, number in zip((self.first_row, self.first_col), pattern.origin, strict=True):
                with QSignalBlocker(line):
                    line.setValue(number)

    def _show_first_number(self, label: str, number: int | None) -> None:
        """Show the lowest number of the marks."""
        self.first_label.setText(label)
        self.first_tag.setAccessibleName(label)
        with QSignalBlocker(self.first_tag):
            self.first_tag.setValue(-1 if number is None else number)

    def _ask_for_layout(self) -> None:
        """Take the circles that a file of the user's choice lists."""
        name, _ = QFileDialog.getOpenFileName(
            self, self.tr("List of circles"), "", self.tr("Lists of circles (*.csv *.json)")
        )
        if not name:
            return
        try:
            pattern, pitch = read_circle_list(name)
        except CalibrationError as error:
            self.failed.emit(error)
            return
        self.show_pattern(pattern, self._side)
        self.listed.emit(pattern, pitch)

    def _edit(self) -> None:
        pattern = KINDS[self.kind.currentData()]
        first = None if self.first_tag.value() < 0 else self.first_tag.value()
        try:
            if isinstance(pattern, Charuco) and isinstance(self._pattern, Charuco):
                marker = self.marker.value() / self._side
                pattern = Charuco(
                    self.dictionary.currentData(),
                    marker or None,
                    self.layout_used.currentData(),
                    first,
                )
            if (
                isinstance(self._pattern, Circles | ListedCircles)
                and pattern.kind == self._pattern.kind
            ):
                diameter = self.diameter.value() / self._side or None
                pattern = replace(self._pattern, diameter=diameter)
            if isinstance(pattern, AprilGrid) and isinstance(self._pattern, AprilGrid):
                pattern = AprilGrid(
                    self.family.currentData(),
                    self.spacing.value() or None,
                    self.border.currentData(),
                    self.order.currentData(),
                    self.corner_squares.currentData(),
                    first,
                    self._pattern.tag_turn,
                )
            if isinstance(pattern, TaggedCheckerboard) and pattern.kind == self._pattern.kind:
                pattern = TaggedCheckerboard(
                    self.family.currentData(),
                    self.border.currentData(),
                    self.step.value() or None,
                    self.order.currentData(),
                )
            if isinstance(pattern, PuzzleBoard) and pattern.kind == self._pattern.kind:
                pattern = PuzzleBoard((self.first_row.value(), self.first_col.value()))
        except CalibrationError as error:
            self.show_pattern(self._pattern, self._side)
            self.failed.emit(error)
            return
        if pattern != self._pattern:
            self.show_pattern(pattern, self._side)
            self.changed.emit()


def _make_choice(tip: str, *choices: tuple[str, Any]) -> QComboBox:
    """Make a list to choose from, of texts with their values, and its tooltip."""
    box = QComboBox()
    box.setToolTip(tip)
    for text, value in choices:
        box.addItem(text, value)
    return box
