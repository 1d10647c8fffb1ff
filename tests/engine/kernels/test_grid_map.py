"""The compiled map of a grid, homography and radial lens, against the readable one."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.lattices import grid_map
from calibgui.engine.lattices.grid_map import RadialHomography

CELLS = np.argwhere(np.ones((6, 9)))[:, ::-1].astype(np.float64)
H = np.array([[52.0, 3.0, -210.0], [-4.0, 50.0, -130.0], [0.002, -0.012, 1.0]])
CENTRE = np.array([320.0, 240.0])
LENSES = [(0.0, 0.0, 0.0), (-2e-6, 0.0, 0.0), (-3e-6, 1e-11, -2e-17), (1.5e-6, 0.0, 0.0)]


@pytest.mark.parametrize("steps", [3, 0])
@pytest.mark.parametrize("bend", LENSES, ids=str)
@pytest.mark.parametrize("most", [400, 30])
def test_the_same_map_is_fitted(bend: tuple[float, ...], steps: int, most: int) -> None:
    seen = RadialHomography(H, CENTRE, np.array(bend))
    uv = seen.locate(CELLS) + 0.02 * np.random.default_rng(0).standard_normal(CELLS.shape)
    ours, truth = (
        RadialHomography(*fit(CELLS, uv, 16, 0.005, 0.5, most, steps, 5, 1e-13))
        for fit in (grid_map._fit_map.kernel, grid_map._fit_map.reference)
    )
    assert truth.coefficients.any() == any(bend)
    np.testing.assert_allclose(ours.locate(CELLS), truth.locate(CELLS), atol=1e-7)
    np.testing.assert_allclose(ours.centre, truth.centre, atol=1e-4)
    np.testing.assert_allclose(np.sign(ours.H[2, 2]), np.sign(truth.H[2, 2]))
    assert np.abs(truth.locate(CELLS) - uv).max() < (0.2 if steps else 5)


def test_no_lens_is_fitted_to_few_points() -> None:
    uv = RadialHomography(H, CENTRE, np.array(LENSES[1])).locate(CELLS)
    for fit in (grid_map._fit_map.kernel, grid_map._fit_map.reference):
        assert not fit(CELLS, uv, len(uv) + 1, 0.005, 0.5, 400, 3, 5, 1e-13)[2].any()


@pytest.mark.parametrize("bend", LENSES, ids=str)
def test_the_same_places_and_derivatives(bend: tuple[float, ...]) -> None:
    coefficients = np.array(bend)
    ours, truth = (
        locate(H, CENTRE, coefficients, CELLS, 5)
        for locate in (grid_map._locate_cells.kernel, grid_map._locate_cells.reference)
    )
    np.testing.assert_allclose(ours, truth, rtol=1e-12)
    compiled, readable = (
        differentiate(H, coefficients, CELLS, 5)
        for differentiate in (
            grid_map._differentiate_map.kernel,
            grid_map._differentiate_map.reference,
        )
    )
    for one, other in zip(compiled, readable, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-11)


def test_the_same_lens_is_inverted() -> None:
    rng = np.random.default_rng(0)
    e, w = rng.uniform(-1, 1, (50, 2)), rng.uniform(-0.3, 1, 50)
    e[0] = 0.0
    w[0] = 1.0
    for bend in ((-0.2, 0.01, 0.0), (0.1, 0.0, 0.0), (0.0, 0.0, 0.0)):
        ours, truth = (
            invert(e, w, np.array(bend), 5)
            for invert in (grid_map._invert_lens.kernel, grid_map._invert_lens.reference)
        )
        np.testing.assert_allclose(ours, truth, rtol=1e-12, atol=1e-12)
