"""The list has a row for each finding on the shown result, with the button that remedies it, and
tells what would be worth being stated."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QGridLayout,
    QLabel,
    QToolButton,
    QWidget,
)

from calibgui.app.calibrating.true_board import GLASS, list_gains
from calibgui.engine.assessment import Finding, Verdict
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.verdict.texts import describe_button
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.elided import ElidedLabel
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.scrolling import make_scrollable
from calibgui.gui.widgets.sheet import Sheet
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.report.verdict import format_times

_LENGTH = re.compile(r"\d mm\b")
"""What a length looks like in a finding's sentences."""
_MIN_TOLD = 1.1
"""Ratio of errors from which a row says by how much its action makes the camera better."""


class FindingsList(Sheet):
    """Lists findings, the most harmful first; details unfold under a row."""

    action_wanted = Signal(object)
    """The finding whose action the user wants."""
    proof_wanted = Signal(object)
    """The finding whose evidence the user wants to see."""
    glass_wanted = Signal()
    """The user states that the board is of glass."""

    def __init__(self, desk: QWidget) -> None:
        super().__init__(desk)
        self.rows: list[FindingRow] = []
        self.glass: GlassRow | None = None
        self._body = QWidget()
        margins = theme.SPACING, 0, theme.SPACING, theme.SPACING
        self._column = make_column(of=self._body, spacing=0, margins=margins)
        make_column(make_scrollable(self._body), of=self, margins=(1, 0, 1, 2))

    def show_verdict(
        self, verdict: Verdict, names: Sequence[str], condition: str, glass: Mapping[str, float]
    ) -> None:
        """List the findings of a verdict, and what a board of glass would bring.

        Args:
            verdict: on the shown result.
            names: of its views.
            condition: a sentence on what lengths rest on; empty if they are confirmed.
            glass: the ± by name that come with a board of glass; none if that is not offered.
        """
        for old in [*self.rows, *([] if self.glass is None else [self.glass])]:
            self._column.removeWidget(old)
            old.deleteLater()
        self.rows = [FindingRow(finding, names, condition) for finding in verdict.findings]
        for row in self.rows:
            row.button.clicked.connect(lambda _=False, f=row.finding: self.action_wanted.emit(f))
            row.proof.clicked.connect(lambda _=False, f=row.finding: self.proof_wanted.emit(f))
            row.unfold.toggled.connect(self._fit)
            self._column.addWidget(row)
        self.glass = GlassRow(glass) if glass else None
        if self.glass is not None:
            self.glass.button.clicked.connect(self.glass_wanted)
            self._column.addWidget(self.glass)
        if not self._column.count():
            self.hide()
        elif self.isVisible():
            self._fit()

    def set_busy(self, busy: bool) -> None:
        """Disable the buttons while an action is being carried out."""
        for row in self.rows:
            row.button.setEnabled(not busy)
        if self.glass is not None:
            self.glass.button.setEnabled(not busy)

    def _fit(self) -> None:
        """Take the height that the rows need now."""
        self._column.activate()
        self.fit()

    def heightForWidth(self, width: int) -> int:  # noqa: N802 - Qt's name
        """Return the height of all rows."""
        column = self._column
        if column.hasHeightForWidth():  # details are unfolded, whose lines depend on the width
            return column.heightForWidth(width - 2) + 4
        return column.sizeHint().height() + 4


class FindingRow(QWidget):
    """One finding: what, how much, one button that does it; details below, folded up."""

    def __init__(self, finding: Finding, names: Sequence[str], condition: str) -> None:
        super().__init__()
        self.finding = finding
        self.what = ElidedLabel()
        self.what.setText(finding.message)
        self.what.setToolTip(finding.message)
        self.how_much = QLabel(
            self.tr("{0} times better once mended").format(format_times(finding.times_better))
            if finding.times_better >= _MIN_TOLD
            else self.tr("{0} px").format(format_two_digits(finding.harm))
        )
        self.unfold = QToolButton()
        self.unfold.setCheckable(True)
        self.unfold.setAutoRaise(True)
        self.unfold.setArrowType(Qt.ArrowType.RightArrow)
        self.unfold.setAccessibleName(self.tr("Details"))
        self.unfold.setToolTip(self.tr("Show the figures and what to do"))
        self.unfold.toggled.connect(self._unfold)
        action = finding.action
        self.button = Button("" if action is None else describe_button(action, names))
        details = f"{finding.evidence}\n{finding.remedy}"
        self.details = WrappedLabel(
            f"{details}\n{condition}" if condition and _LENGTH.search(details) else details
        )
        self.details.setTextFormat(Qt.TextFormat.PlainText)
        self.details.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.proof = Button(self.tr("Show the evidence"))
        # Only hidden, never shown, while they have no parent: each would be a window of its own.
        for widget in (self.details, self.proof, *([self.button] if action is None else [])):
            widget.hide()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, theme.SPACING // 2, 0, theme.SPACING // 2)
        grid.setHorizontalSpacing(theme.SPACING)
        grid.addWidget(self.unfold, 0, 0)
        grid.addWidget(self.what, 0, 1)
        grid.addWidget(self.how_much, 0, 2)
        grid.addWidget(self.button, 0, 3, Qt.AlignmentFlag.AlignRight)
        grid.addWidget(self.details, 1, 1, 1, 2)
        grid.addWidget(self.proof, 1, 3, Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignRight)
        grid.setColumnStretch(1, 1)

    def _unfold(self, shown: bool) -> None:
        down, right = Qt.ArrowType.DownArrow, Qt.ArrowType.RightArrow
        self.unfold.setArrowType(down if shown else right)
        self.details.setVisible(shown)
        self.proof.setVisible(shown)


class GlassRow(QWidget):
    """The row that offers to state that the board is of glass, with the button that does it."""

    def __init__(self, narrower: Mapping[str, float]) -> None:
        super().__init__()
        self.what = WrappedLabel(
            self.tr(
                "If the board is of glass, printed true to {0:g} mm and flat to {1:g} mm: {2} px."
            ).format(GLASS.in_plane, GLASS.out_of_plane, list_gains(narrower))
        )
        self.button = Button(self.tr("It is of glass"))
        make_row(
            (self.what, 1),
            self.button,
            of=self,
            margins=(0, theme.SPACING // 2, 0, theme.SPACING // 2),
        )
