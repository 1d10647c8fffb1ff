"""The median of few values, and the inverses of small matrices, against NumPy's."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import compute_median, invert_2x2


@pytest.mark.parametrize("shape", [(1,), (2,), (7,), (156,), (5, 8), (64, 3), (3, 1)])
def test_the_median_is_numpys(shape: tuple[int, ...]) -> None:
    rng = np.random.default_rng(0)
    for values in (rng.standard_normal(shape), rng.integers(0, 3, shape).astype(np.float64)):
        for axis in range(-1, len(shape) - 1):
            np.testing.assert_array_equal(
                compute_median(values, axis), np.median(values, axis=axis)
            )


@pytest.mark.parametrize("shape", [(), (156,), (3, 5)])
def test_the_inverse_is_numpys(shape: tuple[int, ...]) -> None:
    matrices = np.random.default_rng(0).standard_normal((*shape, 2, 2))
    np.testing.assert_allclose(invert_2x2(matrices), np.linalg.inv(matrices), rtol=1e-9)
