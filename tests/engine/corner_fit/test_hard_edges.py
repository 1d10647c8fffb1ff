"""Corners of drawings without grey pixels state how far rounding may have moved them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.geometry.homography import apply_homography
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions

Array = NDArray[np.float64]
ROWS, COLS = 6, 9
ROUNDING = 1 / np.sqrt(12)
"""Standard deviation of a place that is rounded to whole pixels, px."""


def draw_two_levels(image_from_board: Array) -> tuple[NDArray[np.uint8], Array]:
    """Draw a board of two levels under a homography; the image and the true corners (n, 2) px."""
    n, m = np.meshgrid(np.arange(COLS), np.arange(ROWS))
    truth = apply_homography(image_from_board, np.column_stack([n.ravel(), m.ravel()]) * 1.0)
    end = apply_homography(image_from_board, np.array([[COLS + 1.0, ROWS + 1.0]]))[0]
    v, u = np.mgrid[: int(end[1]), : int(end[0])]
    pixels = np.column_stack([u.ravel(), v.ravel()]) * 1.0
    x, y = apply_homography(np.linalg.inv(image_from_board), pixels).T.reshape(2, *u.shape)
    is_board = (x > -1) & (x < COLS) & (y > -1) & (y < ROWS)
    is_dark = is_board & ((np.floor(x) + np.floor(y)) % 2 == 0)
    return np.where(is_dark, 0, 255).astype(np.uint8), truth


def measure_chi2(image: NDArray[np.uint8], truth: Array) -> tuple[float, float]:
    """The mean square of the corners' errors over what they state, and what they state, px."""
    corners = find_corners(image)
    assert len(corners) == ROWS * COLS
    assert corners.cov is not None
    nearest = np.linalg.norm(corners.uv[:, None] - truth, axis=2).argmin(axis=1)
    off = corners.uv - truth[nearest]
    chi2 = np.einsum("ni,nij,nj->n", off, np.linalg.inv(corners.cov), off)
    stated = np.sqrt(np.trace(corners.cov, axis1=1, axis2=2).mean() / 2)
    return float(chi2.mean() / 2), float(stated)


@pytest.mark.parametrize("square", [11.3, 20.6, 32.7, 75.4])
def test_squares_along_rows_and_columns_are_rounded(square: float) -> None:
    scale = np.array([[square, 0, 1.8 * square], [0, square, 1.8 * square], [0, 0, 1.0]])
    chi2, stated = measure_chi2(*draw_two_levels(scale))
    assert 0.5 < chi2 < 1.3
    assert stated == pytest.approx(ROUNDING, rel=0.2)


def test_edges_that_lean_tell_more() -> None:
    seen = np.array([[39.0, -4.0, 120.0], [5.0, 40.0, 90.0], [4e-3, 3e-3, 1.0]])
    chi2, stated = measure_chi2(*draw_two_levels(seen))
    assert chi2 < 1.3
    assert stated < ROUNDING / 3


def test_a_sharp_photograph_states_what_its_noise_allows() -> None:
    photograph = draw(Conditions(blur=0.3, turn=0.0, tilt=0.0, parts=1), 3).photograph(3)
    corners = find_corners(photograph)
    assert corners.cov is not None
    assert np.sqrt(corners.cov.max()) < 0.1
