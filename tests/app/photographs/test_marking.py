"""Corners put right by hand, on rendered views whose corners are known exactly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.app.photographs import marking
from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.camera.camera import Camera
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import CalibrationError, NoBoardError
from calibgui.engine.features.corners import Corners
from calibgui.engine.images.rendering import render_view
from tests.engine import scenes

BOARD = Board(6, 7, 30.0)
CAMERA = Camera((320, 240), [320.0, 322.0, 157.0, 121.0, 0.1, 0.02, 0.0, 0.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def image() -> Array:
    pose = scenes.looking(CAMERA, np.random.default_rng(5), fill=(0.6, 0.61), board=BOARD)
    return render_view(CAMERA, pose, BOARD, blur=0.8, noise=1.0, seed=1)


@pytest.fixture(scope="module")
def corners(image: Array) -> Corners:
    return find_corners(image, (6, 7))


def outermost(corners: Corners) -> Array:
    places = {tuple(place): k for k, place in enumerate(corners.grid.tolist())}
    rows, cols = corners.shape[0] - 1, corners.shape[1] - 1
    return corners.uv[[places[p] for p in ((0, 0), (0, cols), (rows, cols), (rows, 0))]]


def test_a_click_snaps_to_the_nearest_corner(image: Array, corners: Corners) -> None:
    at = marking.find_nearest_corner(image, corners.uv[10] + [3.0, -2.0], reach=8.0)
    assert at is not None
    assert np.linalg.norm(at - corners.uv[10]) < 0.1
    middle = corners.uv[[0, 1, 7, 8]].mean(axis=0)
    assert marking.find_nearest_corner(image, middle, reach=3.0) is None
    assert marking.find_nearest_corner(image, np.array([-50.0, 20.0]), reach=3.0) is None


def test_four_clicks_count_the_board(image: Array, corners: Corners) -> None:
    rng = np.random.default_rng(0)
    found = marking.mark_board(image, outermost(corners) + rng.uniform(-2, 2, (4, 2)), None, None)
    assert found.shape == (6, 7)
    assert found.complete
    np.testing.assert_allclose(found.uv, corners.uv, atol=0.02)
    with pytest.raises(CalibrationError, match="do not go around"):
        marking.mark_board(image, outermost(corners)[[0, 2, 1, 3]], None, None)


def test_the_projected_grid_has_its_ends_at_the_clicks(corners: Corners) -> None:
    points = outermost(corners)
    grid = marking.project_marked_board(points, corners.shape)
    assert grid.shape == (6, 7, 2)
    np.testing.assert_allclose(grid[[0, 0, -1, -1], [0, -1, -1, 0]], points, atol=1e-9)
    np.testing.assert_allclose(grid.reshape(-1, 2), corners.uv, atol=3)


def test_a_removed_corner_is_found_again_in_its_place(image: Array, corners: Corners) -> None:
    less = marking.remove_corners(corners, 16)
    assert len(less) == 41
    grid, expected = marking.find_missing_corners(less)
    assert grid.tolist() == [corners.grid[16].tolist()]
    assert np.linalg.norm(expected[0] - corners.uv[16]) < 1
    again = marking.restore_corner(image, less, grid[0])
    assert again.complete
    assert again.grid[-1].tolist() == corners.grid[16].tolist()
    assert np.linalg.norm(again.uv[-1] - corners.uv[16]) < 0.1
    assert all(
        len(getattr(again, name)) == 42
        for name in ("estimate", "cov", "blur", "contrast", "residual")
        if getattr(again, name) is not None
    )
    blank = np.full_like(image, 128)
    with pytest.raises(NoBoardError, match="row 2, column 2"):
        marking.restore_corner(blank, less, grid[0])


def test_a_corner_is_restored_beside_one_out_of_place(image: Array, corners: Corners) -> None:
    for k in range(16, 24):
        wrong = marking.move_corner(corners, k + 1, corners.uv[k + 1] + [15.0, 12.0])
        again = marking.restore_corner(image, marking.remove_corners(wrong, k), corners.grid[k])
        assert np.linalg.norm(again.uv[-1] - corners.uv[k]) < 0.1


def test_a_moved_corner_leaves_the_others(corners: Corners) -> None:
    other = marking.move_corner(corners, 3, np.array([1.0, 2.0]))
    assert other.uv[3].tolist() == [1.0, 2.0]
    np.testing.assert_array_equal(np.delete(other.uv, 3, 0), np.delete(corners.uv, 3, 0))


def test_four_quarter_turns_and_two_flips_change_nothing(corners: Corners) -> None:
    turned = corners
    shapes = []
    for _ in range(4):
        turned = marking.turn_board(turned)
        shapes.append(turned.shape)
    assert shapes == [(7, 6), (6, 7), (7, 6), (6, 7)]
    np.testing.assert_array_equal(turned.grid, corners.grid)
    flipped = marking.flip_board(corners)
    assert not np.array_equal(flipped.grid, corners.grid)
    np.testing.assert_array_equal(marking.flip_board(flipped).grid, corners.grid)


def test_a_turn_keeps_the_numbering_right_handed(corners: Corners) -> None:
    def handedness(some: Corners) -> float:
        fit, *_ = np.linalg.lstsq(
            np.column_stack([some.grid, np.ones(len(some))]), some.uv, rcond=None
        )
        return float(np.sign(np.linalg.det(fit[:2])))

    assert handedness(marking.turn_board(corners)) == handedness(corners)
    assert handedness(marking.flip_board(corners)) == -handedness(corners)


def test_without_any_missing_there_is_nothing_to_restore(corners: Corners) -> None:
    grid, expected = marking.find_missing_corners(replace(corners))
    assert len(grid) == len(expected) == 0


def test_only_a_checkerboard_is_counted_anew() -> None:
    grid = np.indices((3, 4)).reshape(2, -1).T
    uv = 20.0 * grid[:, ::-1] + 10.0
    circles = Corners((3, 4), grid, uv, uv, pattern=Circles())
    image = np.zeros((90, 100), np.uint8)
    for change in (
        marking.turn_board,
        marking.flip_board,
        lambda corners: marking.restore_corner(image, corners, grid[0]),
    ):
        with pytest.raises(CalibrationError, match="Only the corners of a checkerboard"):
            change(circles)
