"""From start to export by keys alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import QApplication, QFileDialog, QLineEdit, QWidget
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.settings import DEFAULT_SETTINGS
from calibgui.app.projects.document import Document
from calibgui.app.projects.project import Project
from calibgui.engine.boards import Board
from calibgui.engine.camera import Camera
from calibgui.engine.images import Appearance, render_view, write_image
from calibgui.formats.result_json import read_result
from calibgui.gui.dialogs.export_dialog import ExportDialog
from calibgui.gui.verdict.before_after import BeforeAndAfter
from calibgui.gui.window.main_window import MainWindow
from tests.engine import scenes
from tests.gui.hand import Hand

pytestmark = pytest.mark.slow

Key = Qt.Key
CONTROL = Qt.KeyboardModifier.ControlModifier
BOARD = Board(rows=4, cols=5, square=30.0)
CAMERA = Camera((240, 180), [240.0, 241.0, 118.0, 91.0, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0], "lucchese")
COUNT = 5


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Small photographs of a board whose squares are 2 % too high."""
    images = tmp_path / "photographs"
    images.mkdir()
    rng = np.random.default_rng(2)
    look = Appearance(quiet_zone=0.4, stretch=1.02)
    for number in range(COUNT):
        pose = scenes.looking(CAMERA, rng, fill=(0.5, 0.6), board=BOARD)
        pixels = render_view(CAMERA, pose, BOARD, blur=0.6, noise=1.0, seed=number, appearance=look)
        write_image(images / f"{number}.png", pixels)
    return images


def tab_to(hand: Hand, wanted: QWidget) -> None:
    """Press Tab until a widget has the focus."""
    for _ in range(100):
        if QApplication.focusWidget() is wanted:
            return
        hand.key(Key.Key_Tab)
    raise AssertionError(f"Tab does not come to {wanted}")


def type_name(hand: Hand, name: str) -> None:
    """Type a name into the file dialog that the next key opens, and press Enter."""

    def type_it() -> None:
        dialog, focus = QApplication.activeModalWidget(), QApplication.focusWidget()
        if not isinstance(dialog, QFileDialog) or not dialog.isAncestorOf(focus):
            QTimer.singleShot(10, type_it)
            return
        assert isinstance(focus, QLineEdit)
        focus.setCompleter(None)  # its list is a window, which the offscreen platform warns of
        hand.key(Key.Key_A, CONTROL)
        hand.bot.keyClicks(focus, name)
        hand.key(Key.Key_Return)
        below.activateWindow()  # a window manager does that

    below = QApplication.activeWindow()
    QTimer.singleShot(0, type_it)


def test_from_start_to_export_by_keys_alone(
    window: MainWindow, qtbot: QtBot, folder: Path, tmp_path: Path
) -> None:
    hand, session, bar = Hand(window, qtbot), window.session, window.verdict
    window.activateWindow()
    # One lens model: comparing all would take more time than everything else.
    session.begin(Document(Project(settings=DEFAULT_SETTINGS)))

    def rest() -> None:
        hand.wait(lambda: not session.jobs.running)

    # Open the folder; it is searched and calibrated.
    type_name(hand, str(folder))
    tab_to(hand, window.welcome.buttons[0])
    hand.key(Key.Key_Space)
    hand.wait(lambda: session.result is not None and not window.calibrator.running)

    # Confirm the side of a square.
    tab_to(hand, bar.square.square)
    hand.key(Key.Key_Return)
    assert session.project.lengths_confirmed and not bar.square.confirm.isEnabled()

    # Calibrate again.
    tab_to(hand, window.calibrate)
    hand.key(Key.Key_Space)
    hand.wait(lambda: len(session.project.results) == 2 and bar.verdict is not None)

    # Do what the verdict proposes, and keep it.
    tab_to(hand, bar.button)
    hand.key(Key.Key_Space)
    hand.wait(lambda: isinstance(bar.comparison, BeforeAndAfter) and bar.comparison.isVisible())
    rest()
    assert isinstance(bar.comparison, BeforeAndAfter)
    assert QApplication.focusWidget() is bar.comparison.keep
    hand.key(Key.Key_Space)
    assert not bar.comparison.isVisible()
    assert session.result is not None and session.result.calibration.board_shape is not None

    # Leave a photograph out, put it back and leave it out; the fit follows.
    tab_to(hand, window.images.list)
    hand.key(Key.Key_Home)
    hand.key(Key.Key_Right)
    for enabled in (False, True, False):
        hand.key(Key.Key_Space)
        assert [view.enabled for view in session.project.views].count(False) == (not enabled)
        hand.wait(lambda: session.project.is_current(session.result))
    rest()

    # Export.
    out = tmp_path / "camera.json"
    hand.key(Key.Key_E, CONTROL)
    dialog = QApplication.activeModalWidget()
    assert isinstance(dialog, ExportDialog)
    hand.wait(dialog.save.isEnabled)
    type_name(hand, str(out))
    hand.key(Key.Key_Return)
    hand.wait(out.exists)
    rest()
    hand.key(Key.Key_Escape)
    assert not dialog.isVisible()
    assert session.result is not None
    written = read_result(out)
    assert len(written.used) == COUNT - 1
    camera = session.result.calibration.camera
    np.testing.assert_array_equal(written.calibration.camera.params, camera.params)
