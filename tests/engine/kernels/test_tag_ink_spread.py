"""The compiled sums of the fit of tags by their cells against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.detection.apriltags import tag_ink_spread


@pytest.mark.parametrize("is_shift", [True, False], ids=["shift", "own"])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_the_same_sums(dtype: type, is_shift: bool) -> None:
    """Of tags of unlike blur that are turned, bent, and cut by the image's border."""
    rng = np.random.default_rng(3)
    v, u = np.indices((120, 160))
    image = (120 + 80 * np.sin(u / 3) * np.cos(v / 4)).astype(dtype)
    n, side = 5, 8
    H = np.array([[50.0, 12.0, 60.0], [-9.0, 45.0, 40.0], [0.1, -0.05, 1.0]])
    arguments = (
        image,
        H + np.diag([5.0, 5.0, 0.0]) * rng.uniform(-1, 1, (n, 1, 1)),
        rng.normal(0, 0.5, (n, 16, 2)),
        rng.normal(0, 0.3, (38, 4)),
        rng.random((n, side, side)) < 0.5,
        np.linspace(-0.15, 1.15, 38),
        rng.uniform(0.01, 0.08, (n, 2)),
        rng.uniform(0.05, 0.2, (n, 2)),
        is_shift,
    )
    expected = tag_ink_spread._sum_products.reference(*arguments)
    found = tag_ink_spread._sum_products.kernel(*arguments)
    assert found.shape == expected.shape
    # What is constant in the levels is that of the first two terms.
    assert (abs(found[:, -1, 0] - expected[:, -1, 0]) > 1).any()
    by_level = [
        np.linalg.solve(each[:, :-1, :-1], each[:, :-1, -1:])[..., 0] for each in (found, expected)
    ]
    np.testing.assert_allclose(by_level[0][:, 2:], by_level[1][:, 2:], rtol=1e-3, atol=0.05)
    left = [
        each[:, -1, -1] - np.sum(each[:, :-1, -1] * by, axis=1)
        for each, by in zip((found, expected), by_level, strict=True)
    ]
    np.testing.assert_allclose(left[0], left[1], rtol=1e-4)
    scale = np.sqrt(np.einsum("nii->ni", expected))[:, :-1]
    off = (found - expected)[:, :-1, :-1] / scale[:, :, None] / scale[:, None]
    assert np.abs(off).max() < 1e-6
