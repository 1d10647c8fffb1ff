"""The compiled saddle points against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine import kernels
from calibgui.engine.features import saddle
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions


@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
def test_the_same_saddle_points(kind: type, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = draw(Conditions(size=(320, 240), square=30.0, noise=8.0, blur=1.0), 4)
    image = scene.photograph(0).astype(kind)
    rng = np.random.default_rng(0)
    start = np.concatenate(
        [
            scene.uv.reshape(-1, 2) + rng.normal(0, 1.5, (54, 2)),
            rng.uniform(-4, 320, (200, 2)),  # on edges, in squares, outside
        ]
    )
    sigma, limit = rng.uniform(0.8, 2.0, len(start)), rng.uniform(1.0, 4.0, len(start))
    uv, good = saddle.refine_saddles(image, start, sigma, limit)
    monkeypatch.setattr(kernels, "COMPILED", False)
    expected, expected_good = saddle.refine_saddles(image, start, sigma, limit)
    assert 40 < expected_good.sum() < 200
    np.testing.assert_array_equal(good, expected_good)
    np.testing.assert_allclose(uv, expected, atol=1e-6)
