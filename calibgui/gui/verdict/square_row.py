"""The question how long the squares are, asked when a board was first found, and its answer."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from calibgui.app.projects.lengths import confirm_lengths, set_square
from calibgui.app.projects.project import Project
from calibgui.dataset import ViewStatus
from calibgui.engine.boards import AprilGrid, Pattern
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.layouts import keep_place, make_column, make_row
from calibgui.gui.widgets.number_box import NumberBox
from calibgui.gui.widgets.pattern_texts import list_pattern_texts
from calibgui.gui.widgets.reserved_label import ReservedLabel


class SquareRow(QWidget):
    """Says how many corners were counted, and asks for the side of a square until it is stated.

    Then it stands in the same place, as nothing may move under the button that was pressed.
    """

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self._has_asked = False
        """True if the question was put since a board was first found."""
        self.counted = ReservedLabel(1)
        self.square = NumberBox(decimals=3, minimum=0.001, maximum=100_000.0)
        self.square.setFixedWidth(120)
        self.square.setAccessibleName(self._name_side(session.project.pattern))
        self.square.setToolTip(
            self.tr(
                "Only lengths depend on it, no pixel does. Until it is confirmed, every length "
                "holds on this condition."
            )
        )
        self.confirm = Button(self.tr("Confirm"), Kind.MAIN)
        self.square.valueChanged.connect(lambda _: self._name_button(self._session.project))
        self.square.lineEdit().returnPressed.connect(self.answer)
        self.confirm.clicked.connect(self.answer)
        keep_place(self.square, self.confirm)
        answer = make_row(self.square, self.confirm, None)
        self._column = make_column(
            self.counted,
            answer,
            of=self,
            margins=(0, 0, 0, theme.SPACING // 2),
            spacing=theme.SPACING // 2,
        )
        session.changed.connect(lambda _, after: self._show(after))
        self._show(session.project)

    def reserve(self, lines: int) -> None:
        """Take the height of so many lines of the question from now on, hidden or not."""
        self.counted.reserve(lines)
        self._column.invalidate()  # a hidden widget's layout is not told
        self.updateGeometry()

    def stand_aside(self, is_elsewhere: bool) -> None:
        """Leave the field to the set-up while that is open: one length has one field in sight."""
        for widget in (self.square, self.confirm):
            widget.setVisible(not is_elsewhere)

    def answer(self) -> None:
        """Take the length as it is shown."""
        if not self.confirm.isEnabled():
            return
        mm = self.square.value() * self._session.project.unit.mm
        if abs(mm - self._session.project.square) > 1e-9:
            self._session.edit(self.tr("Size of squares"), lambda p: set_square(p, mm))
        else:
            self._session.edit(self.tr("Confirm the size of squares"), confirm_lengths)

    def _show(self, project: Project) -> None:
        is_found = any(view.status is ViewStatus.FOUND for view in project.views)
        self._has_asked = is_found and (self._has_asked or not project.lengths_confirmed)
        policy = self.sizePolicy()
        # Its place is kept from the first image on: nothing below moves when a board is found.
        policy.setRetainSizeWhenHidden(bool(project.views) and not project.lengths_confirmed)
        self.setSizePolicy(policy)
        self.setVisible(self._has_asked)
        if self.isHidden():
            return
        self.counted.setText(self._ask(project))
        self.square.setAccessibleName(self._name_side(project.pattern))
        if not self.square.hasFocus():
            self.square.show_value(project.square / project.unit.mm)
        self.square.setSuffix(f" {project.unit}")
        self._name_button(project)

    def _ask(self, project: Project) -> str:
        """Return the question, with what is known of the board, or that it was answered."""
        if project.lengths_confirmed:
            text = self.tr("Lengths hold: you have confirmed {0:g} {1}.")
            return text.format(project.square / project.unit.mm, project.unit)
        pattern, board = project.pattern, project.board
        if not pattern.has_squares:
            known = self.tr("How far apart are the circles? {2}, {0} × {1}.")
            counting = self.tr("How far apart are the circles? The board is being counted.")
            parts = self.tr(
                "How far apart are the circles? Their number is not known: state it in the Set-up."
            )
        elif isinstance(pattern, AprilGrid):
            known = self.tr("How long are the tags' sides? {2}, {0} × {1} corners.")
            counting = self.tr("How long are the tags' sides? The board is being counted.")
            parts = self.tr(
                "How long are the tags' sides? Their number is not known: state it in the Set-up."
            )
        else:
            known = self.tr("How long are the squares? {2}, {0} × {1} inner corners.")
            counting = self.tr("How long are the squares? The board is being counted.")
            parts = self.tr(
                "How long are the squares? Their number is not known: state it in the Set-up."
            )
        if board is not None and project.grid_size_doubt is None:
            name = list_pattern_texts()[pattern.kind].name
            return known.format(board.rows, board.cols, name)
        if any(view.status is ViewStatus.WAITING for view in project.views):
            return counting
        return parts

    def _name_side(self, pattern: Pattern) -> str:
        if not pattern.has_squares:
            return self.tr("Distance of circles")
        if isinstance(pattern, AprilGrid):
            return self.tr("Side of a tag")
        return self.tr("Side of a square")

    def _name_button(self, project: Project) -> None:
        text = self.tr("Confirm {0:g} {1}")
        self.confirm.setText(text.format(self.square.value(), project.unit))
        is_other = abs(self.square.value() * project.unit.mm - project.square) > 1e-9
        self.confirm.setEnabled(is_other or not project.lengths_confirmed)
        reason = self.tr("This length is confirmed already; state another one first.")
        self.confirm.setToolTip("" if self.confirm.isEnabled() else reason)
