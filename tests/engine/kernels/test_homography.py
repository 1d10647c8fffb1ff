"""The compiled sums of the DLT against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.geometry import homography


def test_the_compiled_sums_are_the_readable_ones() -> None:
    rng = np.random.default_rng(0)
    source, destination = rng.normal(300, 100, (70, 30, 2)), rng.normal(5, 9, (70, 30, 2))
    mask = rng.uniform(0, 1, (70, 30)) * (rng.random((70, 30)) < 0.9)
    compiled = homography.sum_moments.kernel(source, destination, mask)
    readable = homography.sum_moments.reference(source, destination, mask)
    for ours, truth in zip(compiled, readable, strict=True):
        np.testing.assert_allclose(ours, truth, rtol=1e-12, atol=1e-12 * np.abs(truth).max())


def test_a_single_set_of_points_needs_no_kernel(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError("the kernel is called")

    monkeypatch.setattr(homography.sum_moments, "_kernel", refuse)
    rng = np.random.default_rng(0)
    one = rng.normal(300, 100, (1, 30, 2)), rng.normal(5, 9, (1, 30, 2)), np.ones((1, 30))
    homography.sum_moments(*one)
    with pytest.raises(AssertionError, match="the kernel is called"):
        homography.sum_moments(*(np.concatenate([array, array]) for array in one))
