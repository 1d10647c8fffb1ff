"""Table 1 and figures 4 and 5 show the engine's numbers, and are linked."""

from __future__ import annotations

import csv
import io
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.engine.calibration.initialisation.single_view_pose import evaluate_cosines_equation
from calibgui.gui.panels.method.stage_one import StageOnePanel
from calibgui.gui.panels.mode_page import PANEL_WIDTH
from tests.gui.panels.conftest import Shown, click


def test_table_holds_stage_one(shown: Shown[StageOnePanel], result: Result) -> None:
    panel = shown(StageOnePanel, result)
    rows = list(csv.reader(io.StringIO(panel.table.as_csv())))
    units = {"px": ("xp", "yp", "fx", "fy"), "1/px²": ("k1",), "px′": ("RMS", "σ")}
    unit_of = {name: f" [{unit}]" for unit, names in units.items() for name in names}
    names = ["View", "xp", "yp", "k1", "fy/fx", "fx", "fy", "Steps", "RMS", "σ", "Corners"]
    assert rows[0] == [name + unit_of.get(name, "") for name in names]
    for row, view, name, seen in zip(
        rows[1:],
        result.calibration.stage_one,
        [v.image for v in result.used],
        result.observations(),
        strict=True,
    ):
        corners = len(seen.uv)
        assert view.rms * np.sqrt(corners / (2 * corners - 11)) == pytest.approx(float(row[-2]))
        values = [
            view.xp,
            view.yp,
            view.k1,
            view.aspect,
            view.fx,
            view.fy,
            view.iterations,
            view.rms,
            float(row[-2]),
            corners,
        ]
        assert row[0] == name
        np.testing.assert_array_equal([float(text) for text in row[1:]], values)


def test_a_row_picks_its_view(shown: Shown[StageOnePanel], result: Result, qtbot: QtBot) -> None:
    panel = shown(StageOnePanel, result)
    cell = panel.table.visualRect(panel.table.model().index(3, 0))
    with qtbot.waitSignal(panel.picked) as signal:
        qtbot.mouseClick(panel.table.viewport(), Qt.MouseButton.LeftButton, pos=cell.center())
    assert signal.args == [4, -1]  # the second image of the result is not used


def test_a_point_picks_its_view(shown: Shown[StageOnePanel], result: Result, qtbot: QtBot) -> None:
    panel = shown(StageOnePanel, result)
    aspect = result.calibration.stage_one[5].aspect
    with qtbot.waitSignal(panel.picked) as signal:
        click(qtbot, panel.aspects, 6, aspect)
    assert signal.args == [6, -1]


def test_selection_shows_its_equation(shown: Shown[StageOnePanel], result: Result) -> None:
    panel = shown(StageOnePanel, result)
    panel.select(4)
    view = result.calibration.stage_one[3]
    r, g = panel._curve.getData()
    np.testing.assert_array_equal(g, evaluate_cosines_equation(view.backward, r))
    np.testing.assert_array_equal(panel._root.getData(), [[view.aspect], [0.0]])
    _, aspects = panel._line.getData()
    np.testing.assert_array_equal(aspects, [s.aspect for s in result.calibration.stage_one])


def test_an_outlying_view_is_marked(shown: Shown[StageOnePanel], result: Result) -> None:
    rows = list(result.calibration.stage_one)
    rows[2] = replace(rows[2], rms=40.0)
    rows[4] = replace(rows[4], converged=False)
    rows[6] = replace(rows[6], aspect=np.nan, fx=np.nan, fy=np.nan)
    calibration = replace(result.calibration, stage_one=tuple(rows))
    panel = shown(StageOnePanel, replace(result, calibration=calibration))
    tips = [panel.table.model().index(k, 8).data(Qt.ItemDataRole.ToolTipRole) for k in range(9)]
    assert "Far from the other views: " in tips[2] and "rms" in tips[2]
    assert "no convergence" in tips[4]
    panel.select(7)
    assert "not determined" in panel.equation.area.title.text


def test_empty_state_says_what_to_do(shown: Shown[StageOnePanel], result: Result) -> None:
    panel = shown(StageOnePanel, None)
    assert "Calibrate" in panel._empty.text() and panel._empty.isVisible()
    panel.show_result(result)
    assert panel.table.isVisible()


def test_the_whole_table_is_seen_in_the_least_width(
    shown: Shown[StageOnePanel], result: Result
) -> None:
    panel = shown(StageOnePanel, result)
    panel.resize(396, 600)  # what a window of 1280 px leaves
    assert panel.table.horizontalHeader().length() <= panel.table.viewport().width()
    texts = [panel.table.model().index(3, column).data() for column in range(9)]
    view = result.calibration.stage_one[3]
    heading, _, unit = panel.table.model().headerData(3, Qt.Orientation.Horizontal).partition("\n")
    assert unit == "[1/px²]"
    power = int(heading[-1:].translate(_PLAIN))
    assert float(texts[3]) * 10.0**-power == pytest.approx(view.k1, abs=0.005 * 10.0**-power)
    assert texts[0] == "view4"


_PLAIN = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")


def test_a_long_name_does_not_widen_the_plot(shown: Shown[StageOnePanel], result: Result) -> None:
    views = tuple(replace(view, image=80 * "n" + view.image) for view in result.views)
    panel = shown(StageOnePanel, replace(result, views=views))
    panel.resize(PANEL_WIDTH, 600)
    for k in range(len(result.used)):
        panel._select(k, -1)
        QApplication.processEvents()
        plot = panel.equation
        assert plot.area.minimumWidth() <= plot.area.size().width()
        assert plot.area.size().width() <= plot.width()


def test_why_a_plot_is_empty_is_told_without_numbers(
    shown: Shown[StageOnePanel], result: Result
) -> None:
    first = result.calibration.stage_one[0]
    rows = [replace(first, aspect=np.nan, backward=np.full((3, 3), np.nan))]
    one = replace(result, calibration=replace(result.calibration, stage_one=tuple(rows)))
    panel = shown(StageOnePanel, one)
    panel.select(0)
    assert "not determined" in panel.equation.area.title.text
    assert "No view determines" in panel.aspects.area.title.text

    def count_numbers() -> list[int]:
        return [
            sum(len(values) for _, values in axis.tickValues(0.0, 1.0, 300))
            if axis._tickLevels is None
            else len(axis._tickLevels)
            for plot in (panel.equation, panel.aspects)
            for axis in plot.area.axes.values()
        ]

    assert count_numbers() == [0, 0, 0, 0]
    panel.show_result(result)
    panel.select(0)
    assert min(count_numbers()) > 0
    assert panel.aspects.area.title.maximumHeight() == 0
