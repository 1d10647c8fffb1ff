"""The compiled choice of polynomials against the readable one."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.corner_fit import board_priors


@pytest.mark.parametrize("noise", [0.0, 0.1, 10.0])
def test_the_same_degrees(noise: float) -> None:
    rng = np.random.default_rng(0)
    Q, _ = np.linalg.qr(rng.normal(size=(60, 15)))
    counts = np.array([1, 3, 6, 10, 15])
    values = Q @ (rng.normal(size=(15, 8)) * (np.arange(15)[:, None] < rng.integers(1, 16, 8)))
    values += noise * rng.normal(size=values.shape)
    values[:, 0] = 7.0
    arguments = values, Q.T @ values, counts, 1.4
    degrees, misfit = board_priors._choose_degrees.kernel(*arguments)
    expected, missed = board_priors._choose_degrees.reference(*arguments)
    np.testing.assert_allclose(misfit, missed, atol=1e-6)
    if noise:  # else rounding decides
        np.testing.assert_array_equal(degrees, expected)
        assert len(np.unique(degrees)) > 1 or noise > 1


def test_values_that_are_not_finite_choose_no_degree() -> None:
    values, weights = np.full((9, 1), np.nan), np.full((6, 1), np.nan)
    for choose in (board_priors._choose_degrees.kernel, board_priors._choose_degrees.reference):
        degrees, misfit = choose(values, weights, np.array([1, 3, 6]), 1.4)
        assert degrees.tolist() == [0]
        assert np.isnan(misfit).all()
