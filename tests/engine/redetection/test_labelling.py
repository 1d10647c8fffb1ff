"""Views of a board that deviates from its drawing, numbered from different corners."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.arrays import Array, freeze_ints
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.checkerboard import checkerboard_symmetry
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.features.corners import Corners
from calibgui.engine.redetection.labelling import (
    CornerLabels,
    apply_labels,
    carry_labels,
    has_open_labels,
    label_corners,
)
from tests.engine import scenes

CAMERA = scenes.barrel()
NOISE = 0.05


def views(
    board: Board, deviation: float, turns: Sequence[int], parts: Sequence[tuple[int, int]] = ()
) -> tuple[list[Corners], list[Array]]:
    """Corners of a board with random deviations, mm, numbered after quarter turns, and their true
    grids. The last views show only columns from .. to, numbered from 0."""
    rng = np.random.default_rng(7)
    off = rng.normal(scale=deviation, size=(board.rows * board.cols, 2))
    corners, truth = [], []
    grid = np.indices((board.rows, board.cols)).reshape(2, -1).T
    shape = (board.rows, board.cols)
    for k, quarters in enumerate(turns):
        pose = scenes.looking(CAMERA, rng, fill=(0.6, 0.8), board=board)
        uv = scenes.imaged(CAMERA, pose, board.points() + off)
        uv += rng.normal(scale=NOISE, size=uv.shape)
        numbered, own, relative = grid, grid, False
        rows = board.rows
        for _ in range(quarters):
            numbered = np.column_stack([numbered[:, 1], rows - 1 - numbered[:, 0]])
            rows = board.rows + board.cols - rows
        if k >= len(turns) - len(parts):
            first, last = parts[k - len(turns)]
            seen = (grid[:, 1] >= first) & (grid[:, 1] < last)
            uv, own, relative = uv[seen], grid[seen], True
            numbered = own - np.array([0, first - first % 2])
        cov = np.broadcast_to(NOISE**2 * np.eye(2), (len(uv), 2, 2))
        corners.append(
            Corners(
                shape,
                numbered,
                uv,
                uv,
                cov,
                ambiguity=checkerboard_symmetry(shape),
                relative=relative,
            )
        )
        truth.append(own)
    return corners, truth


def placed(board: Board, corners: list[Corners]) -> tuple[list[Array], list[bool]]:
    observations = [Observation(c.uv, board.points(c.grid), c.cov) for c in corners]
    calibration = calibrate(observations, CAMERA.size)
    placings = label_corners(calibration, corners, board)
    return [p.grid for p in placings], [p.is_certain for p in placings]


@pytest.mark.parametrize(
    ("board", "turns"),
    [(Board(6, 8, 30.0), [0, 2, 2, 0, 2, 0, 0, 2]), (Board(8, 8, 30.0), [0, 1, 2, 3, 0, 1, 3])],
    ids=["half turns", "quarter turns"],
)
def test_turned_views_are_labelled_alike(board: Board, turns: list[int]) -> None:
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


def test_labels_are_applied_where_they_were_open_and_are_certain() -> None:
    board = Board(6, 8, 30.0)
    corners, _ = views(board, 0.0, [0, 2])
    assert has_open_labels(corners[0])
    turned = CornerLabels(freeze_ints(corners[1].grid), is_certain=True)
    labelled = apply_labels(corners[0], turned)
    np.testing.assert_array_equal(labelled.grid, corners[1].grid)
    assert not has_open_labels(labelled)
    assert apply_labels(corners[0], turned._replace(is_certain=False)) is corners[0]
    assert apply_labels(labelled, turned) is labelled


def test_labels_are_carried_to_corners_that_were_left_out() -> None:
    board = Board(6, 8, 30.0)
    (whole, turned), _ = views(board, 0.0, [0, 2])
    kept = np.arange(10, 30)
    before = replace(whole, grid=whole.grid[kept], uv=whole.uv[kept], cov=None)
    after = replace(before, grid=turned.grid[kept], ambiguity=Symmetry.NONE)
    carried = carry_labels(whole, before, after)
    np.testing.assert_array_equal(carried.grid, turned.grid)
    assert carried.ambiguity is Symmetry.NONE
