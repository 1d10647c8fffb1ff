"""The live page with a rendered hand before the camera: it guides, takes, ends, and hands over."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from calibgui.app.photographs import recording
from calibgui.dataset import ViewStatus
from calibgui.engine.boards import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.capture import CameraSettings, Frame, FrameSource
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.gui.live.live_page import LivePage
from calibgui.gui.window.main_window import MainWindow
from tests.scenes.hand import Film, RenderedCamera, Walk, follow, shake, spread_places

CAMERA = Camera((320, 240), [300, 300, 157, 122, -0.2, 0.05, 0, 0, 0], "brown-conrady")
BOARD = Board(6, 8, 20.0)
FIRST = Pose([0.1, -0.1, 0.0], [-75, -50, 330])
LEFT = Qt.MouseButton.LeftButton
STILL = 8
"""Frames for which the hand holds still: longer than a session waits."""


class Hand:
    """A camera before which a hand holds a board where the page wants it."""

    title = "the rendered camera"
    remark = "The camera has 320 x 240 px."
    is_continuous = True
    is_live = False

    def __init__(self) -> None:
        self.page: LivePage | None = None
        self.is_open, self.is_dead = True, False
        self.wanted = CameraSettings()
        self._film, self._rng = Film(CAMERA, BOARD), np.random.default_rng(1)
        self._poses = self._hold()

    def read(self) -> Frame | None:
        if self.is_dead:
            raise CalibrationError("the rendered camera stopped sending images.", "Check it.")
        return self._film.take(next(self._poses))

    def close(self) -> None:
        self.is_open = False

    def _hold(self) -> Iterator[Pose]:
        pose = FIRST
        while True:
            for _ in range(STILL):
                yield pose
            session = None if self.page is None else self.page.session
            goal = None if session is None else session.cameras[0].goal
            if goal is not None:
                pose = shake(follow(goal, CAMERA, BOARD), BOARD, self._rng, 10, 3)


class Page:
    """The page of a window, before a hand."""

    def __init__(self, page: LivePage, hand: Hand, qtbot: QtBot) -> None:
        self.page, self.hand, self._qtbot = page, hand, qtbot

    def click(self, name: str) -> None:
        button = getattr(self.page, name)
        assert button.isVisible()
        self._qtbot.mouseClick(button, LEFT)

    def wait(self, until: Callable[[], bool]) -> None:
        self._qtbot.waitUntil(until, timeout=60_000)


@pytest.fixture
def live(window: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Page:
    hand = Hand()

    def open_hand(_: str, __: float, wanted: CameraSettings) -> FrameSource:
        hand.is_open, hand.wanted = True, wanted
        return hand

    monkeypatch.setattr(recording, "open_source", open_hand)
    qtbot.mouseClick(window.welcome.buttons[1], LEFT)
    assert window.own_pages.live is not None
    assert window.pages.currentWidget() is window.own_pages.live
    hand.page = window.own_pages.live
    window.own_pages.live.folder = tmp_path / "live"
    return Page(window.own_pages.live, hand, qtbot)


def test_a_hand_that_follows_ends_with_a_calibrated_project(live: Page, window: MainWindow) -> None:
    page = live.page
    page.limit.setValue(0.2)
    page.image_size.setCurrentIndex(2)
    page.focus.setValue(30)
    live.click("start")
    live.wait(lambda: page.strip.list.count() >= 2)
    assert live.hand.wanted == CameraSettings((1280, 720), None, 30.0)
    assert page.words.text().startswith(live.hand.remark)
    assert page.view.accessibleDescription()
    live.wait(lambda: not page.is_running)
    assert "known well enough" in page.view.accessibleDescription()
    assert not live.hand.is_open
    files = sorted((page.folder).glob("*.png"))
    assert 3 <= len(files) == page.strip.list.count() <= 15
    live.click("calibrate")
    live.wait(lambda: window.session.result is not None and not window.calibrator.running)
    assert window.pages.currentWidget() is window.page
    views = window.session.project.views
    assert [Path(view.image) for view in views] == files
    assert all(view.status is ViewStatus.FOUND for view in views)


def test_space_takes_any_picture_and_one_can_be_taken_back(live: Page, qtbot: QtBot) -> None:
    page = live.page
    page.limit.setValue(0.01)
    live.click("start")
    live.wait(lambda: page.strip.list.count() == 1)
    for count in (2, 3):
        qtbot.keyClick(page, Qt.Key.Key_Space)
        live.wait(lambda count=count: page.strip.list.count() >= count)
    live.click("finish")
    live.wait(lambda: not page.is_running)
    everything = page.strip.list_files()
    page.strip.list.setCurrentRow(0)
    qtbot.mouseClick(page.strip.toggle, LEFT)
    assert page.strip.list_files() == everything[:-1]
    qtbot.mouseClick(page.strip.toggle, LEFT)
    assert page.strip.list_files() == everything
    assert all(Path(file).is_file() for file in everything)
    live.click("go_on")
    assert page.is_running


def test_a_picture_taken_back_no_longer_counts(live: Page, qtbot: QtBot) -> None:
    page = live.page
    page.limit.setValue(0.01)
    live.click("start")
    live.wait(lambda: page.strip.list.count() >= 2)
    assert page.session is not None
    first = page.session.cameras[0].pictures[0]
    page.strip.list.setCurrentRow(page.strip.list.count() - 1)
    qtbot.mouseClick(page.strip.toggle, LEFT)
    live.wait(lambda: page.session is not None and first not in page.session.cameras[0].pictures)
    qtbot.mouseClick(page.strip.toggle, LEFT)
    live.wait(lambda: page.session is not None and first in page.session.cameras[0].pictures)


def test_a_camera_that_dies_costs_nothing_that_was_taken(live: Page) -> None:
    page = live.page
    live.click("start")
    live.wait(lambda: page.strip.list.count() == 1)
    live.hand.is_dead = True
    live.wait(lambda: not page.is_running)
    assert "stopped sending images. Check it." in page.view.accessibleDescription()
    assert page.calibrate.isVisible()
    assert len(list(page.folder.glob("*.png"))) == page.strip.list.count()


def test_the_camera_is_released_when_the_page_is_left(live: Page, window: MainWindow) -> None:
    live.click("start")
    live.wait(lambda: live.page.strip.list.count() == 1)
    live.click("leave")
    assert window.pages.currentWidget() is window.welcome
    live.wait(lambda: not live.page.is_running)
    assert not live.hand.is_open
    assert not [t for t in threading.enumerate() if t.name == "frames" and t.is_alive()]


def test_a_camera_that_is_not_there_is_said(window: MainWindow, qtbot: QtBot) -> None:
    window.own_pages.photograph_live()
    page = window.own_pages.live
    assert page is not None
    page.sources.boxes[0].setEditText("97")
    qtbot.mouseClick(page.start, LEFT)
    qtbot.waitUntil(lambda: not page.is_running, timeout=30_000)
    assert "camera 97 cannot be opened. Check" in page.view.accessibleDescription()
    assert page.start.isVisible()


def test_two_cameras_take_their_pictures_together_and_become_a_rig(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    poses = {"0": Pose([0, 0, 0], [0, 0, 0]), "1": Pose([0.01, -0.12, 0.0], [-60.0, 1.0, 6.0])}
    walk = Walk(spread_places(BOARD, 5, np.array([30.0, 0.0, 330.0])), hold=0.4, move=0.0)

    def open_rendered(name: str, _: float, __: CameraSettings) -> FrameSource:
        return RenderedCamera(CAMERA, poses[name], BOARD, walk)

    monkeypatch.setattr(recording, "open_source", open_rendered)
    window.own_pages.photograph_live()
    page = window.own_pages.live
    assert page is not None
    page.folder = tmp_path / "live"
    qtbot.mouseClick(page.sources.add, LEFT)
    assert page.sources.list_names() == ["0", "1"]
    qtbot.mouseClick(page.start, LEFT)
    qtbot.waitUntil(lambda: page.strip.list.count() >= 3, timeout=60_000)
    assert len(page.view.views) == 2
    assert all(view.isVisible() and view._image is not None for view in page.view.views)
    assert "cam0 and cam1: " in page.words.text()
    qtbot.mouseClick(page.finish, LEFT)
    qtbot.waitUntil(lambda: not page.is_running, timeout=30_000)
    count = page.strip.list.count()
    page.strip.list.setCurrentRow(0)
    qtbot.mouseClick(page.strip.toggle, LEFT)
    qtbot.mouseClick(page.calibrate, LEFT)
    rig = window.own_pages.rig
    assert rig is not None
    assert window.pages.currentWidget() is rig
    qtbot.waitUntil(lambda: rig.pairing is not None, timeout=30_000)
    assert rig.pairing is not None
    assert [camera.name for camera in rig.pairing.cameras] == ["cam0", "cam1"]
    assert len(rig.pairing.shared) == count - 1


def test_cameras_are_added_and_removed(window: MainWindow, qtbot: QtBot) -> None:
    window.own_pages.photograph_live()
    page = window.own_pages.live
    assert page is not None
    for _ in range(5):
        qtbot.mouseClick(page.sources.add, LEFT)
    assert len(page.sources.boxes) == 4
    assert not page.sources.add.isEnabled()
    for _ in range(3):
        qtbot.mouseClick(page.sources.remove, LEFT)
    assert len(page.sources.boxes) == 1
    assert not page.sources.remove.isVisible()
