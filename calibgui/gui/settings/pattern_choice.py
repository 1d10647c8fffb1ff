"""The choice of what is printed on the board: the kind of pattern, and the fields of that kind."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QComboBox, QDoubleSpinBox, QFormLayout, QLabel, QWidget

from calibgui.engine import opencv
from calibgui.engine.boards import KINDS, Charuco, Circles, Pattern
from calibgui.engine.errors import CalibrationError
from calibgui.gui.widgets.pattern_texts import list_pattern_texts


class PatternChoice(QWidget):
    """A list of kinds, and below it the fields of the chosen kind.

    Fields that are left empty are read from the images.

    Args:
        undecided: the text of a field that is left empty.
    """

    changed = Signal()
    """The user has chosen another `pattern`."""
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
        self.dictionary = QComboBox()
        self.dictionary.setToolTip(self.tr("The set of markers on the board, by OpenCV's name."))
        self.dictionary.addItem(undecided, None)
        for name in opencv.list_dictionaries():
            self.dictionary.addItem(name.removeprefix("DICT_"), name)
        self.layout_used = QComboBox()
        self.layout_used.setToolTip(
            self.tr("Boards with an even number of rows of squares changed with OpenCV 4.6.")
        )
        for text, legacy in (
            (undecided, None),
            (self.tr("first square dark"), False),
            (self.tr("as before OpenCV 4.6"), True),
        ):
            self.layout_used.addItem(text, legacy)
        self.marker, self.diameter = (
            QDoubleSpinBox(decimals=3, minimum=0.0, maximum=100_000.0) for _ in range(2)
        )
        for box in (self.marker, self.diameter):
            box.setSpecialValueText(undecided)
            box.setKeyboardTracking(False)
        self.form = QFormLayout(self)
        self.form.setContentsMargins(0, 0, 0, 0)
        label = QLabel(self.tr("Pattern"))
        label.setMinimumWidth(self.fontMetrics().horizontalAdvance(self.tr("Inner corners")))
        self.form.addRow(label, self.kind)
        self.form.addRow(self.tr("Dictionary"), self.dictionary)
        self.form.addRow(self.tr("Marker"), self.marker)
        self.form.addRow(self.tr("Layout"), self.layout_used)
        self.form.addRow(self.tr("Diameter"), self.diameter)
        self._pattern: Pattern = KINDS["checkerboard"]
        self._side = 1.0
        for combo in (self.kind, self.dictionary, self.layout_used):
            combo.setSizeAdjustPolicy(
                QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
            )
            combo.activated.connect(self._edit)
        for box in (self.marker, self.diameter):
            box.valueChanged.connect(self._edit)
        self.show_pattern(self._pattern, 1.0)

    @property
    def pattern(self) -> Pattern:
        """The pattern as chosen."""
        return self._pattern

    def show_pattern(self, pattern: Pattern, side: float) -> None:
        """Show a pattern on squares of `side`, in the unit that lengths are to be in."""
        self._pattern, self._side = pattern, side
        charuco, circles = isinstance(pattern, Charuco), isinstance(pattern, Circles)
        for field, shown in (
            (self.dictionary, charuco),
            (self.marker, charuco),
            (self.layout_used, charuco),
            (self.diameter, circles),
        ):
            self.form.setRowVisible(field, shown)
        self.kind.setCurrentIndex(self.kind.findData(pattern.kind))
        if isinstance(pattern, Charuco):
            self.dictionary.setCurrentIndex(self.dictionary.findData(pattern.dictionary))
            self.layout_used.setCurrentIndex(self.layout_used.findData(pattern.legacy))
            _show(self.marker, (pattern.marker or 0.0) * side)
        if isinstance(pattern, Circles):
            _show(self.diameter, (pattern.diameter or 0.0) * side)

    def _edit(self) -> None:
        pattern = KINDS[self.kind.currentData()]
        try:
            if isinstance(pattern, Charuco) and pattern.kind == self._pattern.kind:
                marker = self.marker.value() / self._side
                pattern = Charuco(
                    self.dictionary.currentData(), marker or None, self.layout_used.currentData()
                )
            if isinstance(pattern, Circles) and pattern.kind == self._pattern.kind:
                pattern = replace(pattern, diameter=self.diameter.value() / self._side or None)
        except CalibrationError as error:
            self.show_pattern(self._pattern, self._side)
            self.failed.emit(error)
            return
        if pattern != self._pattern:
            self.show_pattern(pattern, self._side)
            self.changed.emit()


def _show(box: QDoubleSpinBox, value: float) -> None:
    """Show a value without a signal."""
    box.blockSignals(True)
    if abs(box.value() - value) > 10.0 ** -box.decimals() / 2:
        box.setValue(value)
    box.blockSignals(False)
