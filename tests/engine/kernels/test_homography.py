"""The compiled DLT against the readable one."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.geometry import homography


def test_the_compiled_homographies_are_the_readable_ones() -> None:
    rng = np.random.default_rng(0)
    source, H = rng.normal(300, 100, (70, 30, 2)), np.eye(3) + rng.normal(0, 2e-4, (70, 3, 3))
    destination = homography.apply_homography(H, source) + rng.normal(0, 3, source.shape)
    mask = rng.uniform(0, 1, (70, 30)) * (rng.random((70, 30)) < 0.9)
    compiled = homography.fit_homographies.kernel(source, destination, mask)
    readable = homography.fit_homographies.reference(source, destination, mask)
    np.testing.assert_allclose(compiled, readable, rtol=1e-9, atol=1e-13)


def test_both_fit_four_points_exactly() -> None:
    rng = np.random.default_rng(1)
    source = np.array([[0.0, 0], [9, 0], [9, 7], [0, 7]]) + rng.normal(0, 0.5, (20, 4, 2))
    H = np.array([[80.0, 5, 300], [-3, 90, 200], [0, 0, 1]]) + rng.normal(0, 1e-2, (20, 3, 3))
    destination = homography.apply_homography(H, source)
    for fit in (homography.fit_homographies.kernel, homography.fit_homographies.reference):
        found = homography.apply_homography(fit(source, destination, np.ones((20, 4))), source)
        np.testing.assert_allclose(found, destination, atol=1e-9)


def test_a_single_set_of_points_needs_no_kernel(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError("the kernel is called")

    monkeypatch.setattr(homography.fit_homographies, "_kernel", refuse)
    rng = np.random.default_rng(0)
    one = rng.normal(300, 100, (1, 30, 2)), rng.normal(5, 9, (1, 30, 2)), np.ones((1, 30))
    homography.fit_homographies(*one)
    with pytest.raises(AssertionError, match="the kernel is called"):
        homography.fit_homographies(*(np.concatenate([array, array]) for array in one))
