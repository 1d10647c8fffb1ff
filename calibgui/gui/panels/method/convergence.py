"""Stage II as it runs: the cost against its iterations (figure 7)."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QT_TRANSLATE_NOOP

from calibgui.dataset import Result
from calibgui.engine.calibration import Cost, Iteration, Status
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.fit_text import describe_fit
from calibgui.gui.widgets.plots import Plot
from calibgui.gui.widgets.reserved_label import ReservedLabel
from calibgui.gui.widgets.tables import format_seconds


class ConvergencePanel(Panel):
    """The cost of every iteration; grows while a calibration runs."""

    title = str(QT_TRANSLATE_NOOP("ConvergencePanel", "Convergence"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "ConvergencePanel",
            "The cost after each step, also while it runs.",
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self.words = ReservedLabel(3)
        self.plot = Plot(self.tr("iteration"), self.tr("cost c"), logarithmic=True, counts=True)
        self.plot.setToolTip(
            self.tr("The sum of squared residuals that Stage II minimises, after each step.")
        )
        self._curve = self.plot.plot(symbol="o", symbolSize=7)
        self._iterations: list[Iteration] = []
        self._unit = ""
        self._fill_body(self.words, (self.plot, 1))

    def start(self, cost: Cost) -> None:
        """A calibration that minimises `cost` begins: forget the last one's iterations."""
        self._iterations = []
        self._state_unit(cost)
        self._result = None
        self._draw()
        self.words.setText(self.tr("Calibrating…"))
        self._stack.setCurrentWidget(self.body)

    def add(self, iteration: Iteration) -> None:
        """One more iteration of the running calibration; it may solve more than once."""
        if self._iterations and iteration.index <= self._iterations[-1].index:
            self._iterations = []
        self._iterations.append(iteration)
        self._draw()
        self.words.setText(
            self.tr("Calibrating: iteration {0}, RMS residual {1:.4f} {2}").format(
                iteration.index, iteration.rms, self._unit
            )
        )

    def _refresh(self, result: Result) -> None:
        calibration = result.calibration
        self._iterations = [*calibration.history]
        self._draw()
        if not calibration.history:
            self.words.setText(self.tr("The camera is known from a file: nothing was solved."))
            return
        last = calibration.history[-1]
        self._state_unit(calibration.cost)
        is_weighted = any(view.cov is not None for view in result.observations())
        text = (
            self.tr("Weighted RMS residual {0:.4f} {1}; {2}.")
            if is_weighted
            else self.tr("RMS residual {0:.4f} {1}; {2}.")
        )
        self.words.setText(
            self._ending(calibration.status).format(last.index)
            + " "
            + text.format(last.rms, self._unit, format_seconds(last.seconds))
            + f" {describe_fit(result)}."
        )

    def _state_unit(self, cost: Cost) -> None:
        """Say in which unit residuals are."""
        self._unit = self.tr("px") if cost is Cost.IMAGE else self.tr("reference px")
        self.plot.set_labels(self.tr("iteration"), self.tr("cost c"), y_unit=f"{self._unit}²")

    def _ending(self, status: Status) -> str:
        return {
            Status.CONVERGED: self.tr("Converged after {0} iterations."),
            Status.PARTIAL: self.tr(
                "Converged after {0} iterations, with assumptions on what the views leave open."
            ),
            Status.STOPPED: self.tr(
                "Stopped after {0} iterations: the best so far is kept, but it is not the optimum."
            ),
            Status.MAX_ITERATIONS: self.tr(
                "Not converged: all {0} iterations were used. Allow more, or hold parameters that "
                "the views do not determine."
            ),
        }[status]

    def _draw(self) -> None:
        colours = theme.current()
        self._curve.setPen(theme.make_pen(colours.accent, width=2))
        self._curve.setSymbolBrush(colours.accent)
        self._curve.setSymbolPen(None)
        self._curve.setData(
            [i.index for i in self._iterations],
            # A perfect fit has no logarithm.
            np.maximum([i.cost for i in self._iterations], np.finfo(float).tiny),
        )
