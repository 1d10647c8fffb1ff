"""Histograms of the residuals with the densities fitted to them (figures 11, 12 and 16)."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QT_TRANSLATE_NOOP

from calibgui.dataset import Result
from calibgui.engine.assessment import Histogram, make_component_histogram, make_length_histogram
from calibgui.gui.panels.evidence.plane import PlaneChoice
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.parts.split import Split
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.plots import Plot

_SAMPLES = 300
"""Number of points of a drawn density."""
_PADDING = 0.03
"""Room around what is drawn, as a share of it."""


class HistogramPlot(Plot):
    """One histogram with its Gaussian or Rayleigh density, and the numbers of both."""

    def __init__(self) -> None:
        super().__init__("", "")
        self.bars = self.plot(stepMode="center", fillLevel=0)
        self.fit = self.plot()
        self._extent = (0.0, 1.0), (0.0, 1.0)

    def show_histogram(
        self, histogram: Histogram, name: str, unit: str, extent: tuple[float, float] | None = None
    ) -> None:
        """Show the density of a quantity.

        Args:
            histogram: of the quantity.
            name: of the quantity, which is in `unit`.
            extent: the largest value and the largest density that the axes reach to; those of
                the histogram if None.
        """
        colours = theme.current()
        self.set_labels(name, self.tr("density"), unit, f"1/{unit}")
        self.bars.setData(histogram.edges, histogram.density)
        self.bars.setPen(theme.make_pen(colours.line))
        self.bars.setBrush(pg.mkBrush(colours.line))
        x = np.linspace(histogram.edges[0], histogram.edges[-1], _SAMPLES)
        self.fit.setData(x, histogram.evaluate_density(x))
        self.fit.setPen(theme.make_pen(colours.bad, width=2))
        law = self.tr("Rayleigh s") if histogram.is_rayleigh else self.tr("Gaussian σ")
        title = self.tr("mean {0:.4f}, SD {1:.4f} {4}<br>{2} = {3:.4f} {4}").format(
            round(histogram.mean, 4) + 0.0, histogram.sd, law, histogram.scale, unit
        )
        if histogram.outside:
            title += self.tr("; {0} farther out").format(histogram.outside)
        self.set_title(title)
        limit, highest = extent or _measure_extent(histogram)
        self._extent = (0.0 if histogram.is_rayleigh else -limit, limit), (0.0, highest)
        self.show_all()

    def show_all(self) -> None:
        """Take back what was zoomed and moved."""
        x, y = self._extent
        self.box.setRange(xRange=x, yRange=y, padding=_PADDING)


def _measure_extent(*histograms: Histogram) -> tuple[float, float]:
    """Return the largest value and the largest density of histograms, the fitted ones included."""
    highest = 0.0
    for h in histograms:
        fitted = h.evaluate_density(np.linspace(h.edges[0], h.edges[-1], _SAMPLES))
        highest = max(highest, float(h.density.max()), float(fitted.max()))
    return max(float(h.edges[-1]) for h in histograms), highest


class HistogramsPanel(Panel):
    """Shows components against a Gaussian and lengths against a Rayleigh distribution."""

    title = str(QT_TRANSLATE_NOOP("HistogramsPanel", "Histograms"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "HistogramsPanel",
            "How the residuals are distributed, beside a Gaussian and a Rayleigh distribution.",
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self.plane = PlaneChoice()
        self.plane.currentIndexChanged.connect(self._refresh_now)
        self.plots = tuple(HistogramPlot() for _ in range(3))
        for plot in self.plots:
            plot.setToolTip(
                self.tr(
                    "Noise of equal size in all directions has Gaussian components and lengths "
                    "after Rayleigh.\nHeavy tails mean bad corners; two humps, a board that is "
                    "not flat or a wrong model."
                )
            )
        choice, plots = make_row(self.plane, None), Split(820, *((plot, 1) for plot in self.plots))
        self._fill_body(choice, (plots, 1))

    def _refresh(self, result: Result) -> None:
        residuals = np.concatenate(self.plane.residuals(result.calibration))
        histograms = (
            make_component_histogram(residuals[:, 0]),
            make_component_histogram(residuals[:, 1]),
            make_length_histogram(np.linalg.norm(residuals, axis=1)),
        )
        # Both components on the same axes, or their difference is not seen.
        of_components, of_lengths = _measure_extent(*histograms[:2]), _measure_extent(histograms[2])
        extents = (of_components, of_components, of_lengths)
        for plot, histogram, name, extent in zip(
            self.plots, histograms, self.plane.names, extents, strict=True
        ):
            plot.show_histogram(histogram, name, self.plane.unit, extent)
