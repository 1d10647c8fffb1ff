"""The compiled sums over the squares between edges against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.corner_fit import light_gradients
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions


@pytest.mark.parametrize("deep", [False, True])
def test_the_same_sums(deep: bool) -> None:
    scene = draw(Conditions(size=(320, 240), deep=deep, parts=1), 1)
    uv = scene.uv.reshape(-1, 2) + np.array([200.0, 0.0])  # some lie beyond the border
    n, rng = len(uv), np.random.default_rng(0)
    angle = np.array([0.0, np.pi / 2]) + rng.uniform(-0.5, 0.5, (n, 2))
    tangent = np.stack([np.cos(angle), np.sin(angle)], axis=2)
    normal = np.stack([-tangent[..., 1], tangent[..., 0]], axis=2)
    lengths = np.stack(
        [rng.normal(0, 1e-3, (n, 2)), rng.uniform(8, 25, (n, 2)), rng.uniform(2, 4, (n, 2))], axis=2
    )
    bands = np.concatenate([tangent, normal, lengths], axis=2)
    sign, side = rng.choice([-1.0, 1.0], n), rng.integers(1, 4, n)
    arguments = scene.photograph(0), uv, bands, sign, rng.normal(0, 1, (n, 6)), side
    sum_cells = light_gradients._sum_cells
    (mine, count), (its, other) = sum_cells.kernel(*arguments), sum_cells.reference(*arguments)
    np.testing.assert_array_equal(count, other)
    assert 0 < np.count_nonzero(count == 0) < n
    np.testing.assert_allclose(mine, its, rtol=1e-9, atol=1e-9 * abs(its).max())
