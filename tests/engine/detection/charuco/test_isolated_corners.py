"""Corners between few markers, each by itself."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.engine.conftest import Scene

PATTERN = Charuco("DICT_4X4_50", 0.7, False)
_CAMERA = Camera((640, 480), [560.0, 562.0, 322.0, 238.0, 0.1, 0.02, 0.0, 1e-4, 0.0, 0.0])
SCENE = Scene(Board(4, 5, 30.0, PATTERN), _CAMERA, (0.3, -0.2, 0.1), 280.0)


def _show_squares(
    rows: tuple[float, float], cols: tuple[float, float], noise: float = 2.0
) -> GreyImage:
    """Show a part of the board only, from some rows and columns of corners to others."""
    image, shown = SCENE.image(noise=noise), np.full((480, 640), 150, np.uint8)
    v, u = np.indices(image.shape)
    ends = [(rows[0], cols[0]), (rows[0], cols[1]), (rows[1], cols[1]), (rows[1], cols[0])]
    quad = project_points(SCENE.board.points(np.array(ends)), SCENE.camera, SCENE.pose)
    inside = np.ones(image.shape, np.bool_)
    for a, b in zip(quad, np.roll(quad, -1, axis=0), strict=True):
        inside &= (b[0] - a[0]) * (v - a[1]) > (b[1] - a[1]) * (u - a[0])
    shown[inside] = image[inside]
    return shown


@pytest.mark.parametrize("pattern", [PATTERN, Charuco()], ids=["stated", "unstated"])
@pytest.mark.parametrize("is_inverted", [False, True])
@pytest.mark.parametrize("method", ["edges", "saddle"])
def test_one_corner_between_two_markers_is_kept(
    pattern: Charuco, is_inverted: bool, method: str
) -> None:
    image = _show_squares((0.05, 1.95), (1.05, 2.95))
    corners = find_corners(
        255 - image if is_inverted else image, (4, 5), pattern=pattern, method=method
    )
    assert corners.grid.tolist() == [[1, 2]]
    assert np.abs(SCENE.error(corners)).max() < 0.1
    assert corners.shape == (4, 5)
    assert not corners.determine_pose
    with pytest.raises(NoBoardError):  # two markers do not tell how long a row is
        find_corners(image, pattern=pattern)


def test_three_corners_in_a_line() -> None:
    corners = find_corners(_show_squares((0.05, 3.9), (1.05, 2.95)), (4, 5), pattern=Charuco())
    assert corners.grid.tolist() == [[1, 2], [2, 2], [3, 2]][: len(corners)]
    assert len(corners) >= 2
    assert np.abs(SCENE.error(corners)).max() < 0.1


def test_the_covariance_of_a_corner_by_itself_holds() -> None:
    rng, chi2 = np.random.default_rng(1), []
    clean = _show_squares((0.05, 1.95), (1.05, 2.95), noise=0.0)
    for _ in range(16):
        image = np.clip(np.rint(clean + rng.normal(0.0, 3.0, clean.shape)), 0, 255)
        corners = find_corners(image.astype(np.uint8), (4, 5), pattern=PATTERN)
        assert corners.cov is not None
        (error,) = SCENE.error(corners)
        chi2.append(error @ np.linalg.inv(corners.cov[0]) @ error)
    assert 0.5 < np.mean(chi2) / 2 < 1.8  # of 32 residuals


def _draw_disc(image: GreyImage, at: Array, radius: float, level: int) -> GreyImage:
    v, u = np.indices(image.shape)
    return np.where(np.hypot(u - at[0], v - at[1]) < radius, np.uint8(level), image)


@pytest.mark.parametrize(("radius", "level"), [(5.0, 230), (5.0, 30), (12.0, 128)])
def test_what_hides_a_corner_is_none(radius: float, level: int) -> None:
    image = _show_squares((0.05, 1.95), (1.05, 2.95))
    at = project_points(SCENE.board.points(np.array([(1, 2)])), SCENE.camera, SCENE.pose)[0]
    with pytest.raises(NoBoardError):
        find_corners(_draw_disc(image, at, radius, level), (4, 5), pattern=PATTERN)


def test_markers_without_squares_have_no_corners() -> None:
    """Markers on white paper where those of a board would lie."""
    image = SCENE.image()
    grid = np.argwhere(np.ones((6, 7))) - 1
    dark = grid[grid.sum(axis=1) % 2 == 0]
    for row, col in dark.tolist():
        quad = project_points(
            SCENE.board.points(np.array([(row - 0.5, col - 0.5)])), SCENE.camera, SCENE.pose
        )
        image = _draw_disc(image, quad[0], 36.0, 220)
    with pytest.raises(NoBoardError):
        find_corners(image, (4, 5), pattern=PATTERN)
