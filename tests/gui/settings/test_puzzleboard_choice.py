"""A PuzzleBoard's first corner is stated with real keys, kept by undo, saved, and printed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QSpinBox

from calibgui.app.projects.project_file import read_project, write_project
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from calibgui.gui.dialogs.print_dialog import PrintDialog
from calibgui.gui.session.session import Session
from calibgui.gui.settings.board_panel import BoardPanel
from calibgui.gui.settings.pattern_choice import PatternChoice


@pytest.fixture
def session(qapp: QApplication) -> Iterator[Session]:
    session = Session(qapp)
    yield session
    session.jobs.close()
    session.deleteLater()


def _choose_puzzleboard(choice: PatternChoice) -> None:
    choice.kind.setFocus()
    while choice.kind.currentData() != "puzzleboard":
        QTest.keyClick(choice.kind, Qt.Key.Key_Down)


def _type(box: QSpinBox, text: str) -> None:
    """Type one less and step up: in a dialog Return would press its button."""
    box.setFocus()
    box.selectAll()
    QTest.keyClicks(box, str(int(text) - 1))
    QTest.keyClick(box, Qt.Key.Key_Up)


def test_the_first_corner_is_stated(session: Session, tmp_path: Path) -> None:
    panel = BoardPanel(session)
    panel.show()
    choice = panel.pattern
    assert not choice.origin.isVisible()
    _choose_puzzleboard(choice)
    assert session.project.pattern == PuzzleBoard()
    assert choice.origin.isVisible()
    _type(choice.first_row, "50")
    _type(choice.first_col, "100")
    assert session.project.pattern == PuzzleBoard((50, 100))
    write_project(session.project, tmp_path / "project.json")
    assert read_project(tmp_path / "project.json").pattern == PuzzleBoard((50, 100))
    session.document.undo()
    assert choice.first_col.value() == 0
    while session.document.undo_label:
        session.document.undo()
    assert session.project.pattern == CHECKERBOARD
    assert not choice.origin.isVisible()
    panel.close()
    panel.deleteLater()


def test_it_can_be_printed(qapp: QApplication) -> None:
    dialog = PrintDialog(Board(6, 9, 12.0))
    dialog.show()
    _choose_puzzleboard(dialog.pattern)
    qapp.processEvents()
    page = dialog.make_sheet()
    assert page.discs
    assert page.white_discs
    assert dialog.save.isEnabled()
    _type(dialog.pattern.first_row, "498")
    assert "leaves the pattern" in dialog.words.text()
    assert not dialog.save.isEnabled()
    dialog.close()
    dialog.deleteLater()
