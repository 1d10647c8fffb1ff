"""The plate's deviations as drawn are the calibration's; the file is that of the formats."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from calibgui.engine.types import Plate
from calibgui.formats.plate_json import read_plate
from calibgui.formats.result import Result
from calibgui.gui.panels.plate import PlatePanel, _round
from tests.gui.panels.conftest import Shown, made


@pytest.fixture(scope="module")
def bent() -> Result:
    """A free plate estimated from views of a bowed one."""
    return made(bow=0.6, plate="free")


@pytest.fixture(scope="module")
def plate(bent: Result) -> Plate:
    assert bent.calibration.plate is not None
    return bent.calibration.plate


def test_dots_arrows_and_key_are_the_deviations(
    shown: Shown[PlatePanel], bent: Result, plate: Plate
) -> None:
    panel = shown(PlatePanel, bent)
    np.testing.assert_array_equal(np.transpose(panel.dots.getData()), plate.nominal)
    line = np.transpose(panel.arrows.getData()).reshape(-1, 7, 2)
    start, tip = line[:, 0], line[:, 1]
    np.testing.assert_allclose(start[:-1], plate.nominal, atol=1e-9)
    key = float(panel.key.toPlainText().split()[0])
    scale = (tip - start)[-1, 0] / key
    np.testing.assert_allclose((tip - start)[:-1], scale * plate.deviation[:, :2], atol=1e-9)
    assert 0 < np.linalg.norm(tip - start, axis=1).max() <= 30.0, "no longer than a square"


def test_colours_are_symmetric_about_the_plane(
    shown: Shown[PlatePanel], bent: Result, plate: Plate
) -> None:
    panel = shown(PlatePanel, bent)
    reach = np.abs(plate.deviation[:, 2]).max()
    assert panel.bar.levels() == pytest.approx((-reach, reach))
    brushes = [spot.brush().color() for spot in panel.dots.points()]
    far, near = int(plate.deviation[:, 2].argmax()), int(plate.deviation[:, 2].argmin())
    assert brushes[far].red() > brushes[far].blue()
    assert brushes[near].red() < brushes[near].blue()


def test_words_and_the_value_under_the_cursor(
    shown: Shown[PlatePanel], bent: Result, plate: Plate
) -> None:
    panel = shown(PlatePanel, bent)
    assert f"{plate.rms:.2g} mm (rms)" in panel.words.text()
    assert f"± {np.median(plate.sigma):.2g} mm" in panel.words.text()
    box = panel.plot.getPlotItem().getViewBox()
    panel._hover(box.mapViewToScene(QPointF(*(plate.nominal[40] + [3.0, -4.0]))))
    text = panel.under_cursor.text()
    assert "({:g}, {:g}) mm".format(*plate.nominal[40]) in text
    for value in plate.deviation[40]:
        assert f"{value:+.3f}" in text
    panel._hover(box.mapViewToScene(QPointF(*(plate.nominal[0] - 25.0))))
    assert panel.under_cursor.text().startswith("Point at")


def test_without_a_plate_it_says_how_to_get_one(shown: Shown[PlatePanel], result: Result) -> None:
    panel = shown(PlatePanel, result)
    assert not panel.body.isVisible()
    assert result.calibration.plate_doubt == 0
    assert panel._empty.text().startswith("The board was taken as drawn")
    assert "Settings" in panel._empty.text()
    doubted = made(bow=0.6)
    assert doubted.calibration.plate_doubt > 0
    panel.show_result(doubted)
    assert f"off by {doubted.calibration.plate_doubt:.2g} mm" in panel._empty.text()
    panel.show_result(None)
    assert "Nothing is calibrated" in panel._empty.text()


def test_the_plate_is_saved(
    shown: Shown[PlatePanel],
    bent: Result,
    plate: Plate,
    tmp_path: Path,
    qtbot: QtBot,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    panel = shown(PlatePanel, bent)

    def answer(name: str) -> Callable[..., tuple[str, str]]:
        return lambda *_: (name, "")

    monkeypatch.setattr(QFileDialog, "getSaveFileName", answer(str(tmp_path / "mine")))
    qtbot.mouseClick(panel.save, Qt.MouseButton.LeftButton)
    np.testing.assert_array_equal(read_plate(tmp_path / "mine.json").deviation, plate.deviation)
    monkeypatch.setattr(QFileDialog, "getSaveFileName", answer(str(tmp_path / "no" / "p.json")))
    with qtbot.waitSignal(panel.failed):
        qtbot.mouseClick(panel.save, Qt.MouseButton.LeftButton)


@pytest.mark.parametrize(
    ("length", "key"), [(0.19, 0.1), (0.2, 0.2), (0.49, 0.2), (0.5, 0.5), (7.0, 5.0)]
)
def test_the_key_is_a_round_length(length: float, key: float) -> None:
    assert _round(length) == pytest.approx(key)
