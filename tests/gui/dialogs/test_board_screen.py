"""A board on the screen is found, in whole pixels, and as long as its ruler was measured."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.engine.boards import Board, Circles
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.detection import find_corners
from calibgui.gui.dialogs.board_screen import BoardScreen
from calibgui.gui.dialogs.print_dialog import PrintDialog
from calibgui.gui.window.main_window import MainWindow

BOARDS = (
    Board(6, 8, 30.0),
    Board(5, 7, 30.0, Charuco("DICT_4X4_50", 0.75, False)),
    Board(7, 9, 30.0, Circles(False, 0.5)),
)


@pytest.mark.parametrize("board", BOARDS, ids=lambda board: board.pattern.kind)
def test_what_is_shown_is_the_board_in_whole_pixels(board: Board, qtbot: QtBot) -> None:
    screen = BoardScreen(board)
    screen.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    qtbot.addWidget(screen)
    screen.resize(900, 700)
    screen.show()
    picture = screen.grab().toImage().convertToFormat(QImage.Format.Format_Grayscale8)
    width = picture.bytesPerLine()
    grey = np.frombuffer(picture.constBits(), np.uint8).reshape(-1, width)
    corners = find_corners(grey[:, : picture.width()], board.grid_size, pattern=board.pattern)
    assert corners.complete
    order = np.lexsort(corners.grid.T[::-1])
    lattice = corners.uv[order].reshape(*board.grid_size, 2)
    assert np.diff(lattice[..., 0], axis=1) == pytest.approx(screen.side_px, abs=0.1)
    assert np.diff(lattice[..., 1], axis=0) == pytest.approx(screen.side_px, abs=0.1)


def test_the_side_follows_the_measured_line(qtbot: QtBot) -> None:
    screen = BoardScreen(BOARDS[0])
    screen.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    qtbot.addWidget(screen)
    screen.resize(900, 700)
    screen.show()
    told = screen.side_mm
    device = QApplication.primaryScreen()
    assert told == pytest.approx(
        screen.side_px * device.physicalSize().width() / device.size().width()
    )
    screen.measured.setValue(104.0)
    assert screen.side_mm == pytest.approx(1.04 * told)
    assert f"{screen.side_mm:.3f} mm" in screen.words.text()
    qtbot.keyClick(screen, Qt.Key.Key_Escape)
    assert not screen.isVisible()


def test_the_dialog_shows_the_chosen_board(window: MainWindow, qtbot: QtBot) -> None:
    dialog = PrintDialog(BOARDS[0], window)
    qtbot.addWidget(dialog)
    dialog.show()
    qtbot.mouseClick(dialog.show_on_screen, Qt.MouseButton.LeftButton)
    (screen,) = [w for w in QApplication.topLevelWidgets() if isinstance(w, BoardScreen)]
    assert screen.isFullScreen()
    screen.close()
