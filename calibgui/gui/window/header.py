"""The bar above everything: what is worked on, the modes, and what is done most."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QSizePolicy, QWidget

from calibgui.app.projects.project import Project
from calibgui.engine.assessment import Grade
from calibgui.gui.session.session import Session
from calibgui.gui.verdict.grade_icon import GradeIcon
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.elided import ElidedLabel
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.pattern_texts import list_pattern_texts
from calibgui.gui.window.mode_bar import ModeBar

_HEIGHT = 44
"""Of each row, device-independent px."""
_LEAST = 180
"""Room for the project's name, with which the modes stand beside it, device-independent px."""


class Header(QWidget):
    """Names the project, with what is in it; the modes get a row of their own in a narrow window.

    Args:
        session: whose project is named.
    """

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self.name, self.summary = QLabel(), ElidedLabel()
        self.modes = ModeBar()
        self.setup = Button(self.tr("Set-up"))
        self.setup.setCheckable(True)
        self.setup.setToolTip(self.tr("The board, the lens, and how to calibrate"))
        self.report = Button(self.tr("Report…"))
        self.report.setToolTip(self.tr("Write what is known as PDF or a web page (Ctrl+P)"))
        self.export = Button(self.tr("Export…"), Kind.MAIN)
        self.export.setToolTip(self.tr("Write the camera for another program (Ctrl+E)"))
        self.grade = Button()
        self.grade.setToolTip(self.tr("Show the verdict, or hide it again"))
        self.grade.setCheckable(True)
        self.grade.hide()
        self.icon = GradeIcon()
        self.icon.hide()
        about = QWidget()
        about.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        make_row(self.name, (self.summary, 1), of=about)
        buttons = QWidget()
        make_row(None, self.icon, self.grade, self.setup, self.report, self.export, of=buttons)
        self._buttons = buttons
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(theme.MARGIN, 0, theme.MARGIN - 2, 0)
        self._grid.setHorizontalSpacing(theme.MARGIN)
        self._grid.setVerticalSpacing(0)
        self._grid.addWidget(about, 0, 0)
        self._grid.addWidget(buttons, 0, 2)
        self._grid.setColumnStretch(0, 2)
        self._grid.setColumnStretch(2, 1)
        self._is_folded: bool | None = None
        self._fold(folded=False)
        self._restyle()
        session.changed.connect(lambda _, after: self._show(after))
        theme.follow(self._restyle)
        self._show(session.project)

    def show_grade(self, grade: Grade | None, text: str) -> None:
        """Tell the verdict, for the case that the inspector is out of sight."""
        self.icon.show_grade(grade)
        self.grade.setText(text)

    def stand_in_for_inspector(self, needed: bool, open_: bool) -> None:
        """Show the verdict here where the inspector is a sheet, which the button opens."""
        self.icon.setVisible(needed)
        self.grade.setVisible(needed)
        self.grade.setChecked(open_)

    def show_modes(self, shown: bool) -> None:
        """Show what there is to choose, or nothing where there are no photographs."""
        for widget in (self.modes, self.setup, self.report, self.export):
            widget.setVisible(shown)
        self._fold_if_narrow()

    def _show(self, project: Project) -> None:
        path = self._session.document.path
        name = path.stem if path is not None else self.tr("Untitled")
        metrics = self.name.fontMetrics()
        self.name.setText(metrics.elidedText(name, Qt.TextElideMode.ElideMiddle, 200))
        self.name.setToolTip("" if path is None else str(path))
        self.summary.setText(self._describe(project))
        self.summary.setToolTip(self.summary.text())

    def _describe(self, project: Project) -> str:
        """Say how many photographs there are, and of what."""
        count, usable = len(project.views), sum(view.usable for view in project.views)
        if not count:
            return ""
        parts = [
            self.tr("1 photograph")
            if count == 1
            else self.tr("{0} photographs").format(count)
            if usable in (0, count)
            else self.tr("{0} of {1} photographs usable").format(usable, count)
        ]
        if (board := project.board) is not None and usable:
            kind = list_pattern_texts()[project.pattern.kind].name
            length = f"{project.square / project.unit.mm:g} {project.unit}"
            parts.append(f"{kind} {board.rows} × {board.cols}, {length}")
        return " · ".join(parts)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._fold_if_narrow()

    def _fold_if_narrow(self) -> None:
        needed = self.modes.sizeHint().width() + self._buttons.sizeHint().width() + _LEAST
        self._fold(folded=needed > self.width() and not self.modes.isHidden())

    def _fold(self, *, folded: bool) -> None:
        """Put the modes below the rest, or into its middle."""
        if folded is not self._is_folded:
            self._is_folded = folded
            self._grid.addWidget(self.modes, *((1, 0, 1, 3) if folded else (0, 1)))
            self._grid.setRowMinimumHeight(0, _HEIGHT)
            self._grid.setRowMinimumHeight(1, _HEIGHT if folded else 0)
            self.setFixedHeight((2 if folded else 1) * _HEIGHT)

    def _restyle(self) -> None:
        self.name.setFont(theme.make_font(bold=True))
        theme.set_text_colour(self.summary, theme.current().muted)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        painter, colours = QPainter(self), theme.current()
        painter.fillRect(self.rect(), QColor(colours.base))
        painter.fillRect(0, self.height() - 1, self.width(), 1, QColor(colours.line))
