"""Boards that photographs do not tell apart are named, with the remedy."""

from __future__ import annotations

import re

import pytest

from calibgui.engine.boards import (
    AprilGrid,
    Board,
    Charuco,
    Circles,
    PuzzleBoard,
    TaggedCheckerboard,
    check_boards_differ,
)
from calibgui.engine.errors import CalibrationError


def make_charuco(dictionary: str | None, first: int | None = None) -> Board:
    """A board of 24 markers."""
    return Board(5, 7, 30.0, Charuco(dictionary, 0.7, first_marker=first))


def make_grid(family: str, first: int | None = None) -> Board:
    """A board of 16 tags."""
    return Board(8, 8, 30.0, AprilGrid(family, 0.3, first_tag=first))


@pytest.mark.parametrize(
    "boards",
    [
        [make_charuco("DICT_4X4_50"), make_charuco("DICT_4X4_50", 24)],
        [make_charuco("DICT_4X4_50"), make_charuco("DICT_5X5_50"), make_grid("t36h11")],
        [make_grid("t36h11", 3), make_grid("t36h11", 19), make_grid("t25h9")],
        [Board(8, 8, 30.0, PuzzleBoard((0, 0))), Board(8, 8, 30.0, PuzzleBoard((0, 8)))],
        [make_charuco("DICT_APRILTAG_36H11", 16), make_grid("t36h11")],
    ],
)
def test_boards_of_other_marks_differ(boards: list[Board]) -> None:
    check_boards_differ(boards, [f"board {b + 1}" for b in range(len(boards))])


@pytest.mark.parametrize(
    ("first", "second", "says", "remedy"),
    [
        (make_charuco("DICT_4X4_50"), make_charuco("DICT_4X4_1000", 23),
         "markers 23 to 23 of DICT_4X4 are on the left one and on the right one", "from 24 on"),
        (make_grid("t36h11", 8), make_grid("t36h11", 20),
         "tags 20 to 23 of t36h11", "from 24 on .* another family.*--first-tag N"),
        (make_charuco("DICT_APRILTAG_36H11"), make_grid("t36h11"), "tags 0 to 15 of t36h11", "24"),
        (Board(8, 8, 30.0, TaggedCheckerboard("t36h11")), make_grid("t36h11"), "tags 0 to", "tag"),
        (Board(8, 8, 30.0, PuzzleBoard((0, 0))), Board(8, 8, 30.0, PuzzleBoard((7, 7))),
         "Parts of the PuzzleBoard", "--origin"),
        (make_charuco("DICT_4X4_50"), Board(5, 7, 30.0),
         "stated of the right one", "--target"),
        (Board(5, 7, 30.0, Circles()), make_charuco("DICT_4X4_50"),
         "stated of the left one", "tags"),
        (make_charuco(None), make_charuco("DICT_4X4_50"),
         "stated of the left one", "--dictionary"),
    ],
)  # fmt: skip
def test_boards_of_the_same_marks_are_named(
    first: Board, second: Board, says: str, remedy: str
) -> None:
    with pytest.raises(CalibrationError) as failed:
        check_boards_differ([first, second], ["the left one", "the right one"])
    assert says in failed.value.message
    assert re.search(remedy, failed.value.hint)
