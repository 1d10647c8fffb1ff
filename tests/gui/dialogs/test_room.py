"""Every dialog has room for its texts on a small screen."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSize
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


def test_no_text_is_clipped(full: MainWindow, qtbot: QtBot) -> None:
    jobs, result = full.session.jobs, full.session.result
    assert result is not None
    dialogs = (
        ExportDialog(jobs, result, full),
        PrintDialog(full.session.project.board, full),
        SeriesDialog(jobs, full),
        HandEyeDialog(jobs, result, full),
        FleetDialog(Path("f.db"), make_overview([]), lambda *_: False, full),
        ManualDialog(full),
        BugDialog(ValueError("by design"), full),
    )
    for dialog in dialogs:
        qtbot.addWidget(dialog)
        dialog.show()
        qtbot.waitUntil(lambda: not jobs.running, timeout=60_000)
        for size in (dialog.size(), dialog.size().boundedTo(SMALL)):
            dialog.resize(size)
            assert dialog.size() == size
            assert list_clipped(dialog, qtbot) == [], type(dialog).__name__
        dialog.close()
