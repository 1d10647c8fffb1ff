"""Every action of the menus is found by typing, and says why it can do nothing."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QApplication, QMenu, QWidget
from pytestqt.qtbot import QtBot

from calibgui.app.projects.project import add_images
from calibgui.gui.panels.answer.undistort import UndistortPanel
from calibgui.gui.panels.evidence.poses import PosesPanel
from calibgui.gui.panels.method.stage_one import StageOnePanel
from calibgui.gui.panels.panel import Panel
from calibgui.gui.window.main_window import MainWindow
from calibgui.gui.window.menus import strip_mnemonic
from calibgui.gui.window.palette import Palette

CONTROL = Qt.KeyboardModifier.ControlModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier


def open_palette(window: MainWindow, qtbot: QtBot) -> Palette:
    """The palette, by its keys."""
    target = QApplication.focusWidget() or window
    qtbot.keyClick(target, Qt.Key.Key_P, CONTROL | SHIFT)
    palettes = [p for p in window.findChildren(Palette) if p.isVisible()]
    assert len(palettes) == 1
    qtbot.waitUntil(palettes[0].isActiveWindow)
    return palettes[0]


def texts(palette: Palette) -> list[str]:
    rows = map(palette.list.topLevelItem, range(palette.list.topLevelItemCount()))
    return [row.text(0) for row in rows]


def find_action(window: MainWindow, text: str) -> QAction:
    return next(
        action
        for menu in window.menuBar().findChildren(QMenu)
        for action in menu.actions()
        if strip_mnemonic(action.text()) == text
    )


def test_it_lists_every_action_of_the_menus(full: MainWindow, qtbot: QtBot) -> None:
    palette = open_palette(full, qtbot)
    expected = {
        strip_mnemonic(action.text())
        for menu in full.menuBar().findChildren(QMenu)
        if menu.parent() is not full.page  # the layers' own menu shows the same actions
        for action in menu.actions()
        if not action.isSeparator() and action.menu() is None
    }
    assert set(texts(palette)) == expected
    assert len(expected) > 25
    palette.reject()


def test_typing_finds_and_enter_runs(full: MainWindow, qtbot: QtBot) -> None:
    image = full.session.project.views[1].image
    full.session.select(image)
    full.images.exclude([image])
    palette = open_palette(full, qtbot)
    qtbot.keyClicks(palette.search, "undo")
    assert texts(palette)[0].startswith("Undo “Exclude")
    assert palette.list.topLevelItem(0).text(2) == "Ctrl+Z"
    qtbot.keyClick(palette.search, Qt.Key.Key_Return)
    assert not palette.isVisible()
    assert full.session.project.views[1].enabled


def test_it_finds_by_the_menu_and_by_the_tip(full: MainWindow, qtbot: QtBot) -> None:
    palette = open_palette(full, qtbot)
    qtbot.keyClicks(palette.search, "dark")  # in the tip of the other two as well
    assert texts(palette) == ["Dark", "As the system", "Light"]
    assert palette.list.topLevelItem(0).text(1) == "View › Colours"
    palette.search.clear()
    for words in ("another program", "opencv"):
        palette.search.setText(words)
        assert texts(palette) == ["Export…"]
    palette.search.setText("no such thing")
    assert texts(palette) == [] and "No action" in palette.about.text()
    palette.reject()


@pytest.mark.parametrize(
    ("typed", "title", "kind"),
    [
        ("undist", "Undistort", UndistortPanel),
        ("stage i", "Stage I", StageOnePanel),
        ("extrinsics", "Poses", PosesPanel),
    ],
)
def test_it_finds_panels_and_brings_them_into_sight(
    full: MainWindow, qtbot: QtBot, typed: str, title: str, kind: type[Panel]
) -> None:
    palette = open_palette(full, qtbot)
    qtbot.keyClicks(palette.search, typed)
    assert texts(palette)[0] == title
    assert palette.list.topLevelItem(0).text(1) == "View › Show panel"
    qtbot.keyClick(palette.search, Qt.Key.Key_Return)
    assert isinstance(full.need_analysis().shown, kind) and full.need_analysis().isVisible()


def test_the_set_up_is_found_before_there_is_a_result(window: MainWindow, qtbot: QtBot) -> None:
    window.session.edit("Add", lambda p: add_images(p, ["a.png"]))
    palette = open_palette(window, qtbot)
    palette.search.setText("show panel")
    assert texts(palette) == ["Photographs", "Set-up"]
    palette.reject()


def test_a_click_runs_once(full: MainWindow, qtbot: QtBot) -> None:
    image = full.session.project.views[1].image
    for _ in range(2):
        full.images.exclude([image])
    palette = open_palette(full, qtbot)
    palette.search.setText("undo")
    row = palette.list.visualItemRect(palette.list.topLevelItem(0))
    qtbot.mouseClick(palette.list.viewport(), Qt.MouseButton.LeftButton, pos=row.center())
    palette.list.itemActivated.emit(palette.list.topLevelItem(0), 0)
    assert not palette.isVisible()
    assert full.session.document.undo_label.startswith("Exclude")
    assert full.session.document.redo_label.startswith("Exclude")
    full.session.document.redo()
    assert not full.session.document.redo_label  # only one was taken back


def test_arrow_keys_move_while_one_types(full: MainWindow, qtbot: QtBot) -> None:
    palette = open_palette(full, qtbot)
    qtbot.keyClick(palette.search, Qt.Key.Key_Down)
    assert palette.list.currentItem() is palette.list.topLevelItem(1)
    assert palette.about.text() == find_action(full, "Open project…").toolTip()
    palette.reject()


def test_what_can_do_nothing_says_why_and_does_not_run(window: MainWindow, qtbot: QtBot) -> None:
    palette = open_palette(window, qtbot)
    palette.search.setText("export")
    assert "Nothing is calibrated yet" in palette.about.text()
    qtbot.keyClick(palette.search, Qt.Key.Key_Return)
    assert palette.isVisible()
    palette.reject()


def test_every_disabled_action_says_why(window: MainWindow) -> None:
    disabled = [
        action
        for menu in window.menuBar().findChildren(QMenu)
        for action in menu.actions()
        if not action.isSeparator() and action.menu() is None and not action.isEnabled()
    ]
    assert {strip_mnemonic(a.text()) for a in disabled} >= {"Undo", "Redo", "Export…", "Mark board"}
    for action in disabled:
        assert action.toolTip().count("\n") == 1, action.text()
        assert action.toolTip().endswith((".", "first.")), action.text()


def test_the_reason_goes_when_the_action_can_be_chosen(full: MainWindow) -> None:
    tip = "Write the camera for OpenCV, ROS, MATLAB or another program (Ctrl+E)"
    assert find_action(full, "Export…").toolTip() == tip


PARTS: dict[str, Callable[[MainWindow], QWidget]] = {
    "list": lambda window: window.images.list,
    "modes": lambda window: window.header.modes,
    "canvas": lambda window: window.page.canvas,
    "calibrate": lambda window: window.calibrate,
    "results": lambda window: window.inspector.camera.results,
    "panels": lambda window: window.need_analysis().show_panel(StageOnePanel).table,
}


def test_shortcuts_work_wherever_the_focus_is(full: MainWindow, qtbot: QtBot) -> None:
    searched: list[list[str]] = []
    full.images.search_wanted.disconnect()
    full.images.search_wanted.connect(searched.append)
    full.session.select(full.session.project.views[0].image)
    for part, find_widget in PARTS.items():
        widget = find_widget(full)
        full.activateWindow()  # what closes leaves no window active
        widget.setFocus()
        qtbot.waitUntil(widget.hasFocus)
        searched.clear()
        qtbot.keyClick(widget, Qt.Key.Key_F5)
        assert searched == [full.images.chosen], part
        open_palette(full, qtbot).reject()
