"""The page of a rig: paired, corrected by hand, calibrated, looked at, written and opened again."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QColor, QDropEvent
from PySide6.QtWidgets import QApplication, QFileDialog
from pytestqt.qtbot import QtBot

from calibgui.engine.boards import Board
from calibgui.engine.camera import Camera
from calibgui.engine.geometry import Pose, rotation_from_vector, vector_from_rotation
from calibgui.engine.images import render_view, write_image
from calibgui.formats.rig_json import read_rig
from calibgui.gui.rig.rig_page import RigPage
from calibgui.gui.widgets import questions, theme
from calibgui.gui.widgets.questions import Answer
from calibgui.gui.window.main_window import MainWindow

LEFT_BUTTON = Qt.MouseButton.LeftButton
BOARD = Board(5, 6, 30.0)
CAMERAS = {
    "left": Camera((320, 240), [300, 300, 160, 120, -0.1, 0.02, 0, 0, 0], "brown-conrady"),
    "right": Camera((320, 240), [306, 306, 158, 122, -0.1, 0.02, 0, 0, 0], "brown-conrady"),
}
RIGHT = Pose([0.01, -0.08, 0.02], [-60.0, 2.0, 4.0])
INSTANTS = 8


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folders left and right with a photograph for each instant."""
    folder = tmp_path_factory.mktemp("rig")
    R, middle = rotation_from_vector(RIGHT.rvec), BOARD.points().mean(axis=0)
    for k in range(INSTANTS):
        tilt = 0.45 * np.array([np.cos(2.4 * k), np.sin(2.4 * k), 0.1])
        turn = rotation_from_vector(tilt)
        at = np.array([30.0 + 20 * np.cos(k), 15 * np.sin(2 * k), 430.0 + 12 * k])
        board = Pose(tilt, at - turn[:, :2] @ middle)
        there = Pose(vector_from_rotation(R @ turn), R @ board.tvec + RIGHT.tvec)
        for name, pose in (("left", board), ("right", there)):
            (folder / name).mkdir(exist_ok=True)
            image = render_view(CAMERAS[name], pose, BOARD, blur=0.7, noise=2.0, seed=k)
            write_image(folder / name / f"{k + 1}.png", image)
    return folder


@pytest.fixture
def page(window: MainWindow, qtbot: QtBot, drawn: Path) -> RigPage:
    window.own_pages.show_rig([str(drawn / "left"), str(drawn / "right")])
    page = window.own_pages.rig
    assert page is not None
    qtbot.waitUntil(lambda: page.pairing is not None and not page.is_running)
    return page


@pytest.fixture
def calibrate(page: RigPage, qtbot: QtBot) -> Callable[[], None]:
    def press() -> None:
        qtbot.mouseClick(page.calibrate, LEFT_BUTTON)
        qtbot.waitUntil(lambda: not page.is_running, timeout=60_000)

    return press


def test_a_rig_is_calibrated_written_and_opened(
    page: RigPage,
    calibrate: Callable[[], None],
    window: MainWindow,
    qtbot: QtBot,
    qapp: QApplication,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert page.matrix.rowCount() == INSTANTS
    assert "8 instants of several cameras" in page.form.words.text()
    page.form.boards.square.setValue(30.0)
    calibrate()
    assert page.result is not None
    assert page.result.rig.poses[1].tvec == pytest.approx(RIGHT.tvec, abs=0.5)
    headline = page.answer.headline
    assert headline.text() == "The cameras agree"
    theme.apply(qapp, theme.Scheme.DARK)
    try:
        assert headline.palette().windowText().color() == QColor(theme.DARK.good)
    finally:
        theme.apply(qapp, theme.Scheme.LIGHT)
    assert page.matrix.item(0, 0).text().endswith(" px")
    file = tmp_path / "rig.json"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(file), ""))
    page.export.menu().actions()[0].trigger()
    assert read_rig(file).rig.names == ("left", "right")
    stereo = tmp_path / "stereo.yaml"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(stereo), ""))
    page.export.menu().actions()[1].trigger()
    assert cv2.FileStorage(str(stereo), cv2.FILE_STORAGE_READ).getNode("T").mat() is not None
    page.result = None
    drop(window, file)
    qtbot.waitUntil(lambda: page.result is not None)
    assert page.matrix.item(0, 1).text().endswith(" px")
    qtbot.mouseClick(page.leave, LEFT_BUTTON)
    assert window.pages.currentWidget() is window.welcome


def drop(window: MainWindow, *paths: Path) -> None:
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path)) for path in paths])
    event = QDropEvent(
        QPointF(window.rect().center()),
        Qt.DropAction.CopyAction,
        data,
        LEFT_BUTTON,
        Qt.KeyboardModifier.NoModifier,
    )
    window.dropEvent(event)


def test_rows_of_a_rectified_pair_belong_together(
    page: RigPage, calibrate: Callable[[], None], qtbot: QtBot
) -> None:
    calibrate()
    page.matrix.setCurrentCell(2, 1)
    page.tabs.setCurrentWidget(page.rectified)
    qtbot.waitUntil(lambda: page.rectified.accessibleDescription() == "left, right")
    first, second = page.rectified.place_images()
    at = first.center().toPoint()
    qtbot.mouseMove(page.rectified, QPoint(at.x(), at.y()))
    picture = page.rectified.grab().toImage()
    ratio = picture.devicePixelRatio()
    for place in (first, second):  # one line, at one height, across both
        colour = picture.pixelColor(round(ratio * (place.left() + 20)), round(ratio * at.y()))
        assert colour.red() > 200
        assert colour.blue() < 100
    assert "if squares are 30 mm" in page.answer.condition.text()
    page.scene.picked.emit(4)
    assert page.matrix.currentRow() == 4


def test_a_wrong_pairing_is_corrected_by_hand(
    page: RigPage, calibrate: Callable[[], None], qtbot: QtBot
) -> None:
    assert page.pairing is not None
    before = page.pairing
    header = page.matrix.horizontalHeader()
    at = QPoint(header.sectionViewportPosition(1) + 20, header.height() // 2)
    qtbot.mouseClick(header.viewport(), LEFT_BUTTON, pos=at)
    qtbot.mouseClick(page.pane.later, LEFT_BUTTON)
    assert [page.pairing.cameras[1].files.get(k) for k in page.pairing.instants] == [
        None,
        *before.cameras[1].files.values(),
    ]
    assert page.matrix.rowCount() == INSTANTS + 1
    calibrate()
    assert page.result is not None
    assert "instant earlier: nothing above holds" in page.answer.words.text()
    qtbot.mouseClick(page.pane.earlier, LEFT_BUTTON)
    assert page.result is None
    assert page.pairing.cameras[1].files == before.cameras[1].files
    page.matrix.choose({0: [1]})
    qtbot.mouseClick(page.pane.leave_out, LEFT_BUTTON)
    assert 1 not in page.pairing.cameras[0].files
    calibrate()
    assert page.answer.headline.text() == "The cameras agree"
    for _ in range(3):
        qtbot.mouseClick(page.pane.undo, LEFT_BUTTON)
    assert page.pairing == before
    assert not page.pane.undo.isEnabled()


def test_folders_that_are_dropped_may_be_of_several_cameras(
    window: MainWindow, drawn: Path, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(questions, "ask", lambda *_: Answer.Yes)
    drop(window, drawn / "left", drawn / "right")
    page = window.own_pages.rig
    assert page is not None
    qtbot.waitUntil(lambda: page.pairing is not None)
    assert window.pages.currentWidget() is page


def test_one_folder_that_mixes_cameras_is_dropped(
    window: MainWindow, drawn: Path, tmp_path: Path, qtbot: QtBot
) -> None:
    """Names single the cameras out: nothing is asked. Other ways to add it tell so."""
    for c, side in enumerate(("left", "right")):
        for k in range(INSTANTS):
            stamp = 1403636579763555584 + (500 * k + 4 * c) * 10**6
            shutil.copy(drawn / side / f"{k + 1}.png", tmp_path / f"image_{c}_{stamp}.png")
    drop(window, tmp_path)
    page = window.own_pages.rig
    assert page is not None
    qtbot.waitUntil(lambda: page.pairing is not None and not page.is_running)
    assert page.pairing is not None
    assert [camera.name for camera in page.pairing.cameras] == ["image0", "image1"]
    assert page.matrix.rowCount() == INSTANTS
    qtbot.mouseClick(page.leave, LEFT_BUTTON)
    with qtbot.waitSignal(window.session.notified) as told:
        window.files.open_paths([str(tmp_path)])
    assert "several cameras: image0 (8), image1 (8)" in told.args[0]
    drop(window, drawn / "left")
    assert window.pages.currentWidget() is not page


def test_videos_that_are_dropped_are_cameras(
    window: MainWindow, drawn: Path, tmp_path: Path, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    for side in ("left", "right"):
        writer = cv2.VideoWriter(
            str(tmp_path / f"{side}.avi"), cv2.VideoWriter.fourcc(*"MJPG"), 10, (320, 240), False
        )
        for k in range(INSTANTS):
            writer.write(cv2.imread(str(drawn / side / f"{k + 1}.png"), cv2.IMREAD_GRAYSCALE))
        writer.release()
    monkeypatch.setattr(questions, "ask", lambda *_: Answer.Yes)
    drop(window, tmp_path / "left.avi", tmp_path / "right.avi")
    page = window.own_pages.rig
    assert page is not None
    qtbot.waitUntil(lambda: page.pairing is not None and not page.is_running)
    assert page.pairing is not None
    assert [camera.name for camera in page.pairing.cameras] == ["left", "right"]
    assert page.matrix.rowCount() == INSTANTS
    assert page.form.offsets.isVisible()
    assert page.form.every.isVisible() and not page.form.within.isVisible()
    page.form.every.setFocus()
    qtbot.keyClick(page.form.every, Qt.Key.Key_Up)
    qtbot.waitUntil(lambda: page.matrix.rowCount() == INSTANTS // 2)
    assert page.pairing.cameras[0].times[page.pairing.cameras[0].files[2]] == 0.2


def test_photographs_are_paired_by_time(
    window: MainWindow, drawn: Path, tmp_path: Path, qtbot: QtBot
) -> None:
    for side, lag in (("left", 0), ("right", 30)):
        (tmp_path / side).mkdir()
        for k in range(4):
            late = lag + (60 if lag and k == 2 else 0)
            name = f"{1403636579763555584 + (500 * k + late) * 10**6}.png"
            shutil.copy(drawn / side / f"{k + 1}.png", tmp_path / side / name)
    window.own_pages.show_rig([str(tmp_path)])
    page = window.own_pages.rig
    assert page is not None
    qtbot.waitUntil(lambda: page.pairing is not None and not page.is_running)
    assert page.pairing is not None
    assert "times, which are at most 90 ms apart: 4 instants" in page.form.words.text()
    within = page.form.within
    within.setFocus()
    within.selectAll()
    qtbot.keyClicks(within, "50")
    qtbot.keyClick(within, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: "30 ms apart: 3 instants" in page.form.words.text())
    assert page.matrix.rowCount() == 5
    qtbot.waitUntil(lambda: not page.is_running)
    qtbot.mouseClick(page.pane.undo, LEFT_BUTTON)
    assert page.matrix.rowCount() == 4


def test_what_tells_no_cameras_is_refused(
    window: MainWindow, drawn: Path, tmp_path: Path, qtbot: QtBot
) -> None:
    for k in range(3):
        shutil.copy(drawn / "left" / f"{k + 1}.png", tmp_path / f"{k}.png")
    window.own_pages.show_rig([str(tmp_path)])
    page = window.own_pages.rig
    assert page is not None
    qtbot.waitUntil(lambda: "tell no two cameras" in page.form.words.text())
    assert not page.calibrate.isVisible()
