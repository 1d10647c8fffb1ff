"""Grids of circles half in the sun and half in a shadow, which takes seven eighths of the light."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.detection.circles import ellipse_fit
from calibgui.engine.detection.find_corners import find_corners
from tests.engine.conftest import Scene

_CAMERA = Camera((640, 480), [560.0, 562.0, 322.0, 238.0, 0.1, 0.02, 0.0, 1e-4, 0.0, 0.0])
_PATTERNS: list[tuple[Circles, GridSize]] = [
    (Circles(False, 0.5), (6, 9)),
    (Circles(True, 0.8), (11, 4)),
]


def _cast_shadow(scene: Scene, along: Array, share: float, *, are_bright: bool) -> GreyImage:
    """Photograph a board of whose circles a `share` lies in the shadow, those least far in the
    direction `along` (2,) px of the image."""
    image = scene.image(noise=0.0).astype(np.float64)
    if are_bright:
        image = image.max() + image.min() - image
    across = np.indices(image.shape)[::-1].T @ along
    circles = project_points(scene.board.points(), scene.camera, scene.pose) @ along
    light = np.where(across.T > np.quantile(circles, share), 1.0, 0.125)
    noisy = image * light + np.random.default_rng(0).normal(0, 2.0, image.shape)
    return np.clip(np.rint(noisy), 0, 255).astype(np.uint8)


@pytest.mark.parametrize("are_bright", [False, True])
@pytest.mark.parametrize(("pattern", "grid_size"), _PATTERNS)
def test_a_shadow_over_half_of_the_board(
    pattern: Circles, grid_size: GridSize, are_bright: bool
) -> None:
    """Circles that its edge crosses have other edges than the rest, and are kept."""
    scene = Scene(Board(*grid_size, 20.0, pattern), _CAMERA, rvec=(0.2, 0.2, 0.1))
    image = _cast_shadow(scene, np.array([1.0, 0.6]), 0.55, are_bright=are_bright)
    for size in (grid_size, None):
        corners = find_corners(image, size, pattern=Circles(pattern.asymmetric))
        assert corners.shape == grid_size and corners.cov is not None
        assert len(corners) >= np.prod(grid_size) - 1
        error = scene.error(corners)
        assert np.sqrt(np.mean(error**2)) < 0.1
        chi2 = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2
        assert np.mean(chi2) < 1.5


@pytest.mark.parametrize("are_bright", [False, True])
def test_what_lies_in_the_sun_is_not_taken_for_the_whole(are_bright: bool) -> None:
    scene = Scene(Board(11, 4, 20.0, Circles(True, 0.8)), _CAMERA, rvec=(0.2, 0.1, 0.0))
    image = _cast_shadow(scene, np.array([0.0, 1.0]), 0.15, are_bright=are_bright)
    assert find_corners(image, pattern=Circles(asymmetric=True)).shape == (11, 4)


def test_circles_beside_the_edge_of_a_shadow_are_evenly_lit() -> None:
    """The last row in the sun, seen with the one before in the shadow, looked as if light rose."""
    scene = Scene(Board(9, 5, 20.0, Circles(True, 0.8)), _CAMERA, rvec=(0.2, 0.1, 0.0))
    image = _cast_shadow(scene, np.array([0.0, 1.0]), 0.83, are_bright=False)
    corners = find_corners(image, (9, 5), pattern=Circles(asymmetric=True))
    off = np.linalg.norm(scene.error(corners), axis=1)
    assert off.max() < 0.1


def test_a_disc_with_one_neighbour_for_both_directions_is_fitted() -> None:
    """Where a hand covers what is around, the steps to either side may lead to the same disc."""
    unknowns = np.array([[0.0, 0.0, 0.04, 0.0, 0.04, 1.0, 100.0, -80.0]] * 2)
    unknowns[1, :2] = 40.0, 30.0
    beside = np.full((2, 2, 2), -1)
    beside[0] = [[1, -1], [-1, 1]]
    gradient = ellipse_fit._estimate_gradient(np.array([100.0, 102.0]), unknowns, beside)
    assert np.isfinite(gradient).all()
