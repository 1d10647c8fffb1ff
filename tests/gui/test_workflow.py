"""The whole way through the window, with the mouse and the keyboard."""

from __future__ import annotations

import json
import shutil
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog, QInputDialog
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating import best_camera
from calibgui.app.projects.project import Project
from calibgui.app.projects.project_file import encode_project
from calibgui.app.system.resources import find_resource
from calibgui.engine.calibration.result import Status
from calibgui.formats.json_document import dumps
from calibgui.formats.result_json import read_result
from calibgui.gui.canvas.layers import Layer
from calibgui.gui.images.image_model import Role
from calibgui.gui.panels.method.convergence import ConvergencePanel
from calibgui.gui.session import calibrator
from calibgui.gui.window.main_window import MainWindow
from tests.gui.hand import Hand, outermost

pytestmark = pytest.mark.slow

COUNT = 8


@pytest.fixture(autouse=True)
def search_in_threads() -> None:
    """Photographs are searched in processes, as they are for the user."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Some of the sample's images, and one that shows nothing."""
    images = tmp_path / "photographs"
    images.mkdir()
    for source in sorted(find_resource("sample").glob("*.png"))[:COUNT]:
        shutil.copy(source, images)
    (images / "view99.png").write_bytes(b"not an image")
    return images


def content(project: Project) -> str:
    """All that edits change: a verdict is found out by the program itself."""
    return dumps({**encode_project(project, Path("/")), "verdicts": None})


def test_from_photographs_to_an_exported_camera(
    window: MainWindow,
    qtbot: QtBot,
    folder: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    hand, session = Hand(window, qtbot), window.session
    begin = content(session.project)

    # Load: the folder is searched and calibrated without another click.
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *_: str(folder))
    hand.click_button(window.welcome.buttons[0])
    hand.wait(lambda: session.result is not None)
    assert session.result is not None
    first = session.result.calibration
    assert first.status is Status.CONVERGED
    hand.wait(lambda: not window.calibrator.running)
    statuses = [
        window.images.list.model().index(row, 0).data(Role.STATUS) for row in range(COUNT + 1)
    ]
    assert statuses == ["70 of 70 corners"] * COUNT + ["unreadable"]
    unreadable = next(v for v in session.project.views if v.reason)
    session.select(unreadable.image)
    assert window.page.reason.isVisible()
    assert window.page.reason.text() == unreadable.reason
    assert not any(tool.isEnabled() for tool in window.page.tools)
    truth = json.loads((find_resource("sample") / "truth.json").read_text())["camera"]["params"]
    assert abs(first.camera.params[0] - truth["fx"]) < 5 * first.sigma[0]

    window.settings.improve.click()  # what is spoilt below is not to be left out by itself

    # Four clicks, somewhat beside the corners; one is taken back in between.
    hand.choose_image("view04.png")
    before = hand.corners()
    window.page.tools[0].trigger()
    points = outermost(before)
    place = window.page.canvas.geometry()
    hand.click(points[0] + [2, -1])
    hand.click(points[3])
    assert window.page.canvas.geometry() == place, "the image moves between two clicks"
    hand.key(Qt.Key.Key_Backspace)
    for point in points[1:]:
        hand.click(point + np.array([1.5, 1.5]))
    hand.wait(window.page.marker.roi_bar.accept.isEnabled)
    bar = window.page.marker.roi_bar
    assert bar.grid_size == before.shape

    # A wrong count is not accepted; the right one is, from the box it was typed into.
    bar.counts[1].stepDown()
    hand.wait(lambda: f"{before.shape[0]} x {before.shape[1] - 1}" in bar.words.text())
    assert not bar.accept.isEnabled()
    QTest.keyClick(bar.counts[1], Qt.Key.Key_Return)
    assert hand.corners() is before
    bar.counts[1].stepUp()
    hand.wait(bar.accept.isEnabled)
    QTest.keyClick(bar.counts[1], Qt.Key.Key_Return)
    assert session.document.undo_label == "Mark board"
    marked = hand.corners()
    assert marked is not before
    assert marked.complete
    np.testing.assert_allclose(outermost(marked), points, atol=0.05)
    assert window.page.canvas.tool is None

    # A wrong corner, made by hand, is seen in the residuals.
    window.page.tools[1].trigger()
    corner_bar, as_found = window.page.marker.corner_bar, hand.corners()
    assert not window.page.layers[Layer.ORDER].isChecked()
    for button, label in ((corner_bar.turn, "Turn axes"), (corner_bar.flip, "Flip axes")):
        hand.click_button(button)
        assert session.document.undo_label == label
    assert window.page.layers[Layer.ORDER].isChecked(), "what was done is seen"
    assert hand.corners().shape == as_found.shape[::-1]
    session.document.undo()
    session.document.undo()
    assert hand.corners() is as_found
    right = hand.corners().uv[25].copy()
    hand.drag(right, right + np.array([5.0, 4.0]), Qt.KeyboardModifier.ControlModifier)
    assert session.document.undo_label == "Move corner"
    wrong = hand.corners().uv[25]
    assert 4 < np.linalg.norm(wrong - right) < 9
    hand.key(Qt.Key.Key_Escape)
    hand.click_button(window.calibrate)
    hand.wait(lambda: len(session.project.results) == 2)
    assert session.result is not None
    hand.wait(lambda: not session.jobs.running)
    rms = {
        v.image: r.rms
        for v, r in zip(session.result.used, session.result.calibration.residuals, strict=True)
    }
    worst = max(rms, key=rms.__getitem__)
    assert Path(worst).name == "view04.png"
    assert window.analysis is not None

    # Its bar stands out: exclude by threshold, and the fit follows.
    others = max(value for image, value in rms.items() if image != worst)
    window.images.list._move_threshold((others + rms[worst]) / 2)
    assert [Path(image).name for image in window.images.chosen] == ["view04.png"]
    hand.click_button(window.images.exclude_above)
    assert [Path(v.image).name for v in session.project.views if not v.enabled] == ["view04.png"]
    hand.wait(lambda: session.project.is_current(session.result))
    assert len(session.project.results) == 2 and len(session.result.used) == COUNT - 1

    # Repaired: it snaps back to where it was, and takes part again.
    hand.choose_image("view04.png")
    window.page.tools[1].trigger()
    hand.drag(hand.corners().uv[25], right + np.array([1.0, 1.0]), Qt.KeyboardModifier.NoModifier)
    assert np.linalg.norm(hand.corners().uv[25] - right) < 0.1
    hand.key(Qt.Key.Key_Escape)
    window.images.list.setFocus()
    hand.key(Qt.Key.Key_Space)
    assert all(view.enabled for view in session.project.views)
    hand.wait(lambda: session.project.is_current(session.result))

    # A calibration that is stopped leaves the last one that is finished in its place.
    def slowly(corner_set: Any, settings: Any, report: Any, stop: Any, **others: Any) -> Any:
        def slow(iteration: Any) -> bool:
            time.sleep(0.1)
            return report(iteration)

        return calibrate_best(corner_set, settings, slow, stop, **others)

    calibrate_best, finished = best_camera.calibrate_best, session.result
    monkeypatch.setattr(calibrator, "calibrate_best", slowly)
    monkeypatch.setattr(calibrator, "calibrate_at_once", lambda *_: None)
    hand.click_button(window.calibrate)
    assert not window.calibrate.isEnabled() and window.calibrate.text() == "C&alibrate"
    convergence = window.analysis.panel(ConvergencePanel)
    hand.wait(lambda: len(convergence._iterations) >= 2)
    hand.click_button(window.progress.cancel)
    assert window.calibrate.isEnabled() and session.result is finished
    hand.wait(lambda: not session.jobs.running)
    assert session.result is finished and window.verdict.verdict is not None
    monkeypatch.setattr(calibrator, "calibrate_best", calibrate_best)

    # What else can be undone.
    monkeypatch.setattr(QInputDialog, "getText", lambda *_: ("kept", True))
    window.files.rename_result(session.result_name)
    window.files.delete_result(next(iter(session.project.results)))
    window.images.remove([unreadable.image])
    window.verdict.square.confirm.setFocus()
    hand.key(Qt.Key.Key_Space)
    window.show_setup()
    window.setup.folds[-1].setChecked(True)
    for widget, key in (
        (window.board.by_hand, Qt.Key.Key_Space),
        (window.board.by_hand, Qt.Key.Key_Space),
        (window.board.unit, Qt.Key.Key_Down),
        (window.board.square, Qt.Key.Key_Up),
        (window.settings.robust, Qt.Key.Key_Space),
        (window.settings.method, Qt.Key.Key_Down),
    ):
        widget.setFocus()
        assert widget.hasFocus()
        hand.key(key)

    # Undo all, redo all: every step is the same on the way back and forward.
    control, shift = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
    window.setFocus()
    end = content(session.project)
    steps = [(session.document.undo_label, end)]
    while session.document.undo_label:
        hand.key(Qt.Key.Key_Z, control)
        steps.append((session.document.undo_label, content(session.project)))
        assert len(steps) < 50
    assert steps[-1] == ("", begin)
    assert [label for label, _ in steps[-2::-1]] == [
        "Add images",
        "Calibrate",
        "Calibration settings",
        "Mark board",
        "Move corner",
        "Calibrate",
        "Exclude view04.png",
        "Move corner",
        "Include view04.png",
        "Rename result",
        "Delete Calibration 1",
        "Remove view99.png",
        "Confirm the size of squares",
        "Mark by hand",
        "Search the images",
        "Unit of squares",
        "Size of squares",
        "Calibration settings",
        "Method",
    ]
    assert window.pages.currentWidget() is window.welcome
    for step in steps[-2::-1]:
        hand.key(Qt.Key.Key_Z, control | shift)
        assert (session.document.undo_label, content(session.project)) == step
    assert not session.document.redo_label

    # Save, begin anew, reopen.
    path = folder / "camera.json"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(path), ""))
    hand.window.setFocus()
    hand.key(Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    hand.wait(lambda: not window.isWindowModified())
    assert path.exists()
    window.files.new()
    assert window.pages.currentWidget() is window.welcome
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    window.files.ask_for_project()
    hand.wait(lambda: len(session.project.views) == COUNT)
    assert content(session.project) == end
    assert not window.isWindowModified()

    # Export.
    out = tmp_path / "out.json"
    starts: list[str] = []
    monkeypatch.setattr(
        QFileDialog,
        "getSaveFileName",
        lambda *asked: (starts.append(asked[2]), (str(out), ""))[1],
    )
    window.files.export()
    dialog = QApplication.activeModalWidget()
    assert dialog is not None
    hand.wait(dialog.save.isEnabled)
    hand.click_button(dialog.save)
    hand.wait(out.exists)
    assert Path(starts[0]).parent == path.parent
    dialog.close()
    exported = read_result(out).calibration.camera.params
    np.testing.assert_array_equal(exported, session.result.calibration.camera.params)
    hand.wait(lambda: not session.jobs.running)
