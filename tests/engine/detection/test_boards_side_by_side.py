"""Of two boards in one picture each is found by its own marks, and none for the other."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.rendering import Appearance, render_view

CAMERA = Camera((960, 720), [800, 800, 480, 360], "pinhole")
POSES = (Pose([0.1, -0.2, 0.05], [-230, -80, 600.0]), Pose([0.1, 0.3, 0.1], [40, -90, 590.0]))
PAPER = 220.0
PAIRS = {
    "ChArUco boards of one dictionary": [
        Board(5, 7, 28.0, Charuco("DICT_4X4_50", 0.7, False, first)) for first in (0, 24)
    ],
    "ChArUco boards of two dictionaries": [
        Board(5, 7, 28.0, Charuco(name, 0.7, False)) for name in ("DICT_4X4_50", "DICT_5X5_50")
    ],
    "AprilGrids of one family": [
        Board(8, 8, 28.0, AprilGrid("t36h11", 0.3, 2, False, True, first)) for first in (0, 16)
    ],
}  # fmt: skip


@cache
def draw(name: str, which: int) -> np.ndarray:
    board, pose = PAIRS[name][which], POSES[which]
    look = Appearance(background=PAPER)  # as paper, so that one board leaves room for the other
    return render_view(CAMERA, pose, board, blur=0.7, appearance=look)


def state(pattern: Pattern) -> Pattern:
    """What a user states of a pattern: its marks."""
    if isinstance(pattern, Charuco):
        return replace(pattern, marker=None, legacy=None)
    assert isinstance(pattern, AprilGrid)
    return AprilGrid(pattern.family, first_tag=pattern.first_tag)


@pytest.mark.parametrize("name", PAIRS)
def test_each_board_is_found_by_its_own_marks(name: str) -> None:
    boards = PAIRS[name]
    single = [draw(name, which) for which in (0, 1)]
    both = np.minimum(*single)
    for board, pose, other in zip(boards, POSES, single[::-1], strict=True):
        pattern = state(board.pattern)
        corners = find_corners(both, board.grid_size, pattern=pattern)
        assert len(corners.uv) == board.rows * board.cols
        truth = project_points(board.points(corners.grid), CAMERA, pose)
        assert np.abs(corners.uv - truth).max() < 0.05
        assert not corners.remark
        with pytest.raises(NoBoardError):
            find_corners(other, board.grid_size, pattern=pattern)


@pytest.mark.parametrize("name", ["ChArUco boards of one dictionary", "AprilGrids of one family"])
def test_the_board_of_which_less_is_seen_is_found(name: str) -> None:
    boards = PAIRS[name]
    first, second = draw(name, 0).copy(), draw(name, 1)
    middle = project_points(boards[0].points(), CAMERA, POSES[0]).mean(axis=0)
    first[:, : int(middle[0])] = PAPER
    corners = find_corners(
        np.minimum(first, second), boards[0].grid_size, pattern=state(boards[0].pattern)
    )
    assert 0.3 < len(corners.uv) / (boards[0].rows * boards[0].cols) < 0.7
    truth = project_points(boards[0].points(corners.grid), CAMERA, POSES[0])
    assert np.abs(corners.uv - truth).max() < 0.1


def test_a_first_marker_counts_without_a_size() -> None:
    name = "ChArUco boards of one dictionary"
    board = PAIRS[name][1]
    image, pattern = draw(name, 1), state(board.pattern)
    corners = find_corners(image, pattern=pattern)
    assert corners.shape == board.grid_size
    assert corners.pattern.first_marker == 24
    with pytest.raises(NoBoardError):
        find_corners(image, pattern=replace(pattern, first_marker=48))
