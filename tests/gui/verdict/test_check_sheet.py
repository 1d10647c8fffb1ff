"""New photographs on a result tell whether the camera is still good, and change nothing."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDragLeaveEvent, QDropEvent
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating import still_good
from calibgui.app.photographs.detection import Detection
from calibgui.dataset import View
from calibgui.engine.assessment import CheckVerdict
from calibgui.gui.verdict import check_sheet
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples

COPY, LEFT, BARE = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton, Qt.KeyboardModifier(0)


def photograph(monkeypatch: pytest.MonkeyPatch, *views: View) -> None:
    """Have the search find these views, whatever is checked with."""
    board = examples.BOARD
    found = Detection(views, examples.CAMERA.size, board.grid_size, board.pattern)
    monkeypatch.setattr(still_good, "find_views", lambda *_, **__: found)
    monkeypatch.setattr(check_sheet, "choose_images", lambda names: (tuple(names), ()))


def drop(window: MainWindow, place: QPoint) -> None:
    """Drag a file over the window, and drop it there."""
    data, at = QMimeData(), QPointF(place)
    data.setUrls([QUrl.fromLocalFile(str(Path("new.png").absolute()))])
    window.dragEnterEvent(QDragEnterEvent(place, COPY, data, LEFT, BARE))
    window.dropEvent(QDropEvent(at, COPY, data, LEFT, BARE))


def test_photographs_on_a_result_check_it_and_change_nothing(
    full: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    photograph(monkeypatch, *examples.views(tmp_path))
    project, edits, sheet = full.session.project, full.session.document.edits, full.check
    inspector = full.inspector
    drop(full, inspector.mapTo(full, inspector.rect().center()))
    qtbot.waitUntil(lambda: sheet.checked is not None)
    assert sheet.isVisible()
    assert full.session.project is project
    assert full.session.document.edits == edits
    assert "STILL GOOD" in sheet.headline.text()
    assert "± " in sheet.words.text()
    assert "below 0.5 px" in sheet.words.text()
    assert "6 of 7 photographs" in sheet.details.text(), "one of them shows no board"
    assert f"of {6 * 42} corners" in sheet.details.text()
    assert "No checkerboard was found." in sheet.details.text()
    sheet.limit.setValue(0.01)
    assert sheet.checked is not None
    assert sheet.checked.check.verdict is CheckVerdict.CANNOT_TELL
    assert "Add pictures" in sheet.words.text(), "what would tell more"
    sheet.close_button.click()
    assert sheet.isHidden()


def test_another_camera_is_to_be_calibrated_again(
    full: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    moved = []
    for view in examples.views(tmp_path)[:6]:
        assert view.corners is not None
        uv = 1.05 * (view.corners.uv - [90.0, 70.0]) * [1.0, 1.03] + [90.0, 70.0]
        moved.append(replace(view, corners=replace(view.corners, uv=uv)))
    photograph(monkeypatch, *moved)
    full.check.check(["new.png"])
    qtbot.waitUntil(lambda: full.check.checked is not None)
    assert full.check.headline.text() == "CALIBRATE AGAIN"


def test_photographs_without_a_board_say_why_they_tell_nothing(
    full: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    photograph(monkeypatch, examples.views(tmp_path)[-1])
    full.check.check(["new.png"])
    qtbot.waitUntil(lambda: "found in none" in full.check.words.text())


def test_photographs_on_the_desk_join_the_project(
    full: MainWindow, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []
    monkeypatch.setattr(full.files, "open_paths", opened.extend)
    monkeypatch.setattr(full.own_pages, "are_of_rig", lambda _: False)
    drop(full, full.pages.mapTo(full, full.pages.rect().center()))
    assert [Path(name).name for name in opened] == ["new.png"]
    assert full.check.isHidden()


def test_the_inspector_invites_while_something_is_dragged_and_there_is_a_result(
    full: MainWindow,
) -> None:
    hint, data = full.inspector._hint, QMimeData()
    data.setUrls([QUrl.fromLocalFile("/new.png")])
    full.dragEnterEvent(QDragEnterEvent(QPoint(5, 5), COPY, data, LEFT, BARE))
    assert hint.isVisible()
    full.dragLeaveEvent(QDragLeaveEvent())
    assert hint.isHidden()
