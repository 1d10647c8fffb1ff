"""Boards that people have are found whole, without a wrong corner."""

from __future__ import annotations

import pytest

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.scenes.tally import Tally, judge
from tests.scenes.troubles import TROUBLES

VARIANTS = 3
"""Number of variants; ``tests.benchmarks.corner_troubles`` draws 20."""


def find(name: str, seed: int) -> Tally:
    """What is found in one variant, its size unknown."""
    photograph = TROUBLES[name](seed)
    try:
        corners = find_corners(photograph.image)
    except NoBoardError:
        return judge(photograph, None)
    return judge(photograph, (corners.grid, corners.uv))


@pytest.mark.parametrize("name", TROUBLES)
def test_boards_in_trouble_are_found_whole(name: str) -> None:
    total = sum((find(name, seed) for seed in range(VARIANTS)), Tally())
    assert (total.whole, total.wrong, total.false) == (VARIANTS, 0, 0)


@pytest.mark.parametrize(
    ("name", "seed"),
    [
        ("curved", 24),  # beyond 90 degrees it was cut in two, and one part handed out as all
        ("chequered", 13),  # edges lead from the board into the floor around it
        ("chequered", 23),  # the board, which is found whole, grew into the floor
        ("chequered", 8),  # the floor was taken for the board, or both were joined and refused
        ("second board", 3010),  # its squares, two empty columns away, were counted as the board's
        ("glare", 3014),  # saddle points in a reflection led across it in fewer steps
        ("no margin", 91010),  # corners of a line lay where the ground's pattern meets the board
        ("drops", 15),  # squares in the drop led from line to line in more steps, or fewer
        ("pile", 1),  # both boards were refused
        ("pile", 97008),  # corners of the one were handed out as the other's
        ("object", 91021),  # refused for the few places that look like squares
        ("half in the sun", 4),  # what lies in the shade has an eighth of the others' contrast
        ("half in the sun", 1039),  # the smaller part, in the sun, was left out
    ],
)
def test_a_board_that_was_lost_or_cut_is_found_whole(name: str, seed: int) -> None:
    assert find(name, seed).whole == 1


@pytest.mark.parametrize(
    ("name", "seed"),
    [
        ("chequered", 34),  # the board, of which the floor took some lines, ends on two sides
        ("clips", 5),  # the rim of a clip that covers half of a square passed for a corner
    ],
)
def test_no_corner_is_wrong(name: str, seed: int) -> None:
    assert find(name, seed).wrong == 0


def test_one_of_two_walls_is_found_by_its_size() -> None:
    """Both boards were once joined over the crease, with wrong corners between."""
    photograph = TROUBLES["crease"](17)
    for truth in photograph.boards:
        corners = find_corners(photograph.image, truth.shape[:2])
        assert judge(photograph, (corners.grid, corners.uv)).whole
        assert len(corners) == truth[..., 0].size
