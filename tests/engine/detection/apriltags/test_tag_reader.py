"""What may be a tag, and how often an image is searched for them."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
import pytest

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.apriltags import FAMILIES, load_family
from calibgui.engine.boards.board import Board
from calibgui.engine.detection.apriltags import grid_tags
from calibgui.engine.detection.apriltags.tag_reader import (
    TagPrint,
    TagReader,
    rate_borders,
    verify_tags,
)
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features import saddle
from tests.scenes.perspective import photograph_pattern
from tests.scenes.without_board import draw_without_board

SIDE, PITCH = 40, 56
"""Of the tags and from one to the next, px."""


def draw_tags(family: str, border: int, numbers: range, blur: float) -> tuple[GreyImage, Array]:
    """A row of tags, and their corners (n, 4, 2) px."""
    image = np.full((PITCH, PITCH * len(numbers)), 190.0)
    at = np.array([(0, 0), (SIDE, 0), (SIDE, SIDE), (0, SIDE)]) + (PITCH - SIDE) / 2 - 0.5
    for k, number in enumerate(numbers):
        dark = np.pad(load_family(family).cells[number], border, constant_values=True)
        tag = np.where(dark, 40.0, 190.0).repeat(12, axis=0).repeat(12, axis=1)
        tag = cv2.resize(tag, (SIDE, SIDE), interpolation=cv2.INTER_AREA)
        left, top = k * PITCH + (PITCH - SIDE) // 2, (PITCH - SIDE) // 2
        image[top : top + SIDE, left : left + SIDE] = tag
    image = cv2.GaussianBlur(image, (0, 0), blur)
    image += np.random.default_rng(0).normal(0, 3, image.shape)
    quads = at + PITCH * np.array([(k, 0) for k in range(len(numbers))])[:, None]
    return np.clip(image, 0, 255).astype(np.uint8), quads


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("border", [1, 2])
def test_whatever_can_be_read_may_be_a_tag(family: str, border: int) -> None:
    for blur in (0.7, 2.5):
        image, quads = draw_tags(family, border, range(len(load_family(family).cells)), blur)
        read = TagReader(image, quads).read(TagPrint(family, border))
        assert (rate_borders(image, quads)[read.which] < 0.45).all()
        assert len(read.which) > 0.9 * len(quads) or blur > 1


def test_of_tags_alone_one_corner_is_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing dark touches it, so that the others need not be."""
    image, quads = draw_tags("t36h11", 2, range(20), 0.7)
    asked: list[int] = []
    refine = saddle.refine_saddles

    def count(image: GreyImage, uv: Array, *others: Any) -> Any:
        asked.append(len(uv))
        return refine(image, uv, *others)

    monkeypatch.setattr(saddle, "refine_saddles", count)
    np.testing.assert_array_equal(grid_tags._refine_quads(image, quads), quads)
    assert sum(asked) < 2 * len(quads)


def test_what_is_filled_evenly_is_no_tag() -> None:
    image = np.full((100, 200), 190, np.uint8)
    image[20:60, 30:80] = 40
    noisy = np.random.default_rng(0).normal(image, 3).astype(np.uint8)
    quad = np.array([[(30.0, 20.0), (80.0, 20.0), (80.0, 60.0), (30.0, 60.0)]]) - 0.5
    assert np.isinf(rate_borders(noisy, quad)).all()


def test_what_is_bright_along_its_sides_is_no_tag() -> None:
    image = np.full((100, 200), 190, np.uint8)
    image[20:60, 30:80], image[30:50, 40:70] = 150, 40
    quad = np.array([[(30.0, 20.0), (80.0, 20.0), (80.0, 60.0), (30.0, 60.0)]]) - 0.5
    assert np.isinf(rate_borders(image, quad)).all()


def test_an_image_is_searched_once_for_each_colour(monkeypatch: pytest.MonkeyPatch) -> None:
    """The explanation of what is missing looks at what the search has seen; the negative and the
    larger sizes of an image are searched only where a look at them shows tags. A look is enough
    where it shows most of a board, whatever its colours."""
    searched: list[str] = []
    search = opencv.detect_dark_quads

    def count(
        image: GreyImage, is_quick: bool = False, is_part: bool = False, **more: Any
    ) -> Array:
        searched.append("part" if is_part else "quick" if is_quick else "all")
        return search(image, is_quick, is_part, **more)

    monkeypatch.setattr(opencv, "detect_dark_quads", count)
    image = draw_without_board(5)
    with pytest.raises(NoBoardError, match="No AprilGrid"):
        find_corners(image, (8, 10), pattern=AprilGrid("t36h11"))
    assert searched == ["quick", "quick", "all"]
    searched.clear()
    with pytest.raises(NoBoardError, match="No AprilGrid"):
        find_corners(cv2.resize(image, (1920, 1440)), pattern=AprilGrid())
    assert searched[:3] == ["quick", "quick", "all"]
    assert set(searched[3:]) == {"part"}
    searched.clear()
    board = Board(8, 10, 1.0, AprilGrid("t36h11", 0.3, 2, False))
    image = photograph_pattern((640, 480), board, 0.7, 0.8)
    for levels, expected in ((image, ["quick"]), (255 - image, ["quick", "quick"])):
        assert find_corners(levels, pattern=AprilGrid()).complete
        assert searched == expected
        searched.clear()


def test_a_tag_is_verified_in_part_of_a_shadow_and_another_number_is_not() -> None:
    numbers = np.arange(40, 46)
    image, quads = draw_tags("t36h11", 2, range(40, 46), 0.7)
    v, u = np.indices(image.shape)
    along = (u - 0.5 * v) % PITCH
    shaded = np.where(along > PITCH / 2, image, image // 5)
    tag = TagPrint("t36h11", 2)
    for levels in (image, shaded):
        assert verify_tags(levels, quads, tag, numbers).all()
        assert not verify_tags(levels, quads, tag, numbers + 7).any()
    assert len(TagReader(shaded, quads).read(tag).numbers) < len(numbers)
