"""The compiled sums of the DLT against the readable ones."""

from __future__ import annotations

import numpy as np

from calibgui.engine.geometry import homography


def test_the_compiled_sums_are_the_readable_ones() -> None:
    from calibgui.engine.kernels.homography import moments

    rng = np.random.default_rng(0)
    source, destination = rng.normal(300, 100, (70, 30, 2)), rng.normal(5, 9, (70, 30, 2))
    mask = rng.uniform(0, 1, (70, 30)) * (rng.random((70, 30)) < 0.9)
    compiled = moments(source, destination, mask)
    for ours, truth in zip(compiled, homography.moments(source, destination, mask), strict=True):
        np.testing.assert_allclose(ours, truth, rtol=1e-12, atol=1e-12 * np.abs(truth).max())
