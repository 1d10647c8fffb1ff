"""Which covariances a corner can be weighed with."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.features.corners import find_usable_covariances


@pytest.mark.parametrize(
    ("cov", "is_usable"),
    [
        (1e-4 * np.eye(2), True),
        (np.diag([1e-12, 1e-3]), True),
        (np.array([[2.0, 1.9], [1.9, 2.0]]), True),
        (np.zeros((2, 2)), False),
        (-1e-4 * np.eye(2), False),
        (np.array([[1.0, 2.0], [2.0, 1.0]]), False),
        (np.diag([1.0, 0.0]), False),
        (np.diag([1.0, 1e-15]), False),
        (np.diag([1.0, np.nan]), False),
        (np.diag([np.inf, 1.0]), False),
    ],
    ids=str,
)
def test_usable_covariances_are_positive_finite_and_far_from_singular(
    cov: Array, is_usable: bool
) -> None:
    around = np.array([np.eye(2), cov, np.eye(2)])
    assert find_usable_covariances(around).tolist() == [True, is_usable, True]
