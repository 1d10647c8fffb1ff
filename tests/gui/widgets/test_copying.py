"""The table or plot in sight is copied from the menu."""

from __future__ import annotations

from PySide6.QtGui import QAction, QGuiApplication
from PySide6.QtWidgets import QMenu
from pytestqt.qtbot import QtBot

from calibgui.gui.panels.evidence.poses import PosesPanel
from calibgui.gui.panels.evidence.residuals import ResidualsPanel
from calibgui.gui.panels.method.stage_one import StageOnePanel
from calibgui.gui.panels.panel import Panel
from calibgui.gui.widgets.tables import Table
from calibgui.gui.window.main_window import MainWindow


def find_command(window: MainWindow, text: str) -> QAction:
    """An action of the menu Edit, as it is when the menu has opened."""
    menu = window.menuBar().actions()[1].menu()
    assert isinstance(menu, QMenu)
    menu.aboutToShow.emit()
    return next(action for action in menu.actions() if action.text().replace("&", "") == text)


def show(window: MainWindow, qtbot: QtBot, kind: type[Panel]) -> Panel:
    panel = window.need_analysis().show_panel(kind)
    qtbot.waitUntil(panel.isVisible)
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    return panel


def test_the_table_in_sight_is_copied(full: MainWindow, qtbot: QtBot) -> None:
    panel = show(full, qtbot, StageOnePanel)
    table = next(table for table in panel.findChildren(Table) if table.isVisible())
    command = find_command(full, "Copy table")
    assert command.isEnabled()
    command.trigger()
    assert QGuiApplication.clipboard().text() == table.as_csv("\t")


def test_the_plot_in_sight_is_copied(full: MainWindow, qtbot: QtBot) -> None:
    panel = show(full, qtbot, PosesPanel)
    assert isinstance(panel, PosesPanel)
    find_command(full, "Copy plot as picture").trigger()
    copied = QGuiApplication.clipboard().image()
    assert copied.size() == panel.space.size() * panel.space.devicePixelRatio()
    show(full, qtbot, ResidualsPanel)
    find_command(full, "Copy plot as picture").trigger()
    assert QGuiApplication.clipboard().image() != copied


def test_without_one_in_sight_the_menu_says_so(full: MainWindow, qtbot: QtBot) -> None:
    show(full, qtbot, PosesPanel)
    command = find_command(full, "Copy table")
    assert not command.isEnabled()
    assert "No table is in sight" in command.toolTip()
