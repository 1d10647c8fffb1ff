"""Views of a board that deviates from its drawing, counted from different corners."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.checkerboard import checkerboard_ambiguity
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.detection.corners import Corners
from calibgui.engine.redetection.labelling import identified
from tests.engine import scenes

CAMERA = scenes.barrel()
NOISE = 0.05


def views(
    board: Board, deviation: float, turns: Sequence[int], parts: Sequence[tuple[int, int]] = ()
) -> tuple[list[Corners], list[Array]]:
    """Corners of a board with random deviations, mm, counted after quarter turns; and their true
    grids. Of the last views only columns from .. to are seen, and counted from 0."""
    rng = np.random.default_rng(7)
    off = rng.normal(scale=deviation, size=(board.rows * board.cols, 2))
    corners, truth = [], []
    grid = np.indices((board.rows, board.cols)).reshape(2, -1).T
    shape = (board.rows, board.cols)
    for k, quarters in enumerate(turns):
        pose = scenes.looking(CAMERA, rng, fill=(0.6, 0.8), board=board)
        uv = scenes.imaged(CAMERA, pose, board.points() + off)
        uv += rng.normal(scale=NOISE, size=uv.shape)
        counted, own, relative = grid, grid, False
        rows = board.rows
        for _ in range(quarters):
            counted = np.column_stack([counted[:, 1], rows - 1 - counted[:, 0]])
            rows = board.rows + board.cols - rows
        if k >= len(turns) - len(parts):
            first, last = parts[k - len(turns)]
            seen = (grid[:, 1] >= first) & (grid[:, 1] < last)
            uv, own, relative = uv[seen], grid[seen], True
            counted = own - np.array([0, first - first % 2])
        cov = np.broadcast_to(NOISE**2 * np.eye(2), (len(uv), 2, 2))
        corners.append(
            Corners(
                shape,
                counted,
                uv,
                uv,
                cov,
                ambiguity=checkerboard_ambiguity(shape),
                relative=relative,
            )
        )
        truth.append(own)
    return corners, truth


def placed(board: Board, corners: list[Corners]) -> tuple[list[Array], list[bool]]:
    observations = [Observation(c.uv, board.points(c.grid), c.cov) for c in corners]
    calibration = calibrate(observations, CAMERA.size)
    placings = identified(calibration, corners, board)
    return [p.grid for p in placings], [p.certain for p in placings]


@pytest.mark.parametrize(
    ("board", "turns"),
    [(Board(6, 8, 30.0), [0, 2, 2, 0, 2, 0, 0, 2]), (Board(8, 8, 30.0), [0, 1, 2, 3, 0, 1, 3])],
    ids=["half turns", "quarter turns"],
)
def test_turned_views_are_counted_alike(board: Board, turns: list[int]) -> None:
    corners, _ = views(board, 0.3, turns)
    grids, certain = placed(board, corners)
    assert all(certain)
    for grid in grids:  # the corners are listed alike in all views
        np.testing.assert_array_equal(grid, grids[0])


def test_parts_find_their_place() -> None:
    board = Board(6, 9, 30.0)
    corners, truth = views(board, 0.3, [0] * 8, parts=[(2, 7), (4, 9)])
    grids, certain = placed(board, corners)
    assert all(certain)
    for grid, true in zip(grids, truth, strict=True):
        np.testing.assert_array_equal(grid, true)


def test_on_a_perfect_board_nothing_is_decided() -> None:
    board = Board(6, 8, 30.0)
    corners, _ = views(board, 0.0, [0, 2, 0, 2, 0, 2])
    grids, certain = placed(board, corners)
    assert not any(certain[1:])
    for grid, view in zip(grids, corners, strict=True):
        np.testing.assert_array_equal(grid, view.grid)
