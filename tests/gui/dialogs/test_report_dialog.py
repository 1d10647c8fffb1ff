"""The report's dialog: what is typed is kept with the project, and stands in the file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QFileDialog
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.dataset.details import Details
from calibgui.gui.dialogs.report_dialog import ReportDialog
from calibgui.gui.session.session import Session


@pytest.fixture
def session(qapp: QApplication) -> Iterator[Session]:
    session = Session(qapp)
    yield session
    session.jobs.close()
    session.deleteLater()


@pytest.fixture
def dialog(session: Session, result: Result, qtbot: QtBot) -> ReportDialog:
    session.edit("before", lambda p: replace(p, details=Details(lens="16 mm")))
    made = ReportDialog(session, result)
    qtbot.addWidget(made)
    made.show()
    return made


def test_there_is_a_box_for_every_detail(dialog: ReportDialog) -> None:
    assert list(dialog.boxes) == [field.name for field in fields(Details)]
    assert dialog.details == Details(lens="16 mm")


def test_what_is_typed_is_kept_and_printed(
    dialog: ReportDialog,
    session: Session,
    qtbot: QtBot,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    qtbot.keyClicks(dialog.boxes["operator"], "N. Nobody")
    dialog.layout_choice.setCurrentIndex(1)
    wanted = tmp_path / "certificate.html"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(wanted), ""))
    with qtbot.waitSignal(dialog.written, timeout=30_000):
        qtbot.mouseClick(dialog.save, Qt.MouseButton.LeftButton)
    page = wanted.read_text(encoding="utf-8")
    assert "Calibration certificate" in page and "N. Nobody" in page and "16 mm" in page
    assert session.project.details == Details(operator="N. Nobody", lens="16 mm")
    session.document.undo()
    assert session.project.details == Details(lens="16 mm")


def test_closing_keeps_what_was_typed(dialog: ReportDialog, session: Session) -> None:
    dialog.boxes["place"].setText("Room 3")
    dialog.reject()
    assert session.project.details.place == "Room 3"


def test_what_cannot_be_written_is_said(
    dialog: ReportDialog, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    wanted = tmp_path / "none" / "r.html"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(wanted), ""))
    qtbot.mouseClick(dialog.save, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: "none" in dialog.words.text(), timeout=30_000)
