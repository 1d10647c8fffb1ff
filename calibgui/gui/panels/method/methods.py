"""The panel that compares methods of calibration, and takes one of them over."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

import numpy as np
from PySide6.QtCore import QT_TRANSLATE_NOOP, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QFrame, QSplitter, QTextBrowser, QWidget

from calibgui.app.calibrating.method_comparison import compare_methods_again
from calibgui.dataset import Result
from calibgui.engine.assessment import MethodComparison
from calibgui.engine.calibration import METHODS, Cost, recover_arguments
from calibgui.gui.jobs.job import Job
from calibgui.gui.panels.method.linked_tables import LinkedTables
from calibgui.gui.panels.method.method_tables import MethodTables
from calibgui.gui.panels.on_demand import OnDemandPanel, have_same_views
from calibgui.gui.panels.parts.difference_map import Difference, DifferenceMap
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.scrolling import make_thin
from calibgui.gui.widgets.wrapped_label import typeset
from calibgui.report.methods import MethodRow, describe_method_comparison, list_method_rows

_WIDE = 820
"""Width from which on the map is beside the tables, px."""
_HIGH = 560
"""Height from which on it is below them in a narrower panel, px; else it is behind a tab."""


class MethodsPanel(OnDemandPanel[MethodComparison]):
    """Tries all methods on the views of the result, and takes the one that the user chooses."""

    title = str(QT_TRANSLATE_NOOP("MethodsPanel", "Methods"))
    keeps_best = True
    purpose = str(
        QT_TRANSLATE_NOOP("MethodsPanel", "All methods of calibration on the same corners.")
    )

    def __init__(self, services: Services) -> None:
        super().__init__(
            services,
            button=self.tr("C&ompare methods"),
            tip=self.tr(
                "Calibrates with every method from these views, and again without some of them, "
                "to see how well it predicts what it has not seen. Takes a while."
            ),
            label=self.tr("Comparing methods"),
            working=self.tr("Calibrating with every method several times…"),
        )
        self._rows: list[MethodRow] = []
        self._chosen = ""
        """Name of the selected method."""
        self.use = Button(self.tr("&Use this method"))
        self.use.clicked.connect(self._use)
        self.tables = MethodTables()
        self.tables.picked.connect(self._show_row)
        self.map = DifferenceMap()
        self.about = QTextBrowser()
        self.about.setAccessibleName(self.tr("About the method"))
        self.about.setFrameShape(QFrame.Shape.NoFrame)
        make_thin(self.about)
        self.compared = _Compared(
            self.tables, {self.tr("Map"): self.map, self.tr("About"): self.about}
        )
        self._lay_out(self.compared, self.use)

    def _missing(self, result: Result) -> str:
        if result.calibration.diagnosis is None:
            return ""
        return self.tr("The views do not determine the camera: methods cannot be compared on them.")

    def _forget(self) -> None:
        super()._forget()
        self._chosen = ""

    def _holds_for(self, asked: Result, result: Result) -> bool:
        return have_same_views(asked, result)

    def _invite(self, result: Result) -> str:
        method = METHODS[_get_method(result)].title
        return self.tr("This result is by the method “{0}”. What would others make of it?").format(
            method
        )

    def _find(self, result: Result, job: Job) -> MethodComparison:
        return compare_methods_again(result, job.advance, job.check_stop)

    def _show_found(self, result: Result, found: MethodComparison) -> None:
        counts = [len(view.uv) for view in result.observations()]
        sentences = [
            self.tr("Each RMS and σ is of {0:,} corners in {1} views.").format(
                sum(counts), len(counts)
            ),
            describe_method_comparison(found, by_label=True),
        ]
        if result is not self._asked:
            sentences.append(
                self.tr("Differences are from the calibration that was shown when they were found.")
            )
        self.words.setText(" ".join(sentences))
        self._rows = list_method_rows(found)
        self.tables.show_rows(self._rows)
        names = [row.name for row in self._rows]
        shown = names.index(self._chosen) if self._chosen in names else 0
        self.tables.select(shown)
        self._show_row(shown)

    def _show_row(self, row: int) -> None:
        """Show what there is to know of a method, and offer it if it gave a camera."""
        shown = self._rows[row]
        self._chosen = shown.name
        refusal = self._refuse(shown)
        self.use.setEnabled(not refusal)
        self.use.setToolTip(
            refusal or self.tr("Set the selected method in the Set-up and calibrate.")
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
        if self.found is not None:
            settings = self.found.trials[self._chosen].settings
            self.method_wanted.emit(settings["method"], settings.get("cost", Cost.IMAGE))

    def _draw_map(self, row: MethodRow) -> None:
        comparison, result = self.found, self._asked
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
                *(f"<p style='margin:3px 0'>{escape(typeset(text))}</p>" for text in words),
                f"<p style='color:{theme.current().muted}; margin:3px 0'>{escape(source)}</p>",
            ]
        )


class _Compared(QSplitter):
    """Tables with what belongs to their chosen row: beside or below them, or behind tabs if there
    is too little room for both.

    Args:
        tables: the tables, each behind a tab.
        parts: what belongs to the row, by the names of their tabs.
    """

    def __init__(self, tables: LinkedTables, parts: Mapping[str, QWidget]) -> None:
        super().__init__(Qt.Orientation.Horizontal)
        self._tables, self._parts = tables, parts
        self._apart = QSplitter(Qt.Orientation.Vertical)
        for splitter in (self, self._apart):
            splitter.setChildrenCollapsible(False)
        self.addWidget(tables)
        self.addWidget(self._apart)
        self._apart.hide()
        self._add_tabs()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        width, height = event.size().width(), event.size().height()
        is_wide, is_apart = width >= _WIDE, not self._apart.isHidden()
        wants_apart = is_wide or height >= _HIGH
        orientation = Qt.Orientation.Horizontal if is_wide else Qt.Orientation.Vertical
        if wants_apart and not (is_apart and orientation is self.orientation()):
            self.setOrientation(orientation)
            self._take_apart(width if is_wide else height)
        elif is_apart and not wants_apart:
            self._apart.hide()
            self._add_tabs()
        super().resizeEvent(event)

    def _add_tabs(self) -> None:
        for name, part in self._parts.items():
            self._tables.addTab(part, name)

    def _take_apart(self, length: int) -> None:
        """Show tables and parts together in a length across or down, px."""
        if self._tables.currentWidget() in self._parts.values():
            self._tables.setCurrentIndex(0)  # not the tab that happens to be beside it
        for part in self._parts.values():
            self._apart.addWidget(part)
            part.show()
        self._apart.show()
        self.setSizes([length // 2, length // 2])
        self._apart.setSizes([5 * self.height() // 7, 2 * self.height() // 7])


def _get_method(result: Result) -> str:
    """Return the name of the method that a result is by."""
    return str(recover_arguments(result.calibration)["method"])
