"""Corners searched again with a known camera, on rendered boards that are partly hidden."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.corners import Corners
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.rendering import render_view
from calibgui.engine.redetection.redetect_corners import are_edges_bent, redetect_corners
from tests.engine import scenes

BOARD = Board(rows=6, cols=9, square=30.0)
SHAPE = (6, 9)
CAMERA = scenes.barrel(focal=420.0, size=(400, 300))
POSE = scenes.looking(CAMERA, np.random.default_rng(3), fill=(0.8, 0.8), board=BOARD)
UV = scenes.imaged(CAMERA, POSE, BOARD.points()).reshape(*SHAPE, 2)
"""(rows, cols, 2) true corners."""

Image = NDArray[np.uint8]


@pytest.fixture(scope="module")
def calibration() -> Calibration:
    rng = np.random.default_rng(0)
    poses = [scenes.looking(CAMERA, rng, fill=(0.5, 0.8), board=BOARD) for _ in range(8)]
    views = scenes.seen(CAMERA, poses, BOARD).noisy(0.02, rng)
    cov = np.broadcast_to(0.02**2 * np.eye(2), (len(views[0].uv), 2, 2))
    return calibrate([Observation(view.uv, view.xy, cov) for view in views], CAMERA.size)


def photograph(pose: Pose = POSE, board: Board = BOARD) -> Image:
    return render_view(CAMERA, pose, board, blur=0.7, noise=2.0, seed=1)


def covered(image: Image, *hidden: Any) -> Image:
    """The image with grey discs over some of the corners, given by their places."""
    image = image.copy()
    v, u = np.indices(image.shape)
    for place in hidden:
        for at in UV[place].reshape(-1, 2):
            image[np.hypot(u - at[0], v - at[1]) < 9] = 120
    return image


def truth_of(corners: Corners) -> Array:
    return np.asarray(UV[corners.grid[:, 0], corners.grid[:, 1]])


def test_fragments_become_a_board(calibration: Calibration) -> None:
    image = covered(photograph(), np.s_[:, 2], np.s_[:, 5], np.s_[2], np.s_[5])
    with pytest.raises(NoBoardError):
        find_corners(image, SHAPE)
    corners = redetect_corners(image, calibration, SHAPE)
    assert len(corners) >= 12
    np.testing.assert_allclose(corners.uv, truth_of(corners), atol=0.1)
    assert not corners.relative


def test_missed_corners_are_found(calibration: Calibration) -> None:
    image = photograph()
    whole = find_corners(image, SHAPE)
    few = Corners(SHAPE, whole.grid[:14], whole.uv[:14], whole.estimate[:14], whole.cov[:14])  # type: ignore[index]
    corners = redetect_corners(image, calibration, SHAPE, few)
    assert corners.complete
    np.testing.assert_allclose(corners.uv, UV.reshape(-1, 2), atol=0.05)
    assert corners.cov is not None


def test_what_is_hidden_is_not_found(calibration: Calibration) -> None:
    hidden = np.s_[1:4, 3:6]
    corners = redetect_corners(covered(photograph(), hidden), calibration, SHAPE)
    seen = {tuple(place) for place in corners.grid.tolist()}
    assert not seen & {(m, n) for m in range(1, 4) for n in range(3, 6)}
    assert len(seen) >= 40
    np.testing.assert_allclose(corners.uv, truth_of(corners), atol=0.1)


def test_a_corner_far_off_is_left_out(calibration: Calibration) -> None:
    image = photograph()
    whole = find_corners(image, SHAPE)
    uv = whole.uv.copy()
    uv[20] += 4.0
    hidden = covered(image, np.s_[2, 2])
    corners = redetect_corners(hidden, calibration, SHAPE, replace(whole, uv=uv))
    assert [2, 2] not in corners.grid.tolist()
    np.testing.assert_allclose(corners.uv, truth_of(corners), atol=0.1)


def test_part_of_a_board_gets_its_place(calibration: Calibration) -> None:
    image = photograph()
    whole = find_corners(image, SHAPE)
    part = whole.grid[:, 1] < 5
    grid = whole.grid[part] + np.array([0, 2])
    shifted = Corners(
        SHAPE,
        grid,
        whole.uv[part],
        whole.estimate[part],
        whole.cov[part],
        relative=True,  # type: ignore[index]
    )
    corners = redetect_corners(image, calibration, SHAPE, shifted)
    assert corners.complete
    assert not corners.relative
    np.testing.assert_allclose(corners.uv, UV.reshape(-1, 2), atol=0.05)


@pytest.mark.parametrize("kind", ["noise", "nothing", "a larger board"])
def test_what_is_not_the_board_is_refused(calibration: Calibration, kind: str) -> None:
    rng = np.random.default_rng(4)
    images: dict[str, Any] = {
        "noise": lambda: rng.integers(0, 255, (300, 400)).astype(np.uint8),
        "nothing": lambda: np.full((300, 400), 90, dtype=np.uint8),
        "a larger board": lambda: photograph(board=Board(7, 9, 25.0)),
    }
    with pytest.raises(NoBoardError) as caught:
        redetect_corners(images[kind](), calibration, SHAPE)
    assert caught.value.hint


WIDE = Camera((480, 360), [120.0, 120, 238, 181, 0.02, -0.01, 0, 0], "kannala-brandt")
"""A lens of 150 degrees."""


def calibrate_wide_lens(model: str) -> tuple[Calibration, Pose]:
    """The wide lens calibrated with a model, and one of the poses, which nearly fills the image."""
    rng = np.random.default_rng(4)
    poses = [scenes.looking(WIDE, rng, fill=(0.7, 0.95), board=BOARD) for _ in range(8)]
    views = scenes.seen(WIDE, poses, BOARD).noisy(0.02, rng)
    cov = np.broadcast_to(0.02**2 * np.eye(2), (len(views[0].uv), 2, 2))
    seen = [Observation(view.uv, view.xy, cov) for view in views]
    return calibrate(seen, WIDE.size, model=model), poses[1]


def list_places(corners: Corners) -> set[tuple[int, int]]:
    return {(row, col) for row, col in corners.grid.tolist()}


def test_a_lens_in_doubt_costs_no_corner() -> None:
    """Brown's four coefficients miss the outer corners of a wide lens by many pixels."""
    wrong, pose = calibrate_wide_lens("brown-conrady-4")
    assert wrong.lens_error > 1
    image = render_view(WIDE, pose, BOARD, blur=0.7, noise=2.0, seed=1)
    before = find_corners(image, SHAPE)
    after = redetect_corners(image, wrong, SHAPE, before)
    assert list_places(after) >= list_places(before)
    shift = [
        np.linalg.norm(after.uv[i] - before.uv[k])
        for i, place in enumerate(after.grid.tolist())
        for k in np.flatnonzero((before.grid == place).all(axis=1))
    ]
    assert max(shift) < 0.02
    # Believed in, that camera removes a corner.
    believed = replace(wrong, lens_error=0.0, board_shape_error=0.0)
    kept = redetect_corners(image, believed, SHAPE, before)
    assert list_places(before) - list_places(kept)


@pytest.mark.parametrize("seed", [1, 2])
def test_a_hidden_corner_goes_or_is_unsure_although_the_lens_is_in_doubt(seed: int) -> None:
    wrong, pose = calibrate_wide_lens("brown-conrady-4")
    image = render_view(WIDE, pose, BOARD, blur=0.7, noise=2.0, seed=seed)
    before = find_corners(image, SHAPE)
    hidden = len(before) // 2
    v, u = np.indices(image.shape)
    off = np.hypot(u - before.uv[hidden, 0], v - before.uv[hidden, 1])
    image[off < 8] = 120
    after = redetect_corners(image, wrong, SHAPE, before)
    lost = np.array(sorted(list_places(before) - list_places(after))).reshape(-1, 2)
    away = np.abs(lost - before.grid[hidden]).max(axis=1)
    assert max(away, default=0) <= 1  # the disc hides ends of the neighbours' edges
    # The far ends of its edges may still place it, roughly.
    kept = (after.grid == before.grid[hidden]).all(axis=1)
    assert kept.any() or 0 in away
    assert (np.sqrt(np.trace(after.cov[kept], axis1=1, axis2=2)) > 0.5).all()


def test_the_camera_places_few_corners_of_bent_edges_better(calibration: Calibration) -> None:
    board = Board(rows=3, cols=4, square=60.0)
    pose = scenes.looking(CAMERA, np.random.default_rng(2), fill=(0.6, 0.6), board=board)
    truth = scenes.imaged(CAMERA, pose, board.points())
    image = render_view(CAMERA, pose, board, blur=0.7, noise=1.0, seed=1)
    first = find_corners(image, (3, 4))
    assert are_edges_bent(first, calibration, pose, board)
    second = redetect_corners(image, calibration, (3, 4), replace(first, uv=first.uv + 0.03))
    np.testing.assert_allclose(second.uv, truth, atol=0.01)
    straight = replace(calibration, camera=replace(CAMERA, params=[*CAMERA.params[:4], *[0.0] * 6]))
    assert not are_edges_bent(first, straight, pose, board)
    assert not are_edges_bent(first, replace(calibration, lens_error=1.0), pose, board)
    assert not are_edges_bent(first, replace(calibration, model_error=0.1), pose, board)
