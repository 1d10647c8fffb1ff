"""The compiled comparison of squares against the readable one."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.lattices import board_ends


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_the_same_squares_also_at_the_border(dtype: type) -> None:
    rng = np.random.default_rng(3)
    image = rng.uniform(0, 255, (60, 80)).astype(dtype)
    place = rng.uniform(-5, (85, 65), (200, 2))
    right, down = (rng.normal(step, 1, (200, 2)) for step in ((8, 0), (0, 8)))
    offsets = np.array([[0.5, 0.3], [0.5, 0.7], [0.3, 0.5]])
    arguments = image, place, right, down, offsets
    compiled = board_ends._compare_squares.kernel(*arguments)
    readable = board_ends._compare_squares.reference(*arguments)
    assert compiled.shape == (2, 3, 200)
    assert 0 < np.isnan(readable).mean() < 0.8
    np.testing.assert_allclose(compiled, readable, rtol=1e-9, atol=1e-9)
