"""The tour points at one part of the window after another, and can be left at any step."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from calibgui.gui.window.main_window import MainWindow
from calibgui.gui.window.tour import Tour


def begin(window: MainWindow) -> Tour:
    window.take_tour()
    assert window._tour is not None
    return window._tour


def place(widget: QWidget, host: QWidget) -> QRect:
    return QRect(widget.mapTo(host, QPoint()), widget.size())


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (960, 1000), (640, 480)])
def test_every_step_points_at_what_it_does_not_cover(
    full: MainWindow, qtbot: QtBot, width: int, height: int
) -> None:
    full.resize(width, height)
    qtbot.wait(20)
    tour, host = begin(full), full.centralWidget()
    for step in tour.steps:
        assert tour.isVisible()
        assert host.rect().contains(tour.geometry()), step.title
        if step.widget.isVisibleTo(host) and width > 640:  # there the photograph fills it all
            assert not tour.geometry().intersects(place(step.widget, host)), step.title
        qtbot.mouseClick(tour.next_button, Qt.MouseButton.LeftButton)
    assert tour.isHidden()


def test_it_is_left_at_any_step_and_taken_again(full: MainWindow, qtbot: QtBot) -> None:
    tour = begin(full)
    qtbot.mouseClick(tour.next_button, Qt.MouseButton.LeftButton)
    qtbot.keyClick(tour, Qt.Key.Key_Escape)
    assert tour.isHidden()
    again = begin(full)
    assert again.place == 0
    qtbot.mouseClick(again.leave_button, Qt.MouseButton.LeftButton)
    assert again.isHidden()


def test_an_empty_window_takes_it_on_the_sample(
    window: MainWindow, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[int] = []
    monkeypatch.setattr(window.files, "open_sample", lambda: opened.append(1))
    window.welcome.buttons[4].click()
    assert opened == [1]
    assert window._tour is not None
    window._tour.leave()
