"""The compiled edge fit against the readable one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from calibgui.engine import kernels
from calibgui.engine.detection.checkerboard import x_corner_fit
from calibgui.engine.detection.find_corners import find_corners
from tests.benchmarks.corner_scenes import Conditions, draw


@pytest.mark.parametrize(
    "scene",
    [
        {},
        {"blur": 0.1},  # the pixel's own box counts
        {"blur": 0.7, "blur_end": 3.0, "light": 1.0},
        {"distortion": 0.5},
        {"ink": 0.05},
        {"ink": -0.05, "blur": 0.2},
        {"square": 30.0, "grid_size": (9, 12), "turn": 20.0},  # leaves the image
    ],
    ids=str,
)
@pytest.mark.parametrize("kind", [np.uint8, np.uint16, np.float32])
def test_compiled_and_readable_find_the_same(
    scene: dict[str, Any], kind: type, monkeypatch: pytest.MonkeyPatch
) -> None:
    usual = {"size": (320, 240), "square": 20.0, "shift": 5.0, "grid_size": (5, 6)}
    image = draw(Conditions(**{**usual, **scene}), 3).photograph(0).astype(kind)
    compiled = find_corners(image)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = find_corners(image)
    assert compiled.shape == readable.shape
    np.testing.assert_array_equal(compiled.grid, readable.grid)
    np.testing.assert_allclose(compiled.uv, readable.uv, atol=2e-5)  # sums in float32
    assert compiled.cov is not None
    assert readable.cov is not None
    scale = np.trace(readable.cov, axis1=1, axis2=2)[:, None, None]
    assert (np.abs(compiled.cov - readable.cov) < 2e-3 * scale).all()
    for quantity in ("residual", "blur", "contrast"):
        pair = getattr(compiled, quantity), getattr(readable, quantity)
        np.testing.assert_allclose(*pair, rtol=1e-3)


def test_the_same_solution_of_the_normal_equations() -> None:
    rng = np.random.default_rng(0)
    J = rng.normal(size=(50, 20, 9)) * 10.0 ** rng.uniform(-2, 2, 9)
    J[0, :, 3] = J[0, :, 4]  # not to be told apart
    N, g = J.transpose(0, 2, 1) @ J, rng.normal(size=(50, 9))
    (step, inverse), expected = x_corner_fit._compiled_solved(N, g), x_corner_fit._solved(N, g)
    np.testing.assert_allclose(step[1:], expected[0][1:], rtol=1e-6)
    np.testing.assert_allclose(inverse, expected[1], rtol=1e-6)
    assert np.isfinite(step).all()
