"""A user's hand on the window: real events of mouse and keyboard."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QApplication, QPushButton
from pytestqt.qtbot import QtBot

from calibgui.engine.arrays import Array
from calibgui.engine.features.corners import Corners
from calibgui.gui.images.image_model import Role
from calibgui.gui.window.main_window import MainWindow

LEFT = Qt.MouseButton.LeftButton


class Hand:
    """What a user does to the window."""

    def __init__(self, window: MainWindow, qtbot: QtBot) -> None:
        self.window, self.bot, self.canvas = window, qtbot, window.page.canvas

    def wait(self, condition: Callable[[], Any], timeout: int = 60_000) -> None:
        self.bot.waitUntil(condition, timeout=timeout)

    def key(
        self, key: Qt.Key, modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier
    ) -> None:
        self.bot.keyClick(QApplication.focusWidget() or self.window, key, modifier)

    def click_button(self, button: QPushButton) -> None:
        self.bot.mouseClick(button, LEFT)

    def choose_image(self, name: str) -> None:
        """Click a row of the list and wait for the picture."""
        view = self.window.images.list
        rows = [view.model().index(row, 0) for row in range(view.model().rowCount())]
        index = next(i for i in rows if i.data() == name)
        view.scrollTo(index)
        self.bot.mouseClick(view.viewport(), LEFT, pos=view.visualRect(index).center())
        self.wait(lambda: self.window.session.images.kept(index.data(Role.PATH)) is not None)
        self.wait(lambda: self.window.page.shown_path == index.data(Role.PATH))

    def click(
        self, uv: Array, modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier
    ) -> None:
        at = self.place(uv)
        self.bot.mouseMove(self.canvas.viewport(), at)
        self.bot.mouseClick(self.canvas.viewport(), LEFT, modifier, at)

    def drag(self, start: Array, end: Array, modifier: Qt.KeyboardModifier) -> None:
        for kind, uv, buttons in (
            (QEvent.Type.MouseButtonPress, start, LEFT),
            (QEvent.Type.MouseMove, (start + end) / 2, LEFT),
            (QEvent.Type.MouseMove, end, LEFT),
            (QEvent.Type.MouseButtonRelease, end, Qt.MouseButton.NoButton),
        ):
            at = QPointF(self.place(uv))
            everywhere = QPointF(self.canvas.viewport().mapToGlobal(at))
            event = QMouseEvent(kind, at, everywhere, LEFT, buttons, modifier)
            QApplication.sendEvent(self.canvas.viewport(), event)

    def place(self, uv: Array) -> QPoint:
        return QPointF(*self.canvas.to_screen(np.asarray(uv)[None])[0]).toPoint()

    def corners(self) -> Corners:
        view = self.window.session.view
        assert view is not None
        assert view.corners is not None
        return view.corners


def outermost(corners: Corners) -> Array:
    place = {tuple(p): k for k, p in enumerate(corners.grid.tolist())}
    rows, cols = corners.shape[0] - 1, corners.shape[1] - 1
    return corners.uv[[place[p] for p in ((0, 0), (0, cols), (rows, cols), (rows, 0))]]
