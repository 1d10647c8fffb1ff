"""The methods of calibration side by side, and one of them to be taken over."""

from __future__ import annotations

from html import escape

import numpy as np
from PySide6.QtCore import QT_TRANSLATE_NOOP, Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QPushButton, QSplitter, QTextBrowser, QVBoxLayout

from calibgui.app.method_comparison import compare_methods_again
from calibgui.dataset import Result
from calibgui.engine.assessment import MethodComparison
from calibgui.engine.calibration import METHODS, Cost, recover_arguments
from calibgui.gui.jobs.job import Job
from calibgui.gui.panels.difference_map import Difference, DifferenceMap
from calibgui.gui.panels.method_tables import MethodTables
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.services import Services
from calibgui.gui.panels.split import Split
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.prose import Prose
from calibgui.report.methods import MethodRow, describe_method_comparison, list_method_rows

_WIDE = 820
"""Width from which on the map is beside the table, px."""
_LINES_OF_WORDS = 4


class MethodsPanel(Panel):
    """Tries all methods on the views of the result, and takes the one that the user chooses."""

    title = str(QT_TRANSLATE_NOOP("MethodsPanel", "Methods"))

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self._jobs = services.jobs
        self._job: Job | None = None
        self._rows: list[MethodRow] = []
        self._chosen = ""
        """Name of the selected method."""
        self._compared: Result | None = None
        """Result whose views were compared on, and whose camera the others are compared with."""
        self.comparison: MethodComparison | None = None
        self.run = QPushButton(self.tr("C&ompare methods"))
        self.run.setToolTip(
            self.tr(
                "Calibrates with every method from these views, and again without some of them, "
                "to see how well it predicts what it has not seen. Takes a while."
            )
        )
        self.run.setMinimumWidth(self.run.sizeHint().width())  # also while it says Cancel
        self.run.clicked.connect(self._run)
        self.use = QPushButton(self.tr("&Use this method"))
        self.use.clicked.connect(self._use)
        self.words = Prose(_LINES_OF_WORDS)
        self.tables = MethodTables()
        self.tables.picked.connect(self._show_row)
        self.map = DifferenceMap()
        self.about = QTextBrowser()
        self.about.setFrameShape(QFrame.Shape.NoFrame)
        self._lay_out()

    def _lay_out(self) -> None:
        bar = QHBoxLayout()
        bar.addWidget(self.run)
        bar.addStretch(1)
        bar.addWidget(self.use)
        chosen = QSplitter(Qt.Orientation.Vertical)
        chosen.setChildrenCollapsible(False)
        for part, share in ((self.map, 5), (self.about, 2)):
            chosen.addWidget(part)
            chosen.setStretchFactor(chosen.indexOf(part), share)
        self.compared = Split(_WIDE, (self.tables, 2), (chosen, 3))
        keeping = self.compared.sizePolicy()
        keeping.setRetainSizeWhenHidden(True)
        self.compared.setSizePolicy(keeping)
        layout = QVBoxLayout(self.body)
        layout.addLayout(bar)
        layout.addWidget(self.words)
        layout.addWidget(self.compared, 1)

    def show_result(self, result: Result | None) -> None:
        """Forget the comparison unless it is on the views of this result."""
        known = self._compared
        if known is None or result is None or not _have_same_views(known, result):
            self.comparison = self._compared = None
            if self._job is not None:
                self._job.cancel()
        super().show_result(result)

    def _missing(self, result: Result) -> str:
        if result.calibration.diagnosis is None:
            return ""
        return self.tr("The views do not determine the camera: methods cannot be compared on them.")

    def _run(self) -> None:
        result = self._result
        assert result is not None
        if self._job is not None:
            self._job.cancel()
            return
        self.comparison, self._compared, self._chosen = None, result, ""
        self.run.setText(self.tr("&Cancel"))
        self.words.show_text(self.tr("Calibrating with every method several times…"))
        self._job = self._jobs.start(
            self.tr("Comparing methods"),
            lambda job: compare_methods_again(result, job.advance),
            self._done,
            failed=lambda error: self.words.show_text(str(error)),
            ended=self._ended,
            owner=self,
        )
        self._refresh_now()

    def _done(self, comparison: MethodComparison) -> None:
        self.comparison = comparison
        self._refresh_now()

    def _ended(self) -> None:
        cancelled = self._job is not None and self._job.cancelled
        self._job = None
        self.run.setText(self.tr("C&ompare methods"))
        if cancelled and self._result is not None:
            self._refresh_now()

    def _refresh(self, result: Result) -> None:
        comparison = self.comparison
        for widget in (self.compared, self.use):
            widget.setVisible(comparison is not None)
        if comparison is None:
            if self._job is None:
                self.words.show_text(self._invite(result))
            return
        sentences = [describe_method_comparison(comparison)]
        if result is not self._compared:
            sentences.append(
                self.tr("Differences are from the calibration that was shown when they were found.")
            )
        self.words.show_text(" ".join(sentences))
        self._rows = list_method_rows(comparison)
        self.tables.show_rows(self._rows)
        names = [row.name for row in self._rows]
        shown = names.index(self._chosen) if self._chosen in names else 0
        self.tables.select(shown)
        self._show_row(shown)

    def _invite(self, result: Result) -> str:
        method = METHODS[_get_method(result)].title
        return self.tr("This result is by the method “{0}”. What would others make of it?").format(
            method
        )

    def _show_row(self, row: int) -> None:
        """Show what there is to know of a method, and offer it if it gave a camera."""
        shown = self._rows[row]
        self._chosen = shown.name
        refusal = self._refuse(shown)
        self.use.setEnabled(not refusal)
        self.use.setToolTip(
            refusal or self.tr("Set the selected method in the Settings and calibrate.")
        )
        self._draw_map(shown)
        self.about.setHtml(self._describe(shown))

    def _refuse(self, row: MethodRow) -> str:
        """Say why a method cannot be taken over; empty if it can."""
        if row.kind == "refused":
            return self.tr("It gives no camera from these views: {0}").format(" ".join(row.remarks))
        if not row.is_usable:
            return self.tr("It knows no lengths, and so gives no camera: only the distortion.")
        return ""

    def _use(self) -> None:
        comparison = self.comparison
        if comparison is not None:
            settings = comparison.trials[self._chosen].settings
            self.method_wanted.emit(settings["method"], settings.get("cost", Cost.IMAGE))

    def _draw_map(self, row: MethodRow) -> None:
        comparison, result = self.comparison, self._compared
        assert comparison is not None
        assert result is not None
        found: Difference | None
        if row.kind == "lines":
            found = comparison.lines[row.name]
        else:
            trial = comparison.trials.get(row.name)
            found = None if trial is None else trial.difference
        if found is None:
            self.map.show_reason(" ".join(row.remarks))
            return
        corners = np.concatenate([view.uv for view in result.observations()])
        self.map.show_difference(found, comparison.chosen.size, corners)

    def _describe(self, row: MethodRow) -> str:
        """Describe a method: its limits, what there is to say of its result, and its source."""
        words = [row.limits, *row.remarks]
        if row.coefficients:
            words.append(self.tr("Its coefficients: {0}.").format(row.coefficients))
        source = self.tr("Source: {0}").format(row.source)
        return "".join(
            [
                f"<b>{escape(row.title)}</b>",
                *(f"<p style='margin:3px 0'>{escape(text)}</p>" for text in words),
                f"<p style='color:{theme.current().muted}; margin:3px 0'>{escape(source)}</p>",
            ]
        )


def _get_method(result: Result) -> str:
    """Return the name of the method that a result is by."""
    return str(recover_arguments(result.calibration)["method"])


def _have_same_views(a: Result, b: Result) -> bool:
    """Return whether two results are from the same corners."""
    return len(a.used) == len(b.used) and all(x is y for x, y in zip(a.used, b.used, strict=True))
