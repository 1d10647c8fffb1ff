"""The deviations as drawn are those of the calibration; the file is that of the formats."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QApplication, QFileDialog
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.engine.boards.shape import BoardShape
from calibgui.formats.board_shape_json import read_board_shape
from calibgui.gui.panels.evidence.board_shape import BoardShapePanel, _round_down
from calibgui.gui.widgets import theme
from tests.gui.panels.conftest import Shown, made


@pytest.fixture(scope="module")
def bent() -> Result:
    """A free board shape estimated from views of a bowed board."""
    return made(bow=0.6, board_shape="free")


@pytest.fixture(scope="module")
def board_shape(bent: Result) -> BoardShape:
    assert bent.calibration.board_shape is not None
    return bent.calibration.board_shape


def test_dots_arrows_and_key_are_the_deviations(
    shown: Shown[BoardShapePanel], bent: Result, board_shape: BoardShape
) -> None:
    panel = shown(BoardShapePanel, bent)
    np.testing.assert_array_equal(np.transpose(panel.dots.getData()), board_shape.nominal)
    line = np.transpose(panel.arrows.getData()).reshape(-1, 7, 2)
    start, tip = line[:, 0], line[:, 1]
    np.testing.assert_allclose(start[:-1], board_shape.nominal, atol=1e-9)
    key = float(panel.key.toPlainText().split()[0])
    scale = (tip - start)[-1, 0] / key
    np.testing.assert_allclose((tip - start)[:-1], scale * board_shape.deviation[:, :2], atol=1e-9)
    assert 0 < np.linalg.norm(tip - start, axis=1).max() <= 30.0, "no longer than a square"


def test_colours_are_symmetric_about_the_plane(
    shown: Shown[BoardShapePanel], bent: Result, board_shape: BoardShape
) -> None:
    panel = shown(BoardShapePanel, bent)
    reach = np.abs(board_shape.deviation[:, 2]).max()
    assert panel.bar.levels == pytest.approx((-reach, reach))
    brushes = [spot.brush().color() for spot in panel.dots.points()]
    far, near = int(board_shape.deviation[:, 2].argmax()), int(board_shape.deviation[:, 2].argmin())
    assert brushes[far].red() > brushes[far].blue()
    assert brushes[near].red() < brushes[near].blue()


def test_arrows_show_on_pale_discs(
    shown: Shown[BoardShapePanel], bent: Result, qapp: QApplication
) -> None:
    theme.apply(qapp, theme.Scheme.DARK)
    try:
        options = shown(BoardShapePanel, bent).arrows.opts
        assert options["shadowPen"].color().name() == theme.DARK.base
        assert options["shadowPen"].widthF() >= options["pen"].widthF() + 1
    finally:
        theme.apply(qapp, theme.Scheme.LIGHT)


def test_words_and_the_value_under_the_cursor(
    shown: Shown[BoardShapePanel], bent: Result, board_shape: BoardShape
) -> None:
    panel = shown(BoardShapePanel, bent)
    assert f"{board_shape.rms:.2g} mm (rms)" in panel.words.text()
    assert f"± {np.median(board_shape.sigma):.2g} mm" in panel.words.text()
    box = panel.plot.box
    panel._hover(box.mapViewToScene(QPointF(*(board_shape.nominal[40] + [3.0, -4.0]))))
    text = panel.under_cursor.text()
    assert "({:g}, {:g}) mm".format(*board_shape.nominal[40]) in text
    for value in board_shape.deviation[40]:
        assert f"{value:+.3f}" in text
    panel._hover(box.mapViewToScene(QPointF(*(board_shape.nominal[0] - 25.0))))
    assert panel.under_cursor.text().startswith("Point at")


def test_without_a_board_shape_it_says_how_to_get_one(
    shown: Shown[BoardShapePanel], result: Result
) -> None:
    panel = shown(BoardShapePanel, result)
    assert not panel.body.isVisible()
    assert result.calibration.board_shape_error == 0
    assert panel._empty.text().startswith("The board was taken as drawn")
    assert "Set-up" in panel._empty.text()
    doubted = made(bow=0.6)
    assert doubted.calibration.board_shape_error > 0
    panel.show_result(doubted)
    assert f"off by {doubted.calibration.board_shape_error:.2g} mm" in panel._empty.text()
    panel.show_result(None)
    assert "Nothing is calibrated" in panel._empty.text()


def test_a_lens_that_is_not_followed_comes_before_the_board(
    shown: Shown[BoardShapePanel], result: Result
) -> None:
    wrong, free = made(model="pinhole"), made(model="pinhole", board_shape="free")
    panel = shown(BoardShapePanel, wrong)
    assert f"{wrong.calibration.lens_error:.2g} px (rms)" in panel._empty.text()
    assert "choose “free”" not in panel._empty.text()
    panel.show_result(free)
    assert "stands in for the lens" in panel.words.text()
    assert "deviates from its drawing" in panel.words.text()
    panel.show_result(result)
    assert "does not follow" not in panel._empty.text()


def test_the_board_shape_is_saved(
    shown: Shown[BoardShapePanel],
    bent: Result,
    board_shape: BoardShape,
    tmp_path: Path,
    qtbot: QtBot,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    panel = shown(BoardShapePanel, bent)

    def answer(name: str) -> Callable[..., tuple[str, str]]:
        return lambda *_: (name, "")

    monkeypatch.setattr(QFileDialog, "getSaveFileName", answer(str(tmp_path / "mine")))
    qtbot.mouseClick(panel.save, Qt.MouseButton.LeftButton)
    np.testing.assert_array_equal(
        read_board_shape(tmp_path / "mine.json").deviation, board_shape.deviation
    )
    monkeypatch.setattr(QFileDialog, "getSaveFileName", answer(str(tmp_path / "no" / "p.json")))
    with qtbot.waitSignal(panel.failed):
        qtbot.mouseClick(panel.save, Qt.MouseButton.LeftButton)


@pytest.mark.parametrize(
    ("length", "key"), [(0.19, 0.1), (0.2, 0.2), (0.49, 0.2), (0.5, 0.5), (7.0, 5.0)]
)
def test_the_key_is_a_round_length(length: float, key: float) -> None:
    assert _round_down(length) == pytest.approx(key)
