"""Small boards in large images, and large images without a board."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.detection.print_samples import QuadSearch
from calibgui.engine.errors import NoBoardError
from tests.scenes.perspective import photograph_pattern
from tests.scenes.without_board import draw_foliage, draw_without_board

_BOARDS = {
    "aprilgrid": Board(8, 10, 22.0, AprilGrid("t36h11", 0.3, 2, False)),
    "charuco": Board(7, 10, 26.0, Charuco("DICT_4X4_50", 0.75, False)),
}
_SIZES = {"aprilgrid": (190, 160), "charuco": (300, 240)}
"""Of the boards' pictures, px."""
_ASKED: dict[str, Pattern] = {"aprilgrid": AprilGrid(), "charuco": Charuco()}


@cache
def _draw_leaves() -> GreyImage:
    return draw_foliage(0, (1800, 2400))


@pytest.mark.parametrize("kind", _BOARDS)
@pytest.mark.parametrize("is_inverted", [False, True])
def test_a_small_board_among_leaves_is_found(kind: str, is_inverted: bool) -> None:
    """Its marks show in the full size only, where most of the image is not searched at first."""
    board = photograph_pattern(_SIZES[kind], _BOARDS[kind], 0.9, 0.7)[10:-10, 10:-10]
    for top, left in ((150, 250), (700, 1500), (1430, 2000)):
        image = _draw_leaves().copy()
        part = image[top : top + board.shape[0], left : left + board.shape[1]]
        part[...] = 255 - board if is_inverted else board
        assert len(find_corners(image, pattern=_ASKED[kind])) > 50


@pytest.mark.parametrize("kind", _BOARDS)
def test_most_of_what_shows_no_marks_is_not_searched(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    searched: list[int] = []
    search = opencv.detect_dark_quads

    def count(image: GreyImage, *how: Any, **more: Any) -> Array:
        searched.append(image.size)
        return search(image, *how, **more)

    monkeypatch.setattr(opencv, "detect_dark_quads", count)
    size = 1800 * 2400
    noise = np.random.default_rng(0).integers(0, 256, (1800, 2400)).astype(np.uint8)
    for image, least in ((_draw_leaves(), 1), (noise, 1), (np.full_like(noise, 128), 0)):
        searched.clear()
        with pytest.raises(NoBoardError):
            find_corners(image, pattern=_ASKED[kind])
        parts = [each for each in searched if each < size / 4]
        assert len(parts) >= least
        assert max(searched) == size / 4


@pytest.mark.parametrize(("kind", "seed"), [("aprilgrid", 12), ("charuco", 12), ("aprilgrid", 11)])
def test_of_thousands_of_parts_some_are_searched(
    kind: str, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Bricks and waves, 2000 and more at the coarsest size: OpenCV compares all pairs of them."""
    found: list[int] = []
    search = opencv.detect_dark_quads

    def count(image: GreyImage, *how: Any, **more: Any) -> Array:
        quads = search(image, *how, **more)
        found.append(len(quads))
        return quads

    monkeypatch.setattr(opencv, "detect_dark_quads", count)
    with pytest.raises(NoBoardError):
        find_corners(draw_without_board(seed, (750, 1000), 0.625), pattern=_ASKED[kind])
    assert max(found) < 1000


def test_small_parts_are_looked_for_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A search of bricks in full looks for large ones more thoroughly; of small ones it knows."""
    searched: list[tuple[int, ...]] = []
    search = opencv.detect_dark_quads

    def count(image: GreyImage, *how: Any, **more: Any) -> Array:
        searched.append(image.shape)
        return search(image, *how, **more)

    monkeypatch.setattr(opencv, "detect_dark_quads", count)
    wall = QuadSearch(draw_without_board(12, (750, 1000), 0.625))
    quick, full = wall.detect_dark_quads(is_quick=True), wall.detect_dark_quads()
    assert searched.count((750, 1000)) == 2
    assert len(searched) <= 2 + 4
    assert min(len(quick), len(full)) > 500


@pytest.mark.parametrize(("size", "at"), [((400, 330), (300, 500)), ((900, 700), (30, 60))])
def test_a_board_before_a_wall_is_found(size: tuple[int, int], at: tuple[int, int]) -> None:
    """Its tags are as small as the bricks, or larger than what is searched at a time."""
    board = photograph_pattern(size, _BOARDS["aprilgrid"], 0.95, 0.7)[10:-10, 10:-10]
    image = draw_without_board(12, (750, 1000), 0.625)
    top, left = at
    image[top : top + board.shape[0], left : left + board.shape[1]] = board
    assert len(find_corners(image, pattern=_ASKED["aprilgrid"])) > 70


def test_quadrilaterals_are_counted_among_specks_up_to_enough() -> None:
    image = np.full((200, 400), 200, np.uint8)
    image[2::5, 2::5] = 60  # 3200 of them
    for k in range(30):
        top, left = 10 + 60 * (k // 10), 10 + 38 * (k % 10)
        image[top - 4 : top + 18, left - 4 : left + 18] = 200
        image[top : top + 14, left : left + 14] = 60
    counts = [opencv.count_quads(image, 11, 20, enough, enough) for enough in (20, 50, 100)]
    assert counts == [20, 30, 0]


def test_a_block_that_the_border_cuts_counts_as_others() -> None:
    """Else the tiles at the border of an image of fine texture would be the first."""
    noise = np.random.default_rng(0).integers(0, 256, (330, 690)).astype(np.uint8)
    detail = opencv.average_detail(noise, 5, 32)
    assert detail.shape == (11, 22)
    inside = detail[:-1, :-1]
    assert np.abs(detail - inside.mean()).max() < 5 * inside.std()
