"""The map is the engine's, for points far away and near."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.uncertainty.projection_uncertainty import (
    ProjectionUncertainty,
    estimate_projection_uncertainty,
)
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.answer.uncertainty import UncertaintyPanel
from calibgui.gui.widgets import theme
from tests.gui.panels.conftest import Shown


@pytest.fixture
def panel(
    shown: Shown[UncertaintyPanel], jobs: Jobs, result: Result, qtbot: QtBot
) -> UncertaintyPanel:
    made = shown(UncertaintyPanel, result)
    qtbot.waitUntil(lambda: not jobs.running)
    return made


@pytest.fixture(scope="module")
def far(result: Result) -> ProjectionUncertainty:
    return estimate_projection_uncertainty(result.calibration, result.observations())


def test_map_and_words_are_the_engines(panel: UncertaintyPanel, far: ProjectionUncertainty) -> None:
    np.testing.assert_array_equal(panel.plot.image.image, far.worst_direction)
    box = panel.plot.image.mapRectToView(panel.plot.image.boundingRect())
    du, dv = far.u[1] - far.u[0], far.v[1] - far.v[0]
    assert box.left() + du / 2 == pytest.approx(far.u[0])
    assert box.bottom() - dv / 2 == pytest.approx(far.v[-1])
    words = panel.words.text()
    for value in (far.centre, far.median, far.worst):
        assert f"{format_two_digits(value)} px" in words
    assert f"{100 * far.fraction(0.1):.0f} % of the image" in words


def test_it_is_said_where_the_colours_end_below_the_worst(
    panel: UncertaintyPanel, far: ProjectionUncertainty
) -> None:
    assert "brightest" not in panel.words.text()
    covariance = far.covariance.copy()
    covariance[0, 0] *= 1e4
    panel._show(replace(far, covariance=covariance))
    top = panel.plot.bar.levels[1]
    assert top < 10 * far.worst
    assert f"The brightest colour is {format_two_digits(top)} px or more." in panel.words.text()


def test_the_limit_is_a_line_around_its_region(
    panel: UncertaintyPanel, far: ProjectionUncertainty, qtbot: QtBot
) -> None:
    limit = round(1.5 * far.median, 3)
    panel.limit.setFocus()
    panel.limit.selectAll()
    qtbot.keyClicks(panel.limit, f"{limit}")
    qtbot.keyClick(panel.limit, Qt.Key.Key_Return)
    line = np.transpose(panel.region.line.getData())
    line = line[np.isfinite(line[:, 0])]
    column = np.abs(far.u - line[:, :1]).argmin(axis=1)
    row = np.abs(far.v - line[:, 1:]).argmin(axis=1)
    assert np.abs(far.worst_direction[row, column] / limit - 1).max() < 0.3
    assert f"{100 * far.fraction(limit):.0f} % of the image" in panel.words.text()


def test_points_at_a_distance(
    panel: UncertaintyPanel, result: Result, jobs: Jobs, qtbot: QtBot
) -> None:
    assert panel.distance.text() == "far away"
    panel.distance.setFocus()
    panel.distance.selectAll()
    qtbot.keyClicks(panel.distance, "500")
    qtbot.keyClick(panel.distance, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: not jobs.running)
    near = estimate_projection_uncertainty(result.calibration, result.observations(), 500.0)
    np.testing.assert_array_equal(panel.plot.image.image, near.worst_direction)
    assert "500 mm away" in panel.words.text()


def test_the_value_under_the_cursor(panel: UncertaintyPanel, far: ProjectionUncertainty) -> None:
    box = panel.plot.box
    panel._hover(box.mapViewToScene(QPointF(far.u[7] + 1, far.v[12] - 1)))
    assert f"σ = {far.worst_direction[12, 7]:.3f} px" in panel.under_cursor.text()
    panel._hover(box.mapViewToScene(QPointF(-30.0, 50.0)))
    assert panel.under_cursor.text().startswith("Point at")


def test_other_colours_are_no_reason_to_compute(
    panel: UncertaintyPanel, jobs: Jobs, qapp: QApplication
) -> None:
    found, words = panel.found, panel.words.text()
    try:
        theme.apply(qapp, theme.Scheme.DARK)
        assert not jobs.running
        assert panel.found is found
        assert panel.words.text() == words
    finally:
        theme.apply(qapp, theme.Scheme.LIGHT)
