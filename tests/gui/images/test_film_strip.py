"""The list of images: what it says, how it is sorted, what keys do in it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QApplication,
)
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.dataset import CornerSet
from calibgui.gui.images.image_model import Role
from calibgui.gui.widgets import theme
from calibgui.gui.window.main_window import MainWindow
from tests.gui.panels.conftest import drag

LEFT = Qt.MouseButton.LeftButton


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
    assert full.header.summary.text().startswith("6 of 7 photographs usable")
    tip = full.images.list.model().index(6, 0).data(Qt.ItemDataRole.ToolTipRole)
    assert "No checkerboard was found" in tip


def test_sorting_by_name_status_and_error(full: MainWindow) -> None:
    full.images.sorting[2].trigger()
    rms = [value for value in listed(full, Role.RMS) if value is not None]
    assert rms == sorted(rms, reverse=True)
    assert listed(full)[-1] == "blank.png"
    full.images.sorting[1].trigger()
    assert listed(full, Role.STATUS)[-1] == "no board"
    full.images.sorting[0].trigger()
    assert listed(full)[0] == "0.png"


def test_what_is_sorted_by_error_stays_in_sight(full: MainWindow, qtbot: QtBot) -> None:
    view, session = full.images.list, full.session
    full.resize(960, 720)
    bar = view.horizontalScrollBar()
    qtbot.waitUntil(lambda: bar.maximum() > 0)
    bar.setValue(bar.maximum())
    full.images.sorting[2].trigger()
    assert bar.value() == 0

    def is_in_sight() -> bool:
        return view.viewport().rect().contains(view.visualRect(view.currentIndex()).center())

    view.setCurrentIndex(view.model().index(0, 0))
    for change in (lambda: full.images.exclude(full.images.chosen), session.document.undo):
        before = session.result
        change()
        qtbot.waitUntil(lambda before=before: session.result is not before)
        qtbot.waitUntil(is_in_sight)
    assert view.currentIndex().row() == 0


def test_several_images_are_excluded_and_removed_by_keys(
    full: MainWindow, qtbot: QtBot, qapp: QApplication
) -> None:
    view = full.images.list
    full.images.follows.setChecked(False)
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
    reason = full.verdict.reason
    assert reason.text().startswith("Out of date, as images")
    theme.apply(qapp, theme.Scheme.DARK)
    qapp.processEvents()
    assert reason.palette().color(reason.foregroundRole()).name() == theme.current().warning
    assert len(full.images.chosen) == 3, "an edit keeps the selection"
    qtbot.keyClick(view, Qt.Key.Key_Space)
    assert all(v.enabled for v in full.session.project.views)
    qtbot.keyClick(view, Qt.Key.Key_Delete)
    assert listed(full) == ["0.png", "4.png", "5.png", "blank.png"]
    for _ in range(3):
        full.session.document.undo()
    assert len(listed(full)) == 7
    assert "Out of date" not in reason.text()


def test_what_is_heard_of_an_image_holds_its_error(full: MainWindow) -> None:
    spoken = listed(full, Qt.ItemDataRole.AccessibleTextRole)
    rms = listed(full, Role.RMS)
    assert spoken[0] == f"0.png, 42 of 42 corners, error {rms[0]:.3f} px"
    assert spoken[6] == "blank.png, no board"


def test_dragging_the_threshold_selects_the_images_above_and_a_button_excludes_them(
    full: MainWindow, qtbot: QtBot
) -> None:
    strip, view = full.images, full.images.list
    assert strip.above == [] and not strip.exclude_above.isVisible()
    rms = dict(zip(listed(full, Role.PATH), listed(full, Role.RMS), strict=True))
    errors = sorted((error for error in rms.values() if error is not None), reverse=True)
    between = (errors[1] + errors[2]) / 2
    x = view.viewport().width() // 2
    drag(
        qtbot,
        view.viewport(),
        QPoint(x, round(view.place_of(view.threshold))),
        QPoint(x, round(view.place_of(between))),
    )
    one_pixel = view.top / (view.place_of(0.0) - view.place_of(view.top))
    assert view.threshold == pytest.approx(between, abs=one_pixel)
    worst = {path for path, error in rms.items() if error is not None and error > view.threshold}
    assert set(strip.chosen) == set(strip.above) == worst
    strip.list._move_threshold(between)
    assert len(strip.chosen) == 2 and strip.exclude_above.text().endswith("2 above · leave out")
    qtbot.mouseClick(strip.exclude_above, LEFT)
    assert [v.image for v in full.session.project.views if not v.enabled] == sorted(strip_two(rms))
    assert full.session.document.undo_label == "Exclude 2 images"


def strip_two(rms: dict[str, float | None]) -> list[str]:
    """The two images with the largest errors."""
    return sorted(rms, key=lambda path: -(rms[path] or 0.0))[:2]


def test_the_threshold_is_moved_by_keys(full: MainWindow, qtbot: QtBot) -> None:
    strip, view = full.images, full.images.list
    view.setFocus()
    while not strip.above:
        before = view.threshold
        qtbot.keyClick(view, Qt.Key.Key_Down)
        assert view.threshold < before
    assert set(strip.chosen) == set(strip.above) and strip.exclude_above.isVisible()
    for _ in range(50):
        qtbot.keyClick(view, Qt.Key.Key_Down)
    assert view.threshold == 0.0 and len(strip.above) == 6
    assert not strip.exclude_above.isEnabled(), "nothing would be left"
    for _ in range(50):
        qtbot.keyClick(view, Qt.Key.Key_Up)
    assert view.threshold == view.top and strip.above == []


def test_the_words_of_the_threshold_stand_at_its_right_end(full: MainWindow) -> None:
    view, words = full.images.list, full.images.exclude_above
    for share in (0.9, 0.5, 0.1):
        view._move_threshold(share * view.top)
        assert words.geometry().right() <= view.viewport().width()
        assert words.geometry().bottom() == pytest.approx(view.place_of(view.threshold), abs=2)


def test_a_result_with_other_errors_puts_the_threshold_above_them(full: MainWindow) -> None:
    session, strip = full.session, full.images
    assert session.result is not None
    calibration = session.result.calibration
    larger = tuple(replace(one, image=1000 * one.image) for one in calibration.residuals)
    worse = replace(session.result, calibration=replace(calibration, residuals=larger))
    chosen = strip.chosen
    session.edit("Calibrate", lambda p: replace(p, results={session.result_name: worse}))
    assert strip.list.threshold == strip.list.top and not strip.exclude_above.isVisible()
    assert strip.above == [] and strip.chosen == chosen


def test_what_the_threshold_selected_is_not_selected_without_it(
    full: MainWindow, qtbot: QtBot
) -> None:
    strip, session = full.images, full.session
    first, before = session.result, strip.chosen
    errors = sorted(error for error in listed(full, Role.RMS) if isinstance(error, float))
    strip.list._move_threshold(errors[3])
    assert set(strip.chosen) == set(strip.above) != set(before)
    qtbot.mouseClick(strip.exclude_above, LEFT)
    qtbot.waitUntil(lambda: session.result is not first)
    assert not strip.above and strip.chosen == before
    session.document.undo()
    assert session.result is first and strip.chosen == before
    # What the user selects stays.
    strip.list._move_threshold(errors[3])
    strip.list.selectAll()
    strip.exclude(strip.above)
    qtbot.waitUntil(lambda: session.result is not first)
    assert len(strip.chosen) == 7


def test_a_bar_is_as_high_as_its_error(full: MainWindow) -> None:
    view = full.images.list
    QApplication.processEvents()
    picture = view.viewport().grab().toImage()
    for row, error in enumerate(listed(full, Role.RMS)[:6]):
        x = view.visualRect(view.model().index(row, 0)).left() + 40
        colour = QColor(theme.current().bar)
        drawn = [y for y in range(picture.height()) if picture.pixelColor(x, y) == colour]
        assert min(drawn) == pytest.approx(view.place_of(error), abs=1.0)


def test_the_fit_follows_and_one_undo_takes_both_back(full: MainWindow, qtbot: QtBot) -> None:
    session = full.session
    before, names = session.result, list(session.project.results)
    full.images.list.setFocus()
    qtbot.keyClick(full.images.list, Qt.Key.Key_Space)
    assert not session.project.views[0].enabled
    qtbot.waitUntil(lambda: session.project.is_current(session.result), timeout=20_000)
    assert session.result is not before and len(session.result.used) == 5
    assert list(session.project.results) == names, "it takes the place of the one before"
    assert listed(full, Role.RMS)[0] is None
    expected = calibrate_views(
        CornerSet(session.project.size, session.project.views, session.project.board),
        session.project.settings,
    )
    found = session.result.calibration.camera.params
    np.testing.assert_allclose(found, expected.calibration.camera.params, rtol=1e-9)
    session.document.undo()
    assert session.result is before and session.project.views[0].enabled
    session.document.redo()
    assert len(session.result.used) == 5


def test_the_fit_does_not_follow_if_it_is_not_wanted(full: MainWindow) -> None:
    before = full.session.result
    full.images.follows.trigger()
    full.images.exclude([full.session.image])
    assert not full.session.jobs.running
    assert full.session.result is before
    assert not full.session.project.is_current(before)


def test_space_means_the_same_on_the_photograph(full: MainWindow, qtbot: QtBot) -> None:
    full.images.follows.setChecked(False)
    full.page.canvas.setFocus()
    qtbot.keyClick(full.page.canvas, Qt.Key.Key_Space)
    assert [v.enabled for v in full.session.project.views] == [False, *[True] * 6]
    qtbot.keyClick(full.page.canvas, Qt.Key.Key_Space)
    assert all(v.enabled for v in full.session.project.views)


def test_arrow_keys_go_along_the_strip(full: MainWindow, qtbot: QtBot) -> None:
    view = full.images.list
    view.setFocus()
    qtbot.keyClick(view, Qt.Key.Key_Right)
    assert full.session.image.endswith("1.png")
    qtbot.keyClick(view, Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
    assert len(full.images.chosen) == 2
