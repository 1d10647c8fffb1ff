"""Videos and phones' photographs that are dropped on the window, with real drop events."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.dataset import ViewStatus
from calibgui.engine.images import read_image
from calibgui.gui.window.main_window import MainWindow
from tests.app.photographs.test_videos import video as video

LEFT = Qt.MouseButton.LeftButton


def drop(window: MainWindow, *paths: Path) -> None:
    """Drag files over the window and drop them, as the window system tells it."""
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path)) for path in paths])
    copy, bare = Qt.DropAction.CopyAction, Qt.KeyboardModifier.NoModifier
    enter = QDragEnterEvent(QPointF(200, 200).toPoint(), copy, data, LEFT, bare)
    QApplication.sendEvent(window, enter)
    assert enter.isAccepted()
    dropped = QDropEvent(QPointF(200, 200), copy, data, LEFT, bare)
    QApplication.sendEvent(window, dropped)
    assert dropped.isAccepted()


def is_searched(window: MainWindow) -> bool:
    views = window.session.project.views
    return bool(views) and all(view.status is not ViewStatus.WAITING for view in views)


def test_frames_of_a_dropped_video_are_added(
    window: MainWindow, qtbot: QtBot, video: Path, tmp_path: Path
) -> None:
    clip = shutil.copy(video, tmp_path / "clip.avi")
    drop(window, clip)
    qtbot.waitUntil(lambda: is_searched(window), timeout=120_000)
    views = window.session.project.views
    assert {Path(view.image).parent for view in views} == {tmp_path / "clip-frames"}
    assert len(views) == 6, "one of each pose"
    assert all(view.status is ViewStatus.FOUND for view in views)
    assert "clip.avi has 30 frames" in window.banner.text.text()


def test_a_damaged_video_is_refused_by_name(
    window: MainWindow, qtbot: QtBot, video: Path, tmp_path: Path
) -> None:
    (tmp_path / "clip.avi").write_bytes(video.read_bytes()[:64])
    drop(window, tmp_path / "clip.avi")
    qtbot.waitUntil(lambda: window.banner.isVisible(), timeout=30_000)
    assert "clip.avi cannot be decoded" in window.banner.text.text()
    assert not window.session.project.views


def test_a_dropped_heic_photograph_is_searched(
    window: MainWindow, qtbot: QtBot, photographs: Path, tmp_path: Path
) -> None:
    pillow_heif = pytest.importorskip("pillow_heif")
    pixels = read_image(photographs / "view1.png").pixels
    file = tmp_path / "view1.heic"
    image = pillow_heif.from_bytes("L", pixels.shape[::-1], pixels.tobytes())
    image.save(str(file), quality=95)
    drop(window, file)
    qtbot.waitUntil(lambda: is_searched(window), timeout=60_000)
    (view,) = window.session.project.views
    assert view.image == str(file) and view.status is ViewStatus.FOUND
