"""Markers that are read where others predict them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.april_grid import AprilGrid, TagLayout
from calibgui.engine.boards.apriltags import draw_tag
from calibgui.engine.boards.board import Board
from calibgui.engine.detection.apriltags.grid_tags import GridTagFinder, find_grid_tags
from calibgui.engine.detection.apriltags.tag_reader import TagPrint
from calibgui.engine.detection.charuco.marker_growth import (
    TAG_NEIGHBOURS,
    MarkerPrints,
    describe_prints,
    grow_markers,
)
from calibgui.engine.detection.charuco.markers import Markers
from tests.scenes.perspective import photograph_pattern

BOARD = Board(8, 10, 22.0, AprilGrid("t36h11", 0.3, 2, False))
LAYOUT = TagLayout(5, False)
ALL = list(range(20))


@pytest.fixture(scope="module")
def image() -> GreyImage:
    return photograph_pattern((640, 480), BOARD, 0.7, 0.8)


@pytest.fixture(scope="module")
def tags(image: GreyImage) -> Markers[TagLayout]:
    """All tags of the image, read as quadrilaterals."""
    found = find_grid_tags([GridTagFinder(image, None)], BOARD.pattern, BOARD.grid_size)
    assert found is not None
    tag_print, tags = found[0]
    assert tag_print == TagPrint("t36h11", 2)
    return tags.select(np.argsort(tags.numbers))


@pytest.fixture(scope="module")
def prints() -> MarkerPrints:
    cells = np.array([draw_tag("t36h11", number, 2) for number in range(30)])
    return describe_prints(cells, TAG_NEIGHBOURS)


def select_few(tags: Markers[TagLayout], layout: TagLayout = LAYOUT) -> Markers[TagLayout]:
    """Select three tags in one row, which agree with any long enough row of either order."""
    few = tags.select(np.arange(3))
    return replace(few, layout=layout, squares=layout.locate_squares(few.numbers))


def test_all_are_read_from_three_and_tell_the_layout(
    image: GreyImage, tags: Markers[TagLayout], prints: MarkerPrints
) -> None:
    layouts = (TagLayout(7, False), LAYOUT, TagLayout(5, True), TagLayout(4, False))
    readings = [select_few(tags, layout) for layout in layouts]
    (grown,) = grow_markers(image, readings, prints, None, None)
    assert grown.layout == LAYOUT
    order = np.argsort(grown.numbers)
    assert grown.numbers[order].tolist() == ALL
    assert np.abs(grown.corners[order] - tags.corners).max() < 1.5
    assert (grown.squares == LAYOUT.locate_squares(grown.numbers)).all()


def test_a_layout_by_chance_grows_no_markers(
    image: GreyImage, tags: Markers[TagLayout], prints: MarkerPrints
) -> None:
    """That markers of different layouts agree on as many pairs does not make them one board's."""
    chance = TagLayout(7, False)
    some = tags.select(np.array([0, 3, 11]))
    false = replace(some, layout=chance, squares=chance.locate_squares(some.numbers))
    for readings in ([false, select_few(tags)], [select_few(tags), false]):
        (grown,) = grow_markers(image, readings, prints, None, None)
        assert grown.layout == LAYOUT
        assert sorted(grown.numbers.tolist()) == ALL


def test_plain_paper_is_not_read_whatever_its_noise_says(
    image: GreyImage, tags: Markers[TagLayout], prints: MarkerPrints
) -> None:
    low, high = (end(tags.corners[12], axis=0) for end in (np.min, np.max))
    (u0, v0), (u1, v1) = np.floor(low).astype(int) - 3, np.ceil(high).astype(int) + 4
    faint = image.copy()
    faint[v0:v1, u0:u1] = np.rint(190 + 0.1 * (faint[v0:v1, u0:u1] - 190.0))
    (grown,) = grow_markers(faint, [select_few(tags)], prints, None, None)
    assert 12 not in grown.numbers
    assert len(grown.numbers) >= 15


def test_only_numbers_of_the_board_are_read_within_the_outline(
    image: GreyImage, tags: Markers[TagLayout], prints: MarkerPrints
) -> None:
    (grown,) = grow_markers(image, [select_few(tags)], prints, 10, None)
    assert sorted(grown.numbers.tolist()) == ALL[:10]
    # Around the lower left tag and the three beside it.
    outline = np.array([tags.corners[k].mean(axis=0) for k in (0, 5, 6, 1)])
    outline = outline.mean(axis=0) + 1.3 * (outline - outline.mean(axis=0))
    (grown,) = grow_markers(image, [select_few(tags)], prints, None, outline)
    assert sorted(grown.numbers.tolist()) == [0, 1, 2, 5, 6]


def test_places_beside_the_board_are_not_looked_at(
    image: GreyImage, tags: Markers[TagLayout], prints: MarkerPrints
) -> None:
    looked_at: list[Array] = []

    def keep(quads: Array) -> Array:
        looked_at.append(quads)
        return quads

    few = select_few(tags)
    (grown,) = grow_markers(image, [few], prints, 10, None, keep)
    assert len(grown.numbers) == 10
    assert sum(map(len, looked_at)) == 10 - len(few.numbers)
