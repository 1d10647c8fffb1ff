"""Methods are compared by a button, shown with their maps, and one is calibrated with."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui import engine
from calibgui.app.projects.document import Document
from calibgui.dataset import Result
from calibgui.engine.assessment.choices import method_comparison
from calibgui.engine.assessment.choices.method_comparison import AS_PRINTED, MethodComparison
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.methods import BOUGUET
from calibgui.engine.calibration.result import Cost
from calibgui.engine.errors import CalibrationError, Progress
from calibgui.engine.numbers import format_two_digits
from calibgui.formats import EXPORTERS
from calibgui.gui.dialogs.export_dialog import ExportDialog
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.method.methods import MethodsPanel
from calibgui.gui.panels.mode_page import PANEL_WIDTH
from calibgui.gui.widgets.tables import Table
from calibgui.gui.window.main_window import MainWindow
from calibgui.report.methods import describe_method_comparison, list_method_rows
from tests.app import examples
from tests.gui.panels.conftest import Shown, click_row, made, place, read_table

LEFT = Qt.MouseButton.LeftButton
FEW = ("lucchese", AS_PRINTED, "bouguet", "stein")
REFUSAL = "The views are all parallel to the sensor."


@pytest.fixture(scope="module")
def few_views() -> Result:
    return made(count=5)


@pytest.fixture(scope="module", autouse=True)
def _few_methods() -> Iterator[None]:
    """Compare few methods, which is quick; one of them refuses all views."""
    listed = method_comparison.list_compared_methods()

    def refuse(*_: object) -> None:
        raise CalibrationError(REFUSAL, "Tilt the board.")

    refusing = replace(BOUGUET, name="tsai", label="Tsai", title="Tsai", initialise=refuse)
    few = {name: listed[name] for name in FEW} | {"tsai": (refusing, {"method": refusing})}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(method_comparison, "list_compared_methods", lambda: few)
        patch.setattr("calibgui.gui.panels.method.methods.compare_methods_again", compare_few)
        yield


def compare_few(
    result: Result, progress: Progress | None = None, check: Callable[[], None] | None = None
) -> MethodComparison:
    camera = result.calibration.camera
    views = result.observations()
    return method_comparison.compare_methods(
        views, camera.size, camera, 2, progress=progress, check=check
    )


@pytest.fixture(scope="module")
def comparison(few_views: Result, _few_methods: None) -> MethodComparison:
    return compare_few(few_views)


@pytest.fixture
def panel(
    shown: Shown[MethodsPanel], few_views: Result, comparison: MethodComparison
) -> MethodsPanel:
    """The panel with a comparison."""
    panel = shown(MethodsPanel, few_views)
    panel._asked = few_views
    panel._done(comparison)
    QApplication.processEvents()
    return panel


def test_a_comparison_that_is_ended_keeps_the_methods_that_are_done(
    shown: Shown[MethodsPanel],
    few_views: Result,
    jobs: Jobs,
    qtbot: QtBot,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def compare(result: Result, progress: Progress, check: Callable[[], None]) -> MethodComparison:
        def wait(done: int, total: int) -> None:
            progress(done, total)
            while done == 2 and not jobs.running[0].stopping:
                time.sleep(0.01)

        return compare_few(result, wait, check)

    monkeypatch.setattr("calibgui.gui.panels.method.methods.compare_methods_again", compare)
    panel = shown(MethodsPanel, few_views)
    panel.run.click()
    qtbot.waitUntil(lambda: jobs.running[0].finished == 2, timeout=20_000)
    jobs.end(jobs.running[0])
    qtbot.waitUntil(lambda: not jobs.running)
    assert panel.found is not None and list(panel.found.trials) == list(FEW)[:2]
    assert panel.tables.isVisible() and panel.run.isEnabled()
    remarks = {row.name: row.remarks for row in panel._rows}
    assert "stopped before it was tried" in " ".join(remarks["tsai"])


def pick(qtbot: QtBot, panel: MethodsPanel, name: str) -> None:
    """Click on a method, in the table that is in front."""
    table = panel.tables.currentWidget()
    assert isinstance(table, Table)
    click_row(qtbot, table, [row.name for row in panel._rows].index(name))


def tip(table: Table, row: int, title: str) -> str:
    """The tooltip of a cell by its column's title."""
    columns = [column.title for column in table._model.columns]
    index = table.model().index(row, columns.index(title))
    return str(index.data(Qt.ItemDataRole.ToolTipRole))


def test_what_belongs_to_a_method_is_behind_a_tab_in_a_narrow_panel(panel: MethodsPanel) -> None:
    panel.resize(PANEL_WIDTH, 480)  # a card of the least width
    QApplication.processEvents()
    tabs = panel.tables
    assert [tabs.tabText(k) for k in range(tabs.count())] == ["Errors", "Camera", "Map", "About"]
    table = tabs.errors
    fourth = table.visualRect(table.model().index(3, 0))
    assert table.viewport().rect().contains(fourth)
    tabs.setCurrentWidget(panel.map)
    QApplication.processEvents()
    assert panel.map.isVisible() and panel.map.height() > 200 and not panel.about.isVisible()
    panel.resize(1100, 500)
    QApplication.processEvents()
    assert tabs.count() == 2
    assert panel.map.isVisible() and panel.about.isVisible() and table.isVisible()
    assert panel.map.width() >= table.width() and panel.map.height() > panel.about.height()
    panel.resize(480, 800)
    QApplication.processEvents()
    assert tabs.count() == 2 and panel.map.isVisible() and panel.about.isVisible()
    assert panel.map.mapTo(panel, QPoint()).y() > table.mapTo(panel, table.rect().bottomLeft()).y()
    panel.resize(PANEL_WIDTH, 480)
    QApplication.processEvents()
    assert tabs.count() == 4 and not panel.map.isVisible() and table.isVisible()


def test_the_button_compares_and_the_tables_hold_the_figures(
    shown: Shown[MethodsPanel], few_views: Result, comparison: MethodComparison, qtbot: QtBot
) -> None:
    panel = shown(MethodsPanel, few_views)
    assert panel.words.text().startswith("This result is by the method “Lucchese")
    assert not panel.compared.isVisible() and not panel.use.isVisible()
    qtbot.mouseClick(panel.run, LEFT)
    assert not panel.run.isEnabled()
    qtbot.waitUntil(lambda: panel.found is not None, timeout=60_000)
    assert panel.compared.isVisible() and panel.run.isEnabled()
    corners = sum(len(view.uv) for view in few_views.observations())
    count, _, words = panel.words.text().partition(" views. ")
    assert f"of {corners:,} corners in {len(few_views.used)}" in count
    assert words == describe_method_comparison(comparison, by_label=True)
    names = ("RMS", "σ", "Unseen", "Differs", "in RMS")
    errors, cameras = read_table(panel.tables.errors), read_table(panel.tables.camera)
    for row, error, camera in zip(list_method_rows(comparison), errors, cameras, strict=True):
        assert error["Method"] == camera["Method"] == row.name
        figures = [float(error[f"{name} [px]"]) for name in names]
        expected = (row.rms, row.sigma, row.unseen, row.difference_worst, row.difference_rms)
        np.testing.assert_allclose(figures, expected, equal_nan=True, atol=1e-9)
        nothing = (math.nan, math.nan)
        for name in ("fx", "fy", "cx", "cy", "skew"):
            pair = [float(camera[f"{title} [px]"]) for title in (name, f"σ of {name}")]
            np.testing.assert_allclose(pair, row.values.get(name, nothing), equal_nan=True)
        shift = [float(camera[f"{title} [px]"]) for title in ("Shift", "σ of Shift")]
        np.testing.assert_allclose(shift, row.shift or nothing, equal_nan=True)


def test_what_is_not_estimated_is_a_dash_that_says_why(panel: MethodsPanel) -> None:
    table, names = panel.tables.camera, [row.name for row in panel._rows]
    columns = [column.title for column in table._model.columns]
    for name, title in (("bouguet", "skew"), ("stein", "fx"), ("tsai", "cx")):
        row = names.index(name)
        assert table.model().index(row, columns.index(title)).data() == "–"
        reason = REFUSAL if name == "tsai" else panel._rows[row].limits
        assert reason in tip(table, row, title)
    assert "±" in tip(table, names.index("bouguet"), "fx")
    straight = tip(panel.tables.errors, names.index("stein"), "RMS")
    assert "straight rows and columns" in straight
    assert panel.tables.errors.model().index(names.index("stein"), 0).data() == "Stein *"


def test_methods_have_plain_names_with_the_options_name_in_the_tooltip(panel: MethodsPanel) -> None:
    for table in (panel.tables.errors, panel.tables.camera):
        for k, row in enumerate(panel._rows):
            assert table.model().index(k, 0).data().removesuffix(" *") == row.label
            assert row.kind == "refused" or f"({row.name})" in tip(table, k, "Method")
    words = panel.words.text()
    assert "Lucchese" in words and "lucchese" not in words and AS_PRINTED not in words
    assert "bouguet" not in words


def test_the_selected_methods_map_and_words_are_shown(
    panel: MethodsPanel, comparison: MethodComparison, qtbot: QtBot
) -> None:
    panel.tables.setCurrentWidget(panel.tables.camera)
    pick(qtbot, panel, "bouguet")
    found = comparison.trials["bouguet"].difference
    assert found is not None
    np.testing.assert_array_equal(panel.map.plot.image.image, found.length)
    assert panel.map.plot.image.levels[1] == pytest.approx(found.worst)
    assert panel.map.under_cursor.text().startswith(f"At most {format_two_digits(found.worst)} px")
    u, v = found.u[10], found.v[8]
    where = panel.map.plot.mapToScene(place(panel.map.plot, u, v))
    panel.map.plot.scene().sigMouseMoved.emit(where)
    assert panel.map.under_cursor.text().endswith(f": {found.length[8, 10]:.3f} px")
    about = panel.about.toPlainText()
    row = next(row for row in panel._rows if row.name == "bouguet")
    for text in (row.title, row.limits, row.source, row.coefficients, *row.remarks):
        assert text in about
    assert panel.tables.errors.currentIndex().row() == panel.tables.camera.currentIndex().row()

    pick(qtbot, panel, "stein")
    np.testing.assert_array_equal(panel.map.plot.image.image, comparison.lines["stein"].length)
    pick(qtbot, panel, "tsai")
    assert panel.map.reason.isVisible() and REFUSAL in panel.map.reason.text()
    panel._refresh_now()
    assert panel.map.reason.isVisible(), "a new look keeps the selection"


def test_only_methods_that_give_a_camera_can_be_used(panel: MethodsPanel, qtbot: QtBot) -> None:
    wanted: list[tuple[str, Cost]] = []
    panel.method_wanted.connect(lambda *which: wanted.append(which))
    for name, reason in (("stein", "knows no lengths"), ("tsai", REFUSAL)):
        pick(qtbot, panel, name)
        assert not panel.use.isEnabled()
        assert reason in panel.use.toolTip()
    for name in ("bouguet", AS_PRINTED):
        pick(qtbot, panel, name)
        assert panel.use.isEnabled() and "calibrate" in panel.use.toolTip()
        qtbot.mouseClick(panel.use, LEFT)
    assert wanted == [("bouguet", Cost.IMAGE), ("lucchese", Cost.PAPER)]


def test_a_comparison_holds_for_the_views_that_it_is_of(
    panel: MethodsPanel, few_views: Result, comparison: MethodComparison, other: Result
) -> None:
    panel.show_result(
        replace(few_views, calibration=replace(few_views.calibration, cost=Cost.PAPER))
    )
    assert panel.found is comparison
    assert "shown when they were found" in panel.words.text()
    panel.show_result(few_views)
    assert "shown when they were found" not in panel.words.text()
    panel.show_result(other)
    assert panel.found is None
    assert panel.words.text().startswith("This result is by")


def test_a_partial_result_is_not_compared(shown: Shown[MethodsPanel], few_views: Result) -> None:
    with pytest.raises(engine.calibration.DegenerateError) as caught:
        engine.calibrate(few_views.observations()[:1], few_views.calibration.camera.size)
    partial = caught.value.partial
    assert partial is not None
    one = replace(few_views, calibration=partial, views=few_views.views[:1])
    panel = shown(MethodsPanel, one)
    assert "cannot be compared" in panel._empty.text()


def test_using_a_method_calibrates_with_it_and_is_undone_and_written(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    session = window.session
    session.begin(Document(examples.calibrated(tmp_path)))
    settings = replace(
        session.project.settings, board_shape=BoardShapeModel.AFFINE, weigh_views=True
    )
    session.edit("Settings", lambda p: replace(p, settings=settings))
    former = session.result
    panel = window.need_analysis().show_panel(MethodsPanel)
    qtbot.mouseClick(panel.run, LEFT)
    qtbot.waitUntil(lambda: panel.found is not None, timeout=60_000)
    assert panel.found is not None
    compared = panel.found.trials["bouguet"].calibration.camera
    pick(qtbot, panel, "bouguet")
    qtbot.mouseClick(panel.use, LEFT)
    now = session.project.settings
    assert (now.method, now.model) == ("bouguet", "brown-conrady-4")
    assert (now.fixed, now.board_shape) == ({}, BoardShapeModel.NOMINAL)
    assert not now.weigh_views
    qtbot.waitUntil(lambda: len(session.project.results) == 3, timeout=60_000)
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)
    result = session.result
    assert result is not None
    assert result.calibration.settings.method == "bouguet"
    np.testing.assert_allclose(result.calibration.camera.params, compared.params, rtol=1e-6)
    assert panel.found is not None, "it is on the same views"

    dialog = ExportDialog(session.jobs, result, window)
    for name, expected in (
        ("result", '"method": "bouguet"'),
        ("opencv", "distortion_coefficients"),
    ):
        dialog.formats.setCurrentRow(list(EXPORTERS).index(name))
        qtbot.waitUntil(lambda: not session.jobs.running)
        EXPORTERS[name].write(result, tmp_path / "camera")
        assert expected in (tmp_path / "camera").read_text()
        assert expected in dialog.text.toPlainText() or name == "result"
    dialog.done(0)

    session.document.undo()
    assert session.result is former
    session.document.undo()
    assert session.project.settings is settings
    session.document.redo()
    session.document.redo()
    assert session.result is result
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)
