"""The table of a fleet: outliers first, reasons on the row, and cameras that open as projects."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QLocale, Qt
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from calibgui.app.projects.project_file import read_project, write_project
from calibgui.dataset import Result
from calibgui.dataset.fleet import Estimate, FleetCamera, FleetEntry, FleetFigures, FleetStatus
from calibgui.engine.assessment import Grade, PixelError
from calibgui.engine.images import write_image
from calibgui.formats import export
from calibgui.formats.fleet_ledger import open_ledger
from calibgui.formats.result_json import read_result
from calibgui.gui.dialogs import fleet_dialog
from calibgui.gui.dialogs.fleet_dialog import FleetDialog
from calibgui.gui.widgets import theme
from calibgui.gui.window.main_window import MainWindow

FOREGROUND = Qt.ItemDataRole.ForegroundRole
NAMES = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "skew")


def make_camera(k: int, rng: np.random.Generator) -> FleetCamera:
    """A camera of an ordinary fleet; number 4 is odd."""
    k1 = rng.normal(-0.2 + 0.1 * (k == 4), 0.002)
    values = [*rng.normal([650, 650, 320, 240], 1), k1, 0.05, 0, 0, 0, 0]
    estimates = [Estimate(float(v), 0.01) for v in values]
    figures = FleetFigures(
        size=(640, 480),
        board="checkerboard 6x7, 30 mm",
        lens_model="brown-conrady",
        views=10,
        corners=400,
        rms=0.05 + 0.01 * k,
        noise=0.05,
        coverage=0.8,
        grade=Grade.GOOD,
        reason="Nothing is wrong.",
        times_better=1.0,
        error=PixelError(0.01, 0.02, 0.05, 0.02, 0.015, 0.02),
        parameters=dict(zip(NAMES, estimates, strict=True)),
    )
    entry = FleetEntry(f"camera {k}", f"S{k}", "2026-05-01")
    return FleetCamera(entry, FleetStatus.DONE, figures=figures, result=f"results/{k}.json")


@pytest.fixture(scope="module")
def ledger(result: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("fleet")
    (folder / "results").mkdir()
    export(result, "result", folder / "results" / "4.json")
    rng = np.random.default_rng(1)
    lost = "The board was found in none of the images."
    refused = FleetCamera(FleetEntry("lost"), FleetStatus.REFUSED, lost, failures=(lost,))
    with open_ledger(folder / "fleet.db", create=True) as opened:
        opened.write([*(make_camera(k, rng) for k in range(20)), refused])
    return folder / "fleet.db"


@pytest.fixture
def dialog(
    window: MainWindow, ledger: Path, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> FleetDialog:
    """The dialog as the menu opens it."""
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(ledger), ""))
    menu = window.menuBar().actions()[0].menu()
    next(action for action in menu.actions() if "leet" in action.text()).trigger()
    qtbot.waitUntil(lambda: bool(window.findChildren(FleetDialog)), timeout=30_000)
    (dialog,) = window.findChildren(FleetDialog)
    return dialog


def test_the_odd_camera_is_first_and_then_what_fails(dialog: FleetDialog) -> None:
    lines = [line.split(",") for line in dialog.table.as_csv().splitlines()]
    assert [line[0] for line in lines[1:3]] == ["camera 4", "lost"]
    assert len(lines) == 22
    assert "21 cameras. Failing: 1. Unlike the others" in dialog.words.text()
    rms = {line[0]: line[5] for line in lines[1:]}
    assert float(rms["camera 7"]) == pytest.approx(0.12)
    dialog.table.picked.emit(1)
    assert dialog.reason.text() == "The board was found in none of the images."
    assert not dialog.open_camera.isEnabled(), "there is nothing to open"
    dialog.reject()


def test_a_camera_opens_as_a_project(
    dialog: FleetDialog, window: MainWindow, result: Result, qtbot: QtBot
) -> None:
    assert "unlike the others" in dialog.reason.text()
    qtbot.mouseClick(dialog.open_camera, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(window.session.project.results), timeout=30_000)
    assert list(window.session.project.results) == ["camera 4"]
    opened = window.session.project.results["camera 4"]
    assert np.array_equal(opened.calibration.camera.params, result.calibration.camera.params)
    assert window.session.project.is_current(opened)
    assert all(Path(view.image).is_absolute() for view in window.session.project.views)


def test_calibrating_what_was_opened_gives_the_same_camera(
    dialog: FleetDialog, window: MainWindow, qtbot: QtBot
) -> None:
    qtbot.mouseClick(dialog.open_camera, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(window.session.project.results), timeout=30_000)
    qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=30_000)
    qtbot.mouseClick(window.calibrate, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: len(window.session.project.results) == 2, timeout=60_000)
    before, again = (r.calibration for r in window.session.project.results.values())
    assert again.camera.model == before.camera.model and again.fixed == before.fixed
    np.testing.assert_allclose(again.camera.params, before.camera.params, rtol=1e-6)
    assert all(map(window.session.project.is_current, window.session.project.results.values()))
    qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=60_000)


def test_a_camera_whose_photographs_are_at_addresses_opens_and_is_saved(
    window: MainWindow, result: Result, tmp_path: Path, qtbot: QtBot
) -> None:
    address = "http://127.0.0.1:9/shots"
    views = tuple(
        replace(view, image=f"{address}/{Path(view.image).name}") for view in result.views
    )
    export(replace(result, views=views), "result", tmp_path / "far.json")
    assert window.files.open_result(tmp_path / "far.json", "far")
    qtbot.waitUntil(lambda: "are at addresses" in window.banner.text.text(), timeout=30_000)
    assert views[0].image in window.banner.text.text()
    write_project(window.session.project, tmp_path / "project.json")
    saved = read_project(tmp_path / "project.json")
    assert [view.image for view in saved.views] == [view.image for view in views]
    assert saved.is_current(saved.results["far"])


def shown(dialog: FleetDialog) -> list[str]:
    return [line.split(",")[0] for line in dialog.table.as_csv().splitlines()[1:]]


def test_what_fails_is_in_another_colour_and_can_be_shown_alone(dialog: FleetDialog) -> None:
    model, column = dialog.table.model(), 3
    inks = {
        model.index(row, column).data(): model.index(row, column).data(FOREGROUND).color().name()
        for row in range(model.rowCount())
    }
    assert inks == {"pass": theme.LIGHT.good, "fail": theme.LIGHT.bad}
    dialog.kind.setCurrentIndex(1)
    assert shown(dialog) == ["lost"]
    dialog.kind.setCurrentIndex(2)
    assert shown(dialog) == ["camera 4"]
    dialog.kind.setCurrentIndex(0)
    dialog.filter.setText("s1")
    assert sorted(shown(dialog)) == ["camera 1", *(f"camera 1{k}" for k in range(10))]
    dialog.filter.setText("found in none")
    assert shown(dialog) == ["lost"], "a reason is found, too"
    dialog.reject()


def test_dates_are_in_the_systems_language(dialog: FleetDialog) -> None:
    before = QLocale()
    QLocale.setDefault(QLocale("de_DE"))
    try:
        assert fleet_dialog._format_date("2026-05-01") == "01.05.26"
        assert fleet_dialog._format_date("in May") == "in May"
    finally:
        QLocale.setDefault(before)
        dialog.reject()


def test_a_camera_is_known_by_its_first_photograph(
    dialog: FleetDialog, ledger: Path, qtbot: QtBot
) -> None:
    image = ledger.parent / "results" / read_result(ledger.parent / "results/4.json").used[0].image
    write_image(image, np.full((240, 320), 200, np.uint8))
    dialog._pick(0)
    qtbot.waitUntil(lambda: not dialog.picture.pixmap().isNull())
    assert dialog.picture.pixmap().toImage().pixelColor(20, 20).red() == 200
    dialog._pick(1)
    assert dialog.picture.pixmap().isNull(), "it has none"
    dialog.reject()
