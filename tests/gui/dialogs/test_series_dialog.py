"""The dialog of a series: what it shows is the engine's, and what it writes is read back."""

from __future__ import annotations

import csv
import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyqtgraph as pg
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from calibgui import engine
from calibgui.app.calibrating.series import Scalar, analyse_series, parse_value
from calibgui.dataset import Result
from calibgui.formats import EXPORTERS, export, read_camera
from calibgui.gui.dialogs.series_dialog import SeriesDialog
from calibgui.gui.window.main_window import MainWindow

VALUES = {"a": 10.0, "b": 20.0, "c": 30.0, "d": 40.0}


@pytest.fixture(scope="module")
def folder(result: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Results whose focal length grows by a thousandth with every 10 degrees, and their table."""
    folder = tmp_path_factory.mktemp("series")
    export(result, "result", folder / "a.json")
    content = json.loads((folder / "a.json").read_text())
    focal = [content["camera"]["params"][name] for name in ("fx", "fy")]
    for name, value in VALUES.items():
        for key, f in zip(("fx", "fy"), focal, strict=True):
            content["camera"]["params"][key] = f * (1 + 1e-4 * value)
        (folder / f"{name}.json").write_text(json.dumps(content))
    rows = "".join(f"{name}.json,{value}\n" for name, value in VALUES.items())
    (folder / "values.csv").write_text(f"file,value\n{rows}")
    return folder


@pytest.fixture
def dialog(window: MainWindow, folder: Path, qtbot: QtBot) -> SeriesDialog:
    dialog = SeriesDialog(window.session.jobs, window)
    qtbot.addWidget(dialog)
    dialog.show()
    paths = [folder / f"{name}.json" for name in VALUES]
    dialog.show_results(paths, Scalar.TEMPERATURE, folder / "values.csv")
    qtbot.waitUntil(lambda: dialog.analysed is not None, timeout=30_000)
    return dialog


def test_the_table_answers_whether_the_camera_has_changed(
    dialog: SeriesDialog, folder: Path
) -> None:
    paths = [folder / f"{name}.json" for name in VALUES]
    expected = analyse_series(paths, Scalar.TEMPERATURE, folder / "values.csv")
    lines = [line.split(",") for line in dialog.results.as_csv().splitlines()]
    assert lines[0][0] == "File" and len(lines) == 5
    for line, drift in zip(lines[2:], expected.drifts, strict=True):
        assert float(line[2]) == pytest.approx(drift.difference.rms)
        assert float(line[3]) == pytest.approx(drift.expected)
        assert line[5] == ("yes" if drift.has_changed else "no")
    assert "straight line describes the camera" in dialog.words.text()


def test_each_parameter_is_drawn_with_its_band(dialog: SeriesDialog) -> None:
    assert dialog.analysed is not None
    series = dialog.analysed.series
    for row in range(dialog.parameter.count()):
        dialog.parameter.setCurrentIndex(row)
        k = dialog.parameter.currentData()
        items = dialog.plot.box.addedItems
        (points,) = [i for i in items if isinstance(i, pg.PlotDataItem) and i.opts["symbol"]]
        x, y = points.getData()
        assert np.allclose(x, list(VALUES.values()))
        assert np.allclose(y, [one.known.camera.params[k] for one in series.settings])
        lower, upper = (i.getData()[1] for i in items[:2])
        sigma = np.sqrt(series.predict(10.0).covariance[k, k])
        assert upper[0] - lower[0] == pytest.approx(2 * sigma)
        (band,) = [i for i in items if isinstance(i, pg.FillBetweenItem)]
        drawn = band.path().boundingRect()
        assert (drawn.left(), drawn.right()) == pytest.approx((10.0, 40.0))
        assert (drawn.top(), drawn.bottom()) == pytest.approx((lower.min(), upper.max()))
        unit = " [px]" if k < 4 else ""
        assert dialog.plot.area.left.labelText.endswith(unit)
        assert dialog.plot.area.bottom.labelText == "temperature [°C]"


@pytest.mark.parametrize(
    ("scalar", "middle"),
    [(Scalar.TEMPERATURE, "25 °C"), (Scalar.ZOOM, "25 mm"), (Scalar.FOCUS, "25")],
)
def test_the_camera_in_the_middle_is_shown_at_first(
    dialog: SeriesDialog, qtbot: QtBot, scalar: Scalar, middle: str
) -> None:
    dialog.scalar.setCurrentIndex(dialog.scalar.findData(scalar))
    qtbot.waitUntil(lambda: dialog.analysed is not None, timeout=30_000)
    assert dialog.analysed is not None
    assert (dialog.at.text(), dialog.said.text()) == (middle, "")
    assert dialog.export.isEnabled()
    known = dialog.analysed.series.predict(25.0)
    assert repr(float(known.camera.params[0]))[:8] in dialog.camera.as_csv()
    dialog.at.setText("warm")
    assert dialog.said.text() == f"warm is no value of {scalar}." and not dialog.export.isEnabled()


def test_the_camera_at_a_value_is_shown_and_written(
    dialog: SeriesDialog, tmp_path: Path, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    dialog.at.clear()
    assert not dialog.export.isEnabled(), "no profile by temperature"
    qtbot.keyClicks(dialog.at, "22.5")
    assert dialog.analysed is not None
    known = dialog.analysed.series.predict(22.5)
    assert repr(float(known.camera.params[0]))[:8] in dialog.camera.as_csv()
    dialog.format.setCurrentIndex(dialog.format.findData("opencv"))
    file = tmp_path / "camera.yaml"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(file), ""))
    qtbot.mouseClick(dialog.export, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: "Saved as camera.yaml" in dialog.said.text(), timeout=30_000)
    assert read_camera(file).camera.focal[0] == pytest.approx(known.camera.focal[0], rel=1e-3)
    dialog.at.setText("50")
    assert "outside of the series" in dialog.said.text() and not dialog.export.isEnabled()


def test_a_zoom_lens_is_written_as_a_profile(
    dialog: SeriesDialog, tmp_path: Path, qtbot: QtBot
) -> None:
    dialog.scalar.setCurrentIndex(dialog.scalar.findData(Scalar.ZOOM))
    qtbot.waitUntil(lambda: dialog.analysed is not None, timeout=30_000)
    dialog.at.clear()
    offered = {dialog.format.itemData(k) for k in range(dialog.format.count())}
    assert offered == {name for name, one in EXPORTERS.items() if one.write_zoom}
    dialog.write(EXPORTERS["gyroflow"], tmp_path / "profile.json")
    qtbot.waitUntil(lambda: "Saved as profile.json" in dialog.said.text(), timeout=30_000)
    profile = json.loads((tmp_path / "profile.json").read_text())
    assert list(profile["interpolations"]) == ["10", "20", "30", "40"]


def test_dates_are_written_below_the_plot_and_fit_into_their_field(
    dialog: SeriesDialog, tmp_path: Path, folder: Path, qtbot: QtBot
) -> None:
    rows = "".join(f"{folder / name}.json,2026-0{k}-01\n" for k, name in enumerate(VALUES, 1))
    (tmp_path / "dates.csv").write_text(f"file,value\n{rows}")
    paths = [folder / f"{name}.json" for name in VALUES]
    dialog.show_results(paths, Scalar.DATE, tmp_path / "dates.csv")
    qtbot.waitUntil(lambda: dialog.analysed is not None, timeout=30_000)
    axis = dialog.plot.area.bottom
    middle = dialog.at.text()
    assert axis.tickStrings([parse_value(middle, Scalar.DATE)], 1.0, 1.0) == [middle[:10]]
    wide = dialog.at.fontMetrics().horizontalAdvance(middle)
    assert dialog.at.cursorRect().width() + wide < dialog.at.width()
    dialog.scalar.setCurrentIndex(dialog.scalar.findData(Scalar.ZOOM))
    dialog.show_results(paths, Scalar.ZOOM, folder / "values.csv")
    qtbot.waitUntil(lambda: dialog.analysed is not None, timeout=30_000)
    assert axis.tickStrings([20.0], 1.0, 1.0) == ["20"]


def test_what_cannot_be_read_is_explained(window: MainWindow, folder: Path, qtbot: QtBot) -> None:
    dialog = SeriesDialog(window.session.jobs, window)
    qtbot.addWidget(dialog)
    assert not dialog.export.isEnabled() and "three or more" in dialog.words.text()
    dialog.show_results([folder / "a.json"], Scalar.FOCUS, None)
    qtbot.waitUntil(lambda: "do not state the focus" in dialog.words.text(), timeout=30_000)
    assert dialog.analysed is None


def test_a_result_that_is_not_determined_is_listed_and_left_out(
    window: MainWindow, result: Result, folder: Path, tmp_path: Path, qtbot: QtBot
) -> None:
    with pytest.raises(engine.calibration.DegenerateError) as caught:
        engine.calibrate(result.observations()[:1], result.calibration.camera.size)
    partial = caught.value.partial
    assert partial is not None
    for name in VALUES:
        (tmp_path / name).mkdir()
        shutil.copy(folder / f"{name}.json", tmp_path / name / "result.json")
    one_view = replace(result, calibration=partial, views=result.views[:1])
    export(one_view, "result", tmp_path / "b" / "result.json")
    rows = "".join(f"{name}/result.json,{value}\n" for name, value in VALUES.items())
    (tmp_path / "values.csv").write_text(f"file,value\n{rows}")
    dialog = SeriesDialog(window.session.jobs, window)
    qtbot.addWidget(dialog)
    paths = [tmp_path / name / "result.json" for name in VALUES]
    dialog.show_results(paths, Scalar.TEMPERATURE, tmp_path / "values.csv")
    qtbot.waitUntil(lambda: dialog.analysed is not None, timeout=30_000)
    assert "b/result.json is left out" in dialog.words.text()
    assert caught.value.message in dialog.words.text()
    lines = list(csv.reader(dialog.results.as_csv().splitlines()))
    assert [line[0] for line in lines[1:]] == [f"{name}/result.json" for name in "acdb"]
    assert lines[4][-2:] == ["left out", caught.value.message]
    assert lines[1][-2:] == ["yes", ""]
    (points,) = [
        item
        for item in dialog.plot.box.addedItems
        if isinstance(item, pg.PlotDataItem) and item.opts["symbol"]
    ]
    assert points.getData()[0].tolist() == [10.0, 30.0, 40.0]


def test_the_command_opens_it(window: MainWindow) -> None:
    menu = window.menuBar().actions()[3].menu()
    next(action for action in menu.actions() if "eries" in action.text()).trigger()
    (dialog,) = window.findChildren(SeriesDialog)
    assert dialog.isVisible()
    dialog.reject()
