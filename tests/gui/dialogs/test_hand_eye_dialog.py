"""The dialog of hand and eye: what it shows is the engine's, and what it writes is read back."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.hand_eye import find_hand_eye
from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.geometry import rotation_from_vector
from calibgui.engine.hand_eye.motions import Motions
from calibgui.formats.robot_poses import read_robot_poses
from calibgui.gui.dialogs.hand_eye_dialog import HandEyeDialog
from calibgui.gui.window.main_window import MainWindow
from calibgui.report.hand_eye import describe_tool
from tests.engine.hand_eye.arms import W, X

LEFT = Qt.MouseButton.LeftButton
Open = Callable[..., HandEyeDialog]


def write_poses(result: Result, file: Path, wrong: int | None = None) -> Path:
    """Write the matrices of a robot that takes the photographs, by their names; one 15 mm off."""
    poses = result.calibration.poses
    rvecs, tvecs = ([getattr(p, name) for p in poses] for name in ("rvec", "tvec"))
    boards = Motions(rotation_from_vector(np.array(rvecs)), np.array(tvecs))
    hands = W.after(boards.invert()).after(X.invert())
    rows: Array = np.concatenate([hands.R, hands.t[..., None]], axis=2).reshape(-1, 12)
    if wrong is not None:
        rows[wrong, 3] += 15.0
    with file.open("w", newline="") as text:
        csv.writer(text).writerows(
            [view.name, *row] for view, row in zip(result.used, rows.tolist(), strict=True)
        )
    return file


def list_lines(dialog: HandEyeDialog) -> list[list[str]]:
    return list(csv.reader(dialog.errors.as_csv().splitlines()))[1:]


@pytest.fixture
def start(
    window: MainWindow, result: Result, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> Open:
    """Open the dialog and choose a file of poses by its button."""

    def start(file: Path, result: Result = result) -> HandEyeDialog:
        dialog = HandEyeDialog(window.session.jobs, result, window)
        qtbot.addWidget(dialog)
        dialog.show()
        monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(file), ""))
        qtbot.mouseClick(dialog.choose, LEFT)
        qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=30_000)
        return dialog

    return start


def test_hand_and_eye_are_shown_and_saved(
    start: Open, result: Result, tmp_path: Path, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    poses = write_poses(result, tmp_path / "robot.csv")
    dialog = start(poses)
    expected = find_hand_eye(result, read_robot_poses(poses)).found
    said = dialog.headline.text()
    assert describe_tool(expected)[1:] in said and "(k = 2); robot " in said
    assert "matrices row by row, millimetres, base from hand" in dialog.words.text()
    place = list(csv.reader(dialog.poses.as_csv().splitlines()))
    assert place[0][1].startswith("Camera in the hand")
    np.testing.assert_allclose([float(row[1]) for row in place[1:4]], X.t, atol=1.0)
    np.testing.assert_allclose([float(row[2]) for row in place[1:4]], expected.sigma[3:])
    assert [line[0] for line in list_lines(dialog)] == [view.name for view in result.used]
    file = tmp_path / "found.json"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(file), ""))
    qtbot.mouseClick(dialog.save, LEFT)
    qtbot.waitUntil(lambda: dialog.said.text() == "Saved as found.json.", timeout=30_000)
    matrix = json.loads(file.read_text())["hand_from_camera"]["matrix"]
    np.testing.assert_allclose(np.array(matrix)[:3, 3], expected.camera_pose.tvec)
    dialog.write(tmp_path / "found.txt")
    qtbot.waitUntil(lambda: "Give it the suffix .json" in dialog.said.text(), timeout=30_000)


def test_where_the_camera_and_the_tool_are_is_stated(
    start: Open, result: Result, tmp_path: Path, qtbot: QtBot
) -> None:
    poses = write_poses(result, tmp_path / "robot.csv")
    dialog = start(poses)
    at_board = dialog.headline.text()
    qtbot.keyClicks(dialog.tool, "0, 0, 1500")
    qtbot.keyClick(dialog.tool, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: dialog.found is not None, timeout=30_000)
    point = np.array([0.0, 0.0, 1500.0])
    expected = find_hand_eye(result, read_robot_poses(poses), tool=point).found
    assert describe_tool(expected)[1:] in dialog.headline.text()
    assert describe_tool(expected)[1:] not in at_board
    dialog.tool.clear()
    qtbot.keyClicks(dialog.tool, "0, 0")
    qtbot.keyClick(dialog.tool, Qt.Key.Key_Return)
    assert dialog.words.text() == "0, 0 is no point X, Y, Z, such as 0, 0, 120."
    assert not dialog.save.isEnabled()
    qtbot.keyClick(dialog.mount, Qt.Key.Key_Down)
    assert "0, 0 is no point" in dialog.words.text()
    qtbot.keyClick(dialog.mount, Qt.Key.Key_Up)
    dialog.tool.clear()
    qtbot.keyClick(dialog.tool, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: dialog.headline.text() == at_board, timeout=30_000)
    qtbot.keyClick(dialog.mount, Qt.Key.Key_End)
    qtbot.waitUntil(lambda: "hand from base" in dialog.words.text(), timeout=30_000)
    assert "Camera in the base" in dialog.poses.as_csv()


def test_a_pose_that_does_not_fit_is_named_and_left_out(
    start: Open, result: Result, tmp_path: Path, qtbot: QtBot
) -> None:
    dialog = start(write_poses(result, tmp_path / "robot.csv", wrong=3))
    name = result.used[3].name
    assert f"does not fit in {name}" in dialog.words.text()
    assert "Leave it out below." in dialog.words.text() and "--" not in dialog.words.text()
    assert not dialog.leave_out.isEnabled()

    def pick(row: int) -> None:
        cell = dialog.errors.visualRect(dialog.errors.model().index(row, 0)).center()
        qtbot.mouseClick(dialog.errors.viewport(), LEFT, pos=cell)

    pick(3)
    qtbot.mouseClick(dialog.leave_out, LEFT)
    qtbot.waitUntil(lambda: dialog.found is not None, timeout=30_000)
    assert "does not fit" not in dialog.words.text()
    assert list_lines(dialog)[3] == [name, "nan", "nan", "left out"]
    for row in (0, 1, 2, 4, 5, 6):
        pick(row)
        qtbot.mouseClick(dialog.leave_out, LEFT)
        qtbot.waitUntil(lambda: "working" not in dialog.words.text(), timeout=30_000)
    assert "need at least" in dialog.words.text() and len(list_lines(dialog)) == 7
    pick(5)
    assert "gain" in dialog.leave_out.text()
    qtbot.mouseClick(dialog.leave_out, LEFT)
    qtbot.waitUntil(lambda: dialog.found is not None, timeout=30_000)
    assert [line[3] for line in list_lines(dialog)].count("yes") == 3


def test_what_cannot_be_done_is_explained(start: Open, result: Result, tmp_path: Path) -> None:
    few = tmp_path / "few.csv"
    few.write_text("1,2,3,4,5,6\n2,3,4,5,6,7\n")
    dialog = start(few)
    assert "few.csv has 2 poses, and there are 10 photographs. Give" in dialog.words.text()
    assert dialog.found is None and not dialog.save.isEnabled()
    dialog = start(few, replace(result, lengths_confirmed=False))
    assert "answer in the window how long the squares are" in dialog.words.text()
    assert not dialog.choose.isEnabled()


def test_the_command_opens_it(full: MainWindow) -> None:
    menu = full.menuBar().actions()[3].menu()
    next(action for action in menu.actions() if "and and" in action.text()).trigger()
    (dialog,) = full.findChildren(HandEyeDialog)
    assert dialog.isVisible()
    dialog.reject()
