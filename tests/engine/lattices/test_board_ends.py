"""What the image shows of a board's end, by painted squares."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.features.lattice import (
    Lattice,
    add_border,
    drop_isolated_and_crop,
    estimate_steps,
    predict_places,
)
from calibgui.engine.lattices import board_ends
from calibgui.engine.lattices.numbering import turn_lattice
from tests.engine.painted_squares import (
    BRIGHT,
    DARK,
    MARGIN,
    SQUARE,
    Image,
    alternate,
    drop,
    invert,
    paint,
    place,
)


@pytest.mark.parametrize(
    ("uv", "inside"),
    [
        ((4.1, 50), True),
        ((3.9, 50), False),
        ((50, 4.1), True),
        ((50, 3.9), False),
        ((94.9, 50), True),
        ((95.1, 50), False),
        ((50, 74.9), True),
        ((50, 75.1), False),
        ((np.nan, 50), False),
    ],
)
def test_positions_at_the_border_are_not_in_the_image(
    uv: tuple[float, float], inside: bool
) -> None:
    assert board_ends.are_in_image(np.array(uv), (80, 100)) == inside


class TestEnds:
    def test_a_board_ends_on_all_sides(self) -> None:
        image = paint(alternate(6, 9))
        assert board_ends.find_ends(place(6, 9), image) == (True, True, True, True)

    @pytest.mark.parametrize("side", range(4))
    def test_it_does_not_end_where_a_line_was_missed(self, side: int) -> None:
        """Of the sides top, right, bottom and left."""
        cells = [np.s_[1:], np.s_[:, :-1], np.s_[:-1], np.s_[:, 1:]]
        part = Lattice(place(6, 9).uv[cells[side]], dark=side in (1, 2))
        ends = board_ends.find_ends(part, paint(alternate(6, 9)))
        assert ends == tuple(k != side for k in range(4))

    def test_the_end_is_not_seen_at_the_border_of_the_image(self) -> None:
        image = paint(alternate(6, 9))[MARGIN - 3 :]
        lattice = Lattice(place(6, 9).uv - [0, MARGIN - 3], dark=True)
        assert board_ends.find_ends(lattice, image) == (False, True, True, True)

    @pytest.mark.parametrize(("cols", "ends"), [(3, True), (2, False)])
    def test_three_places_show_the_end(self, cols: int, ends: bool) -> None:
        top, right, bottom, left = board_ends.find_ends(place(6, cols), paint(alternate(6, cols)))
        assert right
        assert left
        assert top == bottom == ends

    @pytest.mark.parametrize(("hidden", "ends"), [(4, True), (5, False)])
    def test_more_than_six_tenths_of_the_places_show_the_end(self, hidden: int, ends: bool) -> None:
        """Of ten; a place beside a square that is seen shows it."""
        levels = alternate(6, 10)
        levels[0, :hidden] = 125
        assert board_ends.find_ends(place(6, 10), paint(levels))[0] == ends

    @pytest.mark.parametrize(("contrast", "ends"), [(0.42, True), (0.38, False)])
    def test_the_last_squares_are_seen(self, contrast: float, ends: bool) -> None:
        levels = alternate(6, 9)
        levels[0] = 125 + contrast * (levels[0] - 125)
        assert board_ends.find_ends(place(6, 9), paint(levels))[0] == ends

    @pytest.mark.parametrize(("contrast", "ends"), [(0.38, True), (0.42, False)])
    def test_no_squares_are_seen_behind_them(self, contrast: float, ends: bool) -> None:
        levels = alternate(7, 9)
        levels[0] = 125 + contrast * (levels[0] - 125)
        part = Lattice(place(7, 9).uv[1:], dark=False)
        assert board_ends.find_ends(part, paint(levels))[0] == ends

    def test_squares_that_lie_outside_of_the_image_show_no_end(self) -> None:
        """Those in its outermost pixels do not stand in for them."""
        uv = 4 * place(7, 9).uv + 1.5
        image = np.kron(paint(alternate(7, 9)), np.ones((4, 4), np.uint8))
        cut = round(uv[0, 0, 1]) + 4
        nearer = Lattice(uv[1:] - [0, cut - 10], dark=False)  # the line before it seems to be seen
        assert not board_ends.find_ends(nearer, image[cut:])[0]


class TestStrayLines:
    @pytest.mark.parametrize("quarters", range(4))
    @pytest.mark.parametrize(("found", "passes"), [(6, True), (5, False)])
    def test_a_line_beyond_the_end_of_the_board_is_dropped_unless_full(
        self, found: int, passes: bool, quarters: int
    ) -> None:
        """The line beyond the last row is the border of the board."""
        image, lattice = paint(alternate(6, 9)), place(7, 9)
        stray = drop(lattice, *((6, col) for col in range(9) if not 2 <= col < 2 + found))
        kept = board_ends.drop_stray_lines(turn_lattice(stray, quarters), image)
        assert len(kept) == 54 + found * passes
        assert sorted(kept.shape) == ([7, 9] if passes else [6, 9])
        board = turn_lattice(kept, -quarters)
        np.testing.assert_array_equal(board.uv[:6], place(6, 9).uv)
        assert board.dark

    def test_the_outermost_squares_may_be_cut(self) -> None:
        """A board that is cut too closely, three tenths of a square off."""
        image = paint(alternate(6, 9))
        image[int(MARGIN + 6.7 * SQUARE) :] = BRIGHT
        stray = drop(place(7, 9), *((6, col) for col in range(9) if col > 1))
        assert board_ends.drop_stray_lines(stray, image).shape == (6, 9)

    def test_few_corners_at_the_dark_edge_of_the_image_are_kept(self) -> None:
        """The next squares are seen, too, at a third of the contrast."""
        image = paint(alternate(7, 9))
        dark = image[int(MARGIN + 6.7 * SQUARE) :]
        dark[:] = DARK + 0.35 * (dark.astype(np.float64) - DARK)
        few = drop(place(7, 9), *((6, col) for col in range(9) if col > 1))
        assert board_ends.drop_stray_lines(few, image) is few

    def test_few_corners_before_the_end_of_the_board_are_kept(self) -> None:
        lattice = drop(place(6, 9), *((0, col) for col in range(2, 9)))
        assert board_ends.drop_stray_lines(lattice, paint(alternate(6, 9))) is lattice

    def test_lines_that_are_full_enough_are_not_looked_for_in_the_image(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """The first and the last column lack one of nine corners, the first row seven."""
        mapped: list[Lattice] = []
        fit = board_ends.grid_map.fit_grid_map
        monkeypatch.setattr(
            board_ends.grid_map, "fit_grid_map", lambda each: mapped.append(each) or fit(each)
        )
        lattice = drop(place(9, 9), *((0, col) for col in (0, *range(3, 9))), (4, 0), (5, 8))
        board_ends.drop_stray_lines(lattice, paint(alternate(9, 9)))
        assert len(mapped) == 1


class TestStandingAlone:
    def test_up_to_half_of_it_may_be_hidden(self) -> None:
        image, lattice = paint(alternate(6, 9)), place(6, 9)
        row, col = np.indices(lattice.shape)
        inside = (row > 0) & (row < 5) & (col > 0) & (col < 8)
        assert board_ends.stands_alone(lattice, image)
        assert board_ends.stands_alone(lattice.select(~inside | (row == 2)), image)
        assert not board_ends.stands_alone(lattice.select(~inside), image)

    @pytest.mark.parametrize(("sides", "stands"), [(1, True), (2, True), (3, False)])
    def test_it_may_leave_the_image_on_two_sides(self, sides: int, stands: bool) -> None:
        image, lattice = paint(alternate(6, 9)), place(6, 9)
        top, left, right = (MARGIN * (sides > k) for k in range(3))
        cut = image[top:, left : image.shape[1] - right]
        moved = Lattice(lattice.uv - [left, top], dark=True)
        assert board_ends.stands_alone(moved, cut) == stands

    @pytest.mark.parametrize("hidden", [False, True])
    def test_it_does_not_go_on(self, hidden: bool) -> None:
        """Nor on a side of the lattice whose lines hold no corner."""
        lattice = place(6, 9).select(np.indices((6, 9))[1] > 0)
        if not hidden:
            lattice = drop_isolated_and_crop(lattice)
        assert not board_ends.stands_alone(lattice, paint(alternate(6, 9)))


def test_what_lies_in_front_of_a_lattice_depends_on_its_first_lines() -> None:
    """On no more of them than are looked at, whatever is missing."""
    rng = np.random.default_rng(0)
    grid = np.stack(np.meshgrid(np.arange(9.0), np.arange(12.0)), axis=-1)
    count = board_ends._LINES_THAT_PREDICT
    for _ in range(50):
        uv = 20 * grid + rng.uniform(-1, 1, grid.shape)
        uv[rng.uniform(size=uv.shape[:2]) < 0.6] = np.nan
        of_all, of_first = (
            np.stack([each[0] for each in (predict_places(uv), *estimate_steps(uv))])
            for uv in (add_border(uv, 1), add_border(uv[:count], 1))
        )
        np.testing.assert_array_equal(of_first, of_all)


class TestContinuation:
    @staticmethod
    def paint_around(top: int, left: int) -> Image:
        """Paint the squares of 4 x 4 corners, and around them those that some places require."""
        levels = alternate(6, 6)
        inner = np.zeros(levels.shape, dtype=bool)
        inner[1:-1, 1:-1] = True
        inner[0, 1 : top + 2] = top > 0
        inner[1 : left + 2, 0] = left > 0
        return paint(np.where(inner, levels, invert(levels)))

    @pytest.mark.parametrize(("left", "goes_on"), [(2, True), (1, False)])
    def test_a_third_of_the_places_around_alternate(self, left: int, goes_on: bool) -> None:
        """There are 16 places around."""
        inner = Lattice(place(6, 6).uv[1:-1, 1:-1], dark=True)
        image = self.paint_around(top=4, left=left)
        assert board_ends.does_pattern_continue(inner, image) == goes_on

    def test_a_whole_board_does_not_continue(self) -> None:
        assert not board_ends.does_pattern_continue(place(6, 9), paint(alternate(6, 9)))

    @pytest.mark.parametrize(("top", "goes_on"), [(4, True), (0, False)])
    def test_places_outside_of_the_image_do_not_count(self, top: int, goes_on: bool) -> None:
        """Of the twelve places inside, two at the left alternate and those at the top."""
        inner = Lattice(place(6, 6).uv[1:-1, 1:-1], dark=True)
        image = self.paint_around(top, left=2)
        bottom = round(inner.uv[-1, 0, 1]) + SQUARE
        assert board_ends.does_pattern_continue(inner, image[:bottom]) == goes_on
