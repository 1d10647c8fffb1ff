"""What an action does is one edit: taking it back, undo and redo lose nothing."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from calibgui.app.projects.document import Document
from calibgui.app.projects.remedies import apply_action
from calibgui.engine.assessment import Action, ActionKind
from calibgui.engine.boards import BoardShapeModel, BoardShapePrior
from calibgui.gui.session.session import Session
from calibgui.gui.settings.settings_panel import SettingsPanel
from calibgui.gui.verdict import remedy_runner
from calibgui.gui.verdict.remedy_runner import CarriedOut, RemedyRunner
from tests.app import examples

PRIOR = BoardShapePrior(in_plane=0.02, out_of_plane=0.3)


def test_an_estimated_board_shape_is_taken_back_undone_and_done_again(
    qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        remedy_runner, "judge_result", lambda *_: None
    )  # takes long, and is not shown
    project = examples.calibrated(tmp_path)
    settings = replace(
        project.settings,
        model="lucchese",
        board_shape=BoardShapeModel.FREE,
        prior=PRIOR,
        once=True,
    )
    project = replace(project, settings=settings)
    session = Session()
    panel = SettingsPanel(session)
    qtbot.addWidget(panel)
    session.begin(Document(project))
    session.show_result("Calibration 1")  # not the newest
    remedies = RemedyRunner(session)
    done: list[CarriedOut] = []
    remedies.done.connect(done.append)
    action = Action(ActionKind.ESTIMATE_BOARD_SHAPE, model="affine")

    def assert_as_before() -> None:
        assert session.project is project
        assert session.result_name == "Calibration 1"
        assert session.result is project.results["Calibration 1"]
        assert panel.board_shape.model.currentData() == BoardShapeModel.FREE
        assert panel.board_shape.prior == PRIOR
        assert not panel.again.isChecked()

    def act() -> None:
        result = session.result
        assert result is not None
        remedies.run(
            "Estimate the board's shape", lambda p: apply_action(p, result, action), result
        )
        qtbot.waitUntil(lambda: not remedies.running and not session.jobs.running, timeout=60_000)

    assert_as_before()
    act()
    carried_out = done[-1]
    assert carried_out.before is project.results["Calibration 1"]
    assert session.result is carried_out.after
    assert session.project.settings.board_shape is BoardShapeModel.AFFINE
    assert panel.board_shape.model.currentData() == BoardShapeModel.AFFINE
    remedies.take_back(carried_out)
    assert_as_before()
    session.document.redo()
    assert session.project is carried_out.project
    assert session.result is carried_out.after
    session.document.undo()
    assert_as_before()
    act()  # as if for the first time
    assert session.result_name == "Calibration 2"
    session.document.undo()
    assert_as_before()
    session.jobs.close()
