"""Boards that people have are found whole, without a wrong corner."""

from __future__ import annotations

import pytest

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.scenes.tally import Tally, judge
from tests.scenes.troubles import TROUBLES

VARIANTS = 6
"""Number of variants; ``tests.benchmarks.corner_troubles`` draws 20."""
FEW = 3
"""Number of variants that are always drawn, and all to be whole; the others take long."""


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
    total = sum((find(name, seed) for seed in range(FEW)), Tally())
    assert (total.whole, total.wrong, total.false) == (FEW, 0, 0)


@pytest.mark.slow
@pytest.mark.parametrize("name", TROUBLES)
def test_at_most_one_variant_is_not_whole_and_no_corner_wrong(name: str) -> None:
    total = sum((find(name, seed) for seed in range(FEW, VARIANTS)), Tally())
    assert total.whole >= VARIANTS - FEW - 1
    assert total.wrong == total.false == 0


@pytest.mark.parametrize("seed", [24, 34])
def test_a_board_that_reaches_beyond_90_degrees_is_found_whole(seed: int) -> None:
    """Such boards were cut in two at a line of the lattice, and one part handed out as all."""
    assert find("curved", seed).whole == 1


@pytest.mark.parametrize("seed", [1, 17])
def test_one_of_two_walls_is_found_by_its_size(seed: int) -> None:
    """Both boards were once joined over the crease, with wrong corners between."""
    photograph = TROUBLES["crease"](seed)
    for truth in photograph.boards:
        corners = find_corners(photograph.image, truth.shape[:2])
        assert judge(photograph, (corners.grid, corners.uv)).whole
        assert len(corners) == truth[..., 0].size


@pytest.mark.parametrize("seed", [13, 23, 25])
def test_a_board_is_taken_from_the_chequered_floor_around_it(seed: int) -> None:
    """Edges lead from the one into the other (13, 25), or the board, which is found whole, grew
    into the floor (23); the floor lies on both sides of it (25)."""
    assert find("chequered", seed).whole == 1


def test_the_floor_is_not_taken_for_the_board_that_lies_on_it() -> None:
    """The board, of which the floor took some lines, is seen to end on two sides."""
    assert find("chequered", 34).wrong == 0


@pytest.mark.parametrize("seed", [3010, 3012])
def test_a_board_beyond_the_end_of_another_is_not_joined_to_it(seed: int) -> None:
    """Squares of the same size, two empty columns away, were counted as the board's own."""
    assert find("second board", seed).whole == 1


def test_what_only_reflections_hold_together_is_not_joined() -> None:
    """Saddle points in a reflection led across it in fewer steps than there are squares: of a
    board of 10 x 14 corners a half was handed out."""
    assert find("glare", 3014).whole == 1


@pytest.mark.parametrize("seed", [91010, 91018, 91051])
def test_a_patterned_ground_adds_no_line_to_the_board(seed: int) -> None:
    """Up to 3 of 5 corners of a line lay where squares at the board's end meet what lies beyond."""
    assert find("no margin", seed).whole == 1


@pytest.mark.parametrize("seed", [15, 22, 24])
def test_what_is_seen_in_a_drop_is_not_joined_to_the_board(seed: int) -> None:
    """The squares in the drop led from one line of the board to another in more steps, or fewer."""
    assert find("drops", seed).whole == 1


@pytest.mark.parametrize("seed", [1, 4, 9, 14, 19, 97008, 97019, 98049])
def test_a_board_on_another_is_not_joined_to_it(seed: int) -> None:
    """Both were refused, or corners of the one were handed out as the other's."""
    assert find("pile", seed).whole == 1


@pytest.mark.parametrize("seed", [91021, 91035, 91046])
def test_a_large_thing_with_a_pattern_may_lie_on_the_board(seed: int) -> None:
    """The board was refused for the few places at which the thing looks like squares."""
    assert find("object", seed).whole == 1


@pytest.mark.parametrize("seed", [5, 50])
def test_a_clip_at_the_end_of_the_board_adds_no_line(seed: int) -> None:
    """Where it covers half of the last line of squares its rim passed for one more corner."""
    assert find("clips", seed).wrong == 0


@pytest.mark.parametrize("seed", [4, 5, 7, 1039])
def test_a_board_half_in_the_sun_is_found_whole(seed: int) -> None:
    """What lies in the shade has an eighth of the others' contrast, and the board was refused; or
    the smaller part, in the sun, was left out for what it has unexplained in proportion to it."""
    assert find("half in the sun", seed).whole == 1


@pytest.mark.parametrize("seed", [1, 8, 11])
def test_a_chequered_floor_is_not_taken_for_the_board_on_it(seed: int) -> None:
    """It was, where no size is stated; or both were joined and refused."""
    assert find("chequered", seed).whole == 1
