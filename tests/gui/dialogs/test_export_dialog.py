"""The dialog shows what it saves, in every format."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.engine.errors import CalibrationError
from calibgui.formats import EXPORTERS, ExportReport
from calibgui.formats.camera_refit import express_in_format
from calibgui.gui.dialogs.export_dialog import ExportDialog
from calibgui.gui.jobs.jobs import Jobs


@pytest.fixture
def dialog(jobs: Jobs, result: Result, qtbot: QtBot) -> ExportDialog:
    made = ExportDialog(jobs, result)
    qtbot.addWidget(made)
    made.show()
    qtbot.waitUntil(lambda: not jobs.running)
    return made


def choose(dialog: ExportDialog, name: str, jobs: Jobs, qtbot: QtBot) -> None:
    """Walk down the list to a format."""
    dialog.formats.setCurrentRow(0)
    for _ in range(list(EXPORTERS).index(name)):
        qtbot.keyClick(dialog.formats, Qt.Key.Key_Down)
    qtbot.waitUntil(lambda: not jobs.running)


def test_shows_and_copies_the_file(
    dialog: ExportDialog, result: Result, jobs: Jobs, qtbot: QtBot, tmp_path: Path
) -> None:
    dialog.formats.setCurrentRow(0)
    for exporter in EXPORTERS.values():
        qtbot.waitUntil(lambda: not jobs.running, timeout=60_000)
        report = exporter.write(result, tmp_path / exporter.file_name)
        text = report.path.read_bytes().decode(errors="replace")
        is_text = "\ufffd" not in text
        if is_text:
            assert dialog.text.toPlainText().removesuffix("\n…") == text[:20_000]
        else:
            assert dialog.text.toPlainText().startswith("A binary file of ")
        shown = [label.text() for label in (dialog.readers, dialog.keeps, dialog.loses)]
        assert shown == [exporter.readers, exporter.keeps, exporter.loses]
        assert dialog.note.text() == report.note
        assert dialog.copy.isEnabled() is is_text
        if is_text:
            qtbot.mouseClick(dialog.copy, Qt.MouseButton.LeftButton)
            assert QGuiApplication.clipboard().text() == text
        qtbot.keyClick(dialog.formats, Qt.Key.Key_Down)


def test_tells_the_refits_largest_error(
    dialog: ExportDialog, result: Result, jobs: Jobs, qtbot: QtBot
) -> None:
    choose(dialog, "opencv", jobs, qtbot)
    error = express_in_format(result, EXPORTERS["opencv"]).largest_error
    assert dialog.error.text() == f"{error:.3g} px over the whole image"
    choose(dialog, "python", jobs, qtbot)
    assert dialog.error.text() == "none: nothing is refitted"
    assert "unlimited" in dialog._error(float("nan"))


def test_saves_under_the_chosen_name_and_begins_with_its_format_next_time(
    dialog: ExportDialog,
    result: Result,
    jobs: Jobs,
    qtbot: QtBot,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    choose(dialog, "ros", jobs, qtbot)
    wanted = tmp_path / "camera_info"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(wanted), ""))
    with qtbot.waitSignal(dialog.exported) as signal:
        qtbot.mouseClick(dialog.save, Qt.MouseButton.LeftButton)
    assert signal.args[0].path == wanted.with_suffix(".yaml")
    assert "camera_matrix" in wanted.with_suffix(".yaml").read_text()
    assert "Saved as" in dialog.saved.text()
    again = ExportDialog(jobs, result)
    qtbot.addWidget(again)
    assert again.exporter.name == "ros"
    qtbot.waitUntil(lambda: not jobs.running)
    again.reject()


def test_saves_all_formats_in_a_folder(
    dialog: ExportDialog,
    jobs: Jobs,
    qtbot: QtBot,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_: "")
    qtbot.mouseClick(dialog.save_all, Qt.MouseButton.LeftButton)
    assert not jobs.running
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_: str(tmp_path))
    qtbot.mouseClick(dialog.save_all, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not jobs.running, timeout=60_000)
    assert f"of {len(EXPORTERS)} formats are in {tmp_path}" in dialog.saved.text()
    assert (tmp_path / "README.md").is_file() and (tmp_path / "opencv.yaml").is_file()


def test_a_wrong_suffix_is_explained(
    dialog: ExportDialog,
    jobs: Jobs,
    qtbot: QtBot,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path / "a.txt"), ""))
    qtbot.mouseClick(dialog.save, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not jobs.running)
    assert "Give it the suffix .json" in dialog.saved.text()
    assert not list(tmp_path.iterdir())


def test_a_format_that_fails_says_why(jobs: Jobs, result: Result, qtbot: QtBot) -> None:
    """Corners that are not numbers cannot be refitted."""
    few = tuple(
        replace(v, points=v.observation(result.board)._replace(uv=np.full((108, 2), np.nan)))
        if v.usable
        else v
        for v in result.views
    )
    dialog = ExportDialog(jobs, Result(result.calibration, few))
    qtbot.addWidget(dialog)
    dialog.show()
    choose(dialog, "opencv", jobs, qtbot)
    assert "not a finite number" in dialog.note.text()
    assert not dialog.save.isEnabled() and not dialog.copy.isEnabled()
    dialog.reject()


def test_a_refusal_names_the_file_without_the_drafts_folder(
    dialog: ExportDialog, jobs: Jobs, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(_: Result, path: Path) -> ExportReport:
        raise CalibrationError(f"{path} is not written: it cannot be.", "Take another format.")

    refusing = replace(EXPORTERS["lensfun"], write=refuse)
    monkeypatch.setitem(EXPORTERS, "lensfun", refusing)
    choose(dialog, "lensfun", jobs, qtbot)
    assert dialog.note.text().startswith("camera.xml is not written: it cannot be.")


def test_closing_removes_the_drafts(dialog: ExportDialog, qtbot: QtBot) -> None:
    folder = Path(dialog._folder.name)
    assert list(folder.iterdir())
    qtbot.keyClick(dialog, Qt.Key.Key_Escape)
    assert not dialog.isVisible() and not folder.exists()
