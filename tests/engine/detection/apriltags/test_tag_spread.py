"""Corners of tags without small squares where grey levels are no measure of the light."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.images.rendering import compute_irradiance
from tests.engine.conftest import Scene

LENS = Camera((480, 360), [420.0, 420.0, 240.0, 180.0, 0.1, 0.02, 0.0, 0.0, 0.0, 0.0])
BARE = Scene(
    Board(6, 8, 20.0, AprilGrid("t36h11", 0.3, 2, False, False)),
    camera=LENS,
    rvec=(0.3, -0.2, 0.3),
    distance=190.0,
)


def read(levels: Array) -> tuple[Array, Array]:
    """Locate the corners of `BARE` in levels to which noise is added; their errors (n, 2) px, and
    these in standard deviations (n,)."""
    noisy = levels + 1.5 * np.random.default_rng(3).standard_normal(levels.shape)
    image: GreyImage = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
    corners = find_corners(image, pattern=AprilGrid())
    assert len(corners) >= 44 and corners.cov is not None
    error = BARE.error(corners)
    square = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error)
    return error, np.sqrt(square)


@pytest.fixture(scope="module")
def light() -> Array:
    return compute_irradiance(BARE.camera, BARE.pose, BARE.board, blur=0.8)


def test_a_grey_curve_does_not_shrink_tags(light: Array) -> None:
    """All of their outlines lie 0.2 px within them."""
    error, sigmas = read(255 * (light / 255) ** (1 / 2.2))
    assert np.linalg.norm(error, axis=1).max() < 0.1
    assert sigmas.max() < 4


def test_sharpening_does_not_enlarge_tags(light: Array) -> None:
    sharp = light + 1.2 * (light - cv2.GaussianBlur(light, (0, 0), 1.5))
    error, sigmas = read(np.clip(sharp, 0, 255))
    assert np.linalg.norm(error, axis=1).max() < 0.1
    assert sigmas.max() < 5


def test_a_lens_out_of_focus_makes_no_corner_too_sure(light: Array) -> None:
    """Its blur is a disc: what it enlarges tags by is told to a half only. chi2 was 2.7."""
    y, x = np.mgrid[-4:5, -4:5]
    disc = np.clip(4 - np.hypot(x, y), 0, 1)
    _, sigmas = read(cv2.filter2D(light, -1, disc / disc.sum(), borderType=cv2.BORDER_REPLICATE))
    assert np.mean(sigmas**2) / 2 < 1.5


def test_glare_that_clips_the_paper_misleads_no_corners(light: Array) -> None:
    """Some edges are drawn by up to a pixel into the ink."""
    v, u = np.indices(light.shape)
    lamp = 200 * np.exp(-((u - 280.0) ** 2 + (v - 200.0) ** 2) / 2 / 40.0**2)
    error, sigmas = read(light + lamp)
    is_wrong = (np.linalg.norm(error, axis=1) > 0.3) & (sigmas > 5)
    assert not is_wrong.any()
