"""Several boards of a rig: stated in the window, found, written, opened and taken back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractSpinBox, QComboBox, QFileDialog
from pytestqt.qtbot import QtBot

from calibgui.app.rig.boards import StatedBoard
from calibgui.engine.boards import BoardShapeModel, Charuco
from calibgui.formats.rig_json import read_rig
from calibgui.gui.rig.rig_page import RigPage
from calibgui.gui.window.main_window import MainWindow
from tests.engine.rig.drawn_boards import FIRST, PLACE, POSE, write_photographs

LEFT_BUTTON = Qt.MouseButton.LeftButton


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("boards")
    write_photographs(folder)
    return folder


@pytest.fixture
def page(window: MainWindow, qtbot: QtBot, folder: Path) -> RigPage:
    window.own_pages.show_rig([str(folder)])
    page = window.own_pages.rig
    assert page is not None
    qtbot.waitUntil(lambda: page.pairing is not None and not page.is_running)
    return page


def choose(combo: QComboBox, wanted: object) -> None:
    """Step to an entry with the keyboard, as a user does."""
    combo.setFocus()
    combo.setCurrentIndex(0)
    for _ in range(combo.count()):
        if combo.currentData() == wanted:
            return
        QTest.keyClick(combo, Qt.Key.Key_Down)
    assert combo.currentData() == wanted


def enter(box: QAbstractSpinBox, text: str) -> None:
    box.setFocus()
    box.selectAll()
    QTest.keyClicks(box, f"{text}\r")


def state_first_board(page: RigPage, qtbot: QtBot) -> None:
    boards = page.form.boards
    qtbot.mouseClick(boards.recognised, LEFT_BUTTON)
    choose(boards.pattern.kind, "charuco")
    choose(boards.pattern.dictionary, "DICT_4X4_50")
    enter(boards.rows, "4")
    enter(boards.cols, "5")
    enter(boards.square, "28")


def read_stated(page: RigPage) -> tuple[StatedBoard, ...]:
    assert page.pane.setup is not None
    return page.pane.setup.boards


def test_boards_are_stated_found_written_and_opened(
    page: RigPage,
    window: MainWindow,
    qtbot: QtBot,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """left and right never see one board together: two boards join them."""
    boards = page.form.boards
    assert not boards.list.isVisible() and not boards.remove.isVisible()
    state_first_board(page, qtbot)
    qtbot.mouseClick(boards.add, LEFT_BUTTON)
    assert boards.list.count() == 2 and boards.list.currentRow() == 1
    assert boards.pattern.first_label.text() == "First marker"
    assert boards.pattern.first_tag.value() == 15, "the first board has 0 to 14"
    assert not boards.recognised.isVisible()
    stated = read_stated(page)
    assert [board.pattern for board in stated] == [
        Charuco("DICT_4X4_50"),
        Charuco("DICT_4X4_50", first_marker=15),
    ]
    assert [(board.grid_size, board.square) for board in stated] == [((4, 5), 28.0)] * 2
    qtbot.mouseClick(page.calibrate, LEFT_BUTTON)
    qtbot.waitUntil(lambda: not page.is_running, timeout=120_000)
    result = page.result
    assert result is not None, page.form.words.text()
    found, sigma = result.rig.placed_boards[1].pose, result.rig.board_sigma(1)
    away = np.r_[found.rvec - PLACE.rvec, found.tvec - PLACE.tvec]
    assert (np.abs(away) < 4 * sigma).all()
    assert result.rig.poses[1].tvec == pytest.approx(POSE.tvec, abs=3)
    table = page.answer.boards.model()
    shown = [table.index(0, column).data() for column in range(3)]
    assert page.answer.boards.isVisible()
    assert shown[0] == "2"
    distance, plus = (float(part) for part in shown[1].split(" ± "))
    assert abs(distance - np.linalg.norm(PLACE.tvec)) < 4 * plus
    assert 0 < plus < 1
    assert all(page.matrix.item(row, 0).text().endswith(" px") for row in range(6))
    file = tmp_path / "rig.json"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(file), ""))
    page.export.menu().actions()[0].trigger()
    assert [board.pattern.first_marker for board in read_rig(file).boards] == [0, 15]
    page.result = None
    window.own_pages.show_rig([str(file)])
    qtbot.waitUntil(lambda: page.result is not None)
    qtbot.mouseClick(page.set_up, LEFT_BUTTON)
    assert boards.isVisible()
    opened = read_stated(page)
    assert [board.grid_size for board in opened] == [FIRST.grid_size] * 2
    assert [board.square for board in opened] == [28.0] * 2
    assert [board.pattern.first_marker for board in opened if board.pattern] == [0, 15]
    assert [board.pose for board in opened] == [None, None], "it was estimated"
    qtbot.mouseClick(page.set_up, LEFT_BUTTON)
    assert page.answer.isVisible() and page.result is not None


def test_a_place_is_stated_and_taken_back(page: RigPage, qtbot: QtBot) -> None:
    boards = page.form.boards
    state_first_board(page, qtbot)
    assert not boards.is_placed.isVisible(), "all places are beside the first"
    qtbot.mouseClick(boards.add, LEFT_BUTTON)
    assert not boards.place[0].isVisible()
    qtbot.mouseClick(boards.is_placed, LEFT_BUTTON)
    for box, value in zip(boards.place, (160, 8, -15, 2.5, 20, 5), strict=True):
        enter(box, str(value))
    pose = read_stated(page)[1].pose
    assert pose is not None
    assert pose.tvec.tolist() == [160, 8, -15]
    assert np.degrees(pose.rvec) == pytest.approx([2.5, 20, 5])
    choose(page.form.shape, BoardShapeModel.AFFINE)
    assert page.pane.setup is not None and page.pane.setup.shape is BoardShapeModel.AFFINE
    qtbot.mouseClick(page.form.robust, LEFT_BUTTON)
    assert page.pane.setup.robust
    for _ in range(2):  # robust, shape
        qtbot.mouseClick(page.pane.undo, LEFT_BUTTON)
    assert not page.form.robust.isChecked()
    assert page.form.shape.currentData() == BoardShapeModel.NOMINAL
    for _ in range(6):
        qtbot.mouseClick(page.pane.undo, LEFT_BUTTON)
    assert boards.is_placed.isChecked() and boards.place[0].value() == 0
    qtbot.mouseClick(page.pane.undo, LEFT_BUTTON)
    assert not boards.is_placed.isChecked() and read_stated(page)[1].pose is None
    boards.list.setFocus()
    QTest.keyClick(boards.list, Qt.Key.Key_Up)
    assert boards.list.currentRow() == 0 and not boards.is_placed.isVisible()
    qtbot.mouseClick(boards.remove, LEFT_BUTTON)
    [left] = read_stated(page)
    assert left.pattern == Charuco("DICT_4X4_50", first_marker=15)
    assert not boards.list.isVisible()
    while page.pane.undo.isEnabled():
        qtbot.mouseClick(page.pane.undo, LEFT_BUTTON)
    assert read_stated(page) == (StatedBoard(),)
    assert boards.recognised.isChecked()


def test_boards_that_are_not_stated_in_full_are_refused(page: RigPage, qtbot: QtBot) -> None:
    boards = page.form.boards
    qtbot.mouseClick(boards.add, LEFT_BUTTON)
    qtbot.mouseClick(page.calibrate, LEFT_BUTTON)
    qtbot.waitUntil(lambda: not page.is_running)
    assert "The kind or the size of board 1 is not stated" in page.form.words.text()
    assert boards.isVisible()
