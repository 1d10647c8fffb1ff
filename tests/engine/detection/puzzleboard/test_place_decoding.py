"""Places on the PuzzleBoard pattern from dots of which the truth is known."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.boards.puzzleboard import CODE_LINES, PuzzleBoard
from calibgui.engine.detection.puzzleboard import place_decoding
from calibgui.engine.detection.puzzleboard.place_decoding import (
    Dots,
    StatedBoard,
    find_place,
    find_place_of_print,
    is_certain,
    may_be_dots,
    measure_dot_noise,
)

_CONTRAST = 0.8


def _see_dots(
    origin: tuple[int, int],
    size: tuple[int, int],
    quarters: int,
    wrong: float,
    sigma: float,
    rng: np.random.Generator,
) -> Dots:
    """The levels of a board's dots, turned clockwise, a share of them wrong and all with noise."""
    right, down = (np.where(each, 1.0, -1.0) for each in PuzzleBoard(origin).read_dots(size))
    level = np.concatenate([right.ravel(), down.ravel()])
    level[rng.choice(level.size, round(wrong * level.size), replace=False)] *= -1
    level = _CONTRAST * level + sigma * rng.standard_normal(level.size)
    dots = Dots(level[: right.size].reshape(right.shape), level[right.size :].reshape(down.shape))
    for _ in range(quarters):
        dots = Dots(np.rot90(dots.down, -1), np.rot90(dots.right, -1))
    return dots


def _invert(dots: Dots) -> Dots:
    """The dots of a print in which dark and white are exchanged."""
    return Dots(-dots.right, -dots.down)


def _count(
    size: tuple[int, int], wrong: float, sigma: float, count: int, stated: bool
) -> tuple[int, int]:
    """Number of boards whose place was found, and of those given a wrong one."""
    rng = np.random.default_rng(5)
    right = false = 0
    for k in range(count):
        row, col = (int(rng.integers(CODE_LINES + 1 - lines)) for lines in size)
        dots = _see_dots((row, col), size, k % 4, wrong, sigma, rng)
        place = find_place(dots, StatedBoard((row, col), size) if stated else None)
        if is_certain(place):
            true = (place.quarters, place.first) == (k % 4, (row, col))
            right, false = right + true, false + (not true)
    return right, false


@pytest.mark.parametrize(
    ("size", "wrong", "sigma", "stated", "least"),
    [
        ((5, 5), 0.0, 0.1, False, 19),
        ((5, 5), 0.0, 0.2, False, 19),
        ((8, 8), 0.10, 0.1, False, 17),
        ((12, 16), 0.2, 0.1, False, 20),
        ((4, 4), 0.0, 0.1, True, 20),
        ((8, 8), 0.30, 0.1, True, 19),
    ],
)
def test_places_are_found_and_none_is_wrong(
    size: tuple[int, int], wrong: float, sigma: float, stated: bool, least: int
) -> None:
    right, false = _count(size, wrong, sigma, 20, stated)
    assert right >= least
    assert false == 0


@pytest.mark.parametrize("size", [(4, 4), (6, 7), (12, 12)])
@pytest.mark.parametrize("stated", [False, True])
def test_dots_at_random_have_no_place(size: tuple[int, int], stated: bool) -> None:
    rng = np.random.default_rng(6)
    for _ in range(8):
        rows, cols = size
        dots = Dots(
            rng.choice([-1.0, 1.0], (rows, cols - 1)), rng.choice([-1.0, 1.0], (rows - 1, cols))
        )
        board = StatedBoard((100, 200), (30, 30)) if stated else None
        assert not is_certain(find_place(dots, board))


def test_hopeless_places_are_not_compared_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """There are a million of them, and in textures none is likely."""
    compared: list[tuple[int, int]] = []
    weigh = place_decoding._weigh_places
    monkeypatch.setattr(
        place_decoding,
        "_weigh_places",
        lambda size, board: compared.append(size) or weigh(size, board),
    )
    rng = np.random.default_rng(0)
    at_random = Dots(rng.uniform(-0.5, 0.5, (20, 19)), rng.uniform(-0.5, 0.5, (19, 20)))
    assert find_place(at_random).doubt == 1.0
    assert not compared
    assert is_certain(find_place(_see_dots((50, 101), (7, 10), 0, 0.0, 0.1, rng)))
    assert compared


def test_another_part_than_the_stated_one_is_told() -> None:
    dots = _see_dots((50, 100), (7, 8), 0, 0.0, 0.1, np.random.default_rng(7))
    place = find_place(dots, StatedBoard((0, 0), (7, 8)))
    assert is_certain(place)
    assert place.first == (50, 100)


def test_missing_dots_do_not_matter() -> None:
    dots = _see_dots((3, 4), (8, 9), 0, 0.0, 0.1, np.random.default_rng(8))
    right, down = dots.right.copy(), dots.down.copy()
    right[2:5, 3:5] = down[:3, 6:] = np.nan
    place = find_place(Dots(right, down))
    assert is_certain(place)
    assert place.first == (3, 4)
    nothing = Dots(np.full((5, 4), np.nan), np.full((4, 5), np.nan))
    assert not is_certain(find_place(nothing))


def test_the_noise_of_the_dots() -> None:
    dots = _see_dots((0, 0), (20, 20), 0, 0.0, 0.3, np.random.default_rng(9))
    mean, sigma = measure_dot_noise(dots)
    assert mean == pytest.approx(_CONTRAST, abs=0.03)
    assert sigma == pytest.approx(0.3, abs=0.03)


@pytest.mark.parametrize("is_inverted", [False, True])
@pytest.mark.parametrize("is_mirrored", [False, True])
def test_a_mirror_or_an_inverse_print_makes_no_other_place(
    is_inverted: bool, is_mirrored: bool
) -> None:
    """Seen as they are the dots may look like another part of the pattern."""
    rng = np.random.default_rng(5)
    for k in range(4):
        origin = int(rng.integers(490)), int(rng.integers(490))
        dots = _see_dots(origin, (8, 8), k % 4, 0.0, 0.15, rng)
        dots = _invert(dots) if is_inverted else dots
        place, mirrored = find_place_of_print(dots.mirror() if is_mirrored else dots)
        assert is_certain(place)
        assert mirrored == is_mirrored
        assert is_mirrored or place.first == origin


def test_what_may_be_dots() -> None:
    """Real ones pass turned, inverted, mirrored and with many wrong."""
    rng = np.random.default_rng(10)
    for quarters, wrong in ((0, 0.0), (1, 0.3), (2, 0.3), (3, 0.3)):
        dots = _see_dots((30, 40), (16, 18), quarters, wrong, 0.2, rng)
        for print_ in (dots, _invert(dots), dots.mirror(), _invert(dots.mirror())):
            assert may_be_dots(print_)
    assert may_be_dots(_see_dots((0, 0), (3, 3), 0, 0.0, 0.1, rng))
    bare = 0.05 * rng.standard_normal((2, 20, 20))
    assert not may_be_dots(Dots(bare[0, :, 1:], bare[1, 1:]))
    texture = rng.choice([-1.0, 1.0], (2, 30, 30))
    assert not may_be_dots(Dots(texture[0, :, 1:], texture[1, 1:]))
