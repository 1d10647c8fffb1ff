"""The compiled sums of the fit of ellipses against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.detection.circles.ellipse_fit import _sum_products


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_the_same_sums(dtype: type) -> None:
    """Of ellipses of any size and slope, cut by the image's border or outside of it."""
    rng = np.random.default_rng(3)
    image = rng.integers(0, 255, (120, 160)).astype(dtype)
    axes = rng.normal(0, 8, (30, 2, 2))
    S = np.linalg.inv(axes @ axes.transpose(0, 2, 1) + 20 * np.eye(2))
    x = np.empty((30, 8))
    x[:, :2] = rng.uniform(-20, 170, (30, 2))
    x[:, 2:5] = S[:, [0, 0, 1], [0, 1, 1]]
    x[:, 5:] = np.column_stack(
        [rng.uniform(0.3, 3, 30), rng.uniform(80, 150, 30), rng.uniform(-80, 80, 30)]
    )
    x[0, :2] = -500.0
    arguments = image, x, rng.normal(0, 0.1, (30, 2)), 3.0, 0.3
    expected, found = _sum_products.reference(*arguments), _sum_products.kernel(*arguments)
    assert not found[0].any()
    scale = np.sqrt(np.einsum("nii->ni", expected)) + 1e-300
    off = (found - expected) / scale[:, :, None] / scale[:, None]
    assert np.abs(off).max() < 1e-12
