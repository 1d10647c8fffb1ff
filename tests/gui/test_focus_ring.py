"""Whoever works with the keyboard sees where it is."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from calibgui.app.projects.recent import Recent
from calibgui.gui.panels.answer.uncertainty import UncertaintyPanel
from calibgui.gui.panels.evidence.poses import PosesPanel
from calibgui.gui.panels.method.distortion import DistortionPanel
from calibgui.gui.panels.method.lens_models import LensModelsPanel
from calibgui.gui.panels.method.stage_one import StageOnePanel
from calibgui.gui.panels.panel import Panel
from calibgui.gui.widgets.focus_ring import FocusRing
from calibgui.gui.window.main_window import MainWindow


def test_the_welcome_page_shows_which_of_its_entries_has_the_focus(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    window.welcome.show_recent([Recent(tmp_path / "camera.json", "")])
    QApplication.processEvents()
    window.activateWindow()
    qtbot.waitUntil(lambda: QApplication.activeWindow() is window)
    buttons = [b for b in window.welcome.findChildren(QPushButton) if b.isVisible()]
    assert len(buttons) == 7
    for button in buttons:
        button.clearFocus()
        before = button.grab().toImage()
        button.setFocus(Qt.FocusReason.TabFocusReason)
        assert button.grab().toImage() != before, button.text()
        button.clearFocus()
        assert button.grab().toImage() == before, button.text()


def test_wherever_tab_goes_the_focus_is_seen(full: MainWindow, qtbot: QtBot) -> None:
    full.activateWindow()
    qtbot.waitUntil(lambda: QApplication.activeWindow() is full)
    seen: dict[QWidget, bool] = {}
    for kind in (UncertaintyPanel, PosesPanel, StageOnePanel, LensModelsPanel, DistortionPanel):
        full.need_analysis().show_panel(kind)
        qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)
        analysis = full.need_analysis()
        qtbot.waitUntil(
            lambda analysis=analysis: (
                not analysis._waiting
                and all(panel.updatesEnabled() for panel in analysis.findChildren(Panel))
                and not full.session.jobs.running
            ),
            timeout=60_000,
        )
        full.images.list.setFocus(Qt.FocusReason.TabFocusReason)
        for _ in range(40):
            widget = QApplication.focusWidget()
            around = widget.parentWidget()
            focused = around.grab().toImage()
            qtbot.keyClick(widget, Qt.Key.Key_Tab)
            seen[widget] = around.grab().toImage() != focused
    assert len(seen) > 25
    assert [type(widget).__name__ for widget, is_seen in seen.items() if not is_seen] == []


def test_the_mouse_brings_no_ring(full: MainWindow, qtbot: QtBot) -> None:
    full.activateWindow()
    qtbot.waitUntil(lambda: QApplication.activeWindow() is full)
    canvas = full.page.canvas
    (ring,) = canvas.findChildren(FocusRing)
    qtbot.mouseClick(canvas.viewport(), Qt.MouseButton.LeftButton)
    assert canvas.hasFocus() and not ring.is_seen
    full.images.list.setFocus()
    canvas.setFocus(Qt.FocusReason.TabFocusReason)
    assert ring.is_seen
    canvas.clearFocus()
    assert not ring.is_seen
