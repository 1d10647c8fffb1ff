"""Histograms and fits are the engine's, on either plane."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.engine.assessment.residuals.residual_statistics import (
    make_component_histogram,
    make_length_histogram,
    stack_residuals,
)
from calibgui.gui.panels.evidence.histograms import HistogramsPanel
from tests.gui.panels.conftest import Shown


@pytest.mark.parametrize("on_reference", [False, True])
def test_bars_curves_and_numbers(
    shown: Shown[HistogramsPanel], result: Result, qtbot: QtBot, on_reference: bool
) -> None:
    panel = shown(HistogramsPanel, result)
    if on_reference:
        qtbot.keyClick(panel.plane, Qt.Key.Key_Down)
    unit = "reference px" if on_reference else "px"
    residuals = stack_residuals(result.calibration, on_reference)
    expected = (
        make_component_histogram(residuals[:, 0]),
        make_component_histogram(residuals[:, 1]),
        make_length_histogram(np.linalg.norm(residuals, axis=1)),
    )
    for plot, histogram in zip(panel.plots, expected, strict=True):
        edges, density = plot.bars.getData()
        np.testing.assert_array_equal(edges, histogram.edges)
        np.testing.assert_array_equal(density, histogram.density)
        x, y = plot.fit.getData()
        np.testing.assert_array_equal(y, histogram.evaluate_density(x))
        title = plot.area.title.text
        assert f"SD {histogram.sd:.4f} {unit}<br>" in title
        assert title.endswith(f"= {histogram.scale:.4f} {unit}")
    assert f"[{unit}]" in panel.plots[2].area.bottom.labelText


def test_both_components_are_on_the_same_axes(
    shown: Shown[HistogramsPanel], result: Result
) -> None:
    panel = shown(HistogramsPanel, _stretch_along_u(result))
    along_u, along_v, lengths = (plot.box.viewRange() for plot in panel.plots)
    assert along_u == along_v and along_u != lengths
    edges, density = panel.plots[0].bars.getData()
    assert along_u[0][1] >= edges[-1] and along_u[1][1] >= density.max()
    panel.plots[1].box.scaleBy((0.1, 0.1))
    panel.plots[1].show_all()
    assert panel.plots[1].box.viewRange() == along_u


def test_what_the_axes_leave_out_is_told(shown: Shown[HistogramsPanel], result: Result) -> None:
    calibration = result.calibration
    first, *others = calibration.residuals
    bad = replace(first, image=np.vstack([first.image[:-1], [[6.0, 4.0]]]))
    outlying = replace(calibration, residuals=(bad, *others))
    for plot in shown(HistogramsPanel, replace(result, calibration=outlying)).plots:
        assert plot.box.viewRange()[0][1] < 1.0
        assert plot.area.title.text.endswith("; 1 farther out")


def _stretch_along_u(result: Result) -> Result:
    """Return the result with residuals ten times as large along u."""
    calibration = result.calibration
    stretched = [replace(r, image=r.image * [10.0, 1.0]) for r in calibration.residuals]
    return replace(result, calibration=replace(calibration, residuals=tuple(stretched)))
