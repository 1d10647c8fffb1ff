"""The synthetic check (paper 5.2): Table 3 and figures 13 to 16 beside the real ones."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QT_TRANSLATE_NOOP
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QPushButton,
    QTabWidget,
    QVBoxLayout,
)

from calibgui.app.calibration import short_names
from calibgui.app.synthetic import BLUR, SyntheticCheck, synthetic_check
from calibgui.engine.images import Image
from calibgui.engine.render import render
from calibgui.engine.statistics import length_histogram, stacked, summarise
from calibgui.formats.result import Result
from calibgui.gui import theme
from calibgui.gui.jobs import Job, Jobs
from calibgui.gui.panels.before_after import BeforeAfter, Grey
from calibgui.gui.panels.estimates import estimate_columns
from calibgui.gui.panels.histograms import HistogramPlot
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.scatter import ResidualScatter
from calibgui.gui.panels.split import Split
from calibgui.gui.plots import Plot
from calibgui.gui.tables import Column, Table, fixed, number
from calibgui.report.comparison import compare

_BINS = 50


class SyntheticPanel(Panel):
    """Renders the views from the result, calibrates them again and compares.

    Args:
        jobs: that do the work.
        read: the image of a path, called in a worker.
    """

    title = str(QT_TRANSLATE_NOOP("SyntheticPanel", "Synthetic check"))
    icon = "synthetic"

    def __init__(self, jobs: Jobs, read: Callable[[str], Image]) -> None:
        super().__init__()
        self._jobs, self._read = jobs, read
        self._job: Job | None = None
        self._pictures: Job | None = None
        self.check: SyntheticCheck | None = None
        self.run = QPushButton(self.tr("&Render and calibrate"))
        self.run.setToolTip(
            self.tr(
                "Renders every view from the result, finds the corners again and calibrates:\n"
                "what comes back is known exactly, so it shows the error of the method itself."
            )
        )
        self.run.clicked.connect(self._run)
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.table = Table()
        self.images = BeforeAfter(self.tr("real"), self.tr("synthetic"))
        self.scatters = (ResidualScatter(), ResidualScatter())
        self.histograms = (HistogramPlot(), HistogramPlot())
        self.errors = Plot(
            self.tr("relative error of an external parameter"), self.tr("count"), "%"
        )
        self.errors.setToolTip(self.tr("|z real − z synthetic| / |z real| of eq. 51 (figure 14)."))
        self._bars = self.errors.plot(stepMode="center", fillLevel=0)
        self.tabs = QTabWidget(documentMode=True)
        for widget, name in (
            (self.table, self.tr("Table 3")),
            (self.images, self.tr("Images")),
            (self.errors, self.tr("Poses")),
            (Split(500, *((plot, 1) for plot in self.scatters)), self.tr("Residuals")),
            (Split(500, *((plot, 1) for plot in self.histograms)), self.tr("Histograms")),
        ):
            self.tabs.addTab(widget, name)
        keeping = self.tabs.sizePolicy()
        keeping.setRetainSizeWhenHidden(True)
        self.tabs.setSizePolicy(keeping)
        bar = QHBoxLayout()
        bar.addWidget(self.run)
        bar.addWidget(self.words, 1)
        layout = QVBoxLayout(self.body)
        layout.addLayout(bar)
        layout.addWidget(self.tabs, 1)

    def show_result(self, result: Result | None) -> None:
        """Forget the check of another result."""
        self.check = None
        if self._job is not None:
            self._job.cancel()
        super().show_result(result)

    def _run(self) -> None:
        result = self._result
        assert result is not None
        if self._job is not None:
            self._job.cancel()
            return
        self.run.setText(self.tr("&Cancel"))
        self.words.setText(self.tr("Rendering the views and searching them…"))
        self._job = self._jobs.start(
            self.tr("Synthetic check"),
            lambda job: synthetic_check(result, progress=job.advance),
            self._done,
            failed=lambda error: self.words.setText(str(error)),
            ended=self._ended,
        )

    def _done(self, check: SyntheticCheck) -> None:
        if check.real is self._result:
            self.check = check
            self._refresh_now()

    def _ended(self) -> None:
        self._job = None
        self.run.setText(self.tr("&Render and calibrate"))
        if self.check is None and self._result is not None:
            self._refresh_now()

    def _refresh(self, result: Result) -> None:
        check = self.check
        self.tabs.setVisible(check is not None)
        self.run.setEnabled(result.target is not None)
        if check is None:
            if self._job is None:
                self.words.setText(self._invitation(result))
            return
        self._show_table(check)
        self._show_residuals(check)
        errors = 100 * check.extrinsic_errors.ravel()
        count, edges = np.histogram(errors, _BINS, range=(0.0, float(np.quantile(errors, 0.99))))
        self._bars.setData(edges, count)
        self._bars.setPen(pg.mkPen(theme.current().line))
        self._bars.setBrush(pg.mkBrush(theme.current().line))
        self.errors.set_title(
            self.tr("median {0:.3g} %, largest {1:.3g} %").format(np.median(errors), errors.max())
        )
        real, made = (summarise(r.calibration.residuals) for r in (check.real, check.synthetic))
        self.words.setText(
            self.tr(
                "{0} of {1} views found again. e′ = {2:.4f} ± {3:.4f} reference px, "
                "real images {4:.3f} ± {5:.3f}."
            ).format(
                len(check.synthetic.used),
                len(check.synthetic.views),
                made.reference_mean,
                made.reference_sd,
                real.reference_mean,
                real.reference_sd,
            )
        )

    def _invitation(self, result: Result) -> str:
        if result.target is None:
            return self.tr("The target's pattern is not known, so its views cannot be rendered.")
        return self.tr("Would the method find this camera again, if it were just so?")

    def _show_table(self, check: SyntheticCheck) -> None:
        rows = compare(check.real.calibration, check.synthetic.calibration)
        self.table.show_columns(
            [
                Column(self.tr("Parameter"), [row.name for row in rows]),
                *estimate_columns(self.tr("Real"), [r.a for r in rows], [r.sigma_a for r in rows]),
                *estimate_columns(
                    self.tr("Synthetic"), [r.b for r in rows], [r.sigma_b for r in rows]
                ),
                Column(self.tr("Difference"), [row.change for row in rows], number(3)),
                Column(
                    self.tr("in σ"),
                    [r.change / r.sigma_a if r.sigma_a > 0 else np.nan for r in rows],
                    fixed(2),
                    self.tr("The difference over the real result's standard deviation."),
                ),
            ]
        )

    def _show_residuals(self, check: SyntheticCheck) -> None:
        for result, scatter, histogram, name in zip(
            (check.real, check.synthetic),
            self.scatters,
            self.histograms,
            (self.tr("real"), self.tr("synthetic")),
            strict=True,
        ):
            calibration, unit = result.calibration, self.tr("reference px")
            points = [view.reference for view in calibration.residuals]
            scatter.show_residuals(points, "Δx′", "Δy′", unit)
            scatter.set_title(name)
            lengths = np.linalg.norm(stacked(calibration, on_reference=True), axis=1)
            histogram.show_histogram(length_histogram(lengths), f"e′, {name}", unit)

    def _select(self, k: int, corner: int) -> None:
        if self.check is None:
            return
        found = np.cumsum([view.usable for view in self.check.synthetic.views]) - 1
        self.scatters[0].select(k, corner)
        seen = k >= 0 and self.check.synthetic.views[k].usable
        self.scatters[1].select(int(found[k]) if seen else -1)
        result, view = self.check.real, max(k, 0)
        if self._pictures is not None:
            self._pictures.cancel()
        self._pictures = self._jobs.start(
            self.tr("Rendering {0}").format(short_names(result.used)[view]),
            lambda _: pictures(result, view, self._read),
            lambda images: self.images.show_images(*images),
            failed=lambda error: self.words.setText(str(error)),
        )


def pictures(result: Result, k: int, read: Callable[[str], Image]) -> tuple[Grey, Grey]:
    """Figure 13: the image of calibrated view k, and its synthetic version.

    Raises:
        CalibrationError: if the image cannot be read.
    """
    assert result.target is not None
    real = read(result.used[k].image).grey
    pose = result.calibration.poses[k]
    return real, render(result.calibration.camera, pose, result.target, blur=BLUR)
