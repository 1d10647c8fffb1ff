"""A homography through a lens is recovered, with its derivatives; without one none is seen."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.lattices.grid_map import RadialHomography, fit_radial_homography

CELLS = np.argwhere(np.ones((6, 9)))[:, ::-1].astype(np.float64)
H = np.array([[60.0, 5.0, -260.0], [-8.0, 70.0, -190.0], [1e-2, 4e-2, 1.0]])
CENTRE = np.array([330.0, 250.0])


@pytest.mark.parametrize(
    "coefficients", [(-4e-6, 0.0, 0.0), (2e-6, 1e-12, 0.0), (-3e-6, -2e-12, -1e-18)], ids=str
)
def test_a_lens_is_recovered(coefficients: tuple[float, float, float]) -> None:
    true = RadialHomography(H, CENTRE, np.array(coefficients))
    got = fit_radial_homography(CELLS, true.locate(CELLS))
    np.testing.assert_allclose(got.centre, CENTRE, atol=1e-3)
    between = CELLS + 0.5
    np.testing.assert_allclose(got.locate(between), true.locate(between), atol=1e-3)


@pytest.mark.parametrize("coefficients", [(0.0, 0.0, 0.0), (-3e-6, -2e-12, -1e-18)], ids=str)
def test_derivatives_are_those_of_the_positions(coefficients: tuple[float, float, float]) -> None:
    seen = RadialHomography(H, CENTRE, np.array(coefficients))
    first, second = seen.differentiate(CELLS)
    for axis in (0, 1):
        step = 1e-3 * np.eye(2)[axis]
        after, before = seen.locate(CELLS + step), seen.locate(CELLS - step)
        np.testing.assert_allclose(first[:, axis], (after - before) / 2e-3, rtol=1e-5, atol=1e-4)
        curved = (after + before - 2 * seen.locate(CELLS)) / 1e-6
        np.testing.assert_allclose(second[:, axis], curved, rtol=1e-4, atol=1e-3)


def test_a_fisheye_is_followed_where_a_polynomial_is_not() -> None:
    def locate(cells: Array) -> Array:
        """Equidistant, 70 degrees off its axis at the board's corners."""
        ideal = (cells - [4.0, 2.5]) * 0.5 + [0.1, 0.05]
        far = np.linalg.norm(ideal, axis=1, keepdims=True)
        return np.asarray(300.0 * ideal * np.arctan(far) / far)

    between = CELLS[CELLS[:, 0] < 8] + [0.5, 0.0]
    np.testing.assert_allclose(
        fit_radial_homography(CELLS, locate(CELLS)).locate(between), locate(between), atol=0.02
    )


def locate_beyond(cells: Array) -> Array:
    """Positions (n, 2) px of cells seen by an equidistant fisheye, slanted: the first column is up
    to 97 degrees off its axis."""
    board = (cells - [4.0, 2.5]) * 0.55
    rays = np.column_stack([0.5 * board[:, 0] - 1.2, board[:, 1], 0.7 + 0.45 * board[:, 0]])
    across = np.linalg.norm(rays[:, :2], axis=1)
    angle = np.arctan2(across, rays[:, 2])
    return np.asarray(300.0 * rays[:, :2] * (angle / across)[:, None] + CENTRE)


def test_a_board_is_followed_beyond_90_degrees() -> None:
    between = CELLS[CELLS[:, 0] < 8] + [0.5, 0.0]
    seen = fit_radial_homography(CELLS, locate_beyond(CELLS))
    np.testing.assert_allclose(seen.locate(between), locate_beyond(between), atol=0.1)


def test_derivatives_hold_beyond_90_degrees() -> None:
    seen = fit_radial_homography(CELLS, locate_beyond(CELLS))
    first, _ = seen.differentiate(CELLS)
    for axis in (0, 1):
        step = 1e-3 * np.eye(2)[axis]
        slope = (locate_beyond(CELLS + step) - locate_beyond(CELLS - step)) / 2e-3
        np.testing.assert_allclose(first[:, axis], slope, atol=0.3)


def test_no_lens_is_seen_in_noise() -> None:
    plain = RadialHomography(H, np.zeros(2), np.zeros(3)).locate(CELLS)
    noise = np.random.default_rng(0).standard_normal(plain.shape)
    for sigma in (0.0, 0.1, 3.0):
        assert not fit_radial_homography(CELLS, plain + sigma * noise).coefficients.any()
