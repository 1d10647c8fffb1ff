"""Which kind of board photographs show, where none is stated."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibgui.app.photographs import board_recognition
from calibgui.app.photographs.board_recognition import (
    explain_missing_board,
    find_any_board,
    find_mirrored_pattern,
    find_other_pattern,
    recognise_pattern,
)
from calibgui.app.photographs.detection import Detection, find_views, search_view
from calibgui.app.system.kernel_preparation import prepare_every_finder
from calibgui.dataset import View, ViewStatus
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import KINDS
from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.reading import write_image
from tests.engine.conftest import Scene

pytestmark = pytest.mark.usefixtures("search_here")

_CAMERA = Camera((640, 480), [640.0, 642.0, 320.0, 240.0, 0.1, 0.02, 0.0, 1e-4, 0.0, 0.0])


def _search_for_checkerboard(pattern: Pattern, folder: Path) -> tuple[View, ...]:
    """The views of a photograph in which a plain checkerboard was looked for."""
    scene = Scene(Board(8, 10, 20.0, pattern), _CAMERA, (0.4, 0.25, 0.2), 330.0)
    write_image(folder / "view.png", scene.image())
    return find_views([folder / "view.png"]).views


def _search_for_any_board(
    pattern: Pattern, stated: GridSize | None, folder: Path, cut: int = 0
) -> Detection:
    """What is found where no kind is stated in a photograph, less columns at its left."""
    scene = Scene(Board(8, 10, 20.0, pattern), _CAMERA, (0.4, 0.25, 0.2), 330.0)
    write_image(folder / "view.png", scene.image()[:, cut:])

    def find(pattern: Pattern, grid_size: GridSize | None) -> Detection:
        return find_views([folder / "view.png"], grid_size, pattern=pattern)

    return find_any_board(find, stated)


def test_a_plain_checkerboard_is_told_by_a_look(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    views = _search_for_checkerboard(CHECKERBOARD, tmp_path)
    assert views[0].corners is not None
    monkeypatch.delattr(board_recognition, "search_view")
    assert recognise_pattern(views) is None


def test_other_detectors_are_prepared_before_the_work_is_shared(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked = []

    def search(*arguments: object) -> list[tuple[int, object]]:
        asked.append(arguments[-1])
        return []

    monkeypatch.setattr(board_recognition, "map_in_processes", search)
    blank = View("blank.png", ViewStatus.NO_BOARD)
    plain = Detection((blank,), (640, 480), None, CHECKERBOARD, "")
    find_any_board(lambda *_: plain, None)
    assert set(asked) == {prepare_every_finder}


@pytest.mark.parametrize(
    "pattern",
    [TaggedCheckerboard("t36h11", 1, 2, from_top=True), Charuco("DICT_4X4_50", 0.7, legacy=False)],
    ids=["tagged", "charuco"],
)
def test_marks_are_read(pattern: Pattern, tmp_path: Path) -> None:
    recognised = recognise_pattern(_search_for_checkerboard(pattern, tmp_path))
    assert recognised is not None
    assert recognised.kind == pattern.kind


@pytest.mark.parametrize("stated", [None, (8, 10), (10, 8)])
def test_marks_are_read_whatever_size_is_stated(stated: GridSize | None, tmp_path: Path) -> None:
    """Only the marks tell a board's rows from its columns."""
    detection = _search_for_any_board(Charuco("DICT_4X4_50", 0.7, legacy=False), stated, tmp_path)
    assert (detection.pattern.kind, detection.grid_size) == ("charuco", (8, 10))
    assert detection.views[0].usable


def test_a_plain_board_of_another_size_is_told(tmp_path: Path) -> None:
    detection = _search_for_any_board(CHECKERBOARD, (8, 9), tmp_path)
    error, _ = explain_missing_board(detection, (8, 9), is_any_looked_for=True)
    assert error is not None
    assert error.message == "The images show a board of 8x10, not of 8x9."


def test_marks_of_a_board_of_another_size_are_told(tmp_path: Path) -> None:
    """A part of it may well pass for a part of the stated one, but for its marks."""
    detection = _search_for_any_board(
        Charuco("DICT_4X4_50", 0.7, legacy=False), (8, 12), tmp_path, cut=150
    )
    assert detection.pattern.kind == "charuco"
    error, _ = explain_missing_board(detection, (8, 12), is_any_looked_for=True)
    assert error is not None
    assert "not of 8x12" in error.message


def test_boards_that_few_photographs_show_are_recognised(tmp_path: Path) -> None:
    """One of four, of a grid of circles."""
    board = Board(4, 5, 30.0, Circles(diameter=0.5))
    shown = Scene(board, _CAMERA, (0.3, 0.2, 0.1), 300.0).image()
    for k in range(4):
        write_image(tmp_path / f"{k}.png", shown if k == 3 else np.full_like(shown, 128))
    views = find_views(sorted(tmp_path.iterdir())).views
    assert recognise_pattern(views) == Circles()


def test_a_file_that_has_gone(tmp_path: Path) -> None:
    views = _search_for_checkerboard(CHECKERBOARD, tmp_path)
    (tmp_path / "view.png").unlink()
    assert recognise_pattern(views) is None


@pytest.mark.parametrize(
    "pattern",
    [
        Charuco("DICT_4X4_50", 0.7, legacy=False),
        AprilGrid("t36h11", 0.3, 2, from_top=False),
        PuzzleBoard(),
    ],
)
def test_pictures_of_marks_in_a_mirror_are_told(pattern: Pattern, tmp_path: Path) -> None:
    scene = Scene(Board(8, 10, 20.0, pattern), _CAMERA, (0.4, 0.25, 0.2), 330.0)
    write_image(tmp_path / "view.png", scene.image())
    assert find_mirrored_pattern([View(str(tmp_path / "view.png"))]) is None
    write_image(tmp_path / "mirrored.png", scene.image()[:, ::-1])
    detection = find_views([tmp_path / "mirrored.png"], pattern=KINDS[pattern.kind])
    error, faults = explain_missing_board(detection, None)
    assert error is not None
    assert "mirrored: left is right" in error.message
    assert "Turn mirroring off" in error.hint
    assert not faults, "the cause is told once, not for every photograph"


def test_a_mirrored_picture_among_others_is_told(tmp_path: Path) -> None:
    pattern = Charuco("DICT_4X4_50", 0.7, legacy=False)
    image = Scene(Board(8, 10, 20.0, pattern), _CAMERA, (0.4, 0.25, 0.2), 330.0).image()
    write_image(tmp_path / "view.png", image)
    write_image(tmp_path / "mirrored.png", image[:, ::-1])
    images = [tmp_path / "view.png", tmp_path / "mirrored.png"]
    seen, mirrored = find_views(images, pattern=KINDS["charuco"]).views
    assert seen.usable and mirrored.status is ViewStatus.NO_BOARD
    assert mirrored.reason.startswith("The board is mirrored here: left is right.")


def test_marks_in_a_mirror_are_told_where_a_plain_board_is_found(tmp_path: Path) -> None:
    """The corners of such a board are found whichever way its tags are to be read."""
    scene = Scene(
        Board(8, 10, 20.0, TaggedCheckerboard("t36h11", 1, 2, from_top=True)),
        _CAMERA,
        (0.4, 0.25, 0.2),
        330.0,
    )
    write_image(tmp_path / "mirrored.png", scene.image()[:, ::-1])
    views = find_views([tmp_path / "mirrored.png"]).views
    assert views[0].corners is not None
    with pytest.raises(CalibrationError, match="mirrored: left is right") as caught:
        recognise_pattern(views)
    assert "Turn mirroring off" in caught.value.hint


def test_markers_that_do_not_tell_their_part_tell_the_kind(tmp_path: Path) -> None:
    """A ChArUco board that fills more than the image, so that its borders are not seen."""
    pattern = Charuco("DICT_5X5_100", 0.7, legacy=False)
    scene = Scene(Board(8, 10, 20.0, pattern), _CAMERA, (0.4, 0.25, 0.2), 330.0)
    write_image(tmp_path / "view.png", scene.image()[120:280, 200:360])
    image = str(tmp_path / "view.png")
    assert search_view(View(image), pattern=KINDS["charuco"]).corners is None
    assert find_other_pattern([View(image)], CHECKERBOARD) == KINDS["charuco"]
