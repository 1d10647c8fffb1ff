"""The board: how many inner corners, and how large the squares."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFormLayout,
    QLabel,
    QSpinBox,
    QWidget,
)

from calibgui.app.photographs.interlacing import INTERLACED
from calibgui.app.projects.lengths import set_square, set_square_sigma
from calibgui.app.projects.project import (
    Project,
    Unit,
    set_field,
    set_grid_size,
    set_method,
    set_pattern,
)
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import ListedCircles, Pattern
from calibgui.engine.images import Field
from calibgui.gui.session.session import Session
from calibgui.gui.settings.pattern_choice import PatternChoice
from calibgui.gui.settings.size_boxes import UNKNOWN, make_size_boxes
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import INDENTED, make_row
from calibgui.gui.widgets.narrow_combo import NarrowCombo
from calibgui.gui.widgets.number_box import NumberBox
from calibgui.gui.widgets.pattern_texts import name_points, name_side
from calibgui.gui.widgets.sizes import set_times_signs
from calibgui.report.boards import describe_recognised_board


class BoardPanel(QWidget):
    """Pattern and size of the board, as stated or as seen."""

    search_wanted = Signal()
    """The board has changed: images wait to be searched."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self.inferred = QCheckBox(self.tr("&Counted in the images"))
        self.inferred.setToolTip(
            self.tr("Take the size that most images show; turn it off to state it.")
        )
        self.rows, self.cols = make_size_boxes()
        self._document = session.document
        self._typing = False
        """True if the boxes show what is being typed in place of the project's board."""
        self.square = NumberBox(decimals=3, minimum=0.001, maximum=100_000.0)
        self.square.setToolTip(
            self.tr(
                "Side of one square. Only the distances depend on it: measure several squares "
                "together and divide."
            )
        )
        self.square.setAccessibleName(self.tr("Side of a square"))
        self.square_sigma = NumberBox(decimals=4, minimum=0.0, maximum=1000.0, singleStep=0.01)
        self.square_sigma.setSpecialValueText(self.tr("exact"))
        self.square_sigma.setToolTip(
            self.tr(
                "One standard deviation of the side, which all squares share: every length is "
                "uncertain by the same share. A certificate's U (k = 2) is twice as much."
            )
        )
        self.square_sigma.setAccessibleName(self.tr("Standard deviation of the side of a square"))
        self.unit = QComboBox()
        self.unit.addItems(list(Unit))
        self.unit.setAccessibleName(self.tr("Unit"))
        self.method = NarrowCombo()
        for method, text, tip in (
            (
                "edges",
                self.tr("by their edges"),
                self.tr(
                    "Fit the edges that cross at each corner, as exactly as the noise allows, and "
                    "tell how exact that is."
                ),
            ),
            (
                "saddle",
                self.tr("by the saddle point"),
                self.tr("As the paper does: the saddle point of the grey levels at each corner."),
            ),
        ):
            self.method.add_explained(text, method, tip)
        self.method.setToolTip(self.tr("How corners are located; another way searches anew."))
        self.field = NarrowCombo()
        self.field.addItem(self.tr("all rows"), None)
        self.field.addItem(self.tr("odd rows"), Field.ODD)
        self.field.addItem(self.tr("even rows"), Field.EVEN)
        self.field.setToolTip(
            self.tr(
                "Search one field of interlaced frames, in which edges that moved between the two "
                "are not combed. The rows between are interpolated."
            )
        )
        self.by_hand = QCheckBox(self.tr("Mar&k all by hand"))
        self.by_hand.setToolTip(
            self.tr(
                "Images are not searched: point at each board's four outermost corners (M), and "
                "Enter goes on to the next image."
            )
        )

        self.pattern = PatternChoice(self.tr("read from the images"))
        self.counted, self.side = QLabel(), QLabel()
        self.counted.setMinimumWidth(self.pattern.label.minimumWidth())  # fields begin alike
        corners = make_row((self.rows, 1), QLabel("×"), (self.cols, 1))
        side = make_row((self.square, 1), QLabel("±"), (self.square_sigma, 1), self.unit)
        form = self._form = QFormLayout(self)
        form.setSpacing(theme.SPACING)
        form.setContentsMargins(*INDENTED)
        form.addRow(self.pattern)
        form.addRow(self.counted, corners)
        form.addRow("", self.inferred)
        form.addRow(self.tr("Loca&ted"), self.method)
        form.addRow(self.tr("Interlaced"), self.field)
        form.addRow(self.side, side)
        form.addRow("", self.by_hand)

        self.pattern.changed.connect(self._edit_pattern)
        self.pattern.listed.connect(self._take_list)
        self.pattern.failed.connect(session.failed)
        self.inferred.clicked.connect(self._choose_counting)
        for box, other in ((self.rows, self.cols), (self.cols, self.rows)):
            box.valueChanged.connect(self._begin_typing)
            box.editingFinished.connect(partial(self._leave_box, other))
        self.square.valueChanged.connect(self._edit_square)
        self.square_sigma.valueChanged.connect(self._edit_square_sigma)
        for length in (self.square, self.square_sigma):
            length.editingFinished.connect(lambda: session.document.end_sliding_edit())
        self.method.activated.connect(self._edit_method)
        self.field.activated.connect(self._edit_field)
        self.by_hand.clicked.connect(self._edit_by_hand)
        self.unit.activated.connect(self._edit_unit)
        session.changed.connect(self._project_changed)
        self._refresh()

    def _project_changed(self, before: Project, after: Project) -> None:
        if self._session.document is not self._document or before.grid_size != after.grid_size:
            self._document, self._typing = self._session.document, False
        if before.field != after.field:
            for view in after.views:
                self._session.renew(view.image)
        self._refresh()

    def _refresh(self) -> None:
        project = self._session.project
        self.pattern.show_pattern(project.pattern, project.square / project.unit.mm)
        self.pattern.kind.setToolTip(self._describe_pattern(project))
        self.method.setCurrentIndex(self.method.findData(project.method))
        circles = not project.pattern.has_squares
        self._form.setRowVisible(self.method, not circles)
        is_listed = isinstance(project.pattern, ListedCircles)
        for row in (1, 2):  # the numbers of rows and columns
            self._form.setRowVisible(row, not is_listed)
        self.field.setCurrentIndex(self.field.findData(project.field))
        is_interlaced = any(INTERLACED in f"{view.note}{view.reason}" for view in project.views)
        self._form.setRowVisible(self.field, is_interlaced or project.field is not None)
        self.by_hand.setChecked(project.by_hand)
        self.counted.setText(name_points(project.pattern))
        self.side.setText(name_side(project.pattern))
        if not self._typing:
            self._show_board()
        for box, mm in ((self.square, project.square), (self.square_sigma, project.square_sigma)):
            with QSignalBlocker(box):
                if abs(box.value() * project.unit.mm - mm) > 1e-9:
                    box.setValue(mm / project.unit.mm)
        self.unit.setCurrentText(project.unit)

    def _describe_pattern(self, project: Project) -> str:
        """Say what a pattern is, and what of it was read from the images."""
        tip, seen = self.tr("What is printed on the board."), project.corner_set
        read = "" if seen is None else describe_recognised_board(project.pattern, seen)
        return f"{tip} {set_times_signs(read)}".rstrip()

    def _show_board(self) -> None:
        """Show the board as stated or as seen."""
        project = self._session.project
        inferred = project.grid_size is None
        self.inferred.setChecked(inferred)
        rows, cols = project.board.grid_size if project.board else (UNKNOWN, UNKNOWN)
        for box, value in ((self.rows, rows), (self.cols, cols)):
            with QSignalBlocker(box):
                box.setValue(value)
            box.setEnabled(not inferred)

    def _choose_counting(self) -> None:
        """Count the corners in the images, or let the user state them."""
        for box in (self.rows, self.cols):
            box.setEnabled(not self.inferred.isChecked())
        self._typing = not self.inferred.isChecked()
        if self.inferred.isChecked():
            self._state_board(None)
        elif UNKNOWN in (self.rows.value(), self.cols.value()):
            self.rows.setFocus()
            self.rows.selectAll()
        else:
            self.finish_typing()

    def _begin_typing(self) -> None:
        self._typing = True

    def _leave_box(self, other: QSpinBox) -> None:
        """Take what was typed, unless the user goes on to the other box."""
        if not other.hasFocus():
            self.finish_typing()

    def finish_typing(self) -> None:
        """State the rows and columns that were typed, once both are known."""
        stated = self.rows.value(), self.cols.value()
        if self._typing and UNKNOWN not in stated:
            self._typing = False
            self._state_board(stated)

    def _state_board(self, stated: GridSize | None) -> None:
        """Edit the project: its board has `stated` rows and columns, None if they are counted."""
        project = self._session.project
        seen = project.board
        if stated == project.grid_size:
            self._show_board()
            return

        self._session.edit(self.tr("Number of corners"), lambda p: set_grid_size(p, stated))
        if seen is None or stated != (seen.rows, seen.cols):
            self.search_wanted.emit()

    def _edit_pattern(self) -> None:
        pattern = self.pattern.pattern
        self._session.edit(self.tr("Pattern"), lambda p: set_pattern(p, pattern))
        self.search_wanted.emit()

    def _take_list(self, pattern: Pattern, pitch: float) -> None:
        """Take a board of listed circles, whose lengths the list states."""
        self._session.edit(self.tr("Pattern"), lambda p: set_square(set_pattern(p, pattern), pitch))
        self.search_wanted.emit()

    def _edit_method(self) -> None:
        method = self.method.currentData()
        if method != self._session.project.method:
            self._session.edit(self.tr("Way to locate corners"), lambda p: set_method(p, method))
            self.search_wanted.emit()

    def _edit_field(self) -> None:
        named = self.field.currentData()  # Qt makes a text of it
        field = named and Field(named)
        session = self._session
        if field != session.project.field:
            session.edit(self.tr("Rows of interlaced frames"), lambda p: set_field(p, field))
            self.search_wanted.emit()

    def _edit_by_hand(self, by_hand: bool) -> None:
        label = self.tr("Mark by hand") if by_hand else self.tr("Search the images")
        self._session.edit(label, lambda p: replace(p, by_hand=by_hand))
        self.search_wanted.emit()

    def _edit_square(self, value: float) -> None:
        mm = value * self._session.project.unit.mm
        self._session.edit(self.tr("Size of squares"), lambda p: set_square(p, mm), sliding=True)

    def _edit_square_sigma(self, value: float) -> None:
        mm = value * self._session.project.unit.mm
        if mm < self._session.project.square:
            label = self.tr("Uncertainty of squares")
            self._session.edit(label, lambda p: set_square_sigma(p, mm), sliding=True)

    def _edit_unit(self) -> None:
        unit = Unit(self.unit.currentText())
        mm, sigma = (box.value() * unit.mm for box in (self.square, self.square_sigma))

        def change(project: Project) -> Project:
            return set_square_sigma(replace(set_square(project, mm), unit=unit), sigma)

        if unit is not self._session.project.unit:
            self._session.edit(self.tr("Unit of squares"), change)
