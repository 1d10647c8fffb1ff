"""The list of images: what it says, how it is sorted, what keys do in it."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QApplication,
)
from pytestqt.qtbot import QtBot

from calibgui.gui.images.image_model import Role
from calibgui.gui.widgets import theme
from calibgui.gui.window.main_window import MainWindow

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
