"""Circles of a list keep their places, whatever rows and columns number them."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.boards.listed_circles import ListedCircles, list_circles
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.errors import CalibrationError
from tests.scenes.circle_lists import Places, list_rows_by_turns, strew


@pytest.mark.parametrize(
    "places", [list_rows_by_turns(16, 17), strew(70, 0), strew(40, 1), [(5, 7), (9, 7.5), (1, 0)]]
)
def test_places_are_those_of_the_list(places: Places) -> None:
    pattern, pitch = list_circles(np.array(places) + np.array([40.0, -30.0]), diameter=1.0)
    board = Board(*pattern.grid_size, pitch, pattern)
    xy = board.points(pattern.grid)
    np.testing.assert_allclose(xy, np.array(places) - np.min(places, axis=0), atol=1e-9)
    assert len(np.unique(pattern.grid, axis=0)) == len(places), "two have one number"
    between = np.linalg.norm(xy[:, None] - xy + 1e9 * np.eye(len(xy))[..., None], axis=2)
    assert between.min() == pytest.approx(pitch)
    assert pattern.diameter == pytest.approx(1 / pitch)
    np.testing.assert_allclose(pattern.grid[:, ::-1], 2 * xy / pitch, atol=0.5 + 1e-9)


@pytest.mark.parametrize(
    ("places", "symmetry"),
    [
        (list_rows_by_turns(9, 13), Symmetry.HALF_TURN),
        (list_rows_by_turns(8, 13), Symmetry.NONE),
        ([(20.0 * c, 20.0 * r) for r in range(5) for c in range(5)], Symmetry.QUARTER_TURN),
        (strew(30, 2), Symmetry.NONE),
    ],
)
def test_turns_that_look_alike_are_known(places: Places, symmetry: Symmetry) -> None:
    pattern, _ = list_circles(places)
    assert pattern.symmetry(pattern.grid_size) is symmetry
    for quarters, order in pattern.list_turns():
        angle = quarters * np.pi / 2
        R = np.array([(np.cos(angle), -np.sin(angle)), (np.sin(angle), np.cos(angle))])
        off = np.array(pattern.places) - np.max(pattern.places, axis=0) / 2
        np.testing.assert_allclose(off @ R.T, off[order], atol=1e-9)


@pytest.mark.parametrize(
    ("places", "says"),
    [
        ([(0, 0)], "two or more"),
        ([0, 1, 2], "two or more"),
        ([(0, 0), (1, 1), (0, 0)], "one place"),
        ([(0, 0), (1, np.nan)], "no number"),
    ],
)
def test_what_is_no_list_is_refused(places: object, says: str) -> None:
    with pytest.raises(CalibrationError, match=says):
        list_circles(places)  # type: ignore[arg-type]


def test_circles_that_touch_are_refused_and_unknown_places_too() -> None:
    with pytest.raises(CalibrationError, match="touch"):
        list_circles([(0, 0), (10, 0)], diameter=10.0)
    with pytest.raises(CalibrationError, match="not known where"):
        Board(4, 4, 1.0, ListedCircles()).points()
