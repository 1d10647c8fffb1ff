"""The compiled steps and predictions against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine import kernels
from calibgui.engine.features.lattice import estimate_steps, predict_places


@pytest.mark.parametrize("share", [1.0, 0.7, 0.3, 0.1])
@pytest.mark.parametrize("shape", [(6, 9), (1, 5), (2, 2), (30, 20)])
def test_the_same_steps_and_predictions(
    shape: tuple[int, int], share: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(7)
    uv = rng.uniform(0, 100, (*shape, 2))
    uv[rng.random(shape) > share] = np.nan
    (right, down), expected = estimate_steps(uv), predict_places(uv)
    monkeypatch.setattr(kernels, "COMPILED", False)
    np.testing.assert_allclose(np.stack([right, down]), np.stack(estimate_steps(uv)), atol=1e-12)
    np.testing.assert_allclose(expected, predict_places(uv), atol=1e-12)
