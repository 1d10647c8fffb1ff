"""A series of calibrations: parameters against zoom, focus, temperature or date, and changes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path, PurePath

import numpy as np
import pyqtgraph as pg
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QFileDialog,
    QLabel,
    QLineEdit,
    QSplitter,
    QWidget,
)

from calibgui.app.calibrating.series import (
    AnalysedSeries,
    Scalar,
    analyse_series,
    choose_axis_text,
    export_from_series,
    format_value,
    parse_value,
)
from calibgui.engine.assessment import Series, UncertainCamera
from calibgui.engine.errors import CalibrationError
from calibgui.formats import EXPORTERS
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.parts.estimates import estimate_columns
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import make_buttons
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.layouts import keep_place, make_column, make_row
from calibgui.gui.widgets.plots import Plot
from calibgui.gui.widgets.save_names import ask_for_name
from calibgui.gui.widgets.tab_bar import TabWidget
from calibgui.gui.widgets.tables import Column, Table, with_decimals, with_digits
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.report.names import distinguish_paths
from calibgui.report.series import list_sentences

_STEPS = 100
"""Number of values at which the function is drawn."""
_DATE_CHARACTERS = 20
"""Number of characters in whose room a date with its time can be written."""
_BAND_OPACITY = 60
"""Opacity of the band of one standard deviation, of 255."""


class SeriesDialog(QDialog):
    """Shows how a camera varies, tells whether it has changed, and writes what lies between.

    Results are read and functions fitted by a job whenever the files, the quantity or its table
    change.
    """

    def __init__(self, jobs: Jobs, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Series of calibrations"))
        self._jobs, self._work = jobs, Latest(jobs, self)
        self._paths: tuple[Path, ...] = ()
        self._values: Path | None = None
        self.analysed: AnalysedSeries | None = None
        """What is shown; None while there is nothing."""
        self.add = Button(self.tr("&Add results…"), takes_enter=False)
        self.add.clicked.connect(self._ask_for_results)
        self.scalar = QComboBox()
        self.scalar.setAccessibleName(self.tr("The quantity that varies"))
        for scalar, text in (
            (Scalar.ZOOM, self.tr("zoom")),
            (Scalar.FOCUS, self.tr("focus")),
            (Scalar.TEMPERATURE, self.tr("temperature")),
            (Scalar.DATE, self.tr("date")),
        ):
            self.scalar.addItem(text, scalar)
        self.scalar.currentIndexChanged.connect(self._analyse)
        self.table_of_values = Button(self.tr("&Table of values…"), takes_enter=False)
        self.table_of_values.setToolTip(
            self.tr(
                "A CSV file with the columns file,value; temperatures in °C. Without one focal "
                "lengths and dates are read from the photographs."
            )
        )
        self.table_of_values.clicked.connect(self._ask_for_values)
        self.words = WrappedLabel()
        self.results, self.camera = Table(), Table()
        self.parameter = QComboBox()
        self.parameter.setAccessibleName(self.tr("Parameter"))
        self.parameter.currentIndexChanged.connect(self._draw)
        self.plot = Plot("", "")
        self.at = QLineEdit()
        self.at.setAccessibleName(self.tr("Value at which the camera is shown"))
        self.at.setMaximumWidth(_DATE_CHARACTERS * self.fontMetrics().averageCharWidth())
        self.at.textChanged.connect(self._show_camera)
        self.format = QComboBox(sizeAdjustPolicy=QComboBox.SizeAdjustPolicy.AdjustToContents)
        self.format.setAccessibleName(self.tr("Format"))
        self.export = Button(self.tr("&Export…"), takes_enter=False)
        self.export.clicked.connect(self._ask_and_export)
        self.said = WrappedLabel()
        self._lay_out()
        theme.follow(self._draw)
        self.resize(1000, 620)
        self._clear(self.tr("Add the result.json of each setting of one camera: three or more."))

    def _lay_out(self) -> None:
        above = make_row(self.add, QLabel(self.tr("by")), self.scalar, self.table_of_values, None)
        drawing = QWidget()
        make_column(self.parameter, (self.plot, 1), of=drawing)
        tabs = TabWidget()
        tabs.addTab(self.results, self.tr("Results"))
        tabs.addTab(self.camera, self.tr("Camera at a value"))
        self._found = QSplitter()
        self._found.addWidget(tabs)
        self._found.addWidget(drawing)
        self._found.setSizes([540, 460])
        keep_place(self._found)
        buttons = make_buttons(self, self.export)
        below = make_row(
            QLabel(self.tr("Camera at")),
            self.at,
            QLabel(self.tr("as")),
            self.format,
            (self.said, 1),
            buttons,
        )
        make_column(above, self.words, (self._found, 1), below, of=self, margins=theme.MARGIN)

    @property
    def quantity(self) -> Scalar:
        """The chosen quantity."""
        return Scalar(self.scalar.currentData())  # Qt keeps its text only

    def show_results(self, paths: Sequence[Path], scalar: Scalar, values: Path | None) -> None:
        """Show results by a quantity, from a table or from the photographs."""
        self._paths, self._values = tuple(dict.fromkeys(paths)), values
        blocked = self.scalar.blockSignals(True)
        self.scalar.setCurrentIndex(self.scalar.findData(scalar))
        self.scalar.blockSignals(blocked)
        self._analyse()

    def _ask_for_results(self) -> None:
        names, _ = QFileDialog.getOpenFileNames(
            self, self.tr("Results"), "", self.tr("Results (*.json)")
        )
        if names:
            found = (*self._paths, *map(Path, names))
            self.show_results(found, self.quantity, self._values)

    def _ask_for_values(self) -> None:
        name, _ = QFileDialog.getOpenFileName(
            self, self.tr("Table of values"), "", self.tr("Tables (*.csv)")
        )
        if name:
            self.show_results(self._paths, self.quantity, Path(name))

    def _analyse(self) -> None:
        paths, scalar, values = self._paths, self.quantity, self._values
        if paths:
            self._clear(self.tr("working…"))
            self._work.start(
                self.tr("Fitting the series"),
                lambda _: analyse_series(paths, scalar, values),
                self._show,
                lambda error: self._clear(str(error)),
            )

    def _clear(self, text: str) -> None:
        self.analysed = None
        self.words.setText(text)
        self.results.show_columns([])
        self.camera.show_columns([])
        self.parameter.clear()
        self.plot.clear()
        self._show_whether_found(False)

    def _show_whether_found(self, found: bool) -> None:
        """Show tables and plot if there is anything in them, and let a camera be exported."""
        self._found.setVisible(found)
        for widget in (self.at, self.format, self.export):
            widget.setEnabled(found)

    def _show(self, analysed: AnalysedSeries) -> None:
        self.analysed = analysed
        names = _name_files(analysed)[len(analysed.results) :]
        left_out = [(n, one.reason) for n, one in zip(names, analysed.left_out, strict=True)]
        self.words.setText("\n".join(list_sentences(analysed.series, analysed.drifts, left_out)))
        self._tabulate(analysed)
        known = analysed.series.settings[0].known
        free = np.flatnonzero(np.diag(known.covariance) > 0).tolist()
        for k in free:
            self.parameter.addItem(known.camera.names[k], k)
        self._show_whether_found(True)
        settings = analysed.series.settings
        middle = (settings[0].value + settings[-1].value) / 2
        self.at.setText(format_value(middle, analysed.scalar))
        self.at.setToolTip(
            self.tr("From {0} to {1}; empty to write a profile of all focal lengths").format(
                format_value(settings[0].value, analysed.scalar),
                format_value(settings[-1].value, analysed.scalar),
            )
        )
        self._draw()
        self._show_camera()

    def _tabulate(self, analysed: AnalysedSeries) -> None:
        """Show the results of the series, and below them those that are left out."""
        used, reasons = analysed.results, [one.reason for one in analysed.left_out]
        columns = [
            Column(
                self.tr("File"),
                _name_files(analysed),
                lambda name: str(PurePath(name).with_suffix("")),  # all are .json
            ),
            Column(
                self.scalar.currentText().capitalize(),
                [*(one.value for one in used), *(one.value for one in analysed.left_out)],
                lambda value: format_value(value, analysed.scalar),
            ),
        ]
        if analysed.drifts:
            drifts = [None, *analysed.drifts, *[None] * len(reasons)]
            px = self.tr("px")
            columns += [
                Column(
                    self.tr("From the first"),
                    [0.0, *(math.nan if d is None else d.difference.rms for d in drifts[1:])],
                    with_decimals(3),
                    self.tr("Difference from the first camera after a rotation, rms"),
                    unit=px,
                ),
                Column(
                    self.tr("Explained"),
                    [math.nan if d is None else d.expected for d in drifts],
                    with_decimals(3),
                    self.tr("Difference that the calibrations' uncertainties explain"),
                    unit=px,
                ),
                Column(
                    self.tr("Probability"),
                    [math.nan if d is None else d.probability for d in drifts],
                    with_digits(2),
                    self.tr("Of a difference as large as this one if the camera has not changed"),
                    expendable=True,
                ),
                Column(
                    self.tr("Changed"),
                    ["" if d is None else self._answer(d.has_changed) for d in drifts],
                ),
            ]
        if reasons:
            columns += [
                Column(
                    self.tr("Used"),
                    [*[self.tr("yes")] * len(used), *[self.tr("left out")] * len(reasons)],
                    tips=[*[""] * len(used), *reasons],
                ),
                Column(self.tr("Reason"), [*[""] * len(used), *reasons], hidden=True),
            ]
        marked = [k for k, d in enumerate(analysed.drifts, start=1) if d.has_changed]
        self.results.show_columns(columns, marked)

    def _answer(self, has_changed: bool) -> str:
        return self.tr("yes") if has_changed else self.tr("no")

    def _draw(self) -> None:
        """Draw the chosen parameter with its standard deviation, and the function between."""
        self.plot.clear()
        k = self.parameter.currentData()
        if self.analysed is None or k is None:
            return
        series, colours = self.analysed.series, theme.current()
        self.plot.set_labels(
            self.scalar.currentText(),
            self.parameter.currentText(),
            self.analysed.scalar.unit,
            self.tr("px") if k < 4 else "",
        )
        self.plot.write_numbers(choose_axis_text(self.analysed))
        x = np.linspace(series.settings[0].value, series.settings[-1].value, _STEPS)
        middle, sigma = _evaluate(series, x.tolist(), k)
        band = QColor(colours.accent)
        band.setAlpha(_BAND_OPACITY)
        edges = [self.plot.plot(x, middle + sign * sigma, pen=band) for sign in (-1, 1)]
        self.plot.addItem(pg.FillBetweenItem(*edges, brush=band))
        self.plot.plot(x, middle, pen=theme.make_pen(colours.accent, width=2))
        values = np.array([setting.value for setting in series.settings])
        measured = [setting.known for setting in series.settings]
        y = np.array([known.camera.params[k] for known in measured])
        error = np.array([np.sqrt(known.covariance[k, k]) for known in measured])
        self.plot.addItem(
            pg.ErrorBarItem(x=values, y=y, height=2 * error, pen=theme.make_pen(colours.text))
        )
        self.plot.plot(
            values, y, pen=None, symbol="o", symbolSize=6, symbolBrush=colours.text, symbolPen=None
        )
        self.plot.show_all()

    @property
    def value(self) -> float | None:
        """The value at which the camera is shown; None if none is stated.

        Raises:
            ValueError: if it is no value of the quantity.
        """
        text = self.at.text().strip()
        return parse_value(text, self.quantity) if text else None

    def _show_camera(self) -> None:
        """Show the camera at the value, and offer the formats that can hold it."""
        if self.analysed is None:
            return
        known: UncertainCamera | None = None
        said, is_profile = "", False
        try:
            value = self.value
            known = None if value is None else self.analysed.series.predict(value)
            is_profile = value is None and self.analysed.scalar is Scalar.ZOOM
        except ValueError:
            said = self.tr("{0} is no value of {1}.").format(
                self.at.text().strip(), self.scalar.currentText()
            )
        except CalibrationError as error:
            said = str(error)
        self.said.setText(said)
        self._tabulate_camera(known)
        exporters = [
            one
            for one in EXPORTERS.values()
            if (known is not None and not one.needs_corners)
            or (is_profile and one.write_zoom is not None)
        ]
        chosen = self.format.currentText()
        self.format.clear()
        for exporter in exporters:
            self.format.addItem(exporter.title, exporter.name)
        self.format.setCurrentIndex(max(self.format.findText(chosen), 0))
        self.export.setEnabled(bool(exporters))

    def _tabulate_camera(self, known: UncertainCamera | None) -> None:
        if known is None:
            self.camera.show_columns([])
            return
        names, sigma = known.camera.names, np.sqrt(np.diag(known.covariance))
        self.camera.show_columns(
            [
                Column(self.tr("Parameter"), names),
                *estimate_columns(self.tr("Value"), known.camera.params, sigma),
                Column(self.tr("Unit"), [self.tr("px")] * 4 + [""] * (len(names) - 4)),
            ]
        )

    def _ask_and_export(self) -> None:
        exporter = EXPORTERS[self.format.currentData()]
        pattern = " ".join(f"*{suffix}" for suffix in exporter.suffixes)
        path = ask_for_name(
            self,
            self.tr("Export"),
            f"camera{exporter.suffixes[0]}",
            f"{exporter.title} ({pattern})",
        )
        if path is not None:
            self.write(exporter, Path(path))

    def write(self, exporter: Exporter, path: Path) -> None:
        """Write the camera at the value, or the profile of all focal lengths, by a job."""
        if self.analysed is None:
            return
        series, value = self.analysed.series, self.value

        def done(report: ExportReport) -> None:
            self.said.setText(self.tr("Saved as {0}. {1}").format(path.name, report.note))

        self._jobs.start(
            self.tr("Writing {0}").format(path.name),
            lambda _: export_from_series(series, value, exporter, path),
            done,
            failed=lambda error: self.said.setText(str(error)),
            owner=self,
        )


def _name_files(analysed: AnalysedSeries) -> list[str]:
    """Return names of the results of a series, and of those that are left out."""
    files = [str(one.path) for one in analysed.results]
    return distinguish_paths([*files, *(one.file for one in analysed.left_out)])


def _evaluate(series: Series, values: Sequence[float], k: int) -> tuple[np.ndarray, np.ndarray]:
    """Return parameter k and its standard deviation at values."""
    known = [series.predict(value) for value in values]
    middle = np.array([one.camera.params[k] for one in known])
    return middle, np.sqrt([one.covariance[k, k] for one in known])
