"""The result: intrinsics with their standard deviations, and what they are worth."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

import numpy as np
from PySide6.QtCore import QT_TRANSLATE_NOOP
from PySide6.QtWidgets import QFrame, QTextBrowser

from calibgui.dataset import Result
from calibgui.dataset.judging import recall_verdict
from calibgui.engine.calibration import compute_correlations, is_held, make_paper_table
from calibgui.engine.camera import Lucchese, find_model
from calibgui.engine.geometry import PAPER_NAMES
from calibgui.gui.panels.answer.matrix import Matrix
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.parts.estimates import estimate_columns
from calibgui.gui.panels.parts.split import Split
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.scrolling import make_thin
from calibgui.gui.widgets.tab_bar import TabWidget
from calibgui.gui.widgets.tables import Column, Table, with_digits
from calibgui.gui.widgets.wrapped_label import typeset
from calibgui.report.summary import Sentence, Tone, describe_calibration

_PAPER_UNITS = ("px", "px", "px⁻²", "px⁻⁴", "px⁻⁶", "px⁻¹", "px⁻¹", "px⁻²", "px", "px")
_MARKS = {Tone.FACT: "•", Tone.GOOD: "✓", Tone.CAUTION: "!", Tone.ADVICE: "→"}


class ResultPanel(Panel):
    """The estimates in words, in the array frame and in the paper's units.

    Args:
        jobs: that find the words.
    """

    title = str(QT_TRANSLATE_NOOP("ResultPanel", "Result"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "ResultPanel",
            "The camera's parameters with their standard deviations, and what they are worth.",
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self._work = Latest(services.jobs, self)
        self._sentences: Sequence[Sentence] = ()
        self.words = QTextBrowser()
        self.words.setAccessibleName(self.tr("Summary"))
        self.words.setFrameShape(QFrame.Shape.NoFrame)
        make_thin(self.words)
        self.array_frame, self.paper_units = Table(), Table()
        self.correlations = Matrix()
        self.correlations.setToolTip(
            self.tr("Estimates near ±1 can stand in for each other: only a combination is known.")
        )
        self.tabs = TabWidget()
        for widget, name in (
            (Split(820, (self.words, 1), (self.array_frame, 1)), self.tr("Summary")),
            (self.paper_units, self.tr("The paper's units")),
            (self.correlations, self.tr("Correlations")),
        ):
            self.tabs.addTab(widget, name)
        self._fill_body(self.tabs)

    def _refresh(self, result: Result) -> None:
        calibration = result.calibration
        names = calibration.camera.names
        # Those of another result would be read as this one's.
        self._work.cancel()
        self._sentences = ()
        self.words.setPlainText(self.tr("What this result is worth is being found out."))
        if is_held(calibration):
            self.words.setPlainText("\n".join(calibration.warnings))
        elif recall_verdict(result) is not None:
            self.note_verdict()
        self.array_frame.show_columns(
            [
                Column(self.tr("Parameter"), names),
                *estimate_columns(self.tr("Value"), calibration.camera.params, calibration.sigma),
                Column(self.tr("Unit"), ["px"] * 4 + [""] * (len(names) - 4)),
                Column(self.tr("Remark"), self._remarks(result, names)),
            ],
            {names.index(u.name): u.reason for u in calibration.undetermined},
        )
        has_paper = isinstance(find_model(calibration.camera.model), Lucchese)
        self.tabs.setTabVisible(1, has_paper)
        if has_paper:
            values, sigma, sd = make_paper_table(calibration)
            self.paper_units.show_columns(
                [
                    Column(self.tr("Parameter"), PAPER_NAMES),
                    *estimate_columns(self.tr("Value"), values, sigma),
                    Column(self.tr("Unit"), _PAPER_UNITS),
                    Column(
                        self.tr("SD of Table 2"),
                        sd.tolist(),
                        with_digits(3),
                        self.tr(
                            "The paper's sqrt(diag((2 JᵀJ)⁻¹)), which leaves the residuals out.\n"
                            "1σ is what the residuals support."
                        ),
                    ),
                ]
            )
        free = [i for i, name in enumerate(names) if name not in calibration.fixed]
        matrix = compute_correlations(calibration.covariance)[np.ix_(free, free)]
        self.correlations.show_matrix([names[i] for i in free], matrix)

    def note_verdict(self) -> None:
        """Say in words what the result is worth."""
        if (result := self._result) is not None:
            self._work.start(
                "",
                lambda job: describe_calibration(result, job.check),
                self._say,
                self.failed.emit,
            )

    def _say(self, sentences: Sequence[Sentence]) -> None:
        self._sentences = sentences
        self._restyle()

    def _restyle(self) -> None:
        """Take the present colours for the marks; all else has none of its own."""
        if self._sentences:
            self.words.setHtml(_format_html(self._sentences))

    def _remarks(self, result: Result, names: Sequence[str]) -> list[str]:
        """Return a remark on each parameter; empty for most."""
        calibration = result.calibration
        missing = {u.name for u in calibration.undetermined}
        diagnosis = calibration.diagnosis
        assumed = set() if diagnosis is None else {a.name for a in diagnosis.assumptions}
        remarks = []
        for name, value, sigma in zip(
            names, calibration.camera.params, calibration.sigma, strict=True
        ):
            if name in calibration.fixed:
                remarks.append(self.tr("held"))
            elif name in missing:
                remarks.append(self.tr("not determined"))
            elif name in assumed:
                remarks.append(self.tr("assumed"))
            elif name not in names[:4] and abs(value) < 2 * sigma:
                remarks.append(self.tr("may be 0"))
            else:
                remarks.append("")
        return remarks


def _format_html(sentences: Sequence[Sentence]) -> str:
    """The sentences as a list whose marks and colours tell what each is for."""
    colours = theme.current()
    colour = {
        Tone.FACT: colours.muted,
        Tone.GOOD: colours.good,
        Tone.CAUTION: colours.warning,
        Tone.ADVICE: colours.accent,
    }
    rows = "".join(
        f'<tr><td style="color:{colour[s.tone]}; padding:3px 8px"><b>{_MARKS[s.tone]}</b></td>'
        f'<td style="padding:3px 0">{escape(typeset(s.text))}</td></tr>'
        for s in sentences
    )
    return f"<table>{rows}</table>"
