"""The choice of what is known of the board's shape."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QFileDialog,
    QFormLayout,
    QWidget,
)

from calibgui.engine.boards import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.errors import CalibrationError
from calibgui.formats.board_shape_json import read_board_shape
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.narrow_combo import NarrowCombo
from calibgui.gui.widgets.number_box import NumberBox

translate = QCoreApplication.translate
_OFFICE_PRIOR = BoardShapePrior(in_plane=0.1, out_of_plane=0.3)
"""Standard deviations of a board from an office printer that is glued to something stiff, mm."""

_KNOWN = (BoardShapeModel.NOMINAL, BoardShapeModel.FREE)
"""Choices beside which it can be stated how far corners may be from where they should be."""
_FROM_FILE = "file"


def add_board_shapes(combo: NarrowCombo) -> None:
    """Add the shapes that can be estimated to a choice, each with what it means."""
    for model, text, tip in (
        (
            BoardShapeModel.NOMINAL,
            translate("BoardShapeChoice", "as drawn"),
            translate(
                "BoardShapeChoice",
                "Flat and printed true (nominal). Its errors become the camera's.",
            ),
        ),
        (
            BoardShapeModel.AFFINE,
            translate("BoardShapeChoice", "stretched or askew"),
            translate(
                "BoardShapeChoice", "Sides of unequal scale, not quite at right angles (affine)."
            ),
        ),
        (
            BoardShapeModel.BOW,
            translate("BoardShapeChoice", "bowed"),
            translate("BoardShapeChoice", "Bent along rows and columns (bow)."),
        ),
        (
            BoardShapeModel.FREE,
            translate("BoardShapeChoice", "free: every corner"),
            translate(
                "BoardShapeChoice",
                "Every corner is estimated in three dimensions (free). Needs 6 views, and "
                "every corner in 4 of them, or a prior.",
            ),
        ),
    ):
        combo.add_explained(text, model, tip)


class BoardShapeChoice(QWidget):
    """A model to estimate or a known shape to hold, and what is known of the corners' places."""

    changed = Signal()
    slid = Signal()
    """The prior is being changed, and may go on changing."""
    failed = Signal(Exception)
    """The chosen file holds no board shape."""

    def __init__(self) -> None:
        super().__init__()
        self.board_shape: BoardShapeModel | BoardShape | None = BoardShapeModel.NOMINAL
        """The choice, as in `Settings.board_shape`."""
        self.model = NarrowCombo()
        self.model.setAccessibleName(self.tr("Shape of the board"))
        add_board_shapes(self.model)
        self.model.add_explained(
            self.tr("what predicts best"),
            None,
            self.tr("Of these, the one that predicts views best that it has not seen. Slow."),
        )
        self.model.add_explained(
            self.tr("as in a file…"), _FROM_FILE, self.tr("Hold a shape that was saved before.")
        )
        self.known = QCheckBox(self.tr("known to"))
        self.in_plane = self._make_length(
            _OFFICE_PRIOR.in_plane,
            self.tr(" mm in plane"),
            self.tr("Standard deviation of the print in the plane, mm"),
        )
        self.out_of_plane = self._make_length(
            _OFFICE_PRIOR.out_of_plane,
            self.tr(" mm off plane"),
            self.tr("Standard deviation out of the plane: flatness, mm"),
        )
        self.known.setToolTip(
            self.tr(
                "State how far corners may be from where they should be: in the plane, and out "
                "of it. Every ± counts it, and few views can then carry a free board."
            )
        )
        row = make_row((self.in_plane, 1), (self.out_of_plane, 1))
        form = QFormLayout(self)
        form.setSpacing(theme.SPACING)
        form.setContentsMargins(0, 0, 0, 0)
        form.addRow(self.tr("Boar&d is"), self.model)
        form.addRow(self.known, row)
        self.model.activated.connect(self._choose)
        self.known.clicked.connect(self._edit_known)

    @property
    def prior(self) -> BoardShapePrior | None:
        """The standard deviations that are stated for a board as drawn or of free shape; None for
        other choices."""
        if self.board_shape not in _KNOWN or not self.known.isChecked():
            return None
        return BoardShapePrior(self.in_plane.value(), self.out_of_plane.value())

    def show_choice(
        self, board_shape: BoardShapeModel | BoardShape | None, prior: BoardShapePrior | None
    ) -> None:
        """Show a choice without announcing it."""
        self.board_shape = board_shape
        last = self.model.count() - 1
        self.model.setItemText(
            last,
            self.tr("as in a file: {0:.2g} mm off").format(board_shape.rms)
            if isinstance(board_shape, BoardShape)
            else self.tr("as in a file…"),
        )
        chosen = last if isinstance(board_shape, BoardShape) else self.model.findData(board_shape)
        self.model.setCurrentIndex(chosen)
        self.known.setChecked(prior is not None)
        if prior is not None:
            self.in_plane.show_value(prior.in_plane)
            self.out_of_plane.show_value(prior.out_of_plane)
        self._enable()

    def _make_length(self, value: float, unit: str, tip: str) -> NumberBox:
        box = NumberBox(decimals=3, minimum=0.001, maximum=9.0, singleStep=0.05, suffix=unit)
        box.setValue(value)
        box.setKeyboardTracking(False)
        box.setButtonSymbols(NumberBox.ButtonSymbols.NoButtons)
        box.setToolTip(tip)
        box.setAccessibleName(tip)
        box.valueChanged.connect(self.slid)
        return box

    def _enable(self) -> None:
        takes_prior = self.board_shape in _KNOWN
        self.known.setEnabled(takes_prior)
        for box in (self.in_plane, self.out_of_plane):
            box.setEnabled(takes_prior and self.known.isChecked())

    def _edit_known(self) -> None:
        self._enable()
        self.changed.emit()

    def _choose(self) -> None:
        model = self.model.currentData()
        if model == _FROM_FILE:
            self._ask_for_file()
        else:
            self.board_shape = None if model is None else BoardShapeModel(model)
        self.changed.emit()

    def _ask_for_file(self) -> None:
        name, _ = QFileDialog.getOpenFileName(
            self, self.tr("The board's shape"), "", self.tr("Shapes (*.json)")
        )
        if name:
            try:
                self.board_shape = read_board_shape(name)
            except CalibrationError as error:
                self.failed.emit(error)
        self.show_choice(self.board_shape, self.prior)
