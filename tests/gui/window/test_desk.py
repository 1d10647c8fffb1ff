"""The desk: the photograph has the most room, and nothing is clipped at any width."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from PySide6.QtCore import QByteArray, QPoint, QSettings, QSize, Qt
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QCheckBox,
    QComboBox,
    QLabel,
    QScrollArea,
    QStyle,
    QTabBar,
    QTableView,
    QWidget,
)
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.settings import BEST_SETTINGS
from calibgui.app.projects.document import Document
from calibgui.engine.errors import CalibrationError
from calibgui.gui.dialogs.export_dialog import ExportDialog
from calibgui.gui.panels.analysis import GROUPS, PANELS
from calibgui.gui.panels.answer.result import ResultPanel
from calibgui.gui.panels.groups import Group
from calibgui.gui.panels.method.convergence import ConvergencePanel
from calibgui.gui.panels.method.stage_one import StageOnePanel
from calibgui.gui.widgets.elided import ElidedLabel
from calibgui.gui.widgets.reserved_label import ReservedLabel
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples
from tests.gui.hand import Hand

SIZES = [(1280, 720), (1366, 768), (1920, 1080), (960, 1000)]


def resize(window: MainWindow, qtbot: QtBot, width: int, height: int) -> None:
    window.resize(width, height)
    qtbot.waitUntil(lambda: window.width() == width)
    QApplication.processEvents()


def find_clipped(root: QWidget) -> Iterator[str]:
    """Yield what is in sight with less room than its text takes."""
    for widget in root.findChildren(QWidget):
        if not widget.isVisible() or isinstance(widget, ElidedLabel):
            continue
        text = ""
        match widget:
            case QAbstractButton() if widget.text() and not isinstance(widget, QCheckBox):
                text, needed = widget.text(), widget.minimumSizeHint()
                clipped = widget.width() < needed.width() or widget.height() < needed.height()
            case QCheckBox() if widget.text():
                text, needed = widget.text(), widget.sizeHint()
                clipped = widget.width() < needed.width() or widget.height() < needed.height()
            case ReservedLabel():
                text, clipped = widget.text(), widget.is_cut
            case QLabel() if widget.text():
                text = widget.text()
                height = (
                    widget.heightForWidth(widget.width())
                    if widget.wordWrap()
                    else widget.sizeHint().height()
                )
                wide = widget.width() >= widget.sizeHint().width() or widget.wordWrap()
                clipped = widget.height() < height or not wide
            case QTabBar():
                text = " | ".join(map(widget.tabText, range(widget.count())))
                clipped = widget.width() < widget.tabRect(widget.count() - 1).right()
            case QComboBox():
                text, clipped = (
                    widget.currentText(),
                    widget.height() < widget.minimumSizeHint().height(),
                )
            case QTableView():
                text = widget.accessibleName()
                clipped = widget.horizontalHeader().length() > widget.viewport().width()
            case _:
                continue
        if clipped:
            yield f"{type(widget).__name__} {text!r} has {widget.width()} x {widget.height()} px"


def list_clipped(root: QWidget, qtbot: QtBot) -> list[str]:
    """What stays clipped once the layouts have settled."""
    with contextlib.suppress(qtbot.TimeoutError):
        qtbot.waitUntil(lambda: not list(find_clipped(root)), timeout=1000)
    return list(find_clipped(root))


def test_the_layers_stand_at_even_distances(full: MainWindow, qtbot: QtBot) -> None:
    full.inspector.show_image_page()
    resize(full, qtbot, 1280, 720)
    eyes = full.page.layer_list.eyes.values()
    tops = [eye.mapTo(full, eye.rect().center()).y() for eye in eyes]
    steps = {below - above for above, below in pairwise(tops)}
    assert max(steps) - min(steps) <= 1


def test_all_parts_fit_a_full_hd_screen_at_twice_the_scale(full: MainWindow, qtbot: QtBot) -> None:
    full.session.edit("Ask for the squares", lambda p: replace(p, lengths_confirmed=False))
    assert full.verdict.square.isVisible()
    qtbot.waitUntil(lambda: full.minimumSizeHint().height() <= 500)
    resize(full, qtbot, 960, 500)
    assert full.height() == 500
    assert not list(find_clipped(full))


def test_the_set_up_of_a_new_project_needs_no_scrolling(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    """Once the side of a square is confirmed, which the verdict asks for until then."""
    made = replace(examples.calibrated(tmp_path), lengths_confirmed=True)
    window.session.begin(Document(replace(made, settings=BEST_SETTINGS)))
    window.inspector.show_setup()
    resize(window, qtbot, 1280, 720)
    pages = window.inspector.findChildren(QScrollArea)
    [area] = [area for area in pages if area.isAncestorOf(window.settings)]
    qtbot.waitUntil(lambda: area.verticalScrollBar().maximum() == 0, timeout=1000)


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_no_text_is_clipped(full: MainWindow, qtbot: QtBot, width: int, height: int) -> None:
    resize(full, qtbot, width, height)
    analysis = full.need_analysis()
    for show in (full.inspector.show_image_page, full.inspector.show_setup):
        show()
        assert list_clipped(full, qtbot) == []
    for kind in PANELS:
        analysis.show_panel(kind)
        assert list_clipped(full, qtbot) == [], kind.__name__
        assert (full.width(), full.height()) == (width, height), kind.__name__
    qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)


def test_every_panel_has_its_room_in_a_window_that_starts_with_photographs(
    qtbot: QtBot, tmp_path: Path
) -> None:
    """As with a folder on the command line: they come before the window was ever painted."""
    window = MainWindow()
    qtbot.addWidget(window)
    window.resize(960, 720)
    window.show()
    project = examples.calibrated(tmp_path)
    window.session.begin(Document(project))
    qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=60_000)
    analysis = window.need_analysis()
    assert window.inspector.width() >= window.inspector.minimumSizeHint().width()
    for kind in PANELS:
        panel = analysis.show_panel(kind)
        assert panel.isVisible() and panel.width() >= panel.minimumSizeHint().width(), kind
        qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=60_000)
    table = analysis.show_panel(StageOnePanel).table
    names = [str(table.model().index(row, 0).data()) for row in range(table.model().rowCount())]
    room = table.columnWidth(0) - 2 * table.style().pixelMetric(
        QStyle.PixelMetric.PM_FocusFrameHMargin
    )
    assert all(table.fontMetrics().horizontalAdvance(name) <= room for name in names)
    window.session.document.mark_saved(project, window.files.saver.file)
    window.close()


@pytest.mark.parametrize(("width", "least"), [(1280, 800), (1366, 850), (1920, 1200), (960, 500)])
def test_the_photograph_has_the_most_room(
    full: MainWindow, qtbot: QtBot, width: int, least: int
) -> None:
    resize(full, qtbot, width, 720)
    full.inspector_dock.hide()
    full.inspector_dock.show()
    full.change_room()
    qtbot.waitUntil(lambda: full.page.canvas.width() < width / 2)
    full.change_room()
    qtbot.waitUntil(lambda: full.page.canvas.width() >= least)
    assert full.minimumSizeHint().width() <= 960


def test_the_inspector_gets_room_and_gives_it_back(full: MainWindow, qtbot: QtBot) -> None:
    before = full.page.canvas.width()
    qtbot.mouseClick(full.inspector.room, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: full.inspector.width() > 0.6 * full.width())
    assert full.page.canvas.isVisible()
    qtbot.keyClick(full, Qt.Key.Key_F8)
    qtbot.waitUntil(lambda: abs(full.page.canvas.width() - before) < 30)


def test_the_photograph_alone_fills_the_window_and_all_comes_back(
    full: MainWindow, qtbot: QtBot
) -> None:
    resize(full, qtbot, 1280, 720)
    full.inspector_dock.hide()
    qtbot.keyClick(full, Qt.Key.Key_F7)
    assert not full.strip_dock.isVisible()
    page = full.page
    qtbot.waitUntil(lambda: page.canvas.width() + page.bar.width() == full.width())
    qtbot.waitUntil(lambda: page.canvas.height() >= 560)
    assert full.verdict.isVisible()
    qtbot.keyClick(full, Qt.Key.Key_F7)
    assert full.strip_dock.isVisible() and not full.inspector_dock.isVisible()
    full.inspector_dock.show()
    for shown in (False, True):
        qtbot.keyClick(full, Qt.Key.Key_F7)
        assert full.strip_dock.isVisible() is full.inspector_dock.isVisible() is shown


def test_every_panel_is_in_one_group_and_comes_by_its_name(full: MainWindow, qtbot: QtBot) -> None:
    analysis = full.need_analysis()
    assert len(set(PANELS)) == len(PANELS) == sum(map(len, GROUPS.values()))
    for k, group in enumerate(Group):
        tabs = full.inspector.tabs
        at = tabs.tabRect(2 + k).center()
        qtbot.mouseClick(tabs, Qt.MouseButton.LeftButton, pos=at)
        assert analysis.isVisible()
        for kind in GROUPS[group]:
            button = analysis.choosers[group].buttons[kind]
            qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
            assert analysis.panel(kind).isVisible()
    qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)


def test_a_group_comes_back_with_the_panel_that_was_left(full: MainWindow) -> None:
    analysis = full.need_analysis()
    analysis.show_panel(StageOnePanel)
    full.inspector.show_group(Group.ANSWER)
    assert analysis.panel(ResultPanel).isVisible()
    full.inspector.show_group(Group.METHOD)
    assert analysis.panel(StageOnePanel).isVisible()


@pytest.mark.parametrize("kind", [StageOnePanel, ResultPanel, ConvergencePanel])
def test_calibrating_stays_where_one_is(
    full: MainWindow, qtbot: QtBot, kind: type[ResultPanel]
) -> None:
    panel = full.need_analysis().show_panel(kind)
    qtbot.mouseClick(full.calibrate, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: len(full.session.project.results) == 3, timeout=30_000)
    qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=30_000)
    assert panel.isVisible()


def test_a_narrow_strip_is_left_to_the_images(full: MainWindow, qtbot: QtBot) -> None:
    resize(full, qtbot, 1280, 720)
    assert full.images.controls.isVisible()
    full.change_room()
    qtbot.waitUntil(lambda: not full.images.controls.isVisible())
    full.change_room()
    qtbot.waitUntil(full.images.controls.isVisible)


def test_a_threshold_leaves_the_controls_where_they_are(full: MainWindow, qtbot: QtBot) -> None:
    resize(full, qtbot, 960, 1000)
    images = full.images
    before = images.exclude_above.geometry()
    images.threshold.setValue(0.5 * images.list.top)
    assert images.exclude_above.text().startswith("E&xclude above: ")
    resize(full, qtbot, 1000, 1000)
    resize(full, qtbot, 960, 1000)
    assert images.controls.isVisible() and images.exclude_above.geometry() == before


def test_a_message_lies_over_the_picture(full: MainWindow) -> None:
    places = full.page.canvas.geometry(), full.calibrate.geometry()
    full.show_failure(CalibrationError("It cannot be.", "Do otherwise."))
    QApplication.processEvents()
    assert full.banner.isVisible() and full.banner.width() == full.pages.width()
    assert (full.page.canvas.geometry(), full.calibrate.geometry()) == places
    full.session.select(full.session.project.views[6].image)
    assert full.page.reason.isVisible()
    assert (full.page.canvas.geometry(), full.calibrate.geometry()) == places


def test_a_photograph_of_4_by_3_is_800_px_wide(window: MainWindow, qtbot: QtBot) -> None:
    window.files.open_sample()
    qtbot.waitUntil(lambda: window.page.shown_path != "")
    assert window.size() == QSize(1280, 720)
    qtbot.waitUntil(lambda: window.page.canvas.zoom * 640 >= 800)


def test_the_verdict_is_always_in_sight(full: MainWindow, qtbot: QtBot) -> None:
    verdict, dock = full.verdict, full.inspector_dock
    qtbot.waitUntil(lambda: verdict.verdict is not None)
    assert full.inspector.isAncestorOf(verdict)
    dock.hide()
    qtbot.waitUntil(lambda: abs(verdict.width() - full.width()) < 24)
    assert verdict.isVisible() and verdict.mapTo(full, QPoint()).y() < 60
    dock.show()
    qtbot.waitUntil(lambda: verdict.width() < full.width() / 2)
    assert verdict.isVisible() and full.inspector.isAncestorOf(verdict)
    full.session.begin(Document())
    assert not verdict.isVisible(), "there is nothing to judge"


def test_another_verdict_moves_nothing(full: MainWindow, qtbot: QtBot) -> None:
    verdict = full.verdict
    qtbot.waitUntil(lambda: verdict.verdict is not None)
    places = full.inspector.tabs.geometry(), full.calibrate.geometry()
    assert not verdict.unfold.isVisible()
    verdict.unfold.show()
    verdict.button.show()
    verdict.reason.setText(
        "Out of date, as images or board have changed: calibrate again. The photographs show "
        "nothing wrong."
    )
    verdict.figures.setText("RMS 0.1 px")
    for _ in range(3):
        QApplication.processEvents()
    assert (full.inspector.tabs.geometry(), full.calibrate.geometry()) == places


def test_a_low_window_leaves_its_height_to_what_is_below_the_verdict(
    full: MainWindow, qtbot: QtBot
) -> None:
    verdict = full.verdict
    qtbot.waitUntil(lambda: verdict.verdict is not None)
    resize(full, qtbot, 960, 720)
    tall, figures = verdict.height(), verdict.figures.text().split("\n")
    full.resize(960, 500)
    qtbot.waitUntil(lambda: verdict.height() < tall - 20)
    assert verdict.figures.text() == figures[0]
    assert all(figure in verdict.figures.toolTip() for figure in figures)
    full.resize(960, 720)
    qtbot.waitUntil(lambda: verdict.height() == tall)


def test_a_high_window_has_all_figures_below_a_long_reason(full: MainWindow, qtbot: QtBot) -> None:
    verdict = full.verdict
    qtbot.waitUntil(lambda: verdict.verdict is not None)
    resize(full, qtbot, 960, 1000)
    reason = "Nothing is wrong among corners"
    while verdict.reason.count_lines() < 3:
        reason += "; beyond them they"
        verdict._words.give_reason(reason)
    verdict.figures.setText(
        "Error: centre 0.001, covered 0.003, edge 6.4, worst 22 px\n"
        "6.5 mm at the edge, 233 mm away if squares are 30 mm\n"
        "RMS 0.017 px, σ 0.012 px of 948 corners"
    )
    assert not verdict.reason.is_cut and not verdict.figures.is_cut


def test_a_result_is_exported_from_beside_its_name(full: MainWindow, qtbot: QtBot) -> None:
    resize(full, qtbot, 960, 720)
    qtbot.mouseClick(full.need_analysis().export, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: isinstance(QApplication.activeModalWidget(), ExportDialog))
    dialog = QApplication.activeModalWidget()
    assert dialog is not None
    dialog.close()
    full.session.begin(Document())
    assert not full.need_analysis().export.isEnabled()


def test_a_first_calibration_is_said_to_be_on_its_way(window: MainWindow, qtbot: QtBot) -> None:
    headline = window.verdict.headline
    assert headline.text() == "NOT CALIBRATED"
    window.files.open_sample()
    qtbot.waitUntil(lambda: headline.text() == "CALIBRATING…", timeout=20_000)
    window.progress.cancel.click()
    qtbot.waitUntil(lambda: headline.text() == "NOT CALIBRATED", timeout=20_000)
    qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=20_000)


def test_names_of_panels_take_one_row_where_there_is_room(full: MainWindow, qtbot: QtBot) -> None:
    resize(full, qtbot, 1280, 720)
    analysis = full.need_analysis()

    def list_heights() -> list[set[int]]:
        heights = []
        for group, kinds in GROUPS.items():
            analysis.show_panel(kinds[0])
            buttons = analysis.choosers[group].buttons.values()
            heights.append({button.y() for button in buttons})
        return heights

    assert {len(heights) for heights in list_heights()} == {2}
    full.change_room()
    qtbot.waitUntil(lambda: {len(heights) for heights in list_heights()} == {1})
    assert list_clipped(full, qtbot) == []


def test_what_opens_at_the_verdict_stands_beside_or_below_it(
    full: MainWindow, qtbot: QtBot
) -> None:
    verdict, findings = full.verdict, full.verdict.findings
    qtbot.waitUntil(lambda: verdict.verdict is not None)
    findings.open_up()
    assert findings.width() == full.pages.width() < verdict.mapTo(full, QPoint()).x()
    assert findings.pos() == full.pages.mapTo(full, QPoint()), "it cuts neither tools nor caption"
    resize(full, qtbot, 960, 1000)
    assert findings.width() == full.width(), "there is too little room beside it"
    full.inspector_dock.hide()
    qtbot.waitUntil(lambda: findings.width() == verdict.width())
    assert findings.y() == verdict.mapTo(full, QPoint(0, verdict.height())).y()


def test_the_progress_of_work_moves_nothing(full: MainWindow, qtbot: QtBot) -> None:
    place = full.calibrate.geometry()
    job = full.session.jobs.start("Working", lambda job: job.cancelling.wait(5))
    QApplication.processEvents()
    assert full.calibrate.geometry() == place
    job.cancel()
    qtbot.waitUntil(lambda: not full.session.jobs.running)


def test_a_layout_of_the_earlier_window_is_not_restored(
    window: MainWindow, qtbot: QtBot, full: MainWindow
) -> None:
    QSettings().setValue("layout", QByteArray(b"\x00\x00\x00\xffnonsense of an older version"))
    full.session.begin(Document())
    QSettings().setValue("layout", QByteArray(b"\x00\x00\x00\xffnonsense of an older version"))
    window.files.open_sample()
    assert window.strip_dock.isVisible() and window.inspector_dock.isVisible()
    qtbot.waitUntil(lambda: window.page.canvas.width() >= 780)


def test_the_inspector_follows_the_tool_that_is_taken(window: MainWindow, qtbot: QtBot) -> None:
    window.files.open_sample()
    hand = Hand(window, qtbot)
    hand.wait(lambda: window.session.result is not None)
    hand.wait(lambda: window.page.shown_path != "")
    hand.wait(lambda: not window.session.jobs.running)
    window.need_analysis().show_panel(StageOnePanel)
    place = window.page.canvas.geometry()
    window.page.tools[1].trigger()
    assert window.page.marker.corner_bar.isVisible()
    assert window.page.canvas.geometry() == place
    hand.key(Qt.Key.Key_Escape)
    assert window.need_analysis().panel(StageOnePanel).isVisible()
