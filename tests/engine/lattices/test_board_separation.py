"""Boards that hang together are taken apart; one board, however bent, is not."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.lattices.board_separation import separate_boards
from tests.engine.painted_squares import SQUARE, alternate, paint, place
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions
from tests.scenes.creases import draw_corner_of_room
from tests.scenes.without_board import draw_without_board

Array = NDArray[np.float64]
CONDITIONS = Conditions(grid_size=(5, 6), square=26.0, turn=5.0, centre=(-80.0, 0.0), parts=1)
NOWHERE = np.zeros((480, 640), np.uint8)


def join(left_out: int, fold: float = 70.0) -> tuple[Lattice, tuple[Array, Array], Array]:
    """Two boards in one lattice, with `left_out` lines of false corners between them."""
    image, boards = draw_corner_of_room(CONDITIONS, (6, 5), (0.1, 0.1), fold, 4)
    between = (boards[0][:, -1:] + boards[1][:, :1]) / 2
    uv = np.concatenate([boards[0], *[between] * left_out, boards[1]], axis=1)
    return Lattice(uv, True), boards, image


@pytest.mark.parametrize("left_out", [0, 1])
@pytest.mark.parametrize("turned", [False, True])
def test_two_walls_are_cut_apart(left_out: int, turned: bool) -> None:
    lattice, boards, image = join(left_out)
    if turned:
        lattice = Lattice(np.swapaxes(lattice.uv, 0, 1), lattice.dark)
    parts = separate_boards(lattice, image)
    found = sorted(tuple(sorted(map(tuple, part.uv[part.found].round(6)))) for part in parts)
    truth = sorted(tuple(sorted(map(tuple, b.reshape(-1, 2).round(6)))) for b in boards)
    assert found == truth


def test_a_board_is_not_cut_where_a_shadow_draws_one_line_aside() -> None:
    """Of 32 corners 12 were left: two maps follow what is beside the line, but so does one."""
    uv = place(4, 8).uv.copy()
    uv[:, 4, 0] += 0.12 * SQUARE
    lattice = Lattice(uv, dark=True)
    assert separate_boards(lattice, paint(alternate(4, 8))) == [lattice]


def test_the_parts_keep_their_colours() -> None:
    """The first square of the second board is dark where six columns lie before it, not seven."""
    lattice, _, image = join(left_out=0)
    parts = separate_boards(lattice, image)
    assert {part.shape: part.dark for part in parts} == {(5, 6): True, (5, 5): True}
    lattice, _, image = join(left_out=1)
    parts = separate_boards(lattice, image)
    assert {part.shape: part.dark for part in parts} == {(5, 6): True, (5, 5): False}


@pytest.mark.parametrize(
    "conditions",
    [
        Conditions(parts=1),
        Conditions(tilt=60.0, square=36.0, parts=1),
        Conditions(distortion=0.5, square=38.0, parts=1),
        Conditions(fisheye=True, focal=0.4, square=36.0, tilt=40.0, parts=1),
    ],
)
def test_one_board_is_left_as_it_is(conditions: Conditions) -> None:
    uv = draw(conditions, 3).uv + np.random.default_rng(0).normal(0, 0.1, (6, 9, 2))
    lattice = Lattice(uv, True)
    assert separate_boards(lattice, NOWHERE) == [lattice]


def test_a_board_in_waves_is_not_cut() -> None:
    """Three rows that a shutter has shifted each by itself were followed by a map of their own."""
    conditions = Conditions(grid_size=(7, 10), square=26.0, tilt=20.0, turn=15.0, parts=1)
    uv = draw(conditions, 3).uv
    uv[..., 0] += 4.0 * np.sin(uv[..., 1] / 18 + 2)
    lattice = Lattice(uv, True)
    assert separate_boards(lattice, NOWHERE) == [lattice]


def test_one_board_is_not_cut_because_of_what_it_has_grown_into() -> None:
    """A few corners of a pattern around it spoil the map of all, and that of either part less."""
    scene = draw(Conditions(grid_size=(10, 14), square=24.0, turn=15.0, parts=2), 3)
    uv = np.full((10, 17, 2), np.nan)
    uv[:, 3:] = scene.uv
    across = scene.uv[3, 0] - scene.uv[3, 1]
    uv[3, :3] = scene.uv[3, 0] + np.array([[2.1], [1.4], [0.7]]) * across + (6.0, 9.0)
    (core,) = separate_boards(Lattice(uv, False), scene.photograph(0))
    assert np.array_equal(core.uv, scene.uv)


def test_corners_that_coincide_are_no_crease() -> None:
    """Where the end of a line coincides with its neighbour the step there is 0."""
    uv = draw(Conditions(grid_size=(4, 5), parts=1), 3).uv
    uv[0, 0] = uv[0, 1]
    (part,) = separate_boards(Lattice(uv, True), NOWHERE)
    assert part.shape == (4, 5)


def test_what_a_board_has_grown_into_is_left_out() -> None:
    scene = draw(Conditions(parts=2), 3)
    uv = np.full((8, 11, 2), np.nan)
    uv[1:-1, 1:-1] = scene.uv
    right, down = scene.uv[0, 1] - scene.uv[0, 0], scene.uv[1, 0] - scene.uv[0, 0]
    uv[0, 2:4] = scene.uv[0, 1:3] - 0.5 * down + 0.4 * right
    uv[4, 0] = scene.uv[3, 0] - 1.7 * right
    (core,) = separate_boards(Lattice(uv, True), scene.photograph(0))
    assert np.array_equal(core.uv, scene.uv)
    # Where the image does not show that the board ends there, it is left as it is.
    (same,) = separate_boards(Lattice(uv, True), NOWHERE)
    assert same.shape == (8, 11)


def test_a_texture_in_which_corners_coincide_is_refused() -> None:
    """The misfit of its parts is not a number; no cut was the best of those, and that an error."""
    with pytest.raises(NoBoardError):
        find_corners(draw_without_board(500960))
