"""The compiled lens of a grid map against the readable one."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.detection import grid_map

X = np.argwhere(np.ones((6, 9)))[:, ::-1] / 3.0 - [1.3, 0.8]
A = np.array([[1.0, 0.1, 0.05], [-0.05, 0.9, 0.1], [0.02, -0.03, 1.0]])
CENTRE = np.array([0.1, -0.2])


@pytest.mark.parametrize(
    "bend", [(-0.05, 0.0, 0.0), (-0.08, 0.01, -0.001), (0.03, 0.0, 0.0)], ids=str
)
def test_the_same_lens_is_refined(bend: tuple[float, float, float]) -> None:
    seen = grid_map.InverseRadialHomography(A, CENTRE, np.array(bend)).invert(CENTRE[None])
    u = seen.locate(X) + 1e-3 * np.random.default_rng(0).standard_normal(X.shape)
    start = np.array([0.9 * bend[0], 0.0, 0.0])
    results = [
        grid_map.InverseRadialHomography(*refine(X, u, A, CENTRE + 0.05, start, 3, 1e-13))
        for refine in (grid_map._refine_parameters.kernel, grid_map._refine_parameters.reference)
    ]
    ours, truth = (result.invert(u).locate(X) for result in results)
    np.testing.assert_allclose(ours, truth, atol=1e-9)
    assert np.abs(truth - u).max() < 0.01


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
