"""A calibration beside the window says what it is at."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.settings import BEST_SETTINGS, Settings
from calibgui.app.projects.document import Document
from calibgui.app.projects.lengths import set_square
from calibgui.app.projects.project import Project
from calibgui.dataset import Result, ViewStatus
from calibgui.engine.assessment.choices import lens_choice
from calibgui.engine.calibration import Status
from calibgui.engine.images import write_image
from calibgui.gui.session.calibrator import Calibrator
from calibgui.gui.session.detector import Detector
from calibgui.gui.session.session import Session
from tests.app import examples
from tests.engine.scenes import VGA
from tests.gui.panels.conftest import made


@pytest.fixture
def session() -> Iterator[Session]:
    session = Session()
    yield session
    session.jobs.close()


def test_the_choice_of_a_lens_model_is_told_and_over_before_the_solve(
    qtbot: QtBot, session: Session, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lens_choice, "_FIRST_CANDIDATES", ("brown-conrady-4", "lucchese"))
    project = replace(examples.calibrated(tmp_path), settings=BEST_SETTINGS)
    session.begin(Document(project))
    calibrator = Calibrator(session, Detector(session))
    told: list[tuple[str, int]] = []

    def note() -> None:
        told.extend((job.label, job.total) for job in session.jobs.running)

    session.jobs.changed.connect(note)
    calibrator.calibrate()
    qtbot.waitUntil(lambda: len(session.project.results) == 3, timeout=60_000)
    qtbot.waitUntil(lambda: not session.jobs.running)
    assert ("Comparing lens models", 4) in told
    assert session.result is not None
    assert session.result.calibration.settings.model_reason is not None


def test_a_calibration_with_a_named_lens_model_compares_none(
    qtbot: QtBot, session: Session, tmp_path: Path
) -> None:
    session.begin(Document(examples.calibrated(tmp_path)))
    labels: set[str] = set()
    session.jobs.changed.connect(lambda: labels.update(j.label for j in session.jobs.running))
    Calibrator(session, Detector(session)).calibrate()
    qtbot.waitUntil(lambda: len(session.project.results) == 3, timeout=60_000)
    qtbot.waitUntil(lambda: not session.jobs.running)
    assert "Calibrating" in labels and "Comparing lens models" not in labels


@pytest.fixture
def bowed() -> Project:
    """Views of a board that is bowed by 0.6 mm, to be calibrated as well as they allow."""
    result = made(count=12, noise=0.05, bow=0.6)
    return Project(views=result.views, size=VGA, settings=BEST_SETTINGS)


def test_a_first_answer_comes_before_lens_and_board_are_compared_and_undo_goes_through_all(
    qtbot: QtBot, session: Session, bowed: Project
) -> None:
    session.begin(Document(bowed))
    calibrator = Calibrator(session, Detector(session))
    shown: list[tuple[Result, set[str]]] = []
    labels: set[str] = set()

    def note(result: Result | None) -> None:
        if result is not None:
            shown.append((result, set(labels)))

    session.jobs.changed.connect(lambda: labels.update(job.label for job in session.jobs.running))
    session.result_changed.connect(note)
    with qtbot.waitSignal(calibrator.ended, timeout=60_000):
        calibrator.calibrate()
    (first, before), (chosen, _), *_, (best, _) = shown
    assert "Comparing lens models" not in before and "Comparing lens models" in labels
    assert "Making the camera better" in labels
    assert first.calibration.settings.model_reason is None
    assert chosen.calibration.settings.model_reason is not None
    assert best.calibration.board_shape is not None and best.improvements
    assert list(session.project.results) == ["Calibration 1"]
    assert session.document.undo_label == "Make camera better"
    session.document.undo()
    assert session.result is chosen
    session.document.undo()
    assert session.result is None, "the first answer and the chosen one are one edit"


def test_what_is_undone_or_changed_meanwhile_ends_what_makes_it_better(
    qtbot: QtBot, session: Session, bowed: Project
) -> None:
    session.begin(Document(bowed))
    calibrator = Calibrator(session, Detector(session))
    for change in (session.document.undo, lambda: session.edit("Leave out", leave_out_first)):
        with qtbot.waitSignal(session.result_changed, timeout=60_000):
            calibrator.calibrate()
        change()
        assert not calibrator.running
        kept = session.result
        qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)
        assert session.result is kept


def test_a_stopped_calibration_leaves_the_last_finished_answer(
    qtbot: QtBot, session: Session, tmp_path: Path, bowed: Project
) -> None:
    project = replace(bowed, results=examples.calibrated(tmp_path).results)
    session.begin(Document(project))
    calibrator = Calibrator(session, Detector(session))
    kept = session.result
    calibrator.calibrate()
    calibrator.stop()
    assert not calibrator.running and session.result is kept
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)
    assert session.result is kept and list(session.project.results) == list(project.results)
    with qtbot.waitSignal(session.result_changed, timeout=60_000):
        calibrator.calibrate()
    first = session.result
    calibrator.stop()
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)
    assert session.result is first and first is not kept


def test_a_first_solve_that_is_stopped_keeps_its_best_and_says_so(
    qtbot: QtBot, session: Session, bowed: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    session.begin(Document(replace(bowed, settings=Settings())))
    calibrator = Calibrator(session, Detector(session))
    monkeypatch.setattr("calibgui.gui.session.calibrator.calibrate_at_once", lambda *_: None)
    told: list[str] = []
    session.notified.connect(told.append)
    calibrator.calibrate()
    calibrator.stop()
    with qtbot.waitSignal(calibrator.ended, timeout=60_000):
        pass
    assert session.result is not None
    assert session.result.calibration.status is Status.STOPPED
    assert told == ["Stopped: “Calibration 1” is the best so far, not the optimum."]


def test_a_length_that_is_stated_meanwhile_scales_what_comes(
    qtbot: QtBot, session: Session, bowed: Project
) -> None:
    session.begin(Document(bowed))
    calibrator = Calibrator(session, Detector(session))
    with qtbot.waitSignal(session.result_changed, timeout=60_000):
        calibrator.calibrate()
    session.edit("Size of squares", lambda p: set_square(p, 2 * p.square))
    with qtbot.waitSignal(calibrator.ended, timeout=60_000):
        pass
    result = session.result
    assert result is not None and result.improvements and session.project.is_current(result)
    assert result.board is not None and result.board.square == 2 * bowed.square


def test_boards_that_are_known_are_calibrated_though_their_search_was_ended(
    qtbot: QtBot, session: Session, tmp_path: Path
) -> None:
    """Ticking "Mark all by hand" during a search ends it before the images' size is agreed on."""
    project = examples.calibrated(tmp_path)
    pixels = np.full(examples.CAMERA.size[::-1], 90, np.uint8)
    for view in project.views[1:]:  # the first has been deleted since
        write_image(view.image, pixels)
    session.begin(Document(replace(project, size=None, by_hand=True, results={})))
    with qtbot.assertNotEmitted(session.failed), qtbot.waitSignal(session.result_changed):
        Calibrator(session, Detector(session)).calibrate()
    assert session.project.size == examples.CAMERA.size
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)


def leave_out_first(project: Project) -> Project:
    first, *others = project.views
    return replace(project, views=(replace(first, enabled=False), *others))


def test_images_whose_search_died_are_not_put_down_to_the_photographs(
    qtbot: QtBot, session: Session, tmp_path: Path
) -> None:
    project = examples.calibrated(tmp_path)
    lost = [view.refuse(ViewStatus.UNREADABLE, "The process died.") for view in project.views]
    session.begin(Document(replace(project, views=tuple(lost))))
    with qtbot.waitSignal(session.failed) as failed:
        Calibrator(session, Detector(session)).calibrate()
    (error,) = failed.args
    assert str(error).startswith("None of the photographs can be read. Click on one to see why")
