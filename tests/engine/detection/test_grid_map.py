"""Perspectives through lenses are recovered, with their derivatives, and not seen where none is."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.detection.grid_map import Perspective, fit_perspective

CELLS = np.argwhere(np.ones((6, 9)))[:, ::-1].astype(np.float64)
H = np.array([[60.0, 5.0, -260.0], [-8.0, 70.0, -190.0], [1e-2, 4e-2, 1.0]])
CENTRE = np.array([330.0, 250.0])


@pytest.mark.parametrize(
    "bend", [(-4e-6, 0.0, 0.0), (2e-6, 1e-12, 0.0), (-3e-6, -2e-12, -1e-18)], ids=str
)
def test_a_lens_is_recovered(bend: tuple[float, float, float]) -> None:
    true = Perspective(H, CENTRE, np.array(bend))
    got = fit_perspective(CELLS, true.at(CELLS))
    np.testing.assert_allclose(got.centre, CENTRE, atol=1e-3)
    between = CELLS + 0.5
    np.testing.assert_allclose(got.at(between), true.at(between), atol=1e-3)


@pytest.mark.parametrize("bend", [(0.0, 0.0, 0.0), (-3e-6, -2e-12, -1e-18)], ids=str)
def test_derivatives_are_those_of_the_positions(bend: tuple[float, float, float]) -> None:
    seen = Perspective(H, CENTRE, np.array(bend))
    first, second = seen.derivatives(CELLS)
    for axis in (0, 1):
        step = 1e-3 * np.eye(2)[axis]
        after, before = seen.at(CELLS + step), seen.at(CELLS - step)
        np.testing.assert_allclose(first[:, axis], (after - before) / 2e-3, rtol=1e-5, atol=1e-4)
        curved = (after + before - 2 * seen.at(CELLS)) / 1e-6
        np.testing.assert_allclose(second[:, axis], curved, rtol=1e-4, atol=1e-3)


def test_a_fisheye_is_followed_where_a_polynomial_is_not() -> None:
    def at(cells: Array) -> Array:
        """Equidistant, 70 degrees off its axis at the board's corners."""
        ideal = (cells - [4.0, 2.5]) * 0.5 + [0.1, 0.05]
        far = np.linalg.norm(ideal, axis=1, keepdims=True)
        return np.asarray(300.0 * ideal * np.arctan(far) / far)

    between = CELLS[CELLS[:, 0] < 8] + [0.5, 0.0]
    np.testing.assert_allclose(
        fit_perspective(CELLS, at(CELLS)).at(between), at(between), atol=0.02
    )


def test_no_lens_is_seen_in_noise() -> None:
    plain = Perspective(H, np.zeros(2), np.zeros(3)).at(CELLS)
    noise = np.random.default_rng(0).standard_normal(plain.shape)
    for sigma in (0.0, 0.1, 3.0):
        assert not fit_perspective(CELLS, plain + sigma * noise).bend.any()
