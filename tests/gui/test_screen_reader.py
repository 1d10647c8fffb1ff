"""What a screen reader says: no control, table or list without a name."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QAccessible, QAccessibleInterface, QAction
from PySide6.QtWidgets import QAbstractButton, QAbstractScrollArea, QApplication, QComboBox, QWidget
from pytestqt.qtbot import QtBot

from calibgui.gui.dialogs.bug_dialog import BugDialog
from calibgui.gui.dialogs.export_dialog import ExportDialog
from calibgui.gui.dialogs.fleet_dialog import FleetDialog
from calibgui.gui.dialogs.hand_eye_dialog import HandEyeDialog
from calibgui.gui.dialogs.manual_dialog import ManualDialog
from calibgui.gui.dialogs.print_dialog import PrintDialog
from calibgui.gui.dialogs.series_dialog import SeriesDialog
from calibgui.gui.panels.analysis import PANELS
from calibgui.gui.window.main_window import MainWindow
from calibgui.gui.window.palette import Palette
from calibgui.report.fleet_overview import make_overview
from tests.gui.verdict.test_actions import CASES, begin

_Role = QAccessible.Role
_CONTROLS = {
    _Role.Button,
    _Role.ButtonDropDown,
    _Role.ButtonMenu,
    _Role.CheckBox,
    _Role.ComboBox,
    _Role.EditableText,
    _Role.List,
    _Role.PageTab,
    _Role.PushButton,
    _Role.RadioButton,
    _Role.Slider,
    _Role.SpinBox,
    _Role.Table,
    _Role.Tree,
}
"""Roles of what the user works with, or reads line by line."""


def walk(interface: QAccessibleInterface, path: str = "") -> Iterator[tuple[str, str]]:
    """Yield where each control is, in sight or not, and the name that a screen reader says."""
    thing = interface.object()
    kind = type(thing).__name__ if thing is not None else ""
    here = f"{path}/{kind or interface.role().name}"
    own = isinstance(thing, QWidget) and not thing.objectName().startswith("qt_")
    if own and interface.role() in _CONTROLS:
        yield here, interface.text(QAccessible.Text.Name)
    if interface.role() in (_Role.Table, _Role.List, _Role.Tree, _Role.ComboBox, _Role.SpinBox):
        return  # their parts are read as values
    for k in range(interface.childCount()):
        if (child := interface.child(k)) is not None:
            yield from walk(child, here)


def list_nameless(widget: QWidget) -> list[str]:
    interface = QAccessible.queryAccessibleInterface(widget)
    assert interface is not None
    found = list(walk(interface))
    assert found, "nothing is read at all"
    return [place for place, name in found if not name.strip()]


def list_nameless_stops(window: QWidget) -> list[str]:
    """List what the Tab key stops at without a name that a screen reader says."""
    stops = [
        widget
        for widget in window.findChildren(QWidget)
        if widget.isVisible()
        and widget.focusPolicy() & Qt.FocusPolicy.TabFocus
        and widget.focusProxy() is None
        and not isinstance(widget.parent(), QAbstractScrollArea)  # its viewport
    ]
    assert stops
    names = {w: QAccessible.queryAccessibleInterface(w).text(QAccessible.Text.Name) for w in stops}
    return [type(widget).__name__ for widget, name in names.items() if not name.strip()]


def test_the_empty_window(window: MainWindow) -> None:
    assert list_nameless(window) == []


def test_the_window_with_each_panel(full: MainWindow, qtbot: QtBot) -> None:
    for kind in PANELS:
        shown = full.need_analysis().show_panel(kind)
        qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)
        assert list_nameless(full) == [], kind.__name__
        assert list_nameless_stops(full) == [], kind.__name__
        for control in [*shown.findChildren(QAbstractButton), *shown.findChildren(QComboBox)]:
            if control.isVisible() and not control.objectName().startswith("qt_"):
                assert control.toolTip(), control


def test_the_bars_of_marking_the_dialogs_and_the_palette(full: MainWindow, qtbot: QtBot) -> None:
    full.page.marker.roi_bar.show()
    full.page.marker.corner_bar.show()
    full.banner.show_text("?", {"&Yes": lambda: None})
    assert list_nameless(full) == []
    result = full.session.result
    assert result is not None
    dialogs = (
        PrintDialog(full.session.project.board),
        ManualDialog(full),
        ExportDialog(full.session.jobs, result, full),
        SeriesDialog(full.session.jobs, full),
        HandEyeDialog(full.session.jobs, result, full),
        FleetDialog(Path("fleet.db"), make_overview([]), lambda *_: False, full),
        BugDialog(ValueError("by design"), full),
    )
    for dialog in dialogs:
        qtbot.addWidget(dialog)
        dialog.show()
        qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)
        assert list_nameless(dialog) == [], type(dialog).__name__
        dialog.close()
    find = next(a for a in full.findChildren(QAction) if a.shortcut().toString() == "Ctrl+Shift+P")
    find.trigger()
    palette = QApplication.activeModalWidget()
    assert isinstance(palette, Palette)
    assert list_nameless(palette) == []
    palette.close()


def test_the_findings_and_what_an_action_has_done(window: MainWindow, qtbot: QtBot) -> None:
    begin(window, qtbot, CASES["lens"].make())
    bar = window.verdict
    bar.unfold.click()
    bar.findings.rows[0].unfold.click()
    assert list_nameless(bar.findings) == []
    bar.button.click()
    qtbot.waitUntil(
        lambda: bar.comparison is not None and not window.session.jobs.running, timeout=60_000
    )
    assert bar.comparison is not None
    assert list_nameless(bar.comparison) == []
