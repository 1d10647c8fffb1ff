"""What the banner offers where images show another pattern than the stated one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.settings import DEFAULT_SETTINGS
from calibgui.app.photographs import other_board
from calibgui.app.photographs.board_recognition import find_other_pattern
from calibgui.app.photographs.detection import Detection, find_views
from calibgui.app.photographs.other_board import OtherBoard
from calibgui.app.photographs.paths import find_images
from calibgui.app.projects.document import Document
from calibgui.app.projects.project import Project, add_images, set_grid_size, set_pattern
from calibgui.app.system.workers import do_tasks_here
from calibgui.dataset import View, ViewStatus
from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.kinds import KINDS
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.errors import CalibrationError, Cancelled
from calibgui.engine.images.reading import read_image, write_image
from calibgui.engine.images.rendering import render_view
from calibgui.gui.window.main_window import MainWindow
from tests import photographs as tests_photographs
from tests.app import examples
from tests.engine.conftest import Scene

pytestmark = pytest.mark.slow

CIRCLES = Circles(False, 0.5)
LEFT = Qt.MouseButton.LeftButton


def photographs(folder: Path, pattern: Pattern, grid_size: tuple[int, int], count: int = 1) -> None:
    """Return views of a board held in different ways."""
    for k in range(count):
        rvec = 0.4 * np.array([np.cos(2 * k), np.sin(2 * k), 0.3])
        scene = Scene(Board(*grid_size, 16.0, pattern), rvec=tuple(rvec))
        write_image(folder / f"{k}.png", scene.image(noise=2.0, seed=k))


@pytest.mark.parametrize(
    ("pattern", "grid_size"),
    [
        (CIRCLES, (7, 9)),
        (Circles(True, 0.8), (11, 4)),
        (Charuco("DICT_5X5_100", 0.75), (6, 8)),
        (CHECKERBOARD, (6, 8)),
    ],
    ids=["circles", "asymmetric-circles", "charuco", "checkerboard"],
)
def test_the_kind_of_a_board_is_told(
    tmp_path: Path, pattern: Pattern, grid_size: tuple[int, int]
) -> None:
    photographs(tmp_path, pattern, grid_size)
    stated = Charuco() if pattern == CHECKERBOARD else CHECKERBOARD
    with do_tasks_here():  # four times no process is started; with one click, below, they are
        found = find_other_pattern([View(str(tmp_path / "0.png"))], stated)
    assert found == KINDS[pattern.kind]


def test_an_offer_ends_with_its_project(window: MainWindow, tmp_path: Path) -> None:
    gone = str(tmp_path / "gone.png")
    window.files.images_missing.emit([gone])
    window.banner.show_error(CalibrationError("Something else."))
    window.banner.dismiss.click()
    assert "gone.png" in window.banner.text.text()
    window.session.edit("Images", lambda project: add_images(project, [gone]))
    assert window.banner.isVisible()
    window.session.begin(Document())
    assert not window.banner.isVisible()


def test_an_offer_of_another_board_ends_when_another_is_chosen(window: MainWindow) -> None:
    """It would offer what is searched for already, or over what was found with undo."""
    window.session.edit("Pattern", lambda project: set_pattern(project, AprilGrid()))
    window.offers._offer_another(OtherBoard(Charuco()))
    assert "ChArUco" in window.banner.text.text() and window.banner.isVisible()
    window.session.edit("Square", lambda project: replace(project, square=12.0))
    assert window.banner.isVisible()
    window.session.edit("Pattern", lambda project: set_pattern(project, CIRCLES))
    assert not window.banner.isVisible()


def make_folders(folder: Path) -> None:
    """Make folders with photographs of one camera each, in one that has none itself."""
    for place, count in (("left & low", 2), ("right", 1)):
        (folder / place).mkdir()
        for k in range(count):
            write_image(folder / place / f"{k}.png", np.full((48, 64), 99, np.uint8))


@pytest.mark.parametrize(
    ("choice", "found"), [(0, ["0.png", "1.png"]), (2, ["0.png", "1.png", "0.png"])]
)
def test_folders_with_photographs_are_offered_where_there_are_some_below(
    window: MainWindow, tmp_path: Path, choice: int, found: list[str]
) -> None:
    make_folders(tmp_path)
    window.session.edit("By hand", lambda project: replace(project, by_hand=True))
    window.files.open_paths([str(tmp_path)])
    assert "left & low (2 images), right (1 image)" in window.banner.text.text()
    texts = [button.text() for button in window.banner.buttons]
    assert texts == ["Open left && low", "Open right", "&All 3 images"]
    window.banner.buttons[choice].click()
    assert [view.name for view in window.session.project.views] == found
    assert not window.banner.isVisible()


def test_an_offer_of_folders_ends_when_others_are_opened(
    window: MainWindow, tmp_path: Path
) -> None:
    make_folders(tmp_path)
    window.session.edit("By hand", lambda project: replace(project, by_hand=True))
    window.files.open_paths([str(tmp_path)])
    window.files.open_paths([str(tmp_path / "right")])
    assert not window.banner.isVisible()


@pytest.mark.parametrize(
    ("pattern", "grid_size", "told"),
    [
        (CIRCLES, (7, 9), "These look like photographs of a grid of circles."),
        (
            Charuco("DICT_4X4_50", 0.6, legacy=False),
            (6, 8),
            "These look like photographs of a ChArUco board.",
        ),
    ],
    ids=["circles", "charuco"],
)
def test_a_board_of_another_kind_is_taken_as_one_where_none_was_stated(
    window: MainWindow,
    qtbot: QtBot,
    tmp_path: Path,
    pattern: Pattern,
    grid_size: tuple[int, int],
    told: str,
) -> None:
    """As the command line does it. Who takes it back is asked the next time."""
    session = window.session
    photographs(tmp_path, pattern, grid_size, count=4)
    session.begin(Document(Project(settings=DEFAULT_SETTINGS)))  # compares no lens models
    window.files.open_paths([str(tmp_path)])
    qtbot.waitUntil(lambda: isinstance(session.project.pattern, type(pattern)), timeout=60_000)
    assert window.banner.text.text() == f"{told} Undo goes back."
    qtbot.waitUntil(lambda: session.result is not None, timeout=60_000)
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)
    assert {view.status for view in session.project.views} == {ViewStatus.FOUND}
    assert session.result is not None and session.result.board is not None
    assert isinstance(session.result.board.pattern, type(pattern))
    assert len(session.project.results) == 1, "none from corners that were another board's"
    session.document.undo()
    session.document.undo()
    assert session.project.pattern == CHECKERBOARD
    window.offers._offer_another(OtherBoard(pattern))
    assert session.project.pattern == CHECKERBOARD and window.banner.buttons


def test_marks_are_looked_for_on_the_first_board_that_is_found(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not only when a plain board was searched in all photographs, and a camera fitted to it."""
    looks: list[int] = []
    found, may_end = examples.views(tmp_path)[:2], Event()

    def search(*arguments: Any, **_: Any) -> Detection:
        arguments[3](1, 2, found[0])
        may_end.wait(20)
        return Detection(found, (200, 150))

    monkeypatch.setattr(other_board, "recognise_pattern", lambda views: looks.append(len(views)))
    monkeypatch.setattr("calibgui.gui.session.detector.find_views", search)
    window.session.edit("Add", lambda p: add_images(p, [view.image for view in found]))
    window.detector.search()
    qtbot.waitUntil(lambda: looks == [1], timeout=20_000)
    assert window.detector.running
    may_end.set()
    qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=20_000)


def test_boards_are_looked_at_for_marks_once(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every fit ends a search, and what was dismissed is not offered again."""
    looks: list[int] = []

    def look(views: Sequence[View]) -> None:
        looks.append(len(views))

    monkeypatch.setattr(other_board, "recognise_pattern", look)
    found = examples.views(tmp_path)
    window.session.begin(Document(Project(views=tuple(found), size=(320, 240))))
    for _ in range(3):
        window.detector.finished.emit(True)
        qtbot.waitUntil(lambda: not window.session.jobs.running)
    assert looks == [len(found)]
    window.session.begin(Document(Project(views=tuple(found), size=(320, 240))))
    window.detector.finished.emit(True)
    qtbot.waitUntil(lambda: len(looks) == 2)


def test_mirrored_pictures_are_told(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    pattern = Charuco("DICT_5X5_100", 0.75)
    photographs(tmp_path, pattern, (6, 8))
    file = tmp_path / "0.png"
    write_image(file, read_image(file).pixels[:, ::-1])
    window.session.begin(Document(set_pattern(Project(settings=DEFAULT_SETTINGS), Charuco())))
    window.files.open_paths([str(file)])
    told = "The photographs are mirrored"
    qtbot.waitUntil(lambda: window.banner.text.text().startswith(told), timeout=60_000)
    assert not window.banner.buttons


def test_a_wrong_size_is_told_from_the_images(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    photographs(tmp_path, CHECKERBOARD, (6, 8), count=4)
    project = Project(settings=DEFAULT_SETTINGS)  # compares no lens models
    window.session.begin(Document(set_grid_size(project, (9, 9))))
    window.files.open_paths([str(tmp_path)])
    qtbot.waitUntil(lambda: len(window.banner.buttons) == 1, timeout=60_000)
    assert window.banner.text.text() == (
        "A board of 9 × 9 inner corners is in no image; the images show 6 × 8."
    )
    qtbot.mouseClick(window.banner.buttons[0], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: window.session.result is not None, timeout=60_000)
    assert {v.status for v in window.session.project.views} == {ViewStatus.FOUND}


def test_the_look_for_another_board_ends_with_its_question(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, ended = Event(), Event()

    def look(_: object, __: object, stop: Event) -> None:
        begun.set()
        stop.wait(60)
        ended.set()
        raise Cancelled

    monkeypatch.setattr(other_board, "find_other_pattern", look)
    blank = [View(str(tmp_path / "blank.png"), ViewStatus.NO_BOARD, "No board.")]
    window.session.edit("Add", lambda project: replace(project, views=tuple(blank)))
    window.detector.finished.emit(True)
    labels = [job.label for job in window.session.jobs.running]
    assert "Looking for another kind of board" in labels
    qtbot.waitUntil(begun.is_set)
    window.session.document.undo()
    qtbot.waitUntil(ended.is_set, timeout=2_000)
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    assert not window.banner.isVisible()


@pytest.mark.parametrize("found", [Charuco(), None])
def test_a_failure_waits_for_the_look_that_may_explain_it(
    window: MainWindow,
    qtbot: QtBot,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    found: Pattern | None,
) -> None:
    """Nobody is told to take other photographs of a board that another search would find."""
    may_end = Event()

    def look(*_: object) -> Pattern | None:
        may_end.wait(10)
        return found

    monkeypatch.setattr(other_board, "find_other_pattern", look)
    monkeypatch.setattr(other_board, "find_mirrored_pattern", lambda *_: None)
    blank = [View(str(tmp_path / "blank.png"), ViewStatus.NO_BOARD, "No board.")]
    window.session.edit(
        "Add", lambda project: replace(project, views=tuple(blank), pattern=AprilGrid())
    )
    window.detector.finished.emit(True)
    window.session.failed.emit(CalibrationError("None can be used.", "Take others."))
    assert not window.banner.isVisible()
    may_end.set()
    qtbot.waitUntil(window.banner.isVisible, timeout=5_000)
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    said = "None can be used.\nTake others." if found is None else "These look like"
    assert window.banner.text.text().startswith(said)


def test_a_size_that_is_counted_from_parts_is_told(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    """Something grey covers a corner in the middle of every board."""
    board = tests_photographs.BOARD
    middle = board.points().reshape(board.rows, board.cols, -1)[2, 3]
    for k, pose in enumerate(tests_photographs.draw_poses()):
        camera = tests_photographs.CAMERA
        pixels = render_view(camera, pose, board, blur=0.7, noise=1.0, seed=k).copy()
        u, v = np.rint(project_points(middle[None], camera, pose)[0]).astype(int)
        pixels[v - 9 : v + 10, u - 9 : u + 10] = 120
        write_image(tmp_path / f"{k}.png", pixels)
    window.session.begin(Document(Project(settings=DEFAULT_SETTINGS)))
    window.files.open_paths([str(tmp_path)])
    qtbot.waitUntil(
        lambda: window.verdict.verdict is not None and not window.session.jobs.running,
        timeout=60_000,
    )
    assert window.banner.isVisible()
    assert window.banner.text.text() == (
        "No picture shows every corner of the board. It counts as 6 x 7, the largest part seen, "
        "which several pictures share; state its size if it has more."
    )
    assert "6 × 7 inner corners" in window.verdict.square.counted.text()
    for view in window.session.project.views:
        assert view.corners is not None and len(view.corners.uv) < 42


def test_grids_of_circles_that_are_cut_are_refused_as_by_the_command_line(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    """In either picture the next column of circles would be outside."""
    v, u = np.indices((240, 320))
    for k in range(2):
        pixels = np.full((240, 320), 220.0)
        for m, n in np.ndindex(4, 4):
            distance = np.hypot(u - 186 - 36 * n, v - 60 - k - 36 * m)
            pixels -= 180 * np.clip(9.3 - distance, 0, 1)
        write_image(tmp_path / f"{k}.png", pixels.astype(np.uint8))
    session, board = window.session, window.board
    session.begin(Document(Project(settings=DEFAULT_SETTINGS, pattern=Circles())))
    window.files.open_paths([str(tmp_path)])
    qtbot.waitUntil(lambda: window.banner.isVisible() and not session.jobs.running, timeout=60_000)
    found = find_views(find_images([str(tmp_path)]), pattern=Circles())
    with pytest.raises(CalibrationError) as caught:
        found.corner_set(30.0)
    assert caught.value.message in window.banner.text.text()
    assert "State the size of the board: 4 x 4" in window.banner.text.text()
    assert session.result is None
    assert "Their number is not known" in window.verdict.square.counted.text()
    assert window.page.reason.isVisible()
    assert "state the numbers of rows and columns" in window.page.reason.text()
    qtbot.mouseClick(window.calibrate, LEFT)
    qtbot.wait(50)
    assert session.result is None and not session.jobs.running, "the button does no other"

    # Once the size is stated, what is seen of such a grid is its whole.
    window.show_setup()
    qtbot.mouseClick(board.inferred, LEFT, pos=QPoint(8, board.inferred.height() // 2))
    assert session.project.grid_size == (4, 4)
    qtbot.mouseClick(window.calibrate, LEFT)
    qtbot.waitUntil(lambda: session.result is not None, timeout=60_000)
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)
    assert not window.page.reason.isVisible()
    assert "Circles, 4 × 4." in window.verdict.square.counted.text()
