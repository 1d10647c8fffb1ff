"""The settings: what they become, and what they do."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import (
    QApplication,
    QComboBox,
    QFileDialog,
)
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import MODEL_CHOICES, Settings, check_settings
from calibgui.app.projects.project import change_views
from calibgui.dataset import CornerSet
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.methods import METHODS, check_method
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.models import PINHOLE, find_model, list_parameter_names
from calibgui.formats.board_shape_json import write_board_shape
from calibgui.gui.images.image_model import Role
from calibgui.gui.settings.settings_panel import SettingsPanel
from calibgui.gui.window.main_window import MainWindow

LEFT = Qt.MouseButton.LeftButton


def test_settings_become_arguments_of_the_calibration(full: MainWindow) -> None:
    panel = full.settings
    names = list_parameter_names("lucchese")
    assert [name for name in names if not panel.boxes[name].isChecked()] == ["k3", "p3"]
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


def shown_boxes(panel: SettingsPanel) -> list[str]:
    """Return the names of the boxes in sight, row by row."""
    boxes = [(box.y(), box.x(), name) for name, box in panel.boxes.items() if box.isVisible()]
    return [name for _, _, name in sorted(boxes)]


def choose_item(combo: QComboBox, data: str | None, qtbot: QtBot) -> None:
    """Choose an entry with the keyboard, as a user does."""
    combo.setFocus()
    step = Qt.Key.Key_Down if combo.findData(data) > combo.currentIndex() else Qt.Key.Key_Up
    while combo.currentData() != data:
        qtbot.keyClick(combo, step)


def show_all_settings(window: MainWindow) -> None:
    """Open the set-up with all that is folded up at first."""
    window.show_setup()
    for fold in window.setup.folds:
        fold.setChecked(True)


def test_the_lens_model_decides_what_can_be_held(full: MainWindow, qtbot: QtBot) -> None:
    panel, session = full.settings, full.session
    show_all_settings(full)
    models = [panel.model.itemData(k) for k in range(panel.model.count())]
    assert models == [None, *MODEL_CHOICES]
    assert shown_boxes(panel) == list(list_parameter_names("lucchese"))
    panel.values.selectAll()
    qtbot.keyClicks(panel.values, "fx=650.5, p3=0.01, k1=-0.2")
    qtbot.keyClick(panel.values, Qt.Key.Key_Return)

    choose(panel.model, "Brown-Conrady (")  # with the keyboard by way of models without k1
    settings = session.project.settings
    assert settings.model == "brown-conrady"
    assert settings.fixed == {"fx": 650.5, "k1": None, "k3": None}, "values are of the old lens"
    QApplication.processEvents()
    assert shown_boxes(panel) == list(list_parameter_names("brown-conrady"))
    assert not panel.boxes["k1"].isChecked() and panel.boxes["p1"].isChecked()
    panel.values.selectAll()
    qtbot.keyClicks(panel.values, "p3=0.01")
    qtbot.keyClick(panel.values, Qt.Key.Key_Return)
    assert session.project.settings == settings
    assert "no parameter 'p3'" in full.banner.text.text()

    session.document.undo()
    QApplication.processEvents()
    assert session.project.settings.model == "lucchese"
    assert session.project.settings.fixed["p3"] == 0.01
    assert shown_boxes(panel) == list(list_parameter_names("lucchese"))


def test_a_calibration_takes_the_chosen_lens_model(full: MainWindow, qtbot: QtBot) -> None:
    session = full.session
    choose_item(full.settings.model, "brown-conrady", qtbot)
    qtbot.mouseClick(full.calibrate, LEFT)
    qtbot.waitUntil(lambda: len(session.project.results) == 3, timeout=60_000)
    assert session.result is not None
    assert session.result.calibration.camera.model == "brown-conrady"
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)


def test_the_papers_cost_has_its_own_lens_model(full: MainWindow, qtbot: QtBot) -> None:
    panel, session = full.settings, full.session
    choose_item(panel.model, "brown-conrady", qtbot)
    choose_item(panel.cost, Cost.PAPER, qtbot)
    assert session.project.settings.model == "lucchese"
    assert not panel.model.isEnabled()
    assert "its own lens model" in panel.model.toolTip()
    check_settings(session.project.settings)
    choose_item(panel.cost, Cost.IMAGE, qtbot)
    assert panel.model.isEnabled()
    assert "its own lens model" not in panel.model.toolTip()


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
        board_shape=BoardShapeModel.FREE,
        prior=BoardShapePrior(0.25, 0.5),
        robust=True,
        weigh_views=True,
        once=True,
        improve=True,
    )
    changed = {f.name for f in fields(Settings)} - {
        "cost",
        "model",
        "candidates",
        "method",
        "known",
    }
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
    other_model = replace(everything, model="brown-conrady", freed=())
    session.edit("Settings", lambda p: replace(p, settings=other_model))
    panel.robust.click()
    assert session.project.settings == replace(other_model, robust=False)
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
    choice = panel.board_shape
    assert choice.known.isEnabled() and not choice.in_plane.isEnabled()
    choose(choice.model, "bowed")
    assert not choice.known.isEnabled()
    choose(choice.model, "free")
    assert session.project.settings.board_shape is BoardShapeModel.FREE
    qtbot.mouseClick(choice.known, LEFT, pos=QPoint(8, choice.known.height() // 2))
    assert session.project.settings.prior == BoardShapePrior(0.1, 0.3)
    choice.in_plane.setFocus()
    choice.in_plane.selectAll()
    qtbot.keyClicks(choice.in_plane, "0.25")
    qtbot.keyClick(choice.in_plane, Qt.Key.Key_Return)
    assert session.project.settings.prior == BoardShapePrior(0.25, 0.3)
    choose(choice.model, "what predicts best")
    assert (session.project.settings.board_shape, session.project.settings.prior) == (None, None)
    for prior in (BoardShapePrior(0.25, 0.3), BoardShapePrior(0.1, 0.3)):
        session.document.undo()
        assert session.project.settings.prior == prior
        assert choice.in_plane.value() == prior.in_plane

    # A shape from a file; a dialog that is left changes nothing, nor does a file of another kind.
    board_shape = BoardShape(
        BoardShapeModel.BOW, np.zeros((1, 2)), np.full((1, 3), 0.1), np.zeros((1, 3))
    )
    write_board_shape(board_shape, tmp_path / "shape.json")
    (tmp_path / "other.json").write_text("{}")
    for name in ("", str(tmp_path / "other.json")):
        monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_, name=name: (name, ""))
        choose(choice.model, "as in a file")
        assert session.project.settings.board_shape is BoardShapeModel.FREE
        assert choice.model.currentText().startswith("free")
    assert "is not a board shape" in full.banner.text.text()
    monkeypatch.setattr(
        QFileDialog, "getOpenFileName", lambda *_: (str(tmp_path / "shape.json"), "")
    )
    choose(choice.model, "as in a file")
    held = session.project.settings.board_shape
    assert isinstance(held, BoardShape)
    assert choice.model.currentText() == "as in a file: 0.17 mm off"

    # Other costs take a board as drawn.
    choose(panel.cost, "error on the reference plane")
    assert session.project.settings.board_shape is BoardShapeModel.NOMINAL
    assert not choice.isEnabled()
    session.document.undo()
    assert session.project.settings.board_shape is held


def test_outliers_left_out_are_seen_in_the_images_and_undone(
    full: MainWindow, qtbot: QtBot
) -> None:
    session = full.session
    first = session.project.views[1]
    assert first.corners is not None
    uv = np.array(first.corners.uv)
    uv[20] += [6.0, -5.0]
    moved = replace(first, corners=replace(first.corners, uv=uv))
    session.edit("Spoil", lambda p: change_views(p, [first.image], lambda _: moved))
    qtbot.mouseClick(full.settings.robust, LEFT, pos=QPoint(8, full.settings.robust.height() // 2))
    assert session.project.settings.robust
    qtbot.mouseClick(full.calibrate, LEFT)
    qtbot.waitUntil(lambda: not full.calibrator.running, timeout=30_000)
    assert session.result is not None and len(session.project.results) == 3
    assert any("1.png loses 1 corner" in text for text in session.result.calibration.warnings)
    assert session.project.is_current(session.result)
    assert full.images.list.model().index(1, 0).data(Role.STATUS) == "41 of 42 corners"
    session.document.undo()
    assert session.project.views[1] is moved
    qtbot.waitUntil(lambda: not session.jobs.running)


def test_all_fields_begin_in_one_column(full: MainWindow, qtbot: QtBot) -> None:
    show_all_settings(full)
    panel = full.settings
    fields = (panel.method, panel.model, panel.board_shape.model, panel.values)
    qtbot.waitUntil(lambda: len({field.mapTo(full, QPoint()).x() for field in fields}) == 1)


def test_a_new_project_begins_with_the_automatic_choice(window: MainWindow) -> None:
    settings = window.session.project.settings
    assert settings.model is None
    panel = window.settings
    assert panel.model.currentData() is None and panel.model.currentText() == "automatic"
    assert [n for n, box in panel.boxes.items() if not box.isHidden()] == list(PINHOLE)
    panel.boxes["cx"].click()
    assert window.session.project.settings == replace(settings, fixed={"cx": None})


def test_what_every_lens_model_has_stays_held_with_the_automatic_choice(
    full: MainWindow, qtbot: QtBot
) -> None:
    panel, session = full.settings, full.session
    panel.boxes["cy"].click()
    choose_item(panel.model, None, qtbot)
    assert session.project.settings.model is None
    assert session.project.settings.fixed == {"cy": None}, "k3 is none of every lens model's"
    panel.values.selectAll()
    qtbot.keyClicks(panel.values, "k1=0.1")
    qtbot.keyClick(panel.values, Qt.Key.Key_Return)
    assert "not all models have a parameter 'k1'" in full.banner.text.text()
    choose_item(panel.model, "kannala-brandt", qtbot)
    assert session.project.settings.fixed == {"cy": None}
    check_settings(session.project.settings)


def test_every_lens_model_can_be_chosen_and_its_parameters_held(
    full: MainWindow, qtbot: QtBot
) -> None:
    panel, session = full.settings, full.session
    show_all_settings(full)
    for model in MODEL_CHOICES:
        choose_item(panel.model, model, qtbot)
        assert session.project.settings.model == model
        QApplication.processEvents()
        names = list_parameter_names(model)
        assert shown_boxes(panel) == list(names if len(names) < 20 else PINHOLE)
        held = find_model(model).held
        for name in shown_boxes(panel):
            is_held = name in held or name in session.project.settings.fixed
            assert panel.boxes[name].isChecked() is not is_held
        check_settings(session.project.settings)
        tip = panel.model.itemData(panel.model.currentIndex(), Qt.ItemDataRole.ToolTipRole)
        assert tip.startswith(f"{model}. ") and tip.endswith(".")


def test_the_hundreds_of_a_splined_model_have_no_boxes(full: MainWindow, qtbot: QtBot) -> None:
    panel, session = full.settings, full.session
    model = "splined-stereographic-12x8-100"
    settings = Settings(model=model, fixed={"dx_2_5": 0.0})
    session.edit("Settings", lambda p: replace(p, settings=settings))
    assert panel.model.currentData() == model
    assert "12 x 8 over 100 degrees" in panel.model.currentText()
    panel.boxes["fx"].click()
    assert session.project.settings == replace(settings, freed=("fx",))
    panel.values.selectAll()
    qtbot.keyClicks(panel.values, "dy_1_1=0.01")
    qtbot.keyClick(panel.values, Qt.Key.Key_Return)
    assert session.project.settings.fixed == {"dy_1_1": 0.01}
    check_settings(session.project.settings)


def test_a_model_of_the_comparison_is_taken_as_it_was_compared(full: MainWindow) -> None:
    panel, session = full.settings, full.session
    before = Settings(Cost.PAPER, fixed={"cx": 97.0, "k3": None}, freed=("p3",))
    session.edit("Settings", lambda p: replace(p, settings=before))
    panel.choose_model("rational", ("k3", "k6"))
    assert session.project.settings == Settings(
        model="rational", fixed={"cx": 97.0, "k3": None, "k6": None}
    )
    assert panel.model.currentData() == "rational" and panel.cost.currentData() == Cost.IMAGE
    assert not panel.boxes["k6"].isChecked() and panel.boxes["k1"].isChecked()
    session.document.undo()
    assert session.project.settings is before


def test_a_method_brings_its_own_lens_model_and_takes_back_what_it_does_not_take(
    full: MainWindow, qtbot: QtBot
) -> None:
    panel, session = full.settings, full.session
    before = replace(
        session.project.settings,
        board_shape=BoardShapeModel.FREE,
        prior=BoardShapePrior(0.1, 0.3),
        weigh_views=True,
    )
    session.edit("Settings", lambda p: replace(p, settings=before))
    assert panel.method.currentData() == "lucchese" and panel.weigh.isEnabled()
    choose_item(panel.method, "bouguet", qtbot)
    assert session.project.settings == Settings(method="bouguet", model="brown-conrady-4")
    for widget, reason in (
        (panel.model, "own lens model"),
        (panel.cost, "nothing else to minimise"),
        (panel.board_shape, "as it is drawn"),
        (panel.weigh, "equally good"),
    ):
        assert not widget.isEnabled()
        assert reason in widget.toolTip()
    assert panel.robust.isEnabled() and panel.again.isEnabled()
    panel.robust.click()
    assert session.project.settings.method == "bouguet", "what else is chosen leaves it alone"
    choose_item(panel.method, "lucchese", qtbot)
    assert session.project.settings == Settings(model=None, robust=True)
    for widget in (panel.model, panel.cost, panel.board_shape, panel.weigh):
        assert widget.isEnabled()
    session.document.undo()
    session.document.undo()
    session.document.undo()
    assert session.project.settings is before


def test_boxes_are_ticked_as_the_method_holds_parameters(full: MainWindow) -> None:
    panel, session = full.settings, full.session
    panel.choose_method("bouguet", Cost.IMAGE)
    assert not panel.boxes["skew"].isChecked() and panel.boxes["skew"].isEnabled()
    panel.boxes["skew"].click()
    assert session.project.settings.freed == ("skew",)
    project = session.project
    assert project.size is not None
    corner_set = CornerSet(project.size, project.views, project.board)
    assert calibrate_views(corner_set, project.settings).calibration.fixed == ()
    panel.choose_method("zhang-closed-form", Cost.IMAGE)
    assert panel.boxes["skew"].isChecked() and not panel.boxes["k1"].isChecked()
    assert not panel.boxes["k1"].isEnabled(), "a closed form has no equation for it"
    assert "cannot estimate k1" in panel.boxes["k1"].toolTip()
    panel.choose_method("lucchese", Cost.PAPER)
    assert session.project.settings == Settings(Cost.PAPER)
    assert panel.boxes["k1"].isEnabled()


def test_every_method_can_be_chosen_and_is_described(full: MainWindow, qtbot: QtBot) -> None:
    panel, session = full.settings, full.session
    assert [panel.method.itemData(k) for k in range(panel.method.count())] == list(METHODS)
    for name, method in METHODS.items():
        choose_item(panel.method, name, qtbot)
        settings = session.project.settings
        assert settings.method == name
        check_settings(settings)
        check_method(method, settings.model or "lucchese", settings.cost)
        for text in (method.title, method.limits, method.source):
            assert text in panel.method.toolTip()


def test_a_lens_model_that_the_method_does_not_have_is_estimated_by_the_default(
    full: MainWindow,
) -> None:
    panel, session = full.settings, full.session
    panel.choose_method("bouguet", Cost.IMAGE)
    panel.choose_model("kannala-brandt", ())
    assert session.project.settings == Settings(model="kannala-brandt")
