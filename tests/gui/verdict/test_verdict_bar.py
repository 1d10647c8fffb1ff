"""The bar says what a result is worth, and its buttons do what they say and can be undone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, NoReturn

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication, QCheckBox, QPushButton
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import Settings
from calibgui.app.projects.document import Document
from calibgui.app.projects.project import Project, Unit, change_views, record_result
from calibgui.app.projects.project_file import read_project, write_project
from calibgui.dataset import CornerSet, View, ViewStatus, judging
from calibgui.engine.assessment import Cause, Grade
from calibgui.engine.boards import AprilGrid, Circles, Pattern
from calibgui.engine.errors import Cancelled
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.dialogs.export_dialog import ExportDialog
from calibgui.gui.panels.answer.result import ResultPanel
from calibgui.gui.panels.evidence.coverage import CoveragePanel
from calibgui.gui.panels.evidence.residuals import ResidualsPanel
from calibgui.gui.verdict import verdict_bar
from calibgui.gui.verdict.before_after import BeforeAndAfter
from calibgui.gui.verdict.verdict_bar import VerdictBar
from calibgui.gui.widgets.fit_text import describe_fit
from calibgui.gui.widgets.lengths import describe_condition
from calibgui.gui.widgets.tables import Table
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples

LEFT = Qt.MouseButton.LeftButton


def calibrated(project: Project) -> Project:
    """The project with its first result, which no other test shares or has judged."""
    assert project.size is not None
    corner_set = CornerSet(project.size, project.views, project.board)
    result = calibrate_views(corner_set, project.settings)
    empty = replace(project, results=MappingProxyType({}))
    return record_result(empty, "Calibration 1", project.views, result)


@pytest.fixture
def plain(tmp_path: Path) -> Project:
    return replace(examples.calibrated(tmp_path), settings=Settings(), lengths_confirmed=True)


Open = Callable[[Project], VerdictBar]


@pytest.fixture
def open_project(window: MainWindow, qtbot: QtBot) -> Open:
    def begin(project: Project) -> VerdictBar:
        window.session.begin(Document(project))
        bar = window.verdict
        qtbot.waitUntil(
            lambda: bar.verdict is not None and not window.session.jobs.running, timeout=60_000
        )
        return bar

    return begin


def test_a_verdict_that_a_search_for_a_better_camera_found_reaches_the_panels(
    window: MainWindow, qtbot: QtBot, plain: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The search judges the shown result itself, and ends where there is nothing to mend."""

    def end(*_: object) -> NoReturn:
        raise Cancelled

    with monkeypatch.context() as meanwhile:  # what the bar begins by itself comes to nothing
        meanwhile.setattr(verdict_bar, "judge_result", end)
        window.session.begin(Document(calibrated(plain)))
        words = window.need_analysis().show_panel(ResultPanel).words
        qtbot.waitUntil(lambda: "is being found out" in words.toPlainText())
        window.verdict.show_running(True, False)
        result = window.session.result
        assert result is not None
        assert window.verdict.verdict is None
        judging.judge_result(result)
    window.verdict.show_running(False, False)
    qtbot.waitUntil(lambda: "is being found out" not in words.toPlainText(), timeout=30_000)
    assert f"{len(result.used)} views" in words.toPlainText()


def displace(project: Project, change: Callable[[int, Any], Any]) -> Project:
    """The project with the corners of its views k elsewhere."""

    def move(k: int, view: View) -> View:
        if view.corners is None:
            return view
        uv = change(k, np.array(view.corners.uv))
        return replace(view, corners=replace(view.corners, uv=uv))

    return replace(project, views=tuple(move(k, v) for k, v in enumerate(project.views)))


def act(bar: VerdictBar, button: QPushButton, window: MainWindow, qtbot: QtBot) -> BeforeAndAfter:
    """Click the button of an action, and wait for before and after."""
    qtbot.mouseClick(button, LEFT)
    qtbot.waitUntil(
        lambda: (
            bar.comparison is not None
            and bar.comparison.isVisible()
            and not window.session.jobs.running
        ),
        timeout=60_000,
    )
    assert isinstance(bar.comparison, BeforeAndAfter)
    return bar.comparison


def test_a_sound_result_has_its_figures_and_no_findings(
    plain: Project, open_project: Open, window: MainWindow, qtbot: QtBot
) -> None:
    bar = open_project(calibrated(plain))
    verdict = bar.verdict
    assert verdict is not None and bar.icon.grade is verdict.grade
    assert bar.headline.text() in ("GOOD", "USABLE")
    edge, worst = map(format_two_digits, (verdict.error.edge, verdict.error.worst))
    assert f"edge {edge}, worst {worst} px" in bar.figures.text()
    assert "RMS 0.0" in bar.figures.text() and "of 252 corners" in bar.figures.text()
    assert "if squares" not in bar.figures.text()
    assert not bar.unfold.isVisible() and not bar.square.isVisible()
    # What can be done about pixels that are not known well is to add views.
    assert not verdict.is_known_well and bar.button.text() == "Show where to hold the board"
    qtbot.mouseClick(bar.button, LEFT)
    assert isinstance(window.need_analysis().shown, CoveragePanel)
    assert window.need_analysis().isVisible()


def test_photographs_that_are_not_used_are_counted(
    plain: Project, open_project: Open, window: MainWindow, qtbot: QtBot
) -> None:
    open_project(calibrated(plain))
    done, name = window.inspector.done, Path(plain.views[-1].image).stem
    [row] = [row for row in done.rows if not row.entry.is_good]
    assert row.words.text() == f"1 of 7 photographs could not be used: {name}"
    window.session.select(plain.views[0].image)
    qtbot.mouseClick(row.link, LEFT)
    assert window.session.image == plain.views[-1].image and window.page.isVisible()
    open_project(calibrated(replace(plain, views=plain.views[:-1])))
    assert all(row.entry.is_good for row in done.rows)


def test_no_photograph_that_can_be_used_is_said(plain: Project, window: MainWindow) -> None:
    reason = window.verdict.reason
    window.session.begin(Document(replace(plain, views=plain.views[-1:], results={})))
    assert plain.views[-1].status is ViewStatus.NO_BOARD
    assert reason.text() == (
        "No board of the kind “Checkerboard” was found: click a photograph to see why."
    )
    unreadable = replace(plain.views[-1], status=ViewStatus.UNREADABLE)
    window.session.edit("Images", lambda p: replace(p, views=(unreadable,)))
    assert reason.text() == "No photograph can be used: click one to see why."
    window.session.edit("Add", lambda p: replace(p, views=plain.views))
    assert reason.text().startswith("How far the camera can be trusted")


def test_marking_by_hand_is_said_to_be_awaited(plain: Project, window: MainWindow) -> None:
    waiting = tuple(replace(v, status=ViewStatus.WAITING, corners=None) for v in plain.views)
    by_hand = replace(plain, views=waiting, results={}, by_hand=True)
    window.session.begin(Document(by_hand))
    assert window.verdict.reason.text().startswith("Mark the board in the photographs (M)")
    window.session.edit("Search", lambda p: replace(p, by_hand=False))
    assert window.verdict.reason.text().startswith("How far the camera can be trusted")


def test_a_lack_of_views_is_put_down_to_the_images_that_cannot_be_used(
    plain: Project, open_project: Open
) -> None:
    first, *others = plain.views
    lost = [view.refuse(ViewStatus.WRONG_SIZE, "Another size.") for view in others]
    bar = open_project(calibrated(replace(plain, views=(first, *lost))))
    assert bar.reason.text().startswith("One view does not determine a camera")
    assert f"{len(lost)} of {len(plain.views)} images cannot be used" in bar.reason.text()


def test_one_click_remedies_and_one_takes_it_back(
    plain: Project, open_project: Open, window: MainWindow, qtbot: QtBot
) -> None:
    wrong = calibrated(replace(plain, settings=Settings(fixed={"fx": 180.0})))
    bar = open_project(wrong)
    before = bar.verdict
    assert before is not None and before.grade is Grade.CAN_BE_BETTER
    assert bar.headline.text().startswith("CAN BE ") and bar.button.text() == "Free fx"
    comparison = act(bar, bar.button, window, qtbot)
    after = bar.verdict
    assert after is not None
    gained = before.error.covered / after.error.covered
    assert gained == pytest.approx(before.times_better, rel=0.3)
    assert "times smaller" in comparison.title.text()
    assert window.session.project.settings.fixed == {}
    assert len(window.session.project.results) == 2
    changes = comparison.parameters.model()
    assert changes.index(0, 0).data() == "fx"
    # Taken back: everything is as it was, the headline too.
    qtbot.mouseClick(comparison.back, LEFT)
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    assert window.session.project is wrong and not comparison.isVisible()
    assert bar.headline.text().startswith("CAN BE ")
    # Kept: the comparison goes, the result stays until undo.
    comparison = act(bar, bar.button, window, qtbot)
    qtbot.mouseClick(comparison.keep, LEFT)
    assert not comparison.isVisible() and len(window.session.project.results) == 2
    assert window.session.document.undo_label == "Free fx"
    window.session.document.undo()
    assert window.session.project is wrong


def test_work_that_goes_on_keeps_what_was_done(
    plain: Project, open_project: Open, window: MainWindow, qtbot: QtBot
) -> None:
    bar = open_project(calibrated(replace(plain, settings=Settings(fixed={"fx": 180.0}))))
    comparison = act(bar, bar.button, window, qtbot)
    window.session.edit("Settings", lambda p: replace(p, settings=Settings(robust=True)))
    assert not comparison.isVisible() and len(window.session.project.results) == 2


def test_circles_are_called_circles(plain: Project) -> None:
    assert plain.size is not None
    result = calibrate_views(CornerSet(plain.size, plain.views, plain.board), plain.settings)
    assert describe_fit(result).endswith("px of 252 corners")
    assert result.board is not None
    circles = replace(result, board=replace(result.board, pattern=Circles(False, 0.5)))
    assert describe_fit(circles).endswith("px of 252 circles")


def test_findings_unfold_over_the_desk_with_their_evidence(
    plain: Project, open_project: Open, window: MainWindow, qtbot: QtBot
) -> None:
    def misplace(k: int, uv: Any) -> Any:
        uv[::4] += [6.0, -4.0] if k == 2 else 0.0
        return uv

    bar = open_project(calibrated(displace(plain, misplace)))
    assert bar.button.text() == "Leave these corners out"
    place = window.page.mapTo(window, window.page.rect().topLeft())
    qtbot.mouseClick(bar.unfold, LEFT)
    row = bar.findings.rows[0]
    assert bar.findings.isVisible() and row.finding.cause is Cause.MISPLACED_CORNERS
    assert "2.png" in row.what.text() and row.how_much.text().endswith("times better once mended")
    assert not row.details.isVisible()
    qtbot.keyClick(bar.findings, Qt.Key.Key_Escape)
    assert not bar.findings.isVisible() and not bar.unfold.isChecked()
    qtbot.mouseClick(bar.unfold, LEFT)
    folded = bar.findings.height()
    assert folded >= row.sizeHint().height()
    qtbot.mouseClick(row.unfold, LEFT)
    assert row.details.isVisible() and row.finding.evidence in row.details.text()
    assert bar.findings.height() > folded
    assert window.page.mapTo(window, window.page.rect().topLeft()) == place
    qtbot.mouseClick(row.proof, LEFT)
    assert window.analysis is not None and not bar.findings.isVisible()
    assert isinstance(window.analysis.shown, ResidualsPanel)
    assert window.session.image.endswith("2.png")
    comparison = act(bar, bar.button, window, qtbot)
    assert window.session.project.settings.robust
    qtbot.mouseClick(comparison.back, LEFT)
    assert not window.session.project.settings.robust


def test_two_images_are_not_usable_and_ask_for_more(
    plain: Project, open_project: Open, window: MainWindow, qtbot: QtBot
) -> None:
    two = replace(plain, views=plain.views[:2])
    bar = open_project(calibrated(two))
    assert bar.headline.text() == "NOT USABLE"
    assert "2 views are too few" in bar.reason.text()
    assert bar.button.text() == "Show where to hold the board"
    qtbot.mouseClick(bar.button, LEFT)
    assert window.analysis is not None
    assert isinstance(window.analysis.shown, CoveragePanel)


def test_views_that_do_not_determine_the_camera_say_so(
    plain: Project, open_project: Open, window: MainWindow, qtbot: QtBot
) -> None:
    bar = open_project(calibrated(replace(plain, views=plain.views[:1])))
    assert bar.headline.text() == "NOT USABLE"
    assert "One view does not determine a camera" in bar.reason.text()
    assert bar.figures.text().startswith("Error: unknown")
    assert bar.button.text() == "Show where to hold the board" and not bar.unfold.isVisible()
    qtbot.mouseClick(bar.button, LEFT)
    assert window.analysis is not None
    assert isinstance(window.analysis.shown, CoveragePanel)


def test_the_length_of_squares_is_asked_until_it_is_confirmed(
    plain: Project, open_project: Open, window: MainWindow, qtbot: QtBot
) -> None:
    bar = open_project(calibrated(replace(plain, lengths_confirmed=False)))
    row = bar.square
    assert row.isVisible() and "6 × 7 inner corners" in row.counted.text()
    assert row.confirm.text() == "Confirm 30 mm"
    assert "if squares are 30 mm" in bar.figures.text()
    verdict = bar.verdict
    assert verdict is not None
    qtbot.mouseClick(row.confirm, LEFT)
    assert "Lengths hold" in row.counted.text() and "if squares" not in bar.figures.text()
    assert "confirmed already" in row.confirm.toolTip() and not row.confirm.isEnabled()
    assert bar.verdict is verdict  # nothing was judged anew
    window.session.document.undo()
    assert "How long" in row.counted.text() and "if squares are 30 mm" in bar.figures.text()
    row.square.setValue(25.0)
    assert row.confirm.text() == "Confirm 25 mm"
    qtbot.mouseClick(row.confirm, LEFT)
    assert window.session.project.square == 25.0 and window.session.project.lengths_confirmed
    assert bar.verdict is not None and "Out of date" not in bar.reason.text()
    assert not window.calibrator.running, "a length scales, it calibrates nothing anew"
    result = window.session.result
    assert result is not None and result.board is not None and result.board.square == 25.0
    assert bar.verdict.distance == pytest.approx(verdict.distance * 25 / 30)
    assert f"{bar.verdict.distance:.0f} mm away" in bar.figures.text()


def test_the_last_verdict_stays_dimmed_until_there_is_another(
    plain: Project, open_project: Open, window: MainWindow, qtbot: QtBot
) -> None:
    bar = open_project(calibrated(plain))
    headline, icon, judged = bar.headline.text(), bar.icon.grade, bar.verdict
    first = plain.views[0].image
    window.session.select(first)
    others = change_views(window.session.project, [first], lambda v: replace(v, enabled=False))
    corner_set = CornerSet(examples.CAMERA.size, others.views, others.board)
    result = calibrate_views(corner_set, others.settings)
    window.session.edit("Leave out", lambda _: others)
    assert bar.verdict is judged
    window.session.edit("Calibrate", lambda p: record_result(p, "new", others.views, result))
    assert bar.verdict is None, "it is being found out"
    assert bar.headline.text() == headline and bar.icon.grade is icon
    assert bar.reason.text().startswith("Of 6 photographs.")
    assert f"Now: {describe_fit(result)}" in bar.figures.text()
    assert not bar.button.isVisible() and not bar.unfold.isVisible()
    qtbot.waitUntil(lambda: bar.verdict is not None, timeout=60_000)
    assert not bar.reason.text().startswith("Of 6") and "Now:" not in bar.figures.text()
    window.session.begin(Document(replace(plain, results={})))
    assert bar.headline.text() == "NOT CALIBRATED", "another project has no old verdict"


def test_a_project_that_is_opened_again_is_not_judged_again(
    plain: Project,
    open_project: Open,
    window: MainWindow,
    qtbot: QtBot,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    verdict = open_project(calibrated(plain)).verdict
    write_project(window.session.project, tmp_path / "project.json")
    monkeypatch.setattr(judging, "judge_calibration", lambda *_: pytest.fail("judged anew"))
    again = read_project(tmp_path / "project.json")
    window.session.begin(Document(again))
    assert window.verdict.verdict == verdict and not window.verdict.headline.text().isspace()
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    assert window.verdict.verdict == verdict


@pytest.mark.parametrize(
    ("pattern", "question", "side", "condition"),
    [
        (
            Circles(),
            "How far apart are the circles?",
            "Distance of circles",
            "circles are {} apart",
        ),
        (AprilGrid(), "How long are the tags' sides?", "Side of a tag", "tags are {}"),
    ],
    ids=["circles", "aprilgrid"],
)
def test_what_is_asked_of_other_boards_than_squares(
    window: MainWindow, plain: Project, pattern: Pattern, question: str, side: str, condition: str
) -> None:
    project = replace(plain, lengths_confirmed=False)
    assert project.board is not None
    board = replace(project.board, pattern=pattern)
    result = replace(next(iter(project.results.values())), board=board, lengths_confirmed=False)
    assert result.condition == "if " + condition.format("30 mm")
    assert describe_condition(result) == f" {result.condition}"
    window.session.begin(Document(replace(project, pattern=pattern, results=MappingProxyType({}))))
    row = window.verdict.square
    assert row.isVisible() and row.counted.text().startswith(question)
    assert "square" not in row.counted.text() and row.square.accessibleName() == side


def test_a_project_whose_lengths_are_confirmed_asks_nothing(
    plain: Project, open_project: Open, window: MainWindow
) -> None:
    assert plain.lengths_confirmed
    assert not open_project(calibrated(plain)).square.isVisible()
    window.session.begin(Document(Project()))
    assert not window.verdict.square.isVisible()


def test_a_search_that_comes_first_asks_too(window: MainWindow, plain: Project) -> None:
    project = replace(plain, results=MappingProxyType({}), lengths_confirmed=False)
    window.session.begin(Document(project))
    assert window.verdict.headline.text() == "NOT CALIBRATED"
    assert window.verdict.square.isVisible()


def test_nothing_is_asked_before_a_board_is_found(window: MainWindow, plain: Project) -> None:
    project = replace(plain, results=MappingProxyType({}), lengths_confirmed=False)
    found = project.views[0]
    waiting = replace(found, status=ViewStatus.WAITING, corners=None)
    blank = found.refuse(ViewStatus.NO_BOARD, "No checkerboard was found.")
    # A number of rows and columns that the user states is no board that was found.
    unseen = replace(project, views=(blank, waiting), grid_size=(6, 7))
    window.session.begin(Document(unseen))
    row = window.verdict.square
    assert not row.isVisible()
    window.session.document.learn(lambda p: replace(p, views=(blank, found)))
    assert row.isVisible() and "6 × 7 inner corners" in row.counted.text()


def test_changed_settings_make_a_result_old_and_undo_makes_it_new(
    plain: Project, open_project: Open, window: MainWindow, qtbot: QtBot
) -> None:
    bar = open_project(calibrated(plain))
    session, settings = window.session, window.settings
    window.show_setup()
    window.setup.folds[-1].setChecked(True)

    def click(box: QCheckBox) -> None:
        qtbot.mouseClick(box, LEFT, pos=QPoint(8, box.height() // 2))

    def choose_method() -> None:
        settings.method.setFocus()
        qtbot.keyClick(settings.method, Qt.Key.Key_Down)

    def choose_lens() -> None:
        settings.model.setFocus()
        qtbot.keyClick(settings.model, Qt.Key.Key_Down)

    def hold() -> None:
        settings.values.setFocus()
        qtbot.keyClicks(settings.values, "fx=200")
        qtbot.keyClick(settings.values, Qt.Key.Key_Return)

    assert "Out of date" not in bar.reason.text()
    for change in (
        lambda: click(settings.robust),
        lambda: click(settings.weigh),
        lambda: click(settings.boxes["k3"]),
        choose_lens,
        hold,
        choose_method,
    ):
        change()
        assert bar.reason.text().startswith("Out of date, as settings have changed"), change
        qtbot.keyClick(window, Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier)
        dialog = QApplication.activeModalWidget()
        assert isinstance(dialog, ExportDialog)
        assert any("settings have" in label.text() for label in dialog.findChildren(WrappedLabel))
        dialog.close()
        qtbot.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
        assert "Out of date" not in bar.reason.text(), change
    click(settings.robust)
    qtbot.mouseClick(window.calibrate, LEFT)
    qtbot.waitUntil(lambda: len(session.project.results) == 2, timeout=60_000)
    qtbot.waitUntil(lambda: bar.verdict is not None and not session.jobs.running, timeout=60_000)
    assert "Out of date" not in bar.reason.text()
    session.show_result("Calibration 1")
    qtbot.waitUntil(lambda: bar.verdict is not None and not session.jobs.running, timeout=60_000)
    assert "Out of date" in bar.reason.text()


@pytest.mark.parametrize(
    ("size", "least"), [((1280, 720), 0.24), ((1600, 900), 0.24), ((1920, 1080), 0.24)]
)
def test_before_and_after_use_the_room(
    plain: Project,
    open_project: Open,
    window: MainWindow,
    qtbot: QtBot,
    size: tuple[int, int],
    least: float,
) -> None:
    """Beside the tools of a small window the tables leave the map less."""
    window.resize(*size)
    bar = open_project(calibrated(replace(plain, settings=Settings(fixed={"fx": 180.0}))))
    comparison = act(bar, bar.button, window, qtbot)
    QApplication.processEvents()
    image = comparison.map.plot.image
    drawn = image.mapRectToScene(image.boundingRect())
    share = drawn.width() * drawn.height() / (comparison.width() * comparison.height())
    assert share > least
    for table in (comparison.errors, comparison.parameters):
        assert table.horizontalHeader().length() <= table.viewport().width()
        assert table.viewport().width() < table.horizontalHeader().length() + 40


def test_before_and_after_measures_its_tables_once(
    plain: Project,
    open_project: Open,
    window: MainWindow,
    qtbot: QtBot,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """To measure one asks for another layout, for which it would be measured again, without end."""
    bar = open_project(calibrated(replace(plain, settings=Settings(fixed={"fx": 180.0}))))
    comparison = act(bar, bar.button, window, qtbot)
    before = comparison.geometry()
    again = property(lambda _: pytest.fail("measured again"))
    monkeypatch.setattr(Table, "natural_width", again)
    for width in (1800, 960, 1280):
        window.resize(width, 720)
        QApplication.processEvents()
    assert comparison.geometry() == before


def test_a_step_that_made_the_camera_better_is_said_and_undone(
    plain: Project, open_project: Open, window: MainWindow, qtbot: QtBot
) -> None:
    first = calibrated(plain)
    open_project(first)
    done, name = window.inspector.done, next(iter(first.results))
    better = replace(first.results[name], improvements=("The board is bowed: estimated.",))
    window.session.edit("Make camera better", lambda p: record_result(p, name, plain.views, better))
    row = done.rows[0]
    assert row.words.text() == "The board is bowed: estimated." and row.link.text() == "undo"
    window.session.edit("Other", lambda p: replace(p, unit=Unit.INCH))
    assert done.rows[0].link.text() == "why", "what was done since would be taken back"
    qtbot.mouseClick(done.rows[0].link, LEFT)
    assert isinstance(window.need_analysis().shown, ResidualsPanel)
    window.session.document.undo()
    qtbot.mouseClick(done.rows[0].link, LEFT)
    assert window.session.project is first
    assert all(row.link.text() != "undo" for row in done.rows)
    qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=60_000)


def test_the_numbers_stand_on_a_map_of_the_sensor(
    plain: Project, open_project: Open, window: MainWindow
) -> None:
    bar = open_project(calibrated(plain))
    picture = bar.figures.grab().toImage()
    colours = {
        picture.pixelColor(x, picture.height() // 3).name() for x in range(20, picture.width(), 20)
    }
    assert len(colours) > 5, "the error differs over the sensor"
    assert len(bar.figures.list_places()) >= 7
    window.session.edit("Begin", lambda p: replace(p, results={}))
    assert bar.figures.list_places() == [] and bar.figures.text() == ""
