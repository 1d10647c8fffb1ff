"""What the background search finds goes where it was asked for, and nowhere else."""

from __future__ import annotations

import queue
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.app.photographs.detection import Detection
from calibgui.app.projects.document import Document
from calibgui.app.projects.project import (
    Project,
    add_images,
    change_views,
    remove_views,
    set_grid_size,
    set_method,
)
from calibgui.dataset import View, ViewStatus
from calibgui.engine.errors import CalibrationError, Cancelled
from calibgui.engine.images.reading import write_image
from calibgui.gui.session import detector as detector_module
from calibgui.gui.session.calibrator import Calibrator
from calibgui.gui.session.detector import Detector
from calibgui.gui.session.session import Session
from tests.app import examples


class Search:
    """Stands in for `find_views`: finds what the test tells it to, when it says so."""

    def __init__(self) -> None:
        self.asked: list[list[str]] = []
        self.methods: list[str] = []
        self.grid_sizes: list[tuple[int, int] | None] = []
        self.sizes: list[tuple[int, int] | None] = []
        self.size = 200, 150
        self.findings: queue.SimpleQueue[View | None] = queue.SimpleQueue()

    def __call__(
        self,
        images: list[Path],
        grid_size: Any,
        __: Any,
        progress: Any,
        stop: Event,
        size: tuple[int, int] | None,
        method: str,
        **___: Any,
    ) -> Detection:
        self.methods.append(method)
        self.grid_sizes.append(grid_size)
        self.sizes.append(size)
        self.asked.append([image.name for image in images])
        found: dict[str, View] = {}
        while (view := self.findings.get()) is not None:
            found[view.image] = view
            progress(len(found), len(images), view)
        if stop.is_set():
            raise Cancelled
        return Detection(tuple(found.values()), self.size, None)


@pytest.fixture
def session(qapp: QApplication) -> Iterator[Session]:
    session = Session(qapp)
    yield session
    session.jobs.close()
    session.deleteLater()


@pytest.fixture
def search(session: Session, monkeypatch: pytest.MonkeyPatch) -> Iterator[Search]:
    search = Search()
    monkeypatch.setattr(detector_module, "find_views", search)
    yield search
    if session.jobs.running:  # the test has failed: do not wait for what it would have said
        search.findings.put(None)


def begun(session: Session, folder: Path) -> tuple[Detector, tuple[View, ...]]:
    """A search for three images, and what will be found in them."""
    found = examples.views(folder)[:3]
    session.begin(Document(Project()))
    session.edit("Add", lambda p: add_images(p, [view.image for view in found]))
    detector = Detector(session)
    detector.search()
    return detector, found


def status(session: Session) -> list[ViewStatus]:
    return [view.status for view in session.project.views]


WAITING, FOUND = ViewStatus.WAITING, ViewStatus.FOUND


def test_findings_fill_in_as_they_come_and_survive_undo(
    qtbot: QtBot, session: Session, search: Search, tmp_path: Path
) -> None:
    detector, found = begun(session, tmp_path)
    search.findings.put(found[0])
    qtbot.waitUntil(lambda: status(session) == [FOUND, WAITING, WAITING])
    exclude = [found[1].image]
    session.edit("Exclude", lambda p: change_views(p, exclude, lambda v: replace(v, enabled=False)))
    for view in (found[1], found[2], None):
        search.findings.put(view)
    with qtbot.waitSignal(detector.finished):
        pass
    assert status(session) == [FOUND] * 3
    assert not session.project.views[1].enabled
    assert session.project.size == (200, 150)
    session.document.undo()
    assert status(session) == [FOUND] * 3, "what was found is no edit"
    assert session.project.views[1].enabled


def test_what_the_user_did_meanwhile_is_left_alone(
    qtbot: QtBot, session: Session, search: Search, tmp_path: Path
) -> None:
    detector, found = begun(session, tmp_path)
    mine = found[2].corners
    marked, removed = [found[0].image], [found[1].image]
    session.edit(
        "Mark",
        lambda p: change_views(p, marked, lambda v: replace(v, status=FOUND, corners=mine)),
    )
    session.edit("Remove", lambda p: remove_views(p, removed))
    for view in (*found, None):
        search.findings.put(view)
    with qtbot.waitSignal(detector.finished):
        pass
    assert len(session.project.views) == 2
    assert session.project.views[0].corners is mine
    session.document.undo()
    assert session.project.views[1].corners is found[1].corners


def test_images_added_during_a_search_are_searched_after_it(
    qtbot: QtBot, session: Session, search: Search, tmp_path: Path
) -> None:
    detector, found = begun(session, tmp_path)
    session.edit("Add", lambda p: add_images(p, [str(tmp_path / "late.png")]))
    detector.search()
    assert len(search.asked) <= 1
    late = View(str(tmp_path / "late.png"), ViewStatus.NO_BOARD, "No board.")
    for view in (*found, None, late, None):
        search.findings.put(view)
    with qtbot.waitSignal(detector.finished):
        pass
    assert search.asked == [["0.png", "1.png", "2.png"], ["late.png"]]
    assert status(session)[3] is ViewStatus.NO_BOARD


def test_images_without_a_board_do_not_decide_the_size(
    qtbot: QtBot, session: Session, search: Search, tmp_path: Path
) -> None:
    detector, views = begun(session, tmp_path)
    depth_maps = [View(view.image, ViewStatus.NO_BOARD, "No board.") for view in views]
    for view in (*depth_maps, None):
        search.findings.put(view)
    with qtbot.waitSignal(detector.finished):
        pass
    assert session.project.size == search.size
    for size, later in (((640, 480), "first"), ((320, 240), "second")):
        search.size = size
        shown = replace(views[0], image=str(tmp_path / f"{later}.png"))
        session.edit("Add", lambda p, image=shown.image: add_images(p, [image]))
        detector.search()
        for answer in (shown, None):
            search.findings.put(answer)
        with qtbot.waitSignal(detector.finished):
            pass
        assert session.project.size == (640, 480), "that of the first image with a board"
    assert search.sizes == [None, None, (640, 480)]


def test_a_cancelled_search_leaves_images_waiting_and_calibrates_nothing(
    qtbot: QtBot, session: Session, search: Search, tmp_path: Path
) -> None:
    detector, found = begun(session, tmp_path)
    calibrator = Calibrator(session, detector)
    calibrator.calibrate()
    search.findings.put(found[0])
    qtbot.waitUntil(lambda: status(session)[0] is FOUND)
    session.jobs.running[0].cancel()
    search.findings.put(None)
    with qtbot.assertNotEmitted(session.failed, wait=100), qtbot.waitSignal(detector.finished):
        pass
    assert status(session) == [FOUND, WAITING, WAITING]
    assert not calibrator.running
    assert not session.project.results


def test_another_document_opened_during_a_search_is_searched(
    qtbot: QtBot, session: Session, search: Search, tmp_path: Path
) -> None:
    detector, _ = begun(session, tmp_path)
    session.begin(Document(add_images(Project(), [str(tmp_path / "other.png")])))
    detector.search()
    other = View(str(tmp_path / "other.png"), ViewStatus.NO_BOARD, "No board.")
    for view in (None, other, None):
        search.findings.put(view)
    with qtbot.waitSignal(detector.finished) as finished:
        pass
    assert finished.args == [True]
    assert search.asked[-1] == ["other.png"]
    assert status(session) == [ViewStatus.NO_BOARD]


def test_another_way_to_locate_corners_is_another_question(
    qtbot: QtBot, session: Session, search: Search, tmp_path: Path
) -> None:
    detector, found = begun(session, tmp_path)
    qtbot.waitUntil(lambda: len(search.asked) == 1)
    session.edit("Way", lambda p: set_method(p, "saddle"))
    detector.search()
    search.findings.put(found[0])
    qtbot.waitUntil(lambda: len(search.asked) == 2)
    assert status(session) == [WAITING] * 3
    for view in (*found, None):
        search.findings.put(view)
    with qtbot.waitSignal(detector.finished):
        pass
    assert search.methods == ["edges", "saddle"]
    assert status(session) == [FOUND] * 3


def test_a_size_that_is_stated_during_a_search_is_another_question(
    qtbot: QtBot, session: Session, search: Search, tmp_path: Path
) -> None:
    detector, found = begun(session, tmp_path)
    search.findings.put(found[0])
    qtbot.waitUntil(lambda: status(session) == [FOUND, WAITING, WAITING])
    session.edit("Size", lambda p: set_grid_size(p, (8, 8)))
    assert status(session) == [WAITING] * 3
    detector.search()
    job = session.jobs.running[0]
    assert job.cancelled, "what it will find is of no use"
    search.findings.put(found[1])
    qtbot.waitUntil(lambda: len(search.asked) == 2)
    assert status(session) == [WAITING] * 3, "a board of the old size is none of the new one"
    none = [View(view.image, ViewStatus.NO_BOARD, "No board.") for view in found]
    for answer in (*none, None):
        search.findings.put(answer)
    with qtbot.waitSignal(detector.finished) as finished:
        pass
    assert finished.args == [True]
    assert search.grid_sizes == [None, (8, 8)]
    assert status(session) == [ViewStatus.NO_BOARD] * 3
    session.document.undo()
    assert status(session) == [FOUND, WAITING, WAITING], "what was found before it was stated"


def test_a_search_ends_when_undo_has_taken_its_images(
    qtbot: QtBot, session: Session, search: Search, tmp_path: Path
) -> None:
    detector, _ = begun(session, tmp_path)
    told: list[str] = []
    session.notified.connect(told.append)
    qtbot.waitUntil(lambda: len(search.asked) == 1)
    session.document.undo()
    assert session.jobs.running[0].cancelled
    search.findings.put(None)
    with qtbot.waitSignal(detector.finished):
        pass
    assert not told


def test_a_search_that_is_stopped_says_what_waits(
    qtbot: QtBot, session: Session, search: Search, tmp_path: Path
) -> None:
    detector, found = begun(session, tmp_path)
    calibrator = Calibrator(session, detector)
    calibrator.calibrate()
    search.findings.put(found[0])
    qtbot.waitUntil(lambda: status(session)[0] is FOUND)
    calibrator.stop()
    search.findings.put(None)
    with qtbot.waitSignal(session.notified) as told:
        pass
    assert told.args == [
        "The search was stopped: 1 of 3 images have been searched. Calibrate searches the others."
    ]
    assert not detector.running and not calibrator.running


def test_a_result_of_changed_views_is_dropped(
    qtbot: QtBot, session: Session, tmp_path: Path
) -> None:
    session.begin(Document(examples.calibrated(tmp_path)))
    calibrator = Calibrator(session, Detector(session))
    calibrator.calibrate()
    first = [session.project.views[0].image]
    session.edit("Exclude", lambda p: change_views(p, first, lambda v: replace(v, enabled=False)))
    qtbot.waitUntil(lambda: not session.jobs.running)
    assert len(session.project.results) == 2
    calibrator.calibrate()
    qtbot.waitUntil(lambda: len(session.project.results) == 3)
    assert session.result is not None
    assert len(session.result.used) == 5


def test_a_search_that_cannot_be_made_is_reported_once(
    qtbot: QtBot, session: Session, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def broken(*_: Any) -> Detection:
        raise CalibrationError("A process could not be started.", "Try again.")

    monkeypatch.setattr(detector_module, "find_views", broken)
    failures: list[Exception] = []
    session.failed.connect(failures.append)
    detector, _ = begun(session, tmp_path)
    with qtbot.waitSignal(detector.finished) as finished:
        pass
    assert finished.args == [False]
    qtbot.wait(50)
    assert len(failures) == 1 and not detector.running
    assert status(session) == [WAITING] * 3


def test_a_photograph_is_shown_as_it_was_searched(
    qtbot: QtBot, session: Session, search: Search, tmp_path: Path
) -> None:
    """A camera that was held otherwise gives pixels that are turned like the others."""
    detector, found = begun(session, tmp_path)
    image = found[0].image
    write_image(image, np.zeros((30, 40), np.uint8))
    assert session.images.read(image).size == (40, 30)
    turned = replace(found[0], orientation=6, note="Turned.")
    with qtbot.waitSignal(session.renewed, check_params_cb=lambda renewed: renewed == image):
        search.findings.put(turned)
    assert session.images.read(image).size == (30, 40)
    assert session.project.views[0].note == "Turned."
    for view in (found[1], found[2], None):
        search.findings.put(view)
    with qtbot.waitSignal(detector.finished):
        pass
