"""Guidance says what brings the board nearer to where it is wanted."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.capture.guidance import guide_board
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation

CAMERA = Camera((640, 480), [600, 600, 320, 240], "pinhole")
BOARD = Board(6, 9, 30.0)
XY = BOARD.points()
MIDDLE = XY.mean(axis=0)


def _pose(turn: tuple[float, float, float], at: tuple[float, float, float]) -> Pose:
    """The board's middle at a place, turned by degrees."""
    R = rotation_from_vector(np.deg2rad(turn))
    return Pose(vector_from_rotation(R), np.array(at) - R[:, :2] @ MIDDLE)


WANTED = _pose((0, 0, 0), (0, 0, 600))


@pytest.mark.parametrize(
    ("seen", "words"),
    [
        (_pose((0, 0, 0), (-100, 0, 600)), "Move it to the right."),
        (_pose((0, 0, 0), (100, 0, 600)), "Move it to the left."),
        (_pose((0, 0, 0), (0, -80, 600)), "Move it down."),
        (_pose((0, 0, 0), (0, 80, 600)), "Move it up."),
        (_pose((0, 0, 0), (0, 0, 900)), "Bring it closer."),
        (_pose((0, 0, 0), (0, 0, 450)), "Take it farther away."),
        (_pose((0, 0, -40), (0, 0, 600)), "Turn it clockwise."),
        (_pose((0, 0, 40), (0, 0, 600)), "Turn it anticlockwise."),
        (_pose((0, 0, 0), (5, 5, 610)), "Hold it still."),
    ],
)
def test_what_is_farthest_off_is_said(seen: Pose, words: str) -> None:
    assert guide_board(seen, WANTED, XY, CAMERA).instruction == words


@pytest.mark.parametrize(
    ("turn", "words", "side"),
    [
        ((40, 0, 0), "Tilt its lower side away.", XY[:, 1] > MIDDLE[1]),
        ((-40, 0, 0), "Tilt its upper side away.", XY[:, 1] < MIDDLE[1]),
        ((0, 40, 0), "Tilt its left side away.", XY[:, 0] < MIDDLE[0]),
        ((0, -40, 0), "Tilt its right side away.", XY[:, 0] > MIDDLE[0]),
    ],
)
def test_the_side_that_is_to_go_away_is_farther_where_it_is_wanted(
    turn: tuple[float, float, float], words: str, side: np.ndarray
) -> None:
    wanted = _pose(turn, (0, 0, 600))
    assert guide_board(WANTED, wanted, XY, CAMERA).instruction == words
    depth = XY @ rotation_from_vector(np.array(wanted.rvec))[2, :2] + wanted.tvec[2]
    assert depth[side].mean() > 600 > depth[~side].mean()


def test_half_a_turn_counts_as_none() -> None:
    turned = guide_board(_pose((0, 0, 180), (0, 0, 600)), WANTED, XY, CAMERA)
    assert turned.instruction == "Hold it still."
    assert turned.match == pytest.approx(1.0)


def test_the_match_grows_as_the_board_comes_nearer() -> None:
    at = [300, 150, 60, 0]
    matches = [guide_board(_pose((0, 0, 0), (x, 0, 600)), WANTED, XY, CAMERA).match for x in at]
    assert matches == sorted(matches)
    assert matches[-1] == pytest.approx(1.0)
