"""The outcome of an action is shown before and after side by side, to be kept or taken back."""

from __future__ import annotations

import math
import textwrap

import numpy as np
from PySide6.QtCore import Signal, SignalInstance
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from calibgui.engine.assessment import CameraDifference, Verdict, compare_cameras
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.parts.difference_map import DifferenceMap
from calibgui.gui.panels.parts.estimates import estimate_columns
from calibgui.gui.session.session import Session
from calibgui.gui.verdict.remedy_runner import CarriedOut
from calibgui.gui.verdict.texts import describe_grade
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.scrolling import make_scrollable
from calibgui.gui.widgets.sheet import Sheet
from calibgui.gui.widgets.tables import Column, Table, with_decimals
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.report.comparison import compare_parameters
from calibgui.report.verdict import format_times

_TABLES_SHARE = 0.55
"""Share of the width that the tables have at most: the map takes what they leave."""
_LEAST_HEIGHT = 280
"""Height below which tables and map scroll: less would show nothing, device-independent px."""
_HEADING_LETTERS = 12
"""Letters of a grade that stand in one line over its errors, where the map needs the width."""


class BeforeAndAfter(Sheet):
    """Shows errors of pixels and parameters of two results, and a map of their difference."""

    kept = Signal(object)
    """The `CarriedOut` that the user keeps."""
    taken_back = Signal(object)
    """The `CarriedOut` that the user does not want."""

    def __init__(self, desk: QWidget, session: Session) -> None:
        super().__init__(desk, fills=True)
        self._carried_out: CarriedOut | None = None
        self._natural = 0
        """Width of the tables with all their columns, as measured once for each content: the room
        for them, in which headings are shortened, must not change it."""
        self._work = Latest(session.jobs, self)
        self.title = WrappedLabel()
        font = self.title.font()
        font.setBold(True)
        self.title.setFont(font)
        self.errors, self.parameters = Table(), Table()
        self.errors.setAccessibleName(self.tr("Error of a pixel before and after"))
        self.parameters.setAccessibleName(self.tr("Parameters before and after"))
        self.map = DifferenceMap()
        self.map.plot.setToolTip(
            self.tr(
                "Distance between a point's images before and after, after the rotation that\n"
                "brings the two closest where corners (dots) were seen."
            )
        )
        self.keep = Button(self.tr("&Keep"), Kind.MAIN)
        self.back = Button(self.tr("&Take back"))
        self.keep.clicked.connect(lambda: self._answer(self.kept))
        self.back.clicked.connect(lambda: self._answer(self.taken_back))
        head = make_row((self.title, 1), self.back, self.keep)
        tables = make_column(self.errors, (self.parameters, 1))
        inside = QWidget()
        inside.setMinimumHeight(_LEAST_HEIGHT)
        make_row(tables, (self.map, 1), of=inside)
        make_column(head, (make_scrollable(inside), 1), of=self, margins=theme.SPACING)
        # Work that goes on keeps what was done.
        session.changed.connect(lambda _, after: self._close_for_other(after))

    def show_carried_out(self, carried_out: CarriedOut) -> None:
        """Show what an action has done."""
        self._carried_out = carried_out
        before, after = carried_out.before.calibration, carried_out.after.calibration
        gain = carried_out.verdict_before.error.covered / carried_out.verdict_after.error.covered
        self.title.setText(
            self.tr("{0}: the error where there are corners is {1} times smaller").format(
                carried_out.label, format_times(gain)
            )
            if gain > 1
            else self.tr("{0}: the error where there are corners is not smaller").format(
                carried_out.label
            )
        )
        self._show_errors(carried_out.verdict_before, carried_out.verdict_after)
        rows = compare_parameters(before, after)
        self.parameters.show_columns(
            [
                Column(self.tr("Parameter"), [row.name for row in rows]),
                *estimate_columns(
                    self.tr("Before"), [r.a for r in rows], [r.sigma_a for r in rows]
                ),
                *estimate_columns(self.tr("After"), [r.b for r in rows], [r.sigma_b for r in rows]),
                Column(
                    self.tr("Change"),
                    [row.sigmas for row in rows],
                    with_decimals(1),
                    self.tr(
                        "Over the standard deviation of a difference of independent estimates."
                    ),
                    unit="σ",
                ),
            ]
        )
        views = carried_out.after.observations()

        def show(difference: CameraDifference) -> None:
            corners = np.concatenate([view.uv for view in views])
            self.map.show_difference(difference, before.camera.size, corners)

        self.map.show_reason(self.tr("The difference is being computed."))
        self._work.start(
            "",
            lambda _: compare_cameras(after.camera, before.camera, views=views),
            show,
            lambda error: self.map.show_reason(str(error)),
        )
        self._natural = max(self.errors.natural_width, self.parameters.natural_width)
        self.show()
        self._fit_tables()
        self.keep.setFocus()

    def _choose_tables_width(self, width: int) -> int:
        """Return how wide the tables are if the sheet has this width."""
        return min(self._natural, round(_TABLES_SHARE * width))

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._fit_tables()

    def _fit_tables(self) -> None:
        for table in (self.errors, self.parameters):
            table.setFixedWidth(self._choose_tables_width(self.width()))

    def _show_errors(self, before: Verdict, after: Verdict) -> None:
        pairs = [
            (self.tr("Error, {0} [px]").format(name), a, b)
            for name, a, b in (
                (self.tr("centre"), before.error.centre, after.error.centre),
                (self.tr("among corners"), before.error.covered, after.error.covered),
                (self.tr("edge"), before.error.edge, after.error.edge),
                (self.tr("worst"), before.error.worst, after.error.worst),
            )
        ]
        grades = [describe_grade(v.grade, v.times_better) for v in (before, after)]
        self.errors.show_columns(
            [
                Column(self.tr("Verdict"), [name for name, *_ in pairs]),
                *(
                    Column(
                        grade,
                        errors,
                        _format_error,
                        heading="\n".join(textwrap.wrap(grade, _HEADING_LETTERS)),
                    )
                    for grade, errors in zip(
                        grades, ([a for _, a, _ in pairs], [b for *_, b in pairs]), strict=True
                    )
                ),
            ]
        )
        rows = self.errors.verticalHeader().length() + self.errors.horizontalHeader().height()
        self.errors.setFixedHeight(rows + 2 * self.errors.frameWidth() + theme.SPACING)

    def _answer(self, signal: SignalInstance) -> None:
        carried_out, self._carried_out = self._carried_out, None
        self.hide()
        if carried_out is not None:
            signal.emit(carried_out)

    def _close_for_other(self, project: object) -> None:
        if self._carried_out is not None and project is not self._carried_out.project:
            self._carried_out = None
            self.hide()


def _format_error(px: float) -> str:
    """Format an error in px; a dash where it is not known."""
    return format_two_digits(px) if math.isfinite(px) else "–"
