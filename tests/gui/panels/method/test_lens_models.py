"""The comparison is run by its button, shown in two tables, and what is chosen is calibrated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.engine.assessment.choices.lens_choice import LensChoice, choose_lens
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import Progress
from calibgui.gui.panels.method.lens_models import LensModelsPanel
from calibgui.gui.window.main_window import MainWindow
from calibgui.report.lens_choice import describe_lens_choice, list_lens_rows
from calibgui.report.lens_models import get_lens_title
from tests.gui.panels.conftest import Shown, click_row, made, read_table

LEFT = Qt.MouseButton.LeftButton
FEW = ("pinhole", "brown-conrady-4", "lucchese")


@pytest.fixture(scope="module")
def few_views() -> Result:
    return made(count=4)


@pytest.fixture(scope="module")
def choice(few_views: Result) -> LensChoice:
    return compare_few(few_views)


def compare_few(result: Result, progress: Progress | None = None) -> LensChoice:
    """Compare few lens models, which is quick."""
    views, size = result.observations(), result.calibration.camera.size
    return choose_lens(views, size, FEW, progress=progress)


@pytest.fixture(autouse=True)
def _few_lenses(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("calibgui.gui.panels.method.lens_models.compare_lenses_again", compare_few)


def test_the_button_compares_and_the_tables_hold_the_figures(
    shown: Shown[LensModelsPanel], few_views: Result, choice: LensChoice, qtbot: QtBot
) -> None:
    panel = shown(LensModelsPanel, few_views)
    assert panel.words.text().startswith("This result is of the lens model Lucchese")
    assert not panel.tables.isVisible() and not panel.use.isVisible()
    qtbot.mouseClick(panel.run, LEFT)
    assert not panel.run.isEnabled()
    qtbot.waitUntil(lambda: panel.found is not None, timeout=60_000)
    assert panel.tables.isVisible() and "ompare" in panel.run.text()
    assert panel.words.text() == describe_lens_choice(choice)
    rows = list_lens_rows(choice)
    for row, errors, image in zip(
        rows, read_table(panel.tables.errors), read_table(panel.tables.image), strict=True
    ):
        assert errors["n"] == str(row.parameters)
        names = ("RMS", "σx", "σy", "Unseen", "95 %")
        figures = [float(errors[f"{name} [px]"]) for name in names]
        expected = (row.rms, row.sigma_x, row.sigma_y, row.unseen_rms, row.unseen_p95)
        np.testing.assert_allclose(figures, expected, equal_nan=True)
        assert errors["Remarks"] == "; ".join(row.remarks)
        field = [float(image[name]) for name in ("Horizontal", "Vertical", "Diagonal")]
        np.testing.assert_allclose(field, row.field_of_view)
        assert float(image["Differs [px]"]) == pytest.approx(row.difference)
    recommended = next(row for row in rows if row.model == choice.model)
    title = get_lens_title(choice.model)
    assert panel.remarks.text().startswith(f"{title}: RMS {recommended.rms:.3f} px")
    assert "of 432 corners" in panel.remarks.text()


def test_the_selected_model_is_described_and_can_be_used(
    shown: Shown[LensModelsPanel], few_views: Result, choice: LensChoice, qtbot: QtBot
) -> None:
    panel = shown(LensModelsPanel, few_views)
    panel._asked = few_views
    panel._done(choice)
    QApplication.processEvents()
    models = [row.model for row in list_lens_rows(choice)]
    held = {row.model: row.held for row in list_lens_rows(choice)}
    wanted: list[tuple[str, tuple[str, ...]]] = []
    panel.lens_wanted.connect(lambda *which: wanted.append(which))
    for table, model in (
        (panel.tables.errors, "pinhole"),
        (panel.tables.image, "brown-conrady-4"),
    ):
        panel.tables.setCurrentWidget(table)
        click_row(qtbot, table, models.index(model))
        assert panel.remarks.text().startswith(f"{get_lens_title(model)}: RMS")
        qtbot.mouseClick(panel.use, LEFT)
    assert wanted == [(model, held[model]) for model in ("pinhole", "brown-conrady-4")]
    for table in (panel.tables.errors, panel.tables.image):
        assert table.currentIndex().row() == models.index("brown-conrady-4")
    panel._refresh_now()
    kept = get_lens_title("brown-conrady-4")
    assert panel.remarks.text().startswith(kept), "a new look keeps the selection"


def test_a_comparison_holds_for_the_views_that_it_is_of(
    shown: Shown[LensModelsPanel], few_views: Result, choice: LensChoice, other: Result
) -> None:
    panel = shown(LensModelsPanel, few_views)
    panel._asked = few_views
    panel._done(choice)
    calibration = few_views.calibration
    camera = Camera(calibration.camera.size, calibration.camera.params)
    panel.show_result(replace(few_views, calibration=replace(calibration, camera=camera)))
    assert panel.found is choice
    panel.show_result(other)
    assert panel.found is None
    assert panel.words.text().startswith("This result is of")
    panel.show_result(few_views)
    assert panel.found is None, "it would have to be made again"


def test_too_few_views_are_told(shown: Shown[LensModelsPanel], qtbot: QtBot) -> None:
    panel = shown(LensModelsPanel, made(count=2))
    qtbot.mouseClick(panel.run, LEFT)
    qtbot.waitUntil(lambda: "too few to compare lens models" in panel.words.text(), timeout=60_000)


def test_using_a_model_sets_it_and_calibrates(full: MainWindow, qtbot: QtBot) -> None:
    session = full.session
    panel = full.need_analysis().show_panel(LensModelsPanel)
    qtbot.mouseClick(panel.run, LEFT)
    qtbot.waitUntil(lambda: panel.found is not None, timeout=60_000)
    trial = panel.found.trials["brown-conrady-4"]
    held = replace(trial, fixed={"k2": 0.0})  # as if the views left it open
    panel._done(replace(panel.found, trials={**panel.found.trials, held.model: held}))
    models = [row.model for row in list_lens_rows(panel.found)]
    click_row(qtbot, panel.tables.errors, models.index("brown-conrady-4"))
    qtbot.mouseClick(panel.use, LEFT)
    assert session.project.settings.model == "brown-conrady-4"
    qtbot.waitUntil(lambda: len(session.project.results) == 3, timeout=60_000)
    assert session.result is not None
    assert session.result.calibration.camera.model == "brown-conrady-4"
    assert session.result.calibration.fixed == ("k2", "skew")
    assert session.project.settings.fixed == {"k2": None}, "what was held of the old lens is not"
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)
    session.document.undo()
    session.document.undo()
    assert session.project.settings.model == "lucchese"
