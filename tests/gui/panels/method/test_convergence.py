"""The convergence plot while it grows, and when it has ended."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.dataset import Result, View, ViewStatus
from calibgui.engine.calibration import Cost
from calibgui.engine.calibration.result import Status
from calibgui.gui.panels.method.convergence import ConvergencePanel
from tests.gui.panels.conftest import Shown


def test_plot_holds_the_history(shown: Shown[ConvergencePanel], result: Result) -> None:
    panel = shown(ConvergencePanel, result)
    x, y = panel._curve.getOriginalDataset()
    np.testing.assert_array_equal(x, [i.index for i in result.calibration.history])
    np.testing.assert_array_equal(y, [i.cost for i in result.calibration.history])
    assert panel.plot.area.left.logMode
    levels = panel.plot.area.bottom.tickSpacing(-0.2, 3.2, 300)
    assert levels and all(spacing >= 1 for spacing, _ in levels), "there is no iteration 0.5"


def test_grows_while_it_runs(shown: Shown[ConvergencePanel], result: Result) -> None:
    panel = shown(ConvergencePanel, None)
    panel.start(Cost.IMAGE)
    assert panel.plot.isVisible() and "Calibrating" in panel.words.text()
    for n, iteration in enumerate(result.calibration.history, start=1):
        panel.add(iteration)
        assert len(panel._curve.getData()[0]) == n
    words = f"iteration {iteration.index}, RMS residual {iteration.rms:.4f} px"
    assert words in panel.words.text()
    panel.show_result(result)
    assert panel.words.text().startswith("Converged after")
    panel.start(Cost.IMAGE)
    assert panel._curve.getOriginalDataset()[0] is None


def test_another_solve_begins_anew(shown: Shown[ConvergencePanel], result: Result) -> None:
    """A calibration that searches the images again solves twice."""
    panel = shown(ConvergencePanel, None)
    panel.start(Cost.IMAGE)
    history = result.calibration.history
    for iteration in (*history, *history[:2]):
        panel.add(iteration)
    assert panel._curve.getOriginalDataset()[0].tolist() == [0, 1]


@pytest.mark.parametrize(
    ("status", "words"),
    [
        (Status.CONVERGED, "Converged after"),
        (Status.STOPPED, "best so far is kept"),
        (Status.MAX_ITERATIONS, "Not converged"),
    ],
)
def test_says_how_it_ended(
    shown: Shown[ConvergencePanel], result: Result, status: Status, words: str
) -> None:
    ended = replace(result, calibration=replace(result.calibration, status=status))
    panel = shown(ConvergencePanel, ended)
    assert words in panel.words.text()
    assert f"{result.calibration.history[-1].rms:.4f} px" in panel.words.text()


def test_says_where_residuals_are_weighted(shown: Shown[ConvergencePanel], result: Result) -> None:
    points = [
        view._replace(cov=np.tile(np.eye(2), (len(view.uv), 1, 1)))
        for view in result.observations()
    ]
    views = tuple(View(f"{k}.png", ViewStatus.FOUND, points=seen) for k, seen in enumerate(points))
    panel = shown(ConvergencePanel, result)
    assert ". RMS residual" in panel.words.text()
    panel.show_result(Result(result.calibration, views))
    assert ". Weighted RMS residual" in panel.words.text()
