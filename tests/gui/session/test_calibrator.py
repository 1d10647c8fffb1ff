"""A calibration beside the window says what it is at."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.settings import NEW_PROJECT_SETTINGS
from calibgui.app.projects.document import Document
from calibgui.dataset import ViewStatus
from calibgui.engine.assessment.choices import lens_choice
from calibgui.gui.session.calibrator import Calibrator
from calibgui.gui.session.detector import Detector
from calibgui.gui.session.session import Session
from tests.app import examples


@pytest.fixture
def session() -> Iterator[Session]:
    session = Session()
    yield session
    session.jobs.close()


def test_the_choice_of_a_lens_model_is_told_and_over_before_the_solve(
    qtbot: QtBot, session: Session, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lens_choice, "_FIRST_CANDIDATES", ("brown-conrady-4", "lucchese"))
    project = replace(examples.calibrated(tmp_path), settings=NEW_PROJECT_SETTINGS)
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
    assert "model_reason" in session.result.calibration.settings


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
