"""The check is run by its button; its plots hold its numbers."""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.synthetic import BLUR_PX, SyntheticCheck, run_synthetic_check
from calibgui.dataset import Result
from calibgui.engine.assessment.residuals.residual_statistics import (
    make_component_histogram,
    make_length_histogram,
    stack_residuals,
)
from calibgui.engine.images.reading import Image
from calibgui.engine.images.rendering import render_view
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.method.synthetic import SyntheticPanel, render_pair
from calibgui.gui.panels.services import Services
from tests.app.rendered import small_result


def black(path: str) -> Image:
    return Image(np.zeros((150, 200), np.uint8), Path(path))


@pytest.fixture(scope="module")
def small() -> Result:
    return small_result()


@pytest.fixture(scope="module")
def check(small: Result) -> SyntheticCheck:
    return run_synthetic_check(small)


def panel_of(result: Result, jobs: Jobs, qtbot: QtBot) -> SyntheticPanel:
    panel = SyntheticPanel(Services(jobs, black))
    qtbot.addWidget(panel)
    panel.resize(800, 600)
    panel.show_result(result)
    panel.show()
    return panel


def test_the_button_runs_the_check(small: Result, jobs: Jobs, qtbot: QtBot) -> None:
    panel = panel_of(small, jobs, qtbot)
    assert not panel.tabs.isVisible()
    qtbot.mouseClick(panel.run, Qt.MouseButton.LeftButton)
    assert not panel.run.isEnabled()
    qtbot.waitUntil(lambda: panel.found is not None and not jobs.running, timeout=60_000)
    assert panel.tabs.isVisible() and panel.run.isEnabled()
    words = panel.words.text()
    assert words.startswith("Passed: from pictures of this very camera, with the 0.0")
    assert "5 of 5 views found again." in words


def test_tables_and_plots_hold_its_numbers(
    small: Result, check: SyntheticCheck, jobs: Jobs, qtbot: QtBot
) -> None:
    panel = panel_of(small, jobs, qtbot)
    panel._done(check)
    for tab in range(panel.tabs.count()):
        panel.tabs.setCurrentIndex(tab)
    panel.resize(400, 600)  # in the narrowest card
    QApplication.processEvents()
    wide = panel.tabs.tabBar().sizeHint().width()
    assert wide <= panel.tabs.width(), "the names of the tabs need not be scrolled"
    rows = list(csv.reader(io.StringIO(panel.table.as_csv())))[1:]
    numbers = np.array([[float(row[i]) for i in (1, 2, 3, 4)] for row in rows]).T
    real, made = check.real.calibration, check.synthetic.calibration
    expected = (real.camera.params, real.sigma, made.camera.params, made.sigma)
    np.testing.assert_array_equal(numbers, expected)

    edges, count = panel.errors.bars.getData()
    errors = 100 * check.extrinsic_errors.ravel()
    assert count.sum() == np.count_nonzero(errors <= edges[-1])
    for result, scatter, histogram in zip(
        (check.real, check.synthetic), panel.scatters.plots, panel.histograms.plots, strict=True
    ):
        points = np.concatenate(scatter._points)
        np.testing.assert_array_equal(
            points, stack_residuals(result.calibration, on_reference=True)
        )
        lengths = make_length_histogram(np.linalg.norm(points, axis=1))
        np.testing.assert_array_equal(histogram.bars.getData()[1], lengths.density)
    panel.histograms.component.setCurrentIndex(1)
    for result, histogram in zip(
        (check.real, check.synthetic), panel.histograms.plots, strict=True
    ):
        down = make_component_histogram(
            stack_residuals(result.calibration, on_reference=True)[:, 1]
        )
        np.testing.assert_array_equal(histogram.bars.getData()[1], down.density)
        assert "Δy′" in histogram.area.bottom.labelText
    qtbot.waitUntil(lambda: not jobs.running)


def test_only_the_tab_in_front_is_drawn(
    small: Result, check: SyntheticCheck, jobs: Jobs, qtbot: QtBot
) -> None:
    panel = panel_of(small, jobs, qtbot)
    panel._done(check)
    assert panel.table.model().rowCount() == 10
    assert not panel.scatters.plots
    panel.tabs.setCurrentWidget(panel.scatters)
    assert len(panel.scatters.plots[0]._points) == 5
    assert not jobs.running


def test_the_selected_view_is_rendered(
    small: Result, check: SyntheticCheck, jobs: Jobs, qtbot: QtBot
) -> None:
    panel = panel_of(small, jobs, qtbot)
    panel._done(check)
    panel.tabs.setCurrentWidget(panel.images)
    panel.select(4, 11)
    qtbot.waitUntil(lambda: not jobs.running)
    assert len(panel.images._images) == 2
    calibration = small.calibration
    real, made = render_pair(small, 3, black)
    assert not real.any()
    expected = render_view(calibration.camera, calibration.poses[3], small.board, blur=BLUR_PX)
    np.testing.assert_array_equal(made, expected)
    panel.tabs.setCurrentWidget(panel.scatters)
    ring = np.transpose(panel.scatters.plots[0]._ring.getData())
    np.testing.assert_array_equal(ring, calibration.residuals[3].reference[11:12])


def test_without_a_pattern_it_says_why_not(small: Result, jobs: Jobs, qtbot: QtBot) -> None:
    views = tuple(
        replace(v, points=v.observation(small.board), corners=None) if v.usable else v
        for v in small.views
    )
    panel = panel_of(Result(small.calibration, views), jobs, qtbot)
    assert not panel.run.isVisible() and "pattern is not known" in panel._empty.text()
