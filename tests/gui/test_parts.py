"""The parts around the canvas: board, results, messages, dialogs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, QRect, Qt, QUrl
from PySide6.QtGui import QDropEvent, QGuiApplication
from PySide6.QtWidgets import (
    QApplication,
    QFileDialog,
    QInputDialog,
    QMessageBox,
    QWidget,
)
from pytestqt.qtbot import QtBot

from calibgui.app.projects.document import Document
from calibgui.app.projects.project import Unit, change_views
from calibgui.app.projects.project_file import write_project
from calibgui.app.projects.recent import list_recent
from calibgui.dataset import View, ViewStatus
from calibgui.engine.calibration.result import Status
from calibgui.engine.errors import CalibrationError
from calibgui.gui.dialogs.bug_dialog import BugDialog
from calibgui.gui.dialogs.print_dialog import PrintDialog
from calibgui.gui.panels.answer.compare import ComparePanel
from calibgui.gui.panels.answer.result import ResultPanel
from calibgui.gui.panels.evidence.histograms import HistogramsPanel
from calibgui.gui.panels.evidence.poses import PosesPanel
from calibgui.gui.panels.evidence.residuals import ResidualsPanel
from calibgui.gui.panels.parts.split import Split
from calibgui.gui.widgets import questions, theme
from calibgui.gui.widgets.narrow_combo import NarrowCombo
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples

LEFT = Qt.MouseButton.LeftButton


def test_the_squares_side_keeps_its_length_in_every_unit(full: MainWindow, qtbot: QtBot) -> None:
    panel, session = full.board, full.session
    assert (panel.rows.value(), panel.cols.value()) == (6, 7)
    assert not panel.rows.isEnabled(), "what is counted is not stated"
    panel.square.selectAll()
    qtbot.keyClicks(panel.square, "25.4")
    assert session.project.square == pytest.approx(25.4)
    assert session.document.undo_label == "Size of squares"
    session.document.undo()
    assert session.project.square == 30.0, "typing is one step"
    session.document.redo()
    panel.unit.setCurrentText("inch")
    panel.unit.activated.emit(2)
    assert session.project.unit is Unit.INCH
    assert session.project.square == pytest.approx(25.4**2)
    session.document.undo()
    assert panel.square.value() == pytest.approx(25.4)


def test_stating_another_board_searches_again(full: MainWindow, qtbot: QtBot) -> None:
    panel = full.board
    qtbot.mouseClick(panel.inferred, LEFT, pos=QPoint(8, panel.inferred.height() // 2))
    assert full.session.project.grid_size == (6, 7)
    assert panel.rows.isEnabled()
    assert full.session.project.views[0].status is ViewStatus.FOUND, "it is the one that was found"
    with qtbot.waitSignal(panel.search_wanted):
        panel.rows.setValue(5)
        panel.rows.editingFinished.emit()
    assert full.session.project.grid_size == (5, 7)
    assert full.session.document.undo_label == "Number of corners"
    full.session.document.undo()
    assert full.session.project.views[0].corners is not None


def test_views_that_do_not_determine_the_camera_say_what_to_photograph(
    full: MainWindow, qtbot: QtBot
) -> None:
    session = full.session
    others = [view.image for view in session.project.views if view.usable][1:]

    def excluded(view: View) -> View:
        return replace(view, enabled=False)

    session.edit("Exclude", lambda p: change_views(p, others, excluded))
    qtbot.mouseClick(full.calibrate, LEFT)
    qtbot.waitUntil(lambda: len(session.project.results) == 3, timeout=30_000)
    assert session.result is not None
    assert session.result.calibration.status is Status.PARTIAL
    qtbot.waitUntil(lambda: full.verdict.verdict is not None)
    assert "One view does not determine a camera" in full.verdict.reason.text()
    assert "Add at least two more views" in full.verdict.reason.text()
    assert full.banner.isHidden(), "nothing is said twice"
    panel = full.need_analysis().show_panel(ResultPanel)
    qtbot.waitUntil(lambda: not session.jobs.running)
    assert "Assumed, as of an ordinary camera" in panel.words.toPlainText()


def test_results_are_chosen_compared_renamed_and_deleted(
    full: MainWindow, monkeypatch: pytest.MonkeyPatch
) -> None:
    analysis, session = full.need_analysis(), full.session
    assert session.result_name == "k3 held"
    analysis.compare_with("Calibration 1")
    assert analysis.panel(ComparePanel).names == ("Calibration 1", "k3 held")
    table = analysis.panel(ComparePanel).parameters.model()
    rows = {table.index(r, 0).data(): r for r in range(table.rowCount())}
    assert set(rows) >= {"fx", "k3"}
    camera = full.inspector.camera
    camera.results.setCurrentIndex(0)
    camera.results.activated.emit(0)
    assert session.result is session.project.results["Calibration 1"]
    monkeypatch.setattr(QInputDialog, "getText", lambda *_: ("all free", True))
    camera.rename_wanted.emit("Calibration 1")
    assert list(session.project.results) == ["all free", "k3 held"]
    assert set(analysis.panel(ComparePanel).names) == {"all free", "k3 held"}
    assert session.result_name == "all free"
    camera.delete_wanted.emit("all free")
    assert session.result_name == "k3 held"
    session.document.undo()
    assert list(session.project.results) == ["all free", "k3 held"]


def test_a_click_in_the_image_and_in_a_panel_select_the_same(full: MainWindow) -> None:
    panel = full.need_analysis().panel(ResultPanel)
    panel.picked.emit(3, 17)
    assert full.session.image.endswith("3.png")
    assert full.page.canvas.marks.chosen == 17
    assert full.images.list.currentIndex().data() == "3.png"


def test_a_board_and_its_image_are_pointed_at_together(full: MainWindow, qtbot: QtBot) -> None:
    analysis = full.need_analysis()
    poses = analysis.show_panel(PosesPanel)
    qtbot.waitUntil(poses.isVisible)
    view = full.images.list
    index = view.model().index(2, 0)
    qtbot.mouseMove(view.viewport(), view.visualRect(index).center())
    assert poses.space._under_cursor == 2
    bare = view.grab().toImage()
    poses.space.hovered.emit(4)
    assert full.images.list.hovered == full.session.project.views[4].image
    assert view.grab().toImage() != bare
    poses.space.hovered.emit(-1)
    assert full.images.list.hovered == ""


def test_the_caption_is_cut_to_the_picture_and_gives_way_to_the_cursor(
    full: MainWindow, qtbot: QtBot
) -> None:
    caption, port = full.page.caption, full.page.canvas.viewport()
    assert caption.text().startswith("0.png — 42 of 42 corners") and caption.isVisible()
    for at, is_left in ((QPoint(300, 200), True), (QPoint(4, 4), False), (QPoint(300, 200), True)):
        qtbot.mouseMove(port, at)
        qtbot.waitUntil(lambda is_left=is_left: (caption.x() < 20) is is_left)
        assert not caption.geometry().contains(at)
    caption.show_name(40 * "long ")
    assert "…" in caption.text() and caption.width() <= port.width()
    caption.show_name("")
    assert not caption.isVisible()


def test_dropped_and_pasted_paths_become_images(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    paths = [tmp_path / f"{k}.png" for k in range(3)]
    for path in paths:
        path.write_bytes(b"no image")
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path)) for path in paths[:2]])
    copy, move = Qt.DropAction.CopyAction, Qt.DropAction.MoveAction
    drop = QDropEvent(QPointF(200, 200), copy | move, data, LEFT, Qt.KeyboardModifier.NoModifier)
    drop.setDropAction(move)  # as file managers propose, who then may delete the files
    window.dropEvent(drop)
    assert drop.isAccepted() and drop.dropAction() is copy
    assert [Path(v.image).name for v in window.session.project.views] == ["0.png", "1.png"]
    QGuiApplication.clipboard().setText(f'"{paths[2]}"\n')
    window.files.paste()
    assert len(window.session.project.views) == 3
    qtbot.waitUntil(lambda: window.banner.isVisible(), timeout=30_000)
    assert [v.status for v in window.session.project.views] == [ViewStatus.UNREADABLE] * 3
    window.files.open_paths([str(tmp_path / "nowhere")])
    assert "does not exist" in window.banner.text.text()


def test_folders_below_a_dropped_one_are_said_not_to_be_read(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    for name in ("1.png", "clip.mp4", "left/1.png", "left/2.png", "right/1.png"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(b"no image")
    window.session.edit("By hand", lambda project: replace(project, by_hand=True))
    banner = window.banner

    def drop(*names: str) -> None:
        data = QMimeData()
        data.setUrls([QUrl.fromLocalFile(str(tmp_path / name)) for name in names])
        copy = Qt.DropAction.CopyAction
        modifier = Qt.KeyboardModifier.NoModifier
        window.dropEvent(QDropEvent(QPointF(200, 200), copy, data, LEFT, modifier))
        qtbot.waitUntil(lambda: not window.session.jobs.running)

    drop("right")
    assert not banner.isVisible(), "nothing lies below it"
    drop("", "clip.mp4")
    assert [Path(v.image).parent.name for v in window.session.project.views] == [
        "right",
        tmp_path.name,
    ]
    refused, unread = banner.text.text().split("\n")
    assert refused == "Not added, as no image can be read there: clip.mp4."
    assert unread.startswith(f"Not read: {tmp_path / 'left'} (2 images). Of a folder only")
    assert unread.endswith("add these folders as well if they are of the same camera and board.")
    qtbot.mouseClick(banner.dismiss, LEFT)
    drop("left")
    assert not banner.isVisible() and len(window.session.project.views) == 4


def test_a_selection_of_all_files_is_its_photographs_or_its_project(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    for name in ("1.png", "clip.mp4", "notes.json"):
        (tmp_path / name).write_bytes(b"{}")
    everything = [str(path) for path in sorted(tmp_path.iterdir())]
    window.files.open_paths(everything)
    assert [view.name for view in window.session.project.views] == ["1.png"]
    told = "Not added, as no image can be read there: clip.mp4, notes.json."
    assert window.banner.text.text() == told
    qtbot.waitUntil(lambda: "None of the photographs" in window.banner.text.text(), timeout=30_000)
    assert not window.verdict.square.isVisible(), "no board has been found"
    write_project(examples.calibrated(tmp_path), tmp_path / "project.json")
    window.session.document.undo()
    window.files.open_paths([*everything, str(tmp_path / "project.json")])
    qtbot.waitUntil(lambda: window.session.result is not None, timeout=30_000)


def test_what_one_can_click_is_said_where_it_is_there(full: MainWindow) -> None:
    session, page = full.session, full.page
    session.select(session.project.views[0].image)
    view = session.view
    assert view is not None and view.corners is not None
    (u, v), (row, column) = view.corners.uv[8], view.corners.grid[8]
    place = f"   corner: row {row}, column {column}; click to see its "
    assert page._board_index(u, v) == f"{place}residual"
    page.canvas.picked.emit(8)
    assert f"corner in row {row}, column {column}" in page.caption.text()
    assert "residual Δu" in page.caption.text()
    for name in list(session.project.results):
        full.files.delete_result(name)
    assert page._board_index(u, v) == f"{place}place"
    session.select(next(view.image for view in session.project.views if view.reason))
    assert page._board_index(u, v) == "", "there are no corners"


def test_a_message_to_the_window_leaves_what_is_said_of_the_image_in_sight(
    full: MainWindow, qtbot: QtBot
) -> None:
    page, session = full.page, full.session
    session.select(next(view.image for view in session.project.views if view.reason))
    full.banner.show_text("A message.")
    qtbot.waitUntil(page.reason.isVisible)
    qtbot.waitUntil(lambda: not rect_on(full, page.reason).intersects(rect_on(full, full.banner)))
    assert rect_on(full, page.canvas).contains(rect_on(full, page.reason))


def rect_on(window: MainWindow, widget: QWidget) -> QRect:
    """The place of a widget in the window."""
    return QRect(widget.mapTo(window, QPoint()), widget.size())


def test_the_sample_comes_with_its_squares(window: MainWindow) -> None:
    window.files.open_sample()
    assert window.board.square.value() == 25.0
    window.session.document.undo()
    assert window.board.square.value() == 30.0


def test_what_cannot_be_done_comes_with_a_remedy(window: MainWindow, qtbot: QtBot) -> None:
    window.show_failure(CalibrationError("It cannot be.", "Do otherwise."))
    assert window.banner.isVisible()
    assert window.banner.text.text() == "It cannot be.\nDo otherwise."
    qtbot.mouseClick(window.banner.dismiss, LEFT)
    assert not window.banner.isVisible()
    window.session.failed.emit(CalibrationError("It cannot be.", "Do otherwise."))
    window.session.edit("Set squares", lambda p: replace(p, square=p.square + 1))
    assert not window.banner.isVisible(), "the failure is past"


def test_a_bug_is_shown_with_its_traceback_and_the_work_is_kept(
    full: MainWindow, qtbot: QtBot
) -> None:
    full.images.exclude([full.session.image])

    def fails(_: object) -> None:
        raise ZeroDivisionError("by design")

    full.session.jobs.start("Failing", fails)
    qtbot.waitUntil(lambda: isinstance(QApplication.activeModalWidget(), BugDialog))
    dialog = QApplication.activeModalWidget()
    assert isinstance(dialog, BugDialog)
    qtbot.mouseClick(dialog.copy, LEFT)
    text = QGuiApplication.clipboard().text()
    assert "ZeroDivisionError: by design" in text
    assert "numpy" in text
    assert full.files.saver.file.with_name(f".{full.files.saver.file.name}.autosave").exists()
    dialog.close()


def test_a_bug_that_comes_again_is_shown_once(full: MainWindow) -> None:
    """One in what is painted comes again as soon as its dialog is closed."""

    def fail(why: str) -> None:
        try:
            raise ZeroDivisionError(why)
        except ZeroDivisionError as error:
            full.show_failure(error)

    fail("first")
    dialog = QApplication.activeModalWidget()
    assert isinstance(dialog, BugDialog)
    dialog.close()
    fail("second")
    assert QApplication.activeModalWidget() is None and not full.banner.isVisible()
    full.show_failure(ValueError("another"))
    dialog = QApplication.activeModalWidget()
    assert isinstance(dialog, BugDialog)
    dialog.close()


def test_work_that_fails_again_is_told_in_the_banner(full: MainWindow, qtbot: QtBot) -> None:
    """It ends without what the user asked for, and must not do so without a word."""

    def fails(_: object) -> None:
        raise ImportError("half a file")

    full.session.jobs.start("Failing", fails)
    qtbot.waitUntil(lambda: isinstance(QApplication.activeModalWidget(), BugDialog))
    dialog = QApplication.activeModalWidget()
    assert dialog is not None
    dialog.close()
    assert not full.banner.isVisible()
    full.session.jobs.start("Failing", fails)
    qtbot.waitUntil(full.banner.isVisible)
    assert "an error again: half a file." in full.banner.text.text()
    assert "start the program anew" in full.banner.text.text()
    assert QApplication.activeModalWidget() is None


def test_a_panel_that_fails_leaves_the_others(
    full: MainWindow, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError("by design")

    monkeypatch.setattr(ResidualsPanel, "_refresh", fail)
    with pytest.raises(ZeroDivisionError, match="by design"):
        full.need_analysis().show_panel(ResidualsPanel)
    monkeypatch.undo()
    assert full.need_analysis().show_panel(HistogramsPanel).isVisible()
    assert full.need_analysis().show_panel(ResidualsPanel).isVisible()


def test_a_panel_that_cannot_be_built_is_tried_once(
    full: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    tried: list[object] = []

    def fail() -> bool:
        tried.append(None)
        raise ZeroDivisionError("by design")

    monkeypatch.setattr(full.need_analysis(), "build_next", fail)
    with qtbot.captureExceptions() as raised:
        full.preparation._building.start(1)
        qtbot.waitUntil(lambda: bool(raised))
        qtbot.wait(50)
    assert len(tried) == 1


def test_missing_images_are_found_again(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    project = examples.calibrated(tmp_path)
    window.files.saver.save(tmp_path / "empty.json")
    window.session.begin(Document(project))
    window.files.saver.save(tmp_path / "project.json")
    new = tmp_path / "moved"
    new.mkdir()
    for view in project.views[1:]:
        (new / Path(view.image).name).write_bytes(b"")
    window.files.open_project(tmp_path / "project.json")
    qtbot.waitUntil(lambda: bool(window.banner.buttons))
    assert "7 of 7 images are not where they were" in window.banner.text.text()
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_: str(new))
    window.banner.buttons[0].click()
    qtbot.waitUntil(lambda: "Found 6 of 7" in window.banner.text.text())
    assert window.session.document.undo_label == "Relocate images"
    assert window.session.project.views[1].image == str(new / "1.png")
    assert window.session.result is not None
    assert window.session.project.is_current(window.session.result)
    recent = [entry.path for entry in list_recent() if entry.path.is_file()]
    assert recent == [tmp_path / "project.json", tmp_path / "empty.json"]


@pytest.mark.parametrize("answer", ["Save", "Discard", "Cancel"])
def test_unsaved_work_is_not_left_without_a_question(
    full: MainWindow, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answer: str
) -> None:
    path = tmp_path / "p.json"
    full.images.exclude([full.session.image])
    monkeypatch.setattr(questions, "ask", lambda *_: getattr(QMessageBox.StandardButton, answer))
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(path), ""))
    full.files.new()
    assert bool(full.session.project.views) == (answer == "Cancel")
    assert path.exists() == (answer == "Save")


def test_a_board_is_printed_in_the_size_chosen(
    qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    dialog = PrintDialog(examples.BOARD)
    qtbot.addWidget(dialog)
    dialog.show()
    assert (dialog.rows.value(), dialog.cols.value(), dialog.square.value()) == (7, 8, 30.0)
    assert dialog.paper.currentText() == "A3" and dialog.save.isEnabled()
    dialog.paper.setCurrentText("A4")
    assert not dialog.save.isEnabled(), "8 squares of 30 mm need larger paper"
    assert "at most" in dialog.words.text()
    dialog.paper.setCurrentText("A3")
    assert dialog.save.isEnabled()
    monkeypatch.setattr(
        QFileDialog, "getSaveFileName", lambda *_: (str(tmp_path / "board"), "SVG drawing (*.svg)")
    )
    qtbot.mouseClick(dialog.save, LEFT)
    assert (tmp_path / "board.svg").read_text(encoding="utf-8") == dialog.make_sheet().svg()


def test_every_action_has_a_tip_and_no_shortcut_twice(window: MainWindow) -> None:
    actions = [a for menu in window.menuBar().actions() for a in menu.menu().actions()]
    actions = [a for a in actions if a.text() and not a.menu()]
    keys = [a.shortcut().toString() for a in actions if not a.shortcut().isEmpty()]
    assert len(keys) == len(set(keys))
    assert len(actions) > 25
    assert all(action.toolTip() for action in actions)


def test_a_split_is_upright_where_it_is_not_wide(qtbot: QtBot) -> None:
    split = Split(500, (QWidget(), 1), (QWidget(), 1))
    qtbot.addWidget(split)
    split.show()
    for width, height, across in ((900, 400, True), (640, 900, False), (400, 300, False)):
        split.resize(width, height)
        assert (split.orientation() is Qt.Orientation.Horizontal) is across
        one, other = split.sizes()
        assert abs(one - other) <= 2


@pytest.mark.parametrize("scheme", [theme.Scheme.LIGHT, theme.Scheme.DARK])
def test_the_labels_of_the_tools_show_in_either_scheme(
    full: MainWindow, qapp: QApplication, scheme: theme.Scheme
) -> None:
    theme.apply(qapp, scheme)
    qapp.processEvents()
    for action in full.page.tools:
        button = full.page.bar.widgetForAction(action)
        picture = button.grab().toImage()
        lightness = [
            picture.pixelColor(x, y).lightness()
            for x in range(picture.width())
            for y in range(picture.height() // 2, picture.height())  # the label, not the icon
        ]
        assert max(lightness) - min(lightness) > 70, action.text()


def test_a_narrow_choice_shows_that_its_text_goes_on(qtbot: QtBot) -> None:
    combo = NarrowCombo()
    qtbot.addWidget(combo)
    combo.addItem("views registered one by one, then all together")
    combo.resize(160, 30)
    assert combo.shorten_text().endswith("…")
    assert combo.fontMetrics().horizontalAdvance(combo.shorten_text()) < 160
    combo.resize(800, 30)
    assert combo.shorten_text() == combo.currentText()
