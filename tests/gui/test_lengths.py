"""No length is said without its condition until the side of a square is confirmed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QTableView, QTextBrowser, QWidget
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import Settings
from calibgui.app.projects.document import Document
from calibgui.app.projects.project import Project, record_result
from calibgui.dataset import CornerSet
from calibgui.engine.boards import BoardShapeModel
from calibgui.gui.panels.analysis import PANELS
from calibgui.gui.panels.answer.uncertainty import UncertaintyPanel
from calibgui.gui.panels.evidence.board_shape import BoardShapePanel
from calibgui.gui.panels.evidence.poses import PosesPanel
from calibgui.gui.panels.panel import Panel
from calibgui.gui.widgets.plots import Plot
from calibgui.gui.window.main_window import MainWindow
from calibgui.report.tables import tabulate_views
from tests.app import examples

LENGTH = re.compile(r"(?<!if squares are 30 )\bmm\b(?!²)")
CONDITION = "if squares are 30 mm"


@pytest.fixture
def bowed(tmp_path: Path) -> Project:
    """A project with a result whose board was found to be bowed, lengths unconfirmed."""
    project = replace(
        examples.calibrated(tmp_path),
        settings=Settings(board_shape=BoardShapeModel.BOW),
        results=MappingProxyType({}),
        lengths_confirmed=False,
    )
    assert project.size is not None
    corner_set = CornerSet(project.size, project.views, project.board)
    result = calibrate_views(corner_set, project.settings)
    return record_result(project, "Calibration 1", project.views, result)


def list_texts(widget: QWidget) -> Iterator[str]:
    """The texts that a panel shows: sentences, headings of tables and titles of plots."""
    for label in widget.findChildren(QLabel):
        yield label.text()
    for browser in widget.findChildren(QTextBrowser):
        yield browser.toPlainText()
    for table in widget.findChildren(QTableView):
        model = table.model()
        for column in range(model.columnCount()):
            yield str(model.headerData(column, Qt.Orientation.Horizontal))
    for plot in widget.findChildren(Plot):
        yield from (axis.labelText for axis in plot.area.axes.values())
        yield plot.area.title.text
        if plot.colour_bar is not None:
            yield plot.colour_bar._quantity


def show(window: MainWindow, kind: type[Panel], qtbot: QtBot) -> Panel:
    panel = window.need_analysis().show_panel(kind)
    qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=60_000)
    return panel


def test_every_panel_states_the_condition_until_it_is_confirmed(
    window: MainWindow, qtbot: QtBot, bowed: Project
) -> None:
    window.session.begin(Document(bowed))
    uncertainty = window.need_analysis().panel(UncertaintyPanel)
    uncertainty.distance.setValue(500)
    lengths: dict[type[Panel], list[str]] = {}
    for kind in PANELS:
        panel = show(window, kind, qtbot)
        lengths[kind] = [text for text in list_texts(panel) if LENGTH.search(text)]
        unsaid = [text for text in lengths[kind] if CONDITION not in text]
        # Of a board's shape whole sentences come first, with the condition behind them.
        assert not unsaid, f"{kind.__name__}: {unsaid}"
    said = {kind.__name__ for kind, texts in lengths.items() if texts}
    assert said >= {"UncertaintyPanel", "PosesPanel", "CoveragePanel", "BoardShapePanel"}
    poses = window.need_analysis().panel(PosesPanel)
    assert poses.space._condition == f"Lengths hold {CONDITION}."
    qtbot.mouseClick(window.verdict.square.confirm, Qt.MouseButton.LeftButton)
    for kind in (UncertaintyPanel, PosesPanel, BoardShapePanel):
        panel = show(window, kind, qtbot)
        texts = list(list_texts(panel))
        assert any(LENGTH.search(text) for text in texts)
        assert not any(CONDITION in text for text in texts), kind.__name__


def test_a_corner_of_the_board_is_read_with_the_condition(
    window: MainWindow, qtbot: QtBot, bowed: Project
) -> None:
    window.session.begin(Document(bowed))
    panel = show(window, BoardShapePanel, qtbot)
    assert isinstance(panel, BoardShapePanel)
    box = panel.plot.box
    panel._hover(box.mapViewToScene(box.viewRect().center()))
    assert panel.under_cursor.text().endswith(f"mm {CONDITION}")


def test_the_table_of_views_states_it(bowed: Project) -> None:
    result = bowed.results["Calibration 1"]
    confirmed = replace(result, lengths_confirmed=True)
    assert f"distances {CONDITION}" in tabulate_views(result)
    assert CONDITION not in tabulate_views(confirmed)
