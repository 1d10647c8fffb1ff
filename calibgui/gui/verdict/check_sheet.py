"""Whether the camera of the shown result is still good, by photographs that join no project."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import assert_never

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QFileDialog,
    QLabel,
    QWidget,
)

from calibgui.app.calibrating.still_good import Checked, check_with_photographs
from calibgui.app.photographs.paths import choose_images
from calibgui.dataset import Result, View
from calibgui.engine.assessment import DEFAULT_LIMIT, CheckVerdict, Grade
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import FORMATS
from calibgui.gui.jobs.job import Job
from calibgui.gui.panels.latest import Latest
from calibgui.gui.session.session import Session
from calibgui.gui.verdict.grade_icon import GradeIcon, get_colour
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.number_box import NumberBox
from calibgui.gui.widgets.sheet import Sheet
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.report.calibration_check import describe_verdict, list_remarks
from calibgui.report.tables import list_unused_views

_GRADES = {
    CheckVerdict.STILL_GOOD: Grade.GOOD,
    CheckVerdict.HAS_CHANGED: Grade.NOT_USABLE,
    CheckVerdict.CANNOT_TELL: Grade.CAN_BE_BETTER,
}
"""The mark that each answer has."""


class CheckSheet(Sheet):
    """Searches the photographs, and says what they tell; the project stays as it is.

    Args:
        desk: that it lies over.
        session: whose shown result is checked.
    """

    def __init__(self, desk: QWidget, session: Session) -> None:
        super().__init__(desk)
        self._session = session
        self._work = Latest(session.jobs, self)
        self._result: Result | None = None
        self.checked: Checked | None = None
        """What the photographs told; None while they are searched."""
        self.icon, self.headline = GradeIcon(), QLabel()
        self.headline.setFont(theme.make_font(theme.HEADLINE, bold=True))
        self.words, self.details = WrappedLabel(), WrappedLabel()
        self.details.setForegroundRole(self.details.palette().ColorRole.PlaceholderText)
        self.details.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.limit = NumberBox(decimals=2, minimum=0.01, maximum=100.0, singleStep=0.1)
        self.limit.setValue(DEFAULT_LIMIT)
        self.limit.setSuffix(self.tr(" px"))
        self.limit.setAccessibleName(self.tr("Limit"))
        self.limit.setToolTip(self.tr("Change from which the camera counts as changed, px rms"))
        self.limit.valueChanged.connect(lambda _: self._judge())
        self.others = Button(self.tr("C&heck with others…"))
        self.others.clicked.connect(self.ask_for_photographs)
        self.close_button = Button(self.tr("&Close"))
        self.close_button.clicked.connect(self.leave)
        label = QLabel(self.tr("&Limit"))
        label.setBuddy(self.limit)
        top = make_row(
            self.icon, (self.headline, 1), label, self.limit, self.others, self.close_button
        )
        make_column(
            top, self.words, self.details, of=self, margins=(theme.MARGIN, 12, theme.MARGIN, 12)
        )
        self.closed.connect(self._work.cancel)
        session.result_changed.connect(lambda _: self.leave())
        theme.follow(self._show)

    def ask_for_photographs(self) -> None:
        """Check with photographs of the user's choice."""
        kinds = self.tr("Images ({0})").format(" ".join(f"*{suffix}" for suffix in FORMATS))
        title = self.tr("New photographs of the board")
        names, _ = QFileDialog.getOpenFileNames(self, title, "", kinds)
        if names:
            self.check(names)

    def check(self, names: Sequence[str]) -> None:
        """Check with the photographs that files and folders hold."""
        if (result := self._session.result) is None:
            return
        self._result, self.checked = result, None
        self.show()
        self._show()

        def work(job: Job) -> Checked:
            def progress(done: int, total: int, _: View) -> None:
                job.advance(done, total)

            images, _ = choose_images(names)
            return check_with_photographs(result, images, progress, job.cancelling)

        label = self.tr("Checking the camera")
        self._work.start(label, work, self._receive, self._fail, cancelled=self.leave)

    def leave(self) -> None:
        """Close the sheet, and want nothing any more."""
        self._work.cancel()
        self.hide()

    def _receive(self, checked: Checked) -> None:
        self.checked = checked
        self._judge()

    def _fail(self, error: Exception) -> None:
        """Say why the photographs cannot tell anything, unless it is a bug."""
        if not isinstance(error, CalibrationError):
            self.leave()
            self._session.failed.emit(error)
            return
        self.icon.show_grade(None)
        self.headline.setText(self.tr("These photographs cannot be used"))
        self.words.setText(str(error))
        self.fit()

    def _judge(self) -> None:
        """Answer by the limit as it is now."""
        if self.checked is not None:
            check = replace(self.checked.check, limit=self.limit.value())
            self.checked = replace(self.checked, check=check)
            self._show()

    def _show(self) -> None:
        if self.checked is None:
            grade, text, words, details = None, self.tr("Is the camera still good?"), "", []
            words = self.tr("The photographs are searched for the board. They join no project.")
        else:
            check = self.checked.check
            grade, text = _GRADES[check.verdict], self._name(check.verdict)
            words, details = describe_verdict(check), self._list_details(self.checked)
        self.icon.show_grade(grade)
        self.headline.setText(text)
        theme.set_text_colour(self.headline, get_colour(grade))
        self.words.setText(words)
        self.details.setText("\n".join(details))
        self.details.setVisible(bool(details))
        self.fit()

    def _name(self, verdict: CheckVerdict) -> str:
        match verdict:
            case CheckVerdict.STILL_GOOD:
                return self.tr("STILL GOOD")
            case CheckVerdict.HAS_CHANGED:
                return self.tr("CALIBRATE AGAIN")
            case CheckVerdict.CANNOT_TELL:
                return self.tr("TAKE OTHER PHOTOGRAPHS")
            case _:
                assert_never(verdict)

    def _list_details(self, checked: Checked) -> list[str]:
        """List what else there is to say: of the fit, the photographs, and what was left out."""
        check, used = checked.check, [view for view in checked.check.views if view.used]
        sigma = float(np.hypot(check.sigma_x, check.sigma_y) / np.sqrt(2))
        fit = self.tr(
            "{0} of {1} photographs, the stored camera as it is: RMS {2:.3f} px, σ {3:.3f} px of "
            "{4:,} corners."
        ).format(len(used), len(checked.corner_set.views), check.rms, sigma, check.count)
        left_out = [
            f"{name}: {view.reason}."
            for name, view in zip(checked.names, check.views, strict=True)
            if view.reason
        ]
        unused = list_unused_views(checked.corner_set.views)
        return [fit, *list_remarks(check), *left_out, *filter(None, [" ".join(unused.split())])]

    def heightForWidth(self, width: int) -> int:  # noqa: N802 - Qt's name
        """Return the height that all sentences need."""
        column = self.layout()
        assert column is not None
        return column.heightForWidth(width)
