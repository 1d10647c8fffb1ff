"""From photographs to a result that one can trust: six tasks, their clicks and decisions counted.

A click is a press of a button, of the mouse or in a file dialog, or Enter in a box; a decision is
a value that the user has to know. MATLAB's Camera Calibrator takes four clicks (Add Images, Open,
OK, Calibrate) and one decision (the size of a square) for any set of photographs, and names no
cause: the user reads the bars of reprojection errors, drags their threshold, presses Remove and
Calibrate, or chooses other options, and looks whether errors fall. It was not run for this count.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QPushButton
from pytestqt.qtbot import QtBot
from scipy.interpolate import LinearNDInterpolator

from calibgui.app.system.resources import find_resource
from calibgui.engine.arrays import Array
from calibgui.engine.boards import Board
from calibgui.engine.camera import Camera
from calibgui.engine.geometry import Pose
from calibgui.engine.images import read_image, render_view, write_image
from calibgui.gui.panels.evidence.coverage import CoveragePanel
from calibgui.gui.window.main_window import MainWindow
from tests.engine import scenes
from tests.faults.sets import project_corners

pytestmark = pytest.mark.slow

SAMPLE = find_resource("sample")
TRUTH = json.loads((SAMPLE / "truth.json").read_text())
BOARD = Board(rows=7, cols=10, square=25.0)
COUNT = 8
MATLAB_CLICKS = 4
"""Clicks that MATLAB's application takes for any photographs, before anything is mended."""


def copy_sample(folder: Path, count: int = COUNT) -> None:
    for number in range(1, count + 1):
        shutil.copy(SAMPLE / f"view{number:02d}.png", folder)


def blur_three(folder: Path) -> None:
    """Photographs of which three are out of focus."""
    copy_sample(folder)
    for number in (2, 5, 7):
        path = folder / f"view{number:02d}.png"
        write_image(path, cv2.GaussianBlur(read_image(path).pixels, (0, 0), 4.0))


def bend_board(folder: Path) -> None:
    """The sample's photographs, of a board that is bowed by 3 mm."""
    truth = TRUTH["camera"]
    camera = Camera(tuple(truth["size"]), list(truth["params"].values()), truth["model"])
    X, Y = np.meshgrid(np.linspace(-50, 275, 40), np.linspace(-50, 200, 30))
    flat = np.column_stack([X.ravel(), Y.ravel(), np.zeros(X.size)])
    bent = flat + np.column_stack([0 * flat[:, :2], 3.0 * ((flat[:, 0] - 112.5) / 112.5) ** 2])
    width, height = camera.size
    u, v = np.meshgrid(np.arange(width), np.arange(height))
    for view in TRUTH["views"][:COUNT]:
        pose = Pose(view["rvec"], view["tvec_mm"])
        at, source = (project_corners(camera, pose, points) for points in (bent, flat))
        back: Array = LinearNDInterpolator(at, source)(u, v).astype(np.float32)
        pixels = read_image(SAMPLE / view["image"]).pixels
        moved = cv2.remap(pixels, back[..., 0], back[..., 1], cv2.INTER_CUBIC, borderValue=120)
        write_image(folder / view["image"], moved)


def widen_lens(folder: Path) -> None:
    """Photographs with a lens of 105 degrees, the board in its corners, too."""
    camera = Camera(
        (640, 480), [350.0, 350.0, 318.0, 242.0, 0.02, -0.01, 0.0, 0.0], "kannala-brandt"
    )
    rng = np.random.default_rng(4)
    places = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, 0], [0.7, 0], [0, 0.7], [-0.6, 0]])
    for number, place in enumerate(places):
        pose = scenes.looking(camera, rng, fill=(0.4, 0.45), board=BOARD)
        shift = np.append(place * pose.tvec[2] * [0.5, 0.35], 0.0)
        pixels = render_view(
            camera, Pose(pose.rvec, pose.tvec + shift), BOARD, blur=0.7, noise=2.0, seed=number
        )
        write_image(folder / f"view{number:02d}.png", pixels)


class User:
    """Does what a user does, and counts it."""

    def __init__(self, window: MainWindow, qtbot: QtBot, folder: Path) -> None:
        self.window, self.bot, self.folder = window, qtbot, folder
        self.clicks = self.decisions = 0

    def click(self, button: QPushButton) -> None:
        assert button.isVisible() and button.isEnabled()
        self.bot.mouseClick(button, Qt.MouseButton.LeftButton)
        self.clicks += 1

    def open_photographs(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Press the welcome page's button, then Open in the system's dialog."""

        def choose(*_: object) -> str:
            self.clicks += 1
            return str(self.folder)

        monkeypatch.setattr(QFileDialog, "getExistingDirectory", choose)
        self.click(self.window.welcome.buttons[0])
        self.wait()

    def wait(self) -> None:
        """Wait until the result has its verdict and nothing runs."""
        session = self.window.session
        self.bot.waitUntil(
            lambda: (
                session.result is not None
                and session.project.is_current(session.result)
                and self.window.verdict.verdict is not None
                and not session.jobs.running
            ),
            timeout=120_000,
        )

    def state_square(self, mm: str) -> None:
        """Type the side of a square into the box that asks for it, and press Enter."""
        box = self.window.verdict.square.square
        assert box.isVisible()
        box.setFocus()
        box.selectAll()
        self.bot.keyClicks(box.lineEdit(), mm)
        self.bot.keyClick(box.lineEdit(), Qt.Key.Key_Return)
        self.clicks += 1
        self.decisions += 1
        self.wait()

    @property
    def headline(self) -> str:
        bar = self.window.verdict
        return f"{bar.headline.text()}. {bar.reason.text()}"


@pytest.fixture
def user(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> User:
    folder = tmp_path / "photographs"
    folder.mkdir()
    return User(window, qtbot, folder)


def test_clean_photographs(user: User, monkeypatch: pytest.MonkeyPatch) -> None:
    copy_sample(user.folder)
    user.open_photographs(monkeypatch)
    assert user.headline == "GOOD. The photographs show nothing wrong."
    user.state_square("25")
    assert (
        user.headline.startswith("GOOD") and "if squares" not in user.window.verdict.figures.text()
    )
    assert (user.clicks, user.decisions) == (3, 1) and user.clicks < MATLAB_CLICKS


def test_a_wrong_square(user: User, monkeypatch: pytest.MonkeyPatch) -> None:
    copy_sample(user.folder)
    user.open_photographs(monkeypatch)
    user.state_square("30")  # they have 25 mm: no photograph can tell
    assert "if squares" not in user.window.verdict.figures.text()
    box = user.window.board.square
    user.window.show_setup()
    user.clicks += 1
    box.setFocus()
    box.selectAll()
    user.bot.keyClicks(box.lineEdit(), "25")
    user.decisions += 1
    user.bot.keyClick(box.lineEdit(), Qt.Key.Key_Return)
    assert "Out of date" not in user.window.verdict.reason.text(), "the result is scaled"
    result = user.window.session.result
    assert result is not None
    distance = np.linalg.norm(result.calibration.poses[0].tvec)
    assert distance == pytest.approx(np.linalg.norm(TRUTH["views"][0]["tvec_mm"]), rel=2e-3)
    # In MATLAB's application the size is stated with the photographs: they are added anew.
    assert (user.clicks, user.decisions) == (4, 2) and user.clicks < 2 * MATLAB_CLICKS


def test_a_bent_board(user: User, monkeypatch: pytest.MonkeyPatch) -> None:
    bend_board(user.folder)
    user.open_photographs(monkeypatch)
    assert user.headline.startswith("GOOD")
    result = user.window.session.result
    assert result is not None and result.calibration.board_shape is not None
    assert "its shape was estimated" in result.improvements[0]
    user.state_square("25")
    # MATLAB's application has no such remedy: nothing to compare with.
    assert (user.clicks, user.decisions) == (3, 1)


def test_a_wide_lens(user: User, monkeypatch: pytest.MonkeyPatch) -> None:
    widen_lens(user.folder)
    user.open_photographs(monkeypatch)
    assert user.headline.startswith("GOOD")
    user.state_square("25")
    # MATLAB's application takes one more: the fisheye model is to be chosen before.
    assert (user.clicks, user.decisions) == (3, 1) and user.clicks < MATLAB_CLICKS + 1


def test_three_blurred_photographs(user: User, monkeypatch: pytest.MonkeyPatch) -> None:
    blur_three(user.folder)
    user.open_photographs(monkeypatch)
    # What is said to be good is so.
    assert user.headline == (
        "GOOD. The photographs show nothing wrong. view02.png, view05.png and view07.png are "
        "blurred, which does no harm here."
    )
    result = user.window.session.result
    assert result is not None
    truth = list(TRUTH["camera"]["params"].values())[:4]
    np.testing.assert_allclose(result.calibration.camera.params[:4], truth, atol=0.5)
    user.state_square("25")
    # MATLAB's application: the threshold is dragged, outliers are removed, and Calibrate.
    assert (user.clicks, user.decisions) == (3, 1) and user.clicks < MATLAB_CLICKS + 2


def test_two_photographs(user: User, monkeypatch: pytest.MonkeyPatch) -> None:
    copy_sample(user.folder, 2)
    user.open_photographs(monkeypatch)
    assert user.headline.startswith("NOT USABLE. Add views with the board tilted")
    assert user.headline.endswith("2 views are too few.")
    assert user.window.verdict.button.text() == "Show where to hold the board"
    user.click(user.window.verdict.button)
    assert user.window.analysis is not None
    assert isinstance(user.window.analysis.shown, CoveragePanel)
    user.bot.waitUntil(lambda: not user.window.session.jobs.running, timeout=120_000)
    assert (user.clicks, user.decisions) == (3, 0) and user.clicks < MATLAB_CLICKS
