"""Whether checkerboards bear marks, on rendered boards that do and that do not."""

from __future__ import annotations

import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.camera.camera import Camera
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.detection.printed_marks import look_for_marks
from calibgui.engine.features.corners import Corners
from tests.engine.conftest import Scene

_CAMERA = Camera((480, 400), [480.0, 482.0, 240.0, 200.0, 0.1, 0.02, 0.0, 1e-4, 0.0, 0.0])


def _make_scene(pattern: Pattern, square: float) -> Scene:
    return Scene(Board(8, 10, square, pattern), _CAMERA, (0.4, 0.25, 0.2), 330.0)


@pytest.mark.parametrize(
    ("square", "blur", "noise"),
    [(20.0, 0.7, 2.0), (20.0, 2.0, 2.0), (20.0, 0.7, 12.0), (6.0, 0.7, 2.0)],
    ids=["plain", "blurred", "noisy", "small"],
)
def test_a_bare_board(square: float, blur: float, noise: float) -> None:
    image = _make_scene(CHECKERBOARD, square).image(blur, noise)
    assert look_for_marks(image, find_corners(image)) == (False, False)
    assert look_for_marks(255 - image, find_corners(255 - image)) == (False, False)


@pytest.mark.parametrize(
    ("pattern", "square", "blur", "noise"),
    [
        (Charuco("DICT_4X4_50", 0.7, legacy=False), 20.0, 0.7, 2.0),
        (TaggedCheckerboard("t36h11", 1, 2, from_top=True), 20.0, 2.0, 2.0),
        (TaggedCheckerboard("t36h11", 1, 2, from_top=True), 10.0, 0.7, 2.0),
        (TaggedCheckerboard("t25h7", 2, 4, from_top=False), 20.0, 0.7, 12.0),
        (PuzzleBoard((50, 101)), 20.0, 0.7, 2.0),
        (PuzzleBoard((50, 101)), 20.0, 2.0, 2.0),
        (PuzzleBoard((50, 101)), 6.0, 0.7, 2.0),
    ],
    ids=lambda value: getattr(value, "kind", str(value)),
)
def test_a_marked_board(pattern: Pattern, square: float, blur: float, noise: float) -> None:
    image = _make_scene(pattern, square).image(blur, noise)
    marks = look_for_marks(image, find_corners(image, pattern=pattern))
    assert marks == (pattern.kind == "puzzleboard", pattern.kind != "puzzleboard")


def test_too_few_squares_to_tell() -> None:
    image = _make_scene(CHECKERBOARD, 20.0).image()
    corners = find_corners(image)
    row = corners.grid[:, 0] == 0
    one_row = Corners((1, 10), corners.grid[row], corners.uv[row], corners.uv[row])
    assert look_for_marks(image, one_row) == (True, True)
