"""What is known of a board's tags is stated in the window with real keys, saved, and printed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox

from calibgui.app.projects.project_file import read_project, write_project
from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.gui.dialogs.print_dialog import PrintDialog
from calibgui.gui.session.session import Session
from calibgui.gui.settings.board_panel import BoardPanel


@pytest.fixture
def session(qapp: QApplication) -> Iterator[Session]:
    session = Session(qapp)
    yield session
    session.jobs.close()
    session.deleteLater()


def _choose(combo: QComboBox, wanted: object) -> None:
    combo.setFocus()
    for _ in range(combo.count()):
        if combo.currentData() == wanted:
            return
        QTest.keyClick(combo, Qt.Key.Key_Down)
    assert combo.currentData() == wanted


def test_tags_are_stated(session: Session, tmp_path: Path) -> None:
    panel = BoardPanel(session)
    panel.show()
    choice = panel.pattern
    _choose(choice.kind, "aprilgrid")
    assert session.project.pattern == AprilGrid()
    assert choice.spacing.isVisible()
    assert not choice.step.isVisible()
    assert panel.side.text() == "Tag"
    _choose(choice.family, "t25h9")
    _choose(choice.border, 1)
    _choose(choice.order, True)
    choice.spacing.setFocus()
    choice.spacing.selectAll()
    QTest.keyClicks(choice.spacing, "0.25\r")
    _choose(choice.corner_squares, False)
    choice.first_tag.setFocus()
    choice.first_tag.selectAll()
    QTest.keyClicks(choice.first_tag, "12\r")
    stated = AprilGrid("t25h9", 0.25, 1, True, False, 12)
    assert session.project.pattern == stated
    write_project(session.project, tmp_path / "project.json")
    assert read_project(tmp_path / "project.json").pattern == stated
    _choose(choice.kind, "tagged-checkerboard")
    assert choice.step.isVisible()
    assert not choice.spacing.isVisible()
    choice.step.setFocus()
    QTest.keyClick(choice.step, Qt.Key.Key_Up)
    assert session.project.pattern == TaggedCheckerboard(step=2)
    panel.deleteLater()


def test_tags_are_counted_for_the_printer(qapp: QApplication) -> None:
    del qapp
    dialog = PrintDialog(Board(8, 6, 30.0, AprilGrid("t36h11", 0.3, 2, False)), None)
    assert (dialog.rows.value(), dialog.cols.value()) == (4, 3)
    assert dialog.counted.text() == "Tags"
    sheet = dialog.make_sheet()
    assert "AprilGrid of 4 × 3 tags" in sheet.lines[1]
    assert "tags of 30 mm" in sheet.lines[1]
    dialog.deleteLater()
