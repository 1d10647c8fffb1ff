"""Boards whose markers or tags are too small to be read one by one, against rendered truth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import cv2
import numpy as np
import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.detection.charuco import find_charuco, lattice_placement
from calibgui.engine.detection.charuco.lattice_placement import MarkedBoard
from calibgui.engine.detection.charuco.marker_reader import MarkerReader
from calibgui.engine.detection.charuco.marker_subtraction import Marks
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.lattices.pyramid_search import Candidate
from tests.engine.conftest import Scene
from tests.engine.detection.apriltags.test_april_grid import CAMERA, assert_at_bound
from tests.scenes.without_board import draw_without_board

SMALL = Scene(
    Board(8, 11, 20.0, Charuco("DICT_5X5_250", 0.7, legacy=False)),
    camera=CAMERA,
    rvec=(0.3, 0.2, 2.6),
    distance=680.0,
)
"""Squares of 16 px, cells of 1.6 px."""
TAGGED = replace(SMALL, board=Board(12, 15, 20.0, TaggedCheckerboard("t36h11", 1, 2, True)))
BLUR, NOISE = 1.0, 2.0


@pytest.mark.parametrize("inverted", [False, True], ids=["", "inverted"])
@pytest.mark.parametrize("scene", [SMALL, TAGGED], ids=["charuco", "tagged"])
def test_small_marks_are_read_together(scene: Scene, inverted: bool) -> None:
    image = scene.image(BLUR, NOISE)
    board = scene.board
    corners = find_corners(
        255 - image if inverted else image, board.grid_size, pattern=board.pattern
    )
    assert corners.complete
    assert corners.pattern == board.pattern
    assert_at_bound(scene, corners, (0.7, 1.6))


def test_opencv_reads_none_of_these_markers() -> None:
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_5X5_250)
    _, numbers, *_ = cv2.aruco.ArucoDetector(dictionary).detectMarkers(SMALL.image(BLUR, NOISE))
    assert numbers is None


def test_other_dictionaries_are_not_searched_for_a_board_that_is_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """They serve to tell what is there instead."""

    def fail(*_: object, **__: object) -> None:
        raise AssertionError("nothing is to be told")

    monkeypatch.setattr(MarkerReader, "search_dictionaries", fail)
    corners = find_corners(SMALL.image(BLUR, NOISE), (8, 11), pattern=SMALL.board.pattern)
    assert corners.complete


def test_the_side_of_a_marker_need_not_be_stated() -> None:
    corners = find_corners(SMALL.image(BLUR, NOISE), (8, 11), pattern=Charuco("DICT_5X5_250"))
    assert corners.complete
    assert np.abs(SMALL.error(corners)).max() < 0.3
    seen = corners.pattern
    assert isinstance(seen, Charuco)
    assert seen.marker == pytest.approx(0.7, abs=0.03)


def test_a_part_has_the_ids_of_the_whole() -> None:
    image = SMALL.image(BLUR, NOISE)
    image[:, :300] = 128
    corners = find_corners(image, (8, 11), pattern=SMALL.board.pattern)
    assert 30 < len(corners) < 70
    assert np.abs(SMALL.error(corners)).max() < 0.3


@pytest.mark.parametrize(
    ("scene", "stated", "grid_size"),
    [
        (SMALL, Charuco("DICT_6X6_250", 0.7), (8, 11)),
        (SMALL, Charuco("DICT_5X5_250", 0.7), (8, 10)),
        (TAGGED, TaggedCheckerboard("t25h7", 1, 4), (12, 15)),
        (replace(SMALL, board=Board(8, 11, 20.0)), Charuco("DICT_5X5_250", 0.7), (8, 11)),
    ],
    ids=["another dictionary", "another size", "another family", "a plain checkerboard"],
)
def test_another_board_is_refused(
    scene: Scene, stated: Pattern, grid_size: tuple[int, int]
) -> None:
    with pytest.raises(NoBoardError):
        find_corners(scene.image(BLUR, NOISE), grid_size, pattern=stated)


def test_corners_lead_on_where_hardly_a_marker_is_read() -> None:
    scene = replace(SMALL, rvec=(0.7, 0.5, 0.3), distance=460.0)
    corners = find_corners(scene.image(BLUR, noise=3.0), pattern=Charuco())
    assert len(corners) >= 75
    assert_at_bound(scene, corners, (0.6, 1.6))


def test_blurred_markers_draw_no_corner_aside() -> None:
    """They begin a tenth of a square, about one blur, beside the edges."""
    board = Board(8, 11, 20.0, Charuco("DICT_4X4_250", 0.8, legacy=False))
    scene = replace(SMALL, board=board, distance=640.0)
    corners = find_corners(scene.image(1.5, 1.0), board.grid_size, pattern=board.pattern)
    assert corners.complete
    assert np.abs(scene.error(corners)).max() < 0.3
    assert_at_bound(scene, corners, (0.6, 1.6))


def test_squares_without_any_print_say_nothing() -> None:
    """Not even that they are equally unlike all of it."""
    squares = np.kron(np.indices((9, 12)).sum(axis=0) % 2, np.ones((16, 16)))
    image = np.pad(np.where(squares == 1, 220, 30), 60, constant_values=220).astype(np.uint8)
    with pytest.raises(NoBoardError):
        find_corners(image, (8, 11), pattern=Charuco("DICT_5X5_250", 0.7))


def test_markers_begin_nearer_than_corners_are_looked_at_elsewhere() -> None:
    scene = replace(SMALL, rvec=(0.5, 0.4, 0.2), distance=540.0)
    image = scene.image(1.2, NOISE)
    corners = find_corners(image, scene.board.grid_size, pattern=scene.board.pattern)
    assert corners.complete
    assert_at_bound(scene, corners, (0.6, 1.6))


def test_a_lattice_that_is_much_larger_than_the_board_is_not_looked_at(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Wherever it lay, most of its squares would be beside the board; to try all places of one of
    60 x 80 took 30 times as long as to find a board."""

    def fail(*_: object) -> None:
        raise AssertionError("no square need be read")

    monkeypatch.setattr(lattice_placement, "_correlate_squares", fail)
    board = MarkedBoard((4, 5), True, Marks(np.array([(0, 0)]), np.ones((1, 4, 4), bool), 0.1))
    uv = 5.0 * np.stack(np.meshgrid(np.arange(10), np.arange(12)), axis=-1)
    image = np.zeros((80, 80), np.uint8)
    assert lattice_placement.place_by_marks(image, Lattice(uv, True), board) is None


def test_a_lattice_that_fits_on_no_board_of_the_size_does_not_grow(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The dots of a printed picture take longer to follow than all else."""
    large: list[bool] = []
    search = find_charuco.find_candidates

    def note_large(*args: Any, **options: Any) -> Iterator[list[Candidate]]:
        for candidates in search(*args, **options):
            large.extend(each.is_other for each in candidates if len(each.lattice) > 500)
            yield candidates

    monkeypatch.setattr(find_charuco, "find_candidates", note_large)
    with pytest.raises(NoBoardError):
        find_corners(draw_without_board(35), (5, 8), pattern=Charuco("DICT_4X4_50", 0.7, False))
    assert large and all(large)
    assert lattice_placement.is_too_large(_make_lattice(12, 11), (5, 8))
    assert not lattice_placement.is_too_large(_make_lattice(11, 11), (5, 8))


def test_places_are_those_where_most_squares_lie_on_the_board() -> None:
    rng = np.random.default_rng(4)
    for _ in range(50):
        shape, size = (rng.integers(3, 12, 2) for _ in range(2))
        squares = np.argwhere(rng.random(shape - 1) < rng.uniform(0.3, 1))
        first, last = np.minimum(size - shape, 0), np.maximum(size - shape, 0)
        places = np.argwhere(np.ones(last - first + 1, np.bool_)) + first
        at = squares + places[:, None] + 1
        are_most = ((at >= 0) & (at <= size)).all(axis=2).mean(axis=1) >= 0.5
        listed = lattice_placement._list_origins(squares, size, tuple(shape))
        np.testing.assert_array_equal(listed, places[are_most])


def _make_lattice(rows: int, cols: int) -> Lattice:
    return Lattice(np.moveaxis(np.indices((rows, cols)), 0, -1) * 20.0, dark=True)
