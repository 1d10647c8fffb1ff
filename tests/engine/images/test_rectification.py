"""Rectified images against the rendered board and linear ramps."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.rectification import compute_board_extent, rectify_image
from calibgui.engine.images.rendering import Appearance, compute_irradiance
from tests.engine.scenes import barrel

BOARD = Board(7, 10, 25.0)
POSE = Pose([0.4, -0.3, 0.1], [-110.0, -80.0, 420.0])


def ramps(camera: Camera) -> Array:
    """An image (h, w, 2) float32 whose levels are the pixel's own u and v."""
    return np.stack(np.meshgrid(*map(np.arange, camera.size)), axis=-1).astype(np.float32)


def test_a_rectified_view_is_the_board() -> None:
    camera = barrel()
    view = compute_irradiance(camera, POSE, BOARD, blur=1.0).astype(np.float32)
    result = rectify_image(view, camera, POSE, compute_board_extent(BOARD), 2.0)
    assert result.image.shape == (8 * 50, 11 * 50)
    assert result.valid.all()
    squares = result.image.reshape(8, 50, 11, 50).transpose(0, 2, 1, 3)[..., 10:40, 10:40]
    black = np.indices((8, 11)).sum(axis=0) % 2 == 0
    look = Appearance()
    np.testing.assert_allclose(squares[black], look.black, atol=1)
    np.testing.assert_allclose(squares[~black], look.white, atol=1)


def test_rectified_pixels_show_the_board_points_that_the_matrix_says() -> None:
    camera = barrel()
    result = rectify_image(ramps(camera), camera, POSE, (10.0, -20.0, 110.0, 60.0), 1.5)
    assert result.image.shape == (120, 150, 2)
    xy = np.array([[10.0 + 1 / 3, -20.0 + 1 / 3], [60.0 + 1 / 3, 20.0 + 1 / 3]])
    p = xy @ result.matrix[:2, :2].T + result.matrix[:2, 2]
    np.testing.assert_allclose(p, [[0, 0], [75, 60]], atol=1e-9)
    seen = result.image[np.rint(p[:, 1]).astype(int), np.rint(p[:, 0]).astype(int)]
    np.testing.assert_allclose(seen, project_points(xy, camera, POSE), atol=1 / 64 + 0.006)


def test_what_the_camera_did_not_see_of_the_board_is_not_valid() -> None:
    steep = Pose([0.0, 1.3, 0.0], [0.0, 0.0, 300.0])
    result = rectify_image(ramps(barrel()), barrel(), steep, (-600.0, -100.0, 600.0, 100.0), 0.5)
    X = np.arange(600) / 0.5 - 599
    behind = 300 - X * np.sin(1.3) <= 0
    assert not result.valid[:, behind].any()
    assert result.valid[50, 300]


@pytest.mark.parametrize(
    ("extent", "scale"),
    [((0, 0, 0, 10), 1.0), ((10, 0, 0, 10), 1.0), ((0, 0, 1e3, 1e3), 50.0), ((0, 0, 9, 9), np.nan)],
)
def test_impossible_rectifications_are_refused(
    extent: tuple[float, float, float, float], scale: float
) -> None:
    with pytest.raises(CalibrationError, match="cannot be made"):
        rectify_image(np.zeros((480, 640), np.uint8), barrel(), POSE, extent, scale)
