"""Outliers are named and left out, and what is left gives the clean result."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.residuals.outliers import screen_outliers
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.scenes import VGA, barrel, scene

CAMERA = Camera((640, 480), [657, 655, 305, 243, 0.25, 0.06, -0.05, 1e-4, 3e-4, 0])
BOARD = Board(9, 12, 25.0)
POINTS = BOARD.points()


def clean(count: int, seed: int, noise: float = 0.1) -> list[Observation]:
    """Views of the whole board with Gaussian noise, px."""
    rng = np.random.default_rng(seed)
    views: list[Observation] = []
    while len(views) < count:
        R = rotation_from_vector(rng.uniform(-0.6, 0.6, 3))
        T = np.array([rng.uniform(-60, 60), rng.uniform(-40, 40), rng.uniform(450, 650)])
        point = POINTS @ R[:, :2].T + T - R[:, :2] @ POINTS.mean(axis=0)
        uv = pixels_from_rays(point, CAMERA)
        if ((uv > 0) & (uv < CAMERA.size)).all():
            views.append(Observation(uv + rng.normal(0, noise, uv.shape), POINTS))
    return views


def displaced(views: list[Observation], share: float, seed: int) -> tuple[list[Observation], Array]:
    """The views with a share of all corners moved by 3 to 50 px, and which (K, n) those are."""
    rng = np.random.default_rng(seed)
    moved = rng.random((len(views), len(POINTS))) < share
    spoilt = []
    for view, bad in zip(views, moved, strict=True):
        direction = rng.uniform(0, 2 * np.pi, len(POINTS))
        length = bad * rng.uniform(3, 50, len(POINTS))
        shift = length[:, None] * np.stack([np.cos(direction), np.sin(direction)], axis=1)
        spoilt.append(Observation(view.uv + shift, view.xy))
    return spoilt, moved


@pytest.mark.parametrize("seed", range(5))
def test_five_percent_of_displaced_corners_change_nothing(seed: int) -> None:
    views = clean(12, seed)
    spoilt, moved = displaced(views, 0.05, seed)
    truth, screening = calibrate(views, CAMERA.size), screen_outliers(spoilt, CAMERA.size)
    found = ~np.array(screening.kept)
    assert (found | ~moved).all()  # every displaced corner
    assert (found & ~moved).sum() <= 3  # hardly another
    z = (screening.calibration.camera.params - truth.camera.params)[:9] / truth.sigma[:9]
    assert np.abs(z).max() < 2
    for rejected in screening.rejected:
        assert not rejected.is_whole_view
        np.testing.assert_array_equal(rejected.corners, np.flatnonzero(found[rejected.view]))


@pytest.mark.parametrize("fault", ["mirrored", "misnumbered"])
def test_two_spoilt_views_are_named_and_left_out(fault: str) -> None:
    views = clean(12, 7)
    truth = calibrate(views, CAMERA.size)
    grid = np.arange(len(POINTS)).reshape(BOARD.rows, BOARD.cols)
    order = grid[:, ::-1].ravel() if fault == "mirrored" else grid.T.ravel()
    for k in (2, 9):
        views[k] = Observation(views[k].uv[order], POINTS)
    screening = screen_outliers(views, CAMERA.size)
    assert [(r.view, r.is_whole_view) for r in screening.rejected] == [(2, True), (9, True)]
    assert fault in screening.rejected[0].reason
    assert len(screening.calibration.poses) == 10
    z = (screening.calibration.camera.params - truth.camera.params)[:9] / truth.sigma[:9]
    assert np.abs(z).max() < 2


def test_a_turned_board_is_a_good_view() -> None:
    views = clean(8, 3)
    truth = calibrate(views, CAMERA.size)
    turned = [Observation(v.uv[::-1], v.xy) if k < 2 else v for k, v in enumerate(views)]
    screening = screen_outliers(turned, CAMERA.size)
    assert not screening.rejected
    apart = np.abs(screening.calibration.camera.params - truth.camera.params)
    assert (apart <= 1e-4 * truth.sigma).all()


def test_clean_data_lose_next_to_nothing() -> None:
    lost = sum(
        sum(len(r.corners) for r in screen_outliers(clean(10, seed), CAMERA.size).rejected)
        for seed in range(5)
    )
    assert lost <= 2  # 5 x 1080 corners, one in fifty thousand expected


def test_perfect_data_lose_nothing() -> None:
    assert not screen_outliers(clean(6, 1, noise=0.0), CAMERA.size).rejected


def test_good_views_come_back_once_those_that_draw_the_camera_are_left_out() -> None:
    """Beside two that were cropped and stretched a third loses most of its corners at first."""
    rng, middle = np.random.default_rng(6), np.array([320.0, 240.0])
    views = scene(barrel(), 10, seed=6).noisy(0.05, rng)
    for k in range(2):
        uv = middle + np.array([1.2, 1.1]) * (views[k].uv - middle) + [10, -15]
        views[k] = Observation(uv, views[k].xy)
    screening = screen_outliers(views, VGA)
    assert [rejected.view for rejected in screening.rejected] == [0, 1]
