"""The desk: the photograph has the most room, and nothing is clipped at any width."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import replace
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
from calibgui.gui.canvas.layers import Layer
from calibgui.gui.dialogs.export_dialog import ExportDialog
from calibgui.gui.panels.analysis import MODES, PANELS
from calibgui.gui.panels.answer.result import ResultPanel
from calibgui.gui.panels.evidence.residuals import ResidualsPanel
from calibgui.gui.panels.method.convergence import ConvergencePanel
from calibgui.gui.panels.method.stage_one import StageOnePanel
from calibgui.gui.panels.mode_page import PANEL_WIDTH
from calibgui.gui.panels.modes import Mode
from calibgui.gui.settings.limits_choice import LimitsChoice
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.elided import ElidedLabel
from calibgui.gui.widgets.reserved_label import ReservedLabel
from calibgui.gui.window.body import Place
from calibgui.gui.window.inspector import Inspector
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


def test_the_menu_of_layers_shows_and_hides_each(full: MainWindow) -> None:
    menu, canvas = full.page.layer_menu, full.page.canvas
    assert canvas.shown == {Layer.CORNERS}, "at first sight there is one clean grid"
    for layer in Layer:
        before = layer in canvas.shown
        menu.actions_by_layer[layer].trigger()
        assert (layer in canvas.shown) is not before
    menu.scale.setValue(200)
    assert canvas.residual_scale == 200


def test_all_parts_fit_a_full_hd_screen_at_twice_the_scale(full: MainWindow, qtbot: QtBot) -> None:
    full.session.edit("Ask for the squares", lambda p: replace(p, lengths_confirmed=False))
    assert full.verdict.square.isVisible()
    resize(full, qtbot, 960, 500)
    assert full.height() == 500
    assert full.inspector.isVisible() and full.calibrate.isVisible()
    assert full.pages.width() >= 0.6 * 960
    assert list_clipped(full, qtbot) == []


def test_the_set_up_of_a_new_project_needs_no_scrolling(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    made = replace(examples.calibrated(tmp_path), lengths_confirmed=True)
    window.session.begin(Document(replace(made, settings=BEST_SETTINGS)))
    window.show_setup()
    resize(window, qtbot, 1280, 720)
    [area] = window.setup.findChildren(QScrollArea)
    qtbot.waitUntil(lambda: area.verticalScrollBar().maximum() == 0, timeout=1000)


def test_the_folds_of_the_set_up_show_and_hide_their_parts(full: MainWindow, qtbot: QtBot) -> None:
    full.show_setup()
    limits = full.setup.findChild(LimitsChoice)
    assert isinstance(limits, LimitsChoice)
    parts = (full.board, full.settings.lens, limits, full.settings.experts)
    assert [part.isVisible() for part in parts] == [True, True, True, False]
    for fold, part in zip(full.setup.folds, parts, strict=True):
        before = part.isVisible()
        qtbot.mouseClick(fold, Qt.MouseButton.LeftButton)
        assert part.isVisible() is not before
    qtbot.keyClick(full.setup, Qt.Key.Key_Escape)
    assert not full.setup.isVisible() and not full.header.setup.isChecked()


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_no_text_is_clipped(full: MainWindow, qtbot: QtBot, width: int, height: int) -> None:
    resize(full, qtbot, width, height)
    analysis = full.need_analysis()
    full.show_setup()
    assert list_clipped(full, qtbot) == []
    full.header.setup.setChecked(False)
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
    assert window.inspector.width() == Inspector.WIDTH
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


def test_the_desk_has_the_most_room_whatever_it_was_resized_from(
    full: MainWindow, qtbot: QtBot
) -> None:
    for (width, height), least in zip(
        (*SIZES, (960, 720)), (940, 1000, 1500, 960, 600), strict=True
    ):
        for before in SIZES:
            resize(full, qtbot, *before)
            resize(full, qtbot, width, height)
            assert full.pages.width() >= max(least, 0.6 * width)
            assert full.pages.height() >= 0.4 * height
    assert full.minimumSizeHint().width() <= 700


def test_the_inspector_stands_where_there_is_room(full: MainWindow, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: full.verdict.verdict is not None)
    body, inspector, header = full.body, full.inspector, full.header
    for size, place in (
        ((1280, 720), Place.SIDE),
        ((1100, 1000), Place.SIDE),
        ((1000, 1000), Place.ROW),
        ((960, 500), Place.SIDE),
        ((600, 720), Place.SHEET),
    ):
        resize(full, qtbot, *size)
        assert body.place is place and header.grade.isVisible() is (place is Place.SHEET), size
        assert inspector.isVisible() is (place is not Place.SHEET)
        assert list_clipped(full, qtbot) == [], size
        if place is Place.ROW:
            assert inspector.width() == body.width()
            assert inspector.y() >= full.images.y() + full.images.height()
    assert header.grade.text() == full.verdict.headline.text()
    desk = full.pages.geometry()
    qtbot.mouseClick(header.grade, Qt.MouseButton.LeftButton)
    assert inspector.isVisible() and full.pages.geometry() == desk, "it lies over the desk"
    qtbot.mouseClick(header.grade, Qt.MouseButton.LeftButton)
    assert not inspector.isVisible()


def test_the_desk_alone_fills_the_window_and_all_comes_back(full: MainWindow, qtbot: QtBot) -> None:
    resize(full, qtbot, 1280, 720)
    qtbot.waitUntil(lambda: full.verdict.verdict is not None)
    qtbot.keyClick(full, Qt.Key.Key_F7)
    assert not full.images.isVisible() and not full.inspector.isVisible()
    assert full.pages.size() == full.body.size()
    assert full.header.grade.text() == full.verdict.headline.text(), "the verdict stays in sight"
    assert full.header.grade.isVisible() and full.header.icon.grade is full.verdict.icon.grade
    qtbot.keyClick(full, Qt.Key.Key_F7)
    assert full.images.isVisible() and full.inspector.isVisible()
    assert not full.header.grade.isVisible()


def test_every_panel_is_in_one_mode_and_comes_with_it(full: MainWindow, qtbot: QtBot) -> None:
    analysis, bar = full.need_analysis(), full.header.modes
    assert len(set(PANELS)) == len(PANELS)
    for k, mode in enumerate(Mode):
        qtbot.mouseClick(bar, Qt.MouseButton.LeftButton, pos=bar.tabRect(k).center())
        if mode is Mode.PHOTOGRAPHS:
            assert full.page.isVisible()
            continue
        assert analysis.isVisible() and not full.page.isVisible()
        kinds = [kind for row in MODES[mode] for kind in row.kinds]
        qtbot.waitUntil(lambda kinds=kinds: all(analysis.panel(kind).isVisible() for kind in kinds))
        for kind in kinds:
            card = analysis.panel(kind).parentWidget()
            assert card is not None and card.width() >= PANEL_WIDTH
    qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)


def test_what_is_behind_a_link_of_the_inspector_fills_the_desk(
    full: MainWindow, qtbot: QtBot
) -> None:
    qtbot.mouseClick(full.inspector.camera.all, Qt.MouseButton.LeftButton)
    assert full.header.modes.mode is Mode.FIT
    panel = full.need_analysis().panel(ResultPanel)
    area = full.need_analysis().currentWidget()
    assert isinstance(area, QScrollArea)
    top = panel.mapTo(area, QPoint()).y()
    assert 0 <= top < area.height() / 2, "it was scrolled to"
    qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)


def test_a_corner_that_is_pointed_at_is_seen_in_its_photograph(full: MainWindow) -> None:
    panel = full.need_analysis().show_panel(ResidualsPanel)
    panel.picked.emit(2, -1)
    assert full.need_analysis().isVisible(), "a view is only selected"
    panel.picked.emit(3, 17)
    assert full.page.isVisible() and full.header.modes.mode is Mode.PHOTOGRAPHS
    assert full.page.canvas.marks.chosen == 17


def test_a_mode_comes_back_as_it_was_left(full: MainWindow, qtbot: QtBot) -> None:
    analysis = full.need_analysis()
    analysis.show_panel(ResultPanel)
    area = analysis.currentWidget()
    assert isinstance(area, QScrollArea)
    qtbot.waitUntil(lambda: analysis.panel(ResidualsPanel).isVisible())
    place = area.verticalScrollBar().value()
    full.show_mode(Mode.PHOTOGRAPHS)
    full.show_mode(Mode.FIT)
    assert analysis.panel(ResultPanel).isVisible() and area.verticalScrollBar().value() == place
    qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)


@pytest.mark.parametrize("kind", [StageOnePanel, ResultPanel, ConvergencePanel])
def test_calibrating_stays_where_one_is(
    full: MainWindow, qtbot: QtBot, kind: type[ResultPanel]
) -> None:
    panel = full.need_analysis().show_panel(kind)
    qtbot.mouseClick(full.calibrate, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: len(full.session.project.results) == 3, timeout=30_000)
    qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=30_000)
    assert panel.isVisible()


def test_a_threshold_moves_nothing(full: MainWindow, qtbot: QtBot) -> None:
    resize(full, qtbot, 960, 1000)
    images = full.images
    before = images.geometry(), images.list.geometry()
    images.list._move_threshold(0.5 * images.list.top)
    assert "above" in images.exclude_above.text() and images.exclude_above.isVisible()
    assert (images.geometry(), images.list.geometry()) == before


def test_a_message_lies_over_the_picture(full: MainWindow) -> None:
    places = full.page.canvas.geometry(), full.calibrate.geometry()
    full.show_failure(CalibrationError("It cannot be.", "Do otherwise."))
    QApplication.processEvents()
    assert full.banner.isVisible() and full.banner.width() == full.page.canvas.width()
    assert (full.page.canvas.geometry(), full.calibrate.geometry()) == places
    full.session.select(full.session.project.views[6].image)
    assert full.page.reason.isVisible()
    assert (full.page.canvas.geometry(), full.calibrate.geometry()) == places


def test_a_photograph_of_4_by_3_has_the_height_of_the_desk(
    window: MainWindow, qtbot: QtBot
) -> None:
    window.files.open_sample()
    qtbot.waitUntil(lambda: window.page.shown_path != "")
    assert window.size() == QSize(1280, 720)
    qtbot.waitUntil(lambda: window.page.canvas.zoom * 640 >= 680)


def test_there_is_no_verdict_on_nothing(full: MainWindow, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: full.verdict.verdict is not None)
    assert full.verdict.isVisible()
    full.session.begin(Document())
    assert not full.verdict.isVisible() and not full.header.grade.isVisible()


def test_another_verdict_moves_nothing(full: MainWindow, qtbot: QtBot) -> None:
    verdict = full.verdict
    qtbot.waitUntil(lambda: verdict.verdict is not None)
    parts = (full.header.modes, full.calibrate, verdict.figures, full.pages)
    places = [part.geometry() for part in parts]
    assert not verdict.unfold.isVisible()
    verdict.unfold.show()
    verdict.button.show()
    verdict.reason.setText(
        "Out of date, as images or board have changed: calibrate again. The photographs show "
        "nothing wrong."
    )
    for _ in range(3):
        QApplication.processEvents()
    assert [part.geometry() for part in parts] == places


def test_a_low_window_leaves_its_height_to_what_is_below_the_verdict(
    full: MainWindow, qtbot: QtBot
) -> None:
    figures = full.verdict.figures
    qtbot.waitUntil(lambda: full.verdict.verdict is not None)
    resize(full, qtbot, 960, 720)
    tall, said = figures.height(), figures.text()
    resize(full, qtbot, 960, 500)
    qtbot.waitUntil(lambda: figures.height() < tall - 20)
    assert figures.text() == said and said in figures.toolTip()
    resize(full, qtbot, 960, 720)
    qtbot.waitUntil(lambda: figures.height() == tall)


def test_a_high_window_has_room_for_a_long_reason(full: MainWindow, qtbot: QtBot) -> None:
    verdict = full.verdict
    qtbot.waitUntil(lambda: verdict.verdict is not None)
    resize(full, qtbot, 1920, 1080)
    reason = "Nothing is wrong among corners"
    while verdict.reason.count_lines() < 3:
        reason += "; beyond them they"
        verdict.reason.setText(reason)
    assert not verdict.reason.is_cut


def test_a_result_is_exported_from_beside_its_name(full: MainWindow, qtbot: QtBot) -> None:
    resize(full, qtbot, 960, 720)
    qtbot.mouseClick(full.header.export, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: isinstance(QApplication.activeModalWidget(), ExportDialog))
    dialog = QApplication.activeModalWidget()
    assert dialog is not None
    dialog.close()
    full.session.begin(Document())
    assert not full.header.export.isEnabled()


def test_a_first_calibration_is_said_to_be_on_its_way(window: MainWindow, qtbot: QtBot) -> None:
    headline = window.verdict.headline
    assert headline.text() == "NOT CALIBRATED"
    window.files.open_sample()
    qtbot.waitUntil(lambda: headline.text() == "SEARCHING CORNERS…", timeout=20_000)
    window.progress.cancel.click()
    qtbot.waitUntil(lambda: headline.text() == "NOT CALIBRATED", timeout=20_000)
    qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=20_000)


def test_the_modes_have_a_row_of_their_own_in_a_narrow_window(
    full: MainWindow, qtbot: QtBot
) -> None:
    bar = full.header.modes
    for width, is_folded in ((1280, False), (700, True), (1920, False)):
        resize(full, qtbot, width, 720)
        assert (bar.y() >= full.header.export.height()) is is_folded
        assert bar.tabRect(bar.count() - 1).right() <= bar.width() <= full.width()
        assert list_clipped(full, qtbot) == []


def test_what_opens_at_the_verdict_lies_over_the_desk_and_below_a_message(
    full: MainWindow, qtbot: QtBot
) -> None:
    verdict, findings = full.verdict, full.verdict.findings
    qtbot.waitUntil(lambda: verdict.verdict is not None)
    for size in SIZES:
        resize(full, qtbot, *size)
        findings.show()
        assert findings.width() == full.pages.width() and findings.y() == 0
        assert findings.height() <= full.pages.height()
    full.show_failure(CalibrationError("It cannot be.", "Do otherwise."))
    QApplication.processEvents()
    assert findings.y() == full.banner.height() > 0, "it covers no message"
    full.banner.dismiss.click()
    assert findings.y() == 0


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
    window.files.open_sample()
    assert window.images.isVisible() and window.inspector.isVisible()
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
    assert window.page.isVisible(), "the tool works on the photograph"
    assert window.page.marker.corner_bar.isVisible() and not window.inspector.done.isVisible()
    assert window.page.canvas.geometry() == place
    hand.key(Qt.Key.Key_Escape)
    assert window.inspector.camera.isVisible()


def test_an_open_sheet_follows_a_switch_of_the_theme(full: MainWindow, qapp: QApplication) -> None:
    full.show_setup()
    try:
        for scheme in (theme.Scheme.DARK, theme.Scheme.LIGHT):
            theme.apply(qapp, scheme)
            QApplication.processEvents()
            shown = full.setup.palette().windowText().color().name()
            assert shown == theme.current().text, scheme
    finally:
        theme.apply(qapp, theme.Scheme.LIGHT)


def test_the_verdict_has_its_height_after_every_resize(full: MainWindow, qtbot: QtBot) -> None:
    bar = full.verdict
    sizes = ((1280, 720), (1366, 768), (1280, 720), (960, 1000), (1366, 768), (1920, 1080))
    for width, height in sizes:
        full.resize(width, height)
        qtbot.wait(50)
        assert bar.height() >= bar.sizeHint().height(), (width, height)
        assert bar.figures.geometry().bottom() < bar.height()
