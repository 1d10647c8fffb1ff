"""Every dialog has room for its texts on a small screen."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QSize
from PySide6.QtWidgets import QDialog
from pytestqt.qtbot import QtBot

from calibgui.gui.dialogs.bug_dialog import BugDialog
from calibgui.gui.dialogs.export_dialog import ExportDialog
from calibgui.gui.dialogs.fleet_dialog import FleetDialog
from calibgui.gui.dialogs.hand_eye_dialog import HandEyeDialog
from calibgui.gui.dialogs.manual_dialog import ManualDialog
from calibgui.gui.dialogs.print_dialog import PrintDialog
from calibgui.gui.dialogs.series_dialog import SeriesDialog
from calibgui.gui.window.main_window import MainWindow
from calibgui.report.fleet_overview import make_overview
from tests.gui.window.test_desk import list_clipped

SMALL = QSize(870, 470)
"""What a dialog may take of a screen of 1366 x 768 px at 1.5 times the scale."""


def make_export(window: MainWindow) -> QDialog:
    assert window.session.result is not None
    return ExportDialog(window.session.jobs, window.session.result, window)


def make_hand_eye(window: MainWindow) -> QDialog:
    assert window.session.result is not None
    return HandEyeDialog(window.session.jobs, window.session.result, window)


@pytest.mark.parametrize(
    "make",
    [
        make_export,
        lambda window: PrintDialog(window.session.project.board, window),
        lambda window: SeriesDialog(window.session.jobs, window),
        make_hand_eye,
        lambda window: FleetDialog(Path("f.db"), make_overview([]), lambda *_: False, window),
        lambda window: ManualDialog(window),
        lambda window: BugDialog(ValueError("by design"), window),
    ],
    ids=["export", "print", "series", "hand-eye", "fleet", "manual", "bug"],
)
def test_no_text_is_clipped(
    full: MainWindow, qtbot: QtBot, make: Callable[[MainWindow], QDialog]
) -> None:
    dialog = make(full)
    qtbot.addWidget(dialog)
    dialog.show()
    qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)
    for size in (dialog.size(), dialog.size().boundedTo(SMALL)):
        dialog.resize(size)
        assert dialog.size() == size
        assert list_clipped(dialog, qtbot) == []
