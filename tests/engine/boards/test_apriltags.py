"""The families of AprilTags and what is printed of the boards that bear them."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.apriltags import FAMILIES, draw_tag, load_family
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.printed_pattern import PrintedRectangles
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.errors import CalibrationError

COUNTS = {"t36h11": 587, "t25h9": 35, "t25h7": 242, "t16h5": 30, "t36h10": 2320}
FIRST_CODES = {"t36h11": 0xD5D628584, "t25h9": 0x155CBF1, "t16h5": 0x231B}
"""Codes of tag 0 in the AprilTag library: the highest bit is the upper left cell."""


@pytest.mark.parametrize("name", FAMILIES)
def test_families_are_as_large_as_published(name: str) -> None:
    family = load_family(name)
    assert len(family.cells) == COUNTS[name]
    assert f"t{family.side**2}h{family.distance}" == name


@pytest.mark.parametrize("name", FIRST_CODES)
def test_tags_stand_upright(name: str) -> None:
    bits = "".join("0" if dark else "1" for dark in load_family(name).cells[0].ravel())
    assert int(bits, 2) == FIRST_CODES[name]


def test_distances_in_25h7_are_those_published() -> None:
    """The AprilTag library lists how many pairs of tags, whatever their turn, differ in how many
    cells: one wrong code would change that."""
    cells = load_family("t25h7").cells
    turned = [np.rot90(cells, turn, axes=(1, 2)).reshape(len(cells), -1) for turn in range(4)]
    distance = np.min([(turned[0][:, None] != other).sum(axis=2) for other in turned], axis=0)
    found = np.bincount(distance[np.triu_indices(len(cells), 1)])
    published = [2076, 4161, 5299, 6342, 5526, 3503, 1622, 499, 114, 16, 3]
    assert found.tolist() == 7 * [0] + published


def test_places_of_an_april_grid() -> None:
    """Kalibr's: X = (1 + spacing) * tag + corner of it, in sides of a tag."""
    board = Board(4, 4, 88.0, AprilGrid(spacing=0.3))
    x = board.points([(0, k) for k in range(4)])[:, 0]
    np.testing.assert_allclose(x, [0.0, 88.0, 114.4, 202.4])
    np.testing.assert_allclose(board.points([(k, 0) for k in range(4)])[:, 1], x)


@pytest.mark.parametrize("from_top", [False, True])
def test_print_of_an_april_grid(from_top: bool) -> None:
    ink = AprilGrid("t36h11", 0.3, 2, from_top).draw((4, 6))
    assert isinstance(ink, PrintedRectangles)
    assert ink.extent == pytest.approx((-0.3, -0.3, 3.9, 2.6))
    first, last = draw_tag("t36h11", 0, 2), draw_tag("t36h11", 5, 2)
    lower, upper = np.s_[12:22, 1:11], np.s_[1:11, 23:33]
    assert (ink.dark[lower] == first).all() is np.bool_(not from_top)
    assert (ink.dark[upper] == last).all() is np.bool_(not from_top)
    if from_top:
        assert (ink.dark[1:11, 1:11] == first).all()
    # The small squares, and nothing else between the tags.
    assert ink.dark[::11, ::11].all()
    assert np.count_nonzero(ink.dark[::11]) == 3 * 4
    bare = AprilGrid("t36h11", 0.3, 2, from_top, corner_squares=False).draw((4, 6))
    assert isinstance(bare, PrintedRectangles)
    assert not bare.dark[::11].any()
    np.testing.assert_array_equal(bare.dark[1:11], ink.dark[1:11])


@pytest.mark.parametrize("from_top", [False, True])
def test_print_of_a_tagged_checkerboard(from_top: bool) -> None:
    pattern = TaggedCheckerboard("t25h7", 2, 4, from_top)
    ink = pattern.draw((7, 6))
    assert isinstance(ink, PrintedRectangles)
    squares = ink.dark.reshape(8, 9, 7, 9).transpose(0, 2, 1, 3)
    tagged = [(r, c) for r, c in np.ndindex(8, 7) if 0 < squares[r, c].mean() < 1]
    rows = (1, 5) if from_top else (6, 2)
    assert sorted(tagged) == sorted((r, c) for r in rows for c in (1, 5))
    for number, (r, c) in enumerate((r, c) for r in rows for c in (1, 5)):
        np.testing.assert_array_equal(squares[r, c], draw_tag("t25h7", number, 2))
    dark = squares[..., 0, 0]
    np.testing.assert_array_equal(dark, np.indices((8, 7)).sum(axis=0) % 2 == dark[1, 0])
    assert dark[rows[0], 1]


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: AprilGrid("t30h3"), "t30h3"),
        (lambda: AprilGrid(border=3), "3 cells"),
        (lambda: AprilGrid(spacing=1.5), "1.5"),
        (lambda: TaggedCheckerboard(step=3), "every 3 squares"),
        (lambda: AprilGrid("t25h9", 0.3).draw((12, 14)), "35 tags"),
        (lambda: AprilGrid("t36h11", 0.3).draw((11, 12)), "two for each tag"),
        (lambda: AprilGrid().draw((4, 4)), "not known"),
        (lambda: TaggedCheckerboard().draw((4, 4)), "not known"),
        (lambda: Board(4, 4, 1.0, AprilGrid()).points(), "gap"),
    ],
)
def test_what_cannot_be(make: object, says: str) -> None:
    assert callable(make)
    with pytest.raises(CalibrationError, match=says):
        make()


def test_images_together_tell_more() -> None:
    seen = [AprilGrid("t36h11", s, 2, False) for s in (0.2991, 0.2857, 0.28569)]
    assert AprilGrid().complete_from(seen) == AprilGrid("t36h11", 0.2857, 2, False)
    nearly = [AprilGrid("t36h11", s, 2, False) for s in (0.29986, 0.29991, 0.29995, 0.3)]
    assert AprilGrid().complete_from(nearly).spacing == 0.3
    assert AprilGrid(spacing=0.25).complete_from(seen).spacing == 0.25
    assert AprilGrid().complete_from([]) == AprilGrid()
    tagged = TaggedCheckerboard("t25h7", 2, 4, False)
    assert TaggedCheckerboard().complete_from([tagged]) == tagged
