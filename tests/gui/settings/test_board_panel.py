"""The board's pattern is chosen with real clicks, kept by undo, saved, and searched for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QSignalSpy, QTest
from PySide6.QtWidgets import QApplication, QComboBox, QFileDialog
from pytestqt.qtbot import QtBot

from calibgui.app.photographs.interlacing import INTERLACED
from calibgui.app.projects.document import Document
from calibgui.app.projects.project import change_views, set_grid_size
from calibgui.app.projects.project_file import read_project, write_project
from calibgui.dataset import ViewStatus
from calibgui.engine.boards import KINDS
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.listed_circles import ListedCircles
from calibgui.engine.images import Field
from calibgui.gui.dialogs.print_dialog import PrintDialog
from calibgui.gui.session.session import Session, make_empty_document
from calibgui.gui.settings.board_panel import BoardPanel
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples


@pytest.fixture
def session(qapp: QApplication) -> Iterator[Session]:
    session = Session(qapp)
    yield session
    session.jobs.close()
    session.deleteLater()


@pytest.fixture
def panel(session: Session) -> Iterator[BoardPanel]:
    panel = BoardPanel(session)
    panel.show()
    yield panel
    panel.close()
    panel.deleteLater()


def choose(box: QComboBox, row: int) -> None:
    """Step to a row with the keyboard, as a user does."""
    box.setFocus()
    while box.currentIndex() != row:
        QTest.keyClick(box, Qt.Key.Key_Down if box.currentIndex() < row else Qt.Key.Key_Up)


def test_what_was_read_of_a_pattern_is_said(
    session: Session, panel: BoardPanel, tmp_path: Path
) -> None:
    project, read = examples.calibrated(tmp_path), Charuco("DICT_4X4_50", 0.7, legacy=False)
    views = tuple(
        replace(view, corners=view.corners and replace(view.corners, pattern=read))
        for view in project.views
    )
    session.begin(Document(replace(project, views=views, pattern=Charuco())))
    assert "6 × 7 inner corners, DICT_4X4_50, markers 0.70" in panel.pattern.kind.toolTip()
    session.begin(Document(project))
    assert panel.pattern.kind.toolTip() == "What is printed on the board."


def test_all_fields_begin_in_one_column(panel: BoardPanel, qtbot: QtBot) -> None:
    pattern = panel.pattern

    def list_columns(kind: str) -> set[int]:
        last = pattern.corner_squares if kind == "aprilgrid" else pattern.kind
        fields = (pattern.kind, last, panel.rows, panel.square)
        return {field.mapTo(panel, QPoint()).x() for field in fields}

    for row, kind in enumerate(KINDS):
        choose(pattern.kind, row)
        qtbot.waitUntil(lambda kind=kind: len(list_columns(kind)) == 1)


def test_a_charuco_board_is_described(session: Session, panel: BoardPanel, tmp_path: Path) -> None:
    searched = QSignalSpy(panel.search_wanted)
    chosen = panel.pattern
    assert not chosen.dictionary.isVisible()
    choose(chosen.kind, 1)
    assert session.project.pattern == Charuco()
    assert chosen.dictionary.isVisible()
    assert not chosen.diameter.isVisible()
    choose(chosen.dictionary, 2)
    chosen.marker.setFocus()
    chosen.marker.selectAll()
    QTest.keyClicks(chosen.marker, "15")
    QTest.keyClick(chosen.marker, Qt.Key.Key_Return)
    choose(chosen.layout_used, 2)
    stated = session.project.pattern
    assert isinstance(stated, Charuco)
    assert stated.dictionary == chosen.dictionary.currentData()
    assert stated.marker == pytest.approx(0.5)
    assert stated.legacy is True
    assert searched.count() >= 4
    # The marker stays as large when the squares are stated to be larger.
    panel.square.setValue(40.0)
    changed = session.project.pattern
    assert isinstance(changed, Charuco)
    assert changed.marker == pytest.approx(0.375)
    assert chosen.marker.value() == pytest.approx(15.0)
    write_project(session.project, tmp_path / "project.json")
    assert read_project(tmp_path / "project.json").pattern == changed
    while session.document.undo_label:
        session.document.undo()
    assert session.project.pattern == CHECKERBOARD
    assert chosen.kind.currentData() == "checkerboard"


def test_the_size_of_another_kind_of_board_does_not_stay(
    session: Session, panel: BoardPanel
) -> None:
    choose(panel.pattern.kind, 3)
    assert session.project.pattern == Circles(asymmetric=True)
    assert panel.counted.text() == "Circles"
    panel.inferred.click()
    for _ in type_size(panel, "11", "4"):
        pass
    assert session.project.grid_size == (11, 4)
    choose(panel.pattern.kind, 0)
    assert session.project.grid_size is None


def test_every_pattern_can_be_printed(qapp: QApplication) -> None:
    dialog = PrintDialog(Board(6, 9, 12.0))
    dialog.show()
    for row in range(4):
        choose(dialog.pattern.kind, row)
        qapp.processEvents()
        content = dialog.make_sheet()
        assert dialog.save.isEnabled()
        assert bool(content.discs) == (row >= 2)
        assert dialog.preview._drawing.isValid()
        fields = (dialog.pattern.kind, dialog.rows, dialog.square, dialog.paper)
        assert len({field.mapTo(dialog, QPoint()).x() for field in fields}) == 1
    dialog.close()
    dialog.deleteLater()


def test_how_corners_are_located_is_kept_and_undone(
    session: Session, panel: BoardPanel, tmp_path: Path
) -> None:
    session.begin(Document(examples.calibrated(tmp_path)))
    found = session.project.views
    searched = QSignalSpy(panel.search_wanted)
    choose(panel.method, 1)
    assert session.project.method == "saddle"
    assert {view.status for view in session.project.views} == {ViewStatus.WAITING}
    assert searched.count() == 1
    assert session.document.undo_label == "Way to locate corners"
    write_project(session.project, tmp_path / "project.json")
    assert read_project(tmp_path / "project.json").method == "saddle"
    session.document.undo()
    assert session.project.views is found
    assert panel.method.currentData() == session.project.method == "edges"
    choose(panel.pattern.kind, 2)
    assert not panel.method.isVisible(), "circles have but one"


def type_size(panel: BoardPanel, rows: str, cols: str) -> Iterator[str]:
    """Type both numbers with Tab between them; what has been done is yielded after each step."""
    panel.rows.setFocus()
    panel.rows.selectAll()
    QTest.keyClicks(panel.rows, rows)
    yield "rows"
    QTest.keyClick(panel.rows, Qt.Key.Key_Tab)
    yield "tab"
    panel.cols.selectAll()
    QTest.keyClicks(panel.cols, cols)
    yield "columns"
    QTest.keyClick(panel.cols, Qt.Key.Key_Return)
    yield "return"


def test_a_size_is_stated_when_both_numbers_are_typed(
    session: Session, panel: BoardPanel, tmp_path: Path
) -> None:
    session.begin(Document(examples.calibrated(tmp_path)))
    panel.activateWindow()
    searched = QSignalSpy(panel.search_wanted)
    panel.inferred.click()
    assert session.project.grid_size == (6, 7) and searched.count() == 0
    first = [session.project.views[0].image]
    for done in type_size(panel, "8", "9"):
        if done == "return":
            break
        assert session.project.grid_size == (6, 7), f"half a size after {done}"
        # A finding of the search that runs does not take back what is being typed.
        session.document.learn(lambda p: change_views(p, first, lambda v: replace(v, note="new")))
        assert panel.rows.value() == 8
    assert session.project.grid_size == (8, 9)
    assert searched.count() == 1
    assert {view.status for view in session.project.views} == {ViewStatus.WAITING}
    session.document.undo()
    assert (panel.rows.value(), panel.cols.value()) == (6, 7)


def test_a_size_that_nobody_has_seen_is_not_stated_by_a_click(
    session: Session, panel: BoardPanel
) -> None:
    panel.activateWindow()
    panel.inferred.click()
    assert session.project.grid_size is None and panel.rows.text() == "–"
    assert panel.rows.isEnabled() and panel.rows.hasFocus()
    for _ in type_size(panel, "2", "5"):
        pass
    assert session.project.grid_size == (2, 5)
    panel.inferred.click()
    assert session.project.grid_size is None and not panel.rows.isEnabled()


def test_counting_again_searches_where_the_stated_size_was_not_found(
    session: Session, panel: BoardPanel, tmp_path: Path
) -> None:
    session.begin(Document(set_grid_size(examples.calibrated(tmp_path), (8, 9))))
    session.document.learn(
        lambda p: replace(
            p, views=tuple(replace(v, status=ViewStatus.NO_BOARD, reason="No.") for v in p.views)
        )
    )
    searched = QSignalSpy(panel.search_wanted)
    panel.inferred.click()
    assert {view.status for view in session.project.views} == {ViewStatus.WAITING}
    assert searched.count() == 1


def test_the_shortcut_calibrates_with_the_size_that_was_typed(
    full: MainWindow, qtbot: QtBot
) -> None:
    full.activateWindow()
    full.show_setup()
    full.board.inferred.click()
    for done in type_size(full.board, "8", "9"):
        if done == "columns":
            break
    assert full.board.cols.hasFocus() and full.session.project.grid_size == (6, 7)
    QTest.keyClick(full.board.cols, Qt.Key.Key_F9)
    assert full.session.project.grid_size == (8, 9)
    qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)


def test_marking_by_hand_is_for_one_project(session: Session, panel: BoardPanel) -> None:
    """Photographs that are dropped on a new one are searched, whatever the last one was."""
    panel.by_hand.click()
    assert session.project.by_hand and panel.by_hand.isChecked()
    session.begin(make_empty_document())
    assert not session.project.by_hand and not panel.by_hand.isChecked()


def test_how_uncertain_squares_are_is_stated_beside_their_side(
    session: Session, panel: BoardPanel
) -> None:
    panel.square_sigma.setValue(0.02)
    assert session.project.square_sigma == 0.02
    choose(panel.unit, 1)  # centimetres: both numbers stay as typed
    assert session.project.square_sigma == pytest.approx(0.2)
    assert panel.square_sigma.value() == pytest.approx(0.02)
    while session.document.undo_label:
        session.document.undo()
    assert session.project.square_sigma == 0.0 and panel.square_sigma.text() == "exact"


def test_a_field_of_interlaced_frames_is_chosen(
    session: Session, panel: BoardPanel, tmp_path: Path
) -> None:
    """The choice is there where frames are interlaced; undo takes it back."""
    session.begin(Document(examples.calibrated(tmp_path)))
    assert not panel.field.isVisible()
    session.edit(
        "", lambda p: change_views(p, [p.views[0].image], lambda v: replace(v, note=INTERLACED))
    )
    assert panel.field.isVisible()
    wanted = QSignalSpy(panel.search_wanted)
    choose(panel.field, 1)
    QTest.keyClick(panel.field, Qt.Key.Key_Return)
    assert wanted.count() == 1
    assert session.project.field is Field.ODD
    assert all(view.field is Field.ODD for view in session.project.views)
    write_project(session.project, tmp_path / "p.calib")
    assert read_project(tmp_path / "p.calib").field is Field.ODD
    session.document.undo()
    assert session.project.field is None and panel.field.currentIndex() == 0


def test_circles_of_a_list_are_chosen_by_their_file(
    session: Session, panel: BoardPanel, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The list states the lengths; rows and columns are not asked for. Undo takes it back."""
    choose(panel.pattern.kind, list(KINDS).index("listed-circles"))
    assert panel.pattern.layout_file.isVisible() and not panel.rows.isVisible()
    file = tmp_path / "board.csv"
    file.write_text("x,y\n0,0\n20,0\n0,30\n20,30\n")
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(file), ""))
    wanted, failed = QSignalSpy(panel.search_wanted), QSignalSpy(session.failed)
    QTest.mouseClick(panel.pattern.layout_file, Qt.MouseButton.LeftButton)
    project = session.project
    assert isinstance(project.pattern, ListedCircles) and len(project.pattern.grid) == 4
    assert project.square == 20.0 and project.lengths_confirmed
    assert wanted.count() == 1 and "4" in panel.pattern.layout_file.text()
    panel.pattern.diameter.setValue(9.0)
    assert session.project.pattern == ListedCircles(project.pattern.places, 9.0 / 20.0)
    file.write_text("u,v\n0,0\n")
    QTest.mouseClick(panel.pattern.layout_file, Qt.MouseButton.LeftButton)
    assert failed.count() == 1
    session.document.undo()
    session.document.undo()
    assert session.project.pattern == ListedCircles()
