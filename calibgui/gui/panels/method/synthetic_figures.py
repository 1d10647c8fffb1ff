"""The figures of the synthetic check: Table 3, and figures 13 to 16 beside the real ones."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtWidgets import QComboBox, QWidget

from calibgui.app.calibrating.synthetic import SyntheticCheck
from calibgui.engine.assessment import (
    make_component_histogram,
    make_length_histogram,
    stack_residuals,
)
from calibgui.gui.panels.evidence.histograms import HistogramPlot
from calibgui.gui.panels.parts.estimates import estimate_columns
from calibgui.gui.panels.parts.scatter import ResidualScatter
from calibgui.gui.panels.parts.split import Split
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.plots import Plot
from calibgui.gui.widgets.tables import Column, Table, with_decimals, with_digits
from calibgui.report.comparison import compare_parameters

_BINS = 50
_LEAST_BESIDE = 500
"""Least width of two plots side by side, px."""
_COMPONENTS = ("Δx′", "Δy′", "e′")


class ParameterTable(Table):
    """Table 3: the camera that was rendered, and the one that was found again."""

    def show_check(self, check: SyntheticCheck) -> None:
        """Show both results' intrinsics and how they differ."""
        rows = compare_parameters(check.real.calibration, check.synthetic.calibration)
        self.show_columns(
            [
                Column(self.tr("Parameter"), [row.name for row in rows]),
                *estimate_columns(self.tr("Real"), [r.a for r in rows], [r.sigma_a for r in rows]),
                *estimate_columns(
                    self.tr("Synthetic"), [r.b for r in rows], [r.sigma_b for r in rows]
                ),
                Column(
                    self.tr("Difference"),
                    [row.change for row in rows],
                    with_digits(3),
                    optional=True,
                ),
                Column(
                    self.tr("in σ"),
                    [r.change / r.sigma_b if r.sigma_b > 0 else np.nan for r in rows],
                    with_decimals(2),
                    self.tr("The difference over the synthetic result's standard deviation."),
                ),
            ]
        )


class PoseErrors(Plot):
    """Figure 14: how far the poses that were rendered are missed."""

    def __init__(self) -> None:
        super().__init__(self.tr("relative error of an external parameter"), self.tr("count"), "%")
        self.setToolTip(self.tr("|z real − z synthetic| / |z real| of eq. 51 (figure 14)."))
        self.bars = self.plot(stepMode="center", fillLevel=0)

    def show_check(self, check: SyntheticCheck) -> None:
        """Show the relative errors of all poses, the largest hundredth left out."""
        errors = 100 * check.extrinsic_errors.ravel()
        count, edges = np.histogram(errors, _BINS, range=(0.0, float(np.quantile(errors, 0.99))))
        self.bars.setData(edges, count)
        self.bars.setPen(theme.make_pen(theme.current().line))
        self.bars.setBrush(pg.mkBrush(theme.current().line))
        self.set_title(
            self.tr("median {0:.3g} %, largest {1:.3g} %").format(np.median(errors), errors.max())
        )


class Scatters(QWidget):
    """Figure 15: the residuals of real and synthetic views."""

    def __init__(self) -> None:
        super().__init__()
        self.plots: tuple[ResidualScatter, ...] = ()
        """The two plots, once there is something to show: to make them takes a while."""
        self._layout = make_column(of=self)

    def show_check(self, check: SyntheticCheck) -> None:
        """Show the residuals on the reference plane."""
        if not self.plots:
            self.plots = ResidualScatter(), ResidualScatter()
            self._layout.addWidget(Split(_LEAST_BESIDE, *((plot, 1) for plot in self.plots)))
        real = check.real.places
        found_again = [i for i, v in zip(real, check.synthetic.views, strict=True) if v.usable]
        for result, views, plot, name in (
            (check.real, real, self.plots[0], self.tr("real")),
            (check.synthetic, found_again, self.plots[1], self.tr("synthetic")),
        ):
            points = [view.reference for view in result.calibration.residuals]
            plot.show_residuals(points, views, *_COMPONENTS[:2], self.tr("reference px"))
            plot.set_title(name)

    def select(self, check: SyntheticCheck, k: int, corner: int) -> None:
        """Highlight calibrated view k, and one of its corners, where it was found again."""
        found = np.cumsum([view.usable for view in check.synthetic.views]) - 1
        seen = k >= 0 and check.synthetic.views[k].usable
        self.plots[0].select(k, corner)
        self.plots[1].select(int(found[k]) if seen else -1)


class Histograms(QWidget):
    """Figure 16: one component of the residuals of real and synthetic views, or their length."""

    def __init__(self) -> None:
        super().__init__()
        self.component = QComboBox()
        self.component.addItems(_COMPONENTS)
        self.component.setCurrentIndex(2)
        self.component.setAccessibleName(self.tr("Component of the residuals"))
        self.component.setToolTip(
            self.tr("The residuals' components on the reference plane, or their length e′.")
        )
        self.component.currentIndexChanged.connect(self._draw)
        self.plots: tuple[HistogramPlot, ...] = ()
        """The two plots, once there is something to show: to make them takes a while."""
        self._check: SyntheticCheck | None = None
        choice = make_row(self.component, None)
        self._layout = make_column(choice, of=self, margins=(0, theme.SPACING, 0, 0))

    def show_check(self, check: SyntheticCheck) -> None:
        """Show the component that is chosen."""
        if not self.plots:
            self.plots = HistogramPlot(), HistogramPlot()
            self._layout.addWidget(Split(_LEAST_BESIDE, *((plot, 1) for plot in self.plots)), 1)
        self._check = check
        self._draw()

    def _draw(self) -> None:
        if self._check is None:
            return
        which, unit = self.component.currentIndex(), self.tr("reference px")
        names = self.tr("{0}, real"), self.tr("{0}, synthetic")
        results = self._check.real, self._check.synthetic
        for result, plot, name in zip(results, self.plots, names, strict=True):
            residuals = stack_residuals(result.calibration, on_reference=True)
            histogram = (
                make_component_histogram(residuals[:, which])
                if which < 2
                else make_length_histogram(np.linalg.norm(residuals, axis=1))
            )
            plot.show_histogram(histogram, name.format(_COMPONENTS[which]), unit)
