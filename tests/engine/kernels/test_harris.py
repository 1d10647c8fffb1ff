"""The compiled score of Harris against the readable one."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine import kernels
from calibgui.engine.features import harris


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_the_same_scores_also_at_the_border(dtype: type, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(3)
    image = rng.uniform(0, 255, (60, 80)).astype(dtype)
    uv = rng.uniform(-2, (82, 62), (100, 2))
    weights = rng.uniform(0, 1, (100, 5, 23))
    arguments = image, uv, weights, 0.04
    compiled = harris._score_positions.kernel(*arguments)
    readable = harris._score_positions.reference(*arguments)
    np.testing.assert_allclose(compiled, readable, rtol=1e-9)
    spacing = rng.uniform(2, 40, 100)
    estimates = harris.estimate_corners(image, uv, spacing)
    monkeypatch.setattr(kernels, "COMPILED", False)
    np.testing.assert_array_equal(estimates, harris.estimate_corners(image, uv, spacing))
