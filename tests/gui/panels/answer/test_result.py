"""The result panel's tables, matrix and words are the engine's."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.dataset.judging import judge_result
from calibgui.engine.calibration.refinement.covariances import (
    compute_correlations,
    make_paper_table,
)
from calibgui.engine.calibration.result import Undetermined
from calibgui.gui.panels.answer.result import ResultPanel
from calibgui.gui.widgets.tables import Table
from calibgui.report.summary import describe_calibration
from tests.gui.panels.conftest import Shown, made

NAMES = ["fx", "fy", "cx", "cy", "k1", "k2", "k3", "p1", "p2", "p3"]

Told = Callable[[Result], ResultPanel]


@pytest.fixture
def told(shown: Shown[ResultPanel], qtbot: QtBot) -> Told:
    """Brings a result on screen and waits for its words."""

    def show(result: Result) -> ResultPanel:
        judge_result(result)
        panel = shown(ResultPanel, result)
        qtbot.waitUntil(lambda: "being found out" not in panel.words.toPlainText())
        return panel

    return show


def rows(table: Table) -> list[list[str]]:
    return list(csv.reader(io.StringIO(table.as_csv())))[1:]


def test_intrinsics_with_their_sigma(told: Told, result: Result) -> None:
    panel = told(result)
    table = rows(panel.array_frame)
    assert [row[0] for row in table] == NAMES
    values, sigma = (np.array([float(row[i]) for row in table]) for i in (1, 2))
    np.testing.assert_array_equal(values, result.calibration.camera.params)
    np.testing.assert_array_equal(sigma, result.calibration.sigma)
    fx = panel.array_frame.model().index(0, 1).data()
    assert fx == f"{values[0]:.2f} ± {sigma[0]:.2f}"
    assert table[-1][4] == "held"


def test_the_papers_units(told: Told, result: Result) -> None:
    panel = told(result)
    table = rows(panel.paper_units)
    shown_numbers = np.array([[float(row[i]) for i in (1, 2, 4)] for row in table]).T
    np.testing.assert_array_equal(shown_numbers, make_paper_table(result.calibration))


def test_other_models_have_no_papers_units(told: Told) -> None:
    panel = told(made(model="brown-conrady"))
    assert not panel.tabs.isTabVisible(1)
    names = [row[0] for row in rows(panel.array_frame)]
    assert names[4:] == ["k1", "k2", "p1", "p2", "k3", "skew"]


def test_correlations_leave_out_what_is_held(told: Told, result: Result, qtbot: QtBot) -> None:
    panel = told(result)
    bar = panel.tabs.tabBar()
    qtbot.mouseClick(bar, Qt.MouseButton.LeftButton, pos=bar.tabRect(2).center())
    matrix = panel.correlations
    assert matrix.isVisible()
    assert matrix._names == tuple(NAMES[:-1])
    np.testing.assert_array_equal(
        matrix._values, compute_correlations(result.calibration.covariance)[:9, :9]
    )
    assert matrix.text(4, 5) == f"{matrix._values[4, 5]:.2f}"
    # k1 and k2 are strongly and negatively correlated: their cell is blue.
    corner = matrix.cell(4, 5).topLeft().toPoint() + QPoint(4, 4)
    pixel = matrix.grab().toImage().pixelColor(corner)
    assert pixel.blue() > pixel.red() + 80


def test_words_are_the_summary(told: Told, result: Result) -> None:
    panel = told(result)
    text = panel.words.toPlainText().replace("\xa0", " ")
    for sentence in describe_calibration(result):
        assert sentence.text in text


def test_the_words_of_another_result_do_not_stay(told: Told, result: Result) -> None:
    panel = told(result)
    panel.show_result(made(seed=5))
    assert panel.words.toPlainText() == "What this result is worth is being found out."


def test_what_is_not_determined_is_marked(told: Told, result: Result) -> None:
    sigma = result.calibration.sigma.copy()
    sigma[2] = np.nan
    calibration = replace(
        result.calibration, sigma=sigma, undetermined=(Undetermined("cx", "no tilt"),)
    )
    panel = told(replace(result, calibration=calibration))
    model = panel.array_frame.model()
    assert model.index(2, 4).data() == "not determined"
    assert model.index(2, 0).data(Qt.ItemDataRole.ToolTipRole) == "no tilt"
    assert "cx is not determined" in panel.words.toPlainText()
