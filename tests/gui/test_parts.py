"""The parts around the canvas: list, board, settings, messages, dialogs."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QColor, QDropEvent, QGuiApplication
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QFileDialog,
    QInputDialog,
    QMessageBox,
    QWidget,
)
from pytestqt.qtbot import QtBot

from calibgui.app.document import Document
from calibgui.app.project import Unit, with_each
from calibgui.app.recent import recent_projects
from calibgui.app.settings import Settings
from calibgui.engine.errors import CalibrationError
from calibgui.engine.types import Cost, Plate, PlateModel, Prior, Status, View, ViewStatus
from calibgui.formats.plate_json import write_plate
from calibgui.gui import theme
from calibgui.gui.bug_dialog import BugDialog
from calibgui.gui.help_dialog import HelpDialog
from calibgui.gui.image_model import Role
from calibgui.gui.main_window import MainWindow
from calibgui.gui.panels.result import ResultPanel
from calibgui.gui.panels.split import Split
from calibgui.gui.print_dialog import PrintDialog
from tests.app import examples

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def full(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> MainWindow:
    """The window with six found views, one without a board, and two results."""
    window.session.begin(Document(examples.calibrated(tmp_path)))
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    return window


def listed(window: MainWindow, role: int = Qt.ItemDataRole.DisplayRole) -> list[object]:
    model = window.images.list.model()
    return [model.index(row, 0).data(role) for row in range(model.rowCount())]


def test_the_list_says_what_was_found_and_how_well_it_fits(full: MainWindow) -> None:
    assert listed(full) == [*(f"{k}.png" for k in range(6)), "blank.png"]
    assert listed(full, Role.STATUS) == [*["42 of 42 corners"] * 6, "no board"]
    result = full.session.result
    assert result is not None
    rms = [residuals.rms for residuals in result.calibration.residuals]
    assert listed(full, Role.RMS) == [*rms, None]
    assert full.images.count.text() == "6 of 7 usable"
    tip = full.images.list.model().index(6, 0).data(Qt.ItemDataRole.ToolTipRole)
    assert "No checkerboard was found" in tip


def test_sorting_by_name_status_and_error(full: MainWindow) -> None:
    full.images.sorting.setCurrentIndex(2)
    rms = [value for value in listed(full, Role.RMS) if value is not None]
    assert rms == sorted(rms, reverse=True)
    assert listed(full)[-1] == "blank.png"
    full.images.sorting.setCurrentIndex(1)
    assert listed(full, Role.STATUS)[-1] == "no board"
    full.images.sorting.setCurrentIndex(0)
    assert listed(full)[0] == "0.png"


def test_several_images_are_excluded_and_removed_by_keys(
    full: MainWindow, qtbot: QtBot, qapp: QApplication
) -> None:
    view = full.images.list
    for row, modifier in (
        (1, Qt.KeyboardModifier.NoModifier),
        (3, Qt.KeyboardModifier.ShiftModifier),
    ):
        at = view.visualRect(view.model().index(row, 0)).center()
        qtbot.mouseClick(view.viewport(), LEFT, modifier, at)
    assert len(full.images.chosen) == 3
    qtbot.keyClick(view, Qt.Key.Key_Space)
    assert full.session.document.undo_label == "Exclude 3 images"
    assert listed(full, Role.STATUS)[1] == "excluded"
    assert full.analysis is not None
    assert full.analysis.state.text() == "out of date"
    theme.apply(qapp, theme.Scheme.DARK)
    qapp.processEvents()
    assert theme.current().warning in full.analysis.state.styleSheet()
    assert len(full.images.chosen) == 3, "an edit keeps the selection"
    qtbot.keyClick(view, Qt.Key.Key_Space)
    assert all(v.enabled for v in full.session.project.views)
    qtbot.keyClick(view, Qt.Key.Key_Delete)
    assert listed(full) == ["0.png", "4.png", "5.png", "blank.png"]
    for _ in range(3):
        full.session.document.undo()
    assert len(listed(full)) == 7
    assert full.analysis.state.text() == ""


def test_the_squares_side_keeps_its_length_in_every_unit(full: MainWindow, qtbot: QtBot) -> None:
    panel, session = full.target, full.session
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
    panel = full.target
    qtbot.mouseClick(panel.inferred, LEFT, pos=QPoint(8, panel.inferred.height() // 2))
    assert full.session.project.board == (6, 7)
    assert panel.rows.isEnabled()
    assert full.session.project.views[0].status is ViewStatus.FOUND, "it is the one that was found"
    with qtbot.waitSignal(panel.search_wanted):
        panel.rows.setValue(5)
        panel.rows.editingFinished.emit()
    assert full.session.project.board == (5, 7)
    assert full.session.document.undo_label == "Number of corners"
    full.session.document.undo()
    assert full.session.project.views[0].corners is not None


def test_settings_become_arguments_of_the_calibration(full: MainWindow) -> None:
    panel = full.settings
    assert [name for name, box in panel.boxes.items() if not box.isChecked()] == ["k3", "p3"]
    panel.boxes["k3"].click()
    panel.boxes["p3"].click()
    panel.boxes["cx"].click()
    settings = full.session.project.settings
    assert (settings.fixed, settings.freed) == ({"cx": None}, ("p3",))
    panel.cost.setCurrentIndex(1)
    panel.cost.activated.emit(1)
    assert full.session.project.settings.cost is Cost.REFERENCE
    for _ in range(4):
        full.session.document.undo()
    assert not panel.boxes["k3"].isChecked()
    assert panel.cost.currentData() == Cost.IMAGE


def test_parameters_are_held_at_values(full: MainWindow, qtbot: QtBot) -> None:
    panel, session = full.settings, full.session
    panel.values.selectAll()
    qtbot.keyClicks(panel.values, "fx=650.5, p3=0.01")
    qtbot.keyClick(panel.values, Qt.Key.Key_Return)
    assert session.project.settings.fixed == {"fx": 650.5, "k3": None, "p3": 0.01}
    assert not panel.boxes["fx"].isChecked()
    panel.boxes["p1"].click()  # what else is chosen leaves the values alone
    assert session.project.settings.fixed["fx"] == 650.5
    panel.boxes["fx"].click()  # to be estimated after all
    assert session.project.settings.fixed == {"k3": None, "p1": None, "p3": 0.01}
    assert panel.values.text() == "p3=0.01"
    before = session.project.settings
    for text in ("k9=1", "fx=-1", "fx=wide"):
        panel.values.selectAll()
        qtbot.keyClicks(panel.values, text)
        qtbot.keyClick(panel.values, Qt.Key.Key_Return)
        assert session.project.settings is before
        assert panel.values.text() == "p3=0.01"
        assert full.banner.isVisible()
    panel.values.selectAll()
    qtbot.keyClick(panel.values, Qt.Key.Key_Delete)
    qtbot.keyClick(panel.values, Qt.Key.Key_Return)
    assert session.project.settings.fixed == {"k3": None, "p1": None}
    for _ in range(4):
        session.document.undo()
    assert panel.boxes["fx"].isChecked()
    assert panel.values.text() == ""


def test_every_setting_is_in_the_panel_and_none_disturbs_another(full: MainWindow) -> None:
    panel, session = full.settings, full.session
    everything = Settings(
        cost=Cost.IMAGE,
        fixed={"fx": 650.5, "k3": None},
        freed=("p3",),
        plate=PlateModel.FREE,
        prior=Prior(0.25, 0.5),
        robust=True,
        weigh_views=True,
        once=True,
    )
    changed = {f.name for f in fields(Settings)} - {"cost"}
    assert all(getattr(everything, name) != getattr(Settings(), name) for name in changed)
    session.edit("Settings", lambda p: replace(p, settings=everything))
    panel.robust.click()
    assert session.project.settings == replace(everything, robust=False)
    panel.weigh.click()
    panel.again.click()
    assert session.project.settings == replace(
        everything, robust=False, weigh_views=False, once=False
    )
    for _ in range(3):
        session.document.undo()
    assert session.project.settings is everything
    choose(panel.cost, "error on the reference plane")
    assert not session.project.settings.weigh_views
    assert not panel.weigh.isEnabled()


def choose(box: QComboBox, text: str) -> None:
    """Choose an entry as the mouse would."""
    row = next(k for k in range(box.count()) if box.itemText(k).startswith(text))
    box.setCurrentIndex(row)
    box.activated.emit(row)


def test_the_boards_shape_is_a_setting(
    full: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    panel, session = full.settings, full.session
    choice = panel.plate
    assert not choice.known.isEnabled()
    choose(choice.model, "free")
    assert session.project.settings.plate is PlateModel.FREE
    qtbot.mouseClick(choice.known, LEFT, pos=QPoint(8, choice.known.height() // 2))
    assert session.project.settings.prior == Prior(0.1, 0.3)
    choice.in_plane.setFocus()
    choice.in_plane.selectAll()
    qtbot.keyClicks(choice.in_plane, "0.25")
    qtbot.keyClick(choice.in_plane, Qt.Key.Key_Return)
    assert session.project.settings.prior == Prior(0.25, 0.3)
    choose(choice.model, "what predicts best")
    assert (session.project.settings.plate, session.project.settings.prior) == (None, None)
    for prior in (Prior(0.25, 0.3), Prior(0.1, 0.3)):
        session.document.undo()
        assert session.project.settings.prior == prior
        assert choice.in_plane.value() == prior.in_plane

    # A plate from a file; a dialog that is left changes nothing, and nor does another file.
    plate = Plate(PlateModel.BOW, np.zeros((1, 2)), np.full((1, 3), 0.1), np.zeros((1, 3)))
    write_plate(plate, tmp_path / "plate.json")
    (tmp_path / "other.json").write_text("{}")
    for name in ("", str(tmp_path / "other.json")):
        monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_, name=name: (name, ""))
        choose(choice.model, "as in a file")
        assert session.project.settings.plate is PlateModel.FREE
        assert choice.model.currentText().startswith("free")
    assert "not a file of the format" in full.banner.text.text()
    monkeypatch.setattr(
        QFileDialog, "getOpenFileName", lambda *_: (str(tmp_path / "plate.json"), "")
    )
    choose(choice.model, "as in a file")
    held = session.project.settings.plate
    assert isinstance(held, Plate)
    assert choice.model.currentText() == "as in a file: 0.17 mm off"

    # Other costs take a board as drawn.
    choose(panel.cost, "error on the reference plane")
    assert session.project.settings.plate is PlateModel.NOMINAL
    assert not choice.isEnabled()
    session.document.undo()
    assert session.project.settings.plate is held


def test_outliers_left_out_are_seen_in_the_images_and_undone(
    full: MainWindow, qtbot: QtBot
) -> None:
    session = full.session
    first = session.project.views[1]
    assert first.corners is not None
    uv = np.array(first.corners.uv)
    uv[20] += [6.0, -5.0]
    moved = replace(first, corners=replace(first.corners, uv=uv))
    session.edit("Spoil", lambda p: with_each(p, [first.image], lambda _: moved))
    qtbot.mouseClick(full.settings.robust, LEFT, pos=QPoint(8, full.settings.robust.height() // 2))
    assert session.project.settings.robust
    qtbot.mouseClick(full.calibrate, LEFT)
    qtbot.waitUntil(lambda: len(session.project.results) == 3, timeout=30_000)
    assert session.result is not None
    assert any("1.png loses 1 corner" in text for text in session.result.calibration.warnings)
    assert session.project.is_current(session.result)
    assert listed(full, Role.STATUS)[1] == "41 of 42 corners"
    session.document.undo()
    assert session.project.views[1] is moved
    qtbot.waitUntil(lambda: not session.jobs.running)


def test_views_that_do_not_determine_the_camera_say_what_to_photograph(
    full: MainWindow, qtbot: QtBot
) -> None:
    session = full.session
    others = [view.image for view in session.project.views if view.usable][1:]

    def excluded(view: View) -> View:
        return replace(view, enabled=False)

    session.edit("Exclude", lambda p: with_each(p, others, excluded))
    qtbot.mouseClick(full.calibrate, LEFT)
    qtbot.waitUntil(lambda: len(session.project.results) == 3, timeout=30_000)
    assert session.result is not None
    assert session.result.calibration.status is Status.PARTIAL
    assert full.banner.isVisible()
    assert "is partial. One view does not" in full.banner.text.text()
    assert "Add at least two more views" in full.banner.text.text()
    panel = full.analysis.findChild(ResultPanel)
    assert panel is not None
    assert "Assumed, as of an ordinary camera" in panel.words.toPlainText()
    qtbot.waitUntil(lambda: not session.jobs.running)


def test_results_are_chosen_compared_renamed_and_deleted(
    full: MainWindow, monkeypatch: pytest.MonkeyPatch
) -> None:
    analysis, session = full.analysis, full.session
    assert analysis is not None
    assert session.result_name == "k3 held"
    analysis.compare_with("Calibration 1")
    table = analysis.panel(ResultPanel).differences.model()
    rows = {table.index(r, 0).data(): r for r in range(table.rowCount())}
    assert set(rows) >= {"fx", "k3"}
    analysis.results.setCurrentIndex(0)
    analysis.results.activated.emit(0)
    assert session.result is session.project.results["Calibration 1"]
    monkeypatch.setattr(QInputDialog, "getText", lambda *_: ("all free", True))
    analysis.rename_wanted.emit("Calibration 1")
    assert list(session.project.results) == ["all free", "k3 held"]
    assert session.result_name == "all free"
    analysis.delete_wanted.emit("all free")
    assert session.result_name == "k3 held"
    session.document.undo()
    assert list(session.project.results) == ["all free", "k3 held"]


def test_a_click_in_the_image_and_in_a_panel_select_the_same(full: MainWindow) -> None:
    assert full.analysis is not None
    panel = full.analysis.panel(ResultPanel)
    panel.picked.emit(3, 17)
    assert full.session.image.endswith("3.png")
    assert full.page.canvas.marks.chosen == 17
    assert full.images.list.currentIndex().data() == "3.png"


def test_a_heading_without_room_ends_in_dots(full: MainWindow) -> None:
    heading = full.page.heading
    heading.setText("short")
    assert heading.shown_text() == "short"
    heading.setText(40 * "long ")
    assert heading.shown_text().endswith("…")
    assert heading.fontMetrics().horizontalAdvance(heading.shown_text()) <= heading.width()


def test_dropped_and_pasted_paths_become_images(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    paths = [tmp_path / f"{k}.png" for k in range(3)]
    for path in paths:
        path.write_bytes(b"no image")
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path)) for path in paths[:2]])
    drop = QDropEvent(
        QPointF(200, 200), Qt.DropAction.CopyAction, data, LEFT, Qt.KeyboardModifier.NoModifier
    )
    window.dropEvent(drop)
    assert [Path(v.image).name for v in window.session.project.views] == ["0.png", "1.png"]
    QGuiApplication.clipboard().setText(f'"{paths[2]}"\n')
    window.files.paste()
    assert len(window.session.project.views) == 3
    qtbot.waitUntil(lambda: window.banner.isVisible(), timeout=30_000)
    assert [v.status for v in window.session.project.views] == [ViewStatus.UNREADABLE] * 3
    window.files.open_paths([str(tmp_path / "nowhere")])
    assert "does not exist" in window.banner.text.text()


def test_the_sample_comes_with_its_squares(window: MainWindow) -> None:
    window.files.open_sample()
    assert window.target.square.value() == 25.0
    window.session.document.undo()
    assert window.target.square.value() == 30.0


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
    assert recent_projects() == [tmp_path / "project.json", tmp_path / "empty.json"]


@pytest.mark.parametrize("answer", ["Save", "Discard", "Cancel"])
def test_unsaved_work_is_not_left_without_a_question(
    full: MainWindow, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answer: str
) -> None:
    path = tmp_path / "p.json"
    full.images.exclude([full.session.image])
    monkeypatch.setattr(
        QMessageBox, "question", lambda *_: getattr(QMessageBox.StandardButton, answer)
    )
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
    assert (tmp_path / "board.svg").read_text(encoding="utf-8") == dialog.content().svg()


def test_every_action_has_a_tip_and_no_shortcut_twice(window: MainWindow) -> None:
    actions = [a for menu in window.menuBar().actions() for a in menu.menu().actions()]
    actions = [a for a in actions if a.text() and not a.menu()]
    keys = [a.shortcut().toString() for a in actions if not a.shortcut().isEmpty()]
    assert len(keys) == len(set(keys))
    assert len(actions) > 25
    assert all(action.toolTip() for action in actions)


def test_help_names_keys_that_work(qtbot: QtBot, window: MainWindow) -> None:
    dialog = HelpDialog(window)
    qtbot.addWidget(dialog)
    text = dialog.text.toPlainText()
    assert "Lucchese" in text
    known = {a.shortcut().toString() for a in window.findChildren(type(window.page.tools[0]))}
    assert {"F9", "M", "E", "Ctrl+0", "Ctrl+1", "Shift+1", "Shift+6"} <= known


def test_the_layout_is_remembered(qtbot: QtBot, tmp_path: Path) -> None:
    widths = []
    for width in (400, None):
        window = MainWindow()
        window.show()
        window.resize(1280, 720)  # the offscreen screen is smaller than a remembered window
        qtbot.waitExposed(window)
        window.session.begin(Document(examples.calibrated(tmp_path)))
        if width is not None:
            window.resizeDocks([window.image_dock], [width], Qt.Orientation.Horizontal)
        qtbot.wait(50)
        widths.append(window.image_dock.width())
        window.close()
        window.deleteLater()
    assert widths[0] == widths[1] == 400


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
def test_the_buttons_of_a_part_show_on_its_title(
    window: MainWindow, qapp: QApplication, scheme: theme.Scheme
) -> None:
    theme.apply(qapp, scheme)
    qapp.processEvents()
    ground = QColor(theme.current().window).lightness()
    for name in ("qt_dockwidget_floatbutton", "qt_dockwidget_closebutton"):
        button = window.analysis_dock.findChild(QAbstractButton, name)
        assert button is not None
        icon = button.icon().pixmap(10, 10).toImage()
        inks = [icon.pixelColor(x, y) for x in range(10) for y in range(10)]
        drawn = [ink.lightness() for ink in inks if ink.alpha() > 200]
        assert drawn and abs(np.mean(drawn) - ground) > 70
