"""What the board shows of the difference of its corners' blurs."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibgui.engine.arrays import Array
from calibgui.engine.corner_fit.x_corner_step import estimate_blur_difference

angles = st.floats(-np.pi, np.pi)


def edges(seed: int, turn: float) -> Array:
    """(60, 2, 2) normals of edges that cross at 60 to 120 degrees, all turned alike but for 20."""
    rng = np.random.default_rng(seed)
    first = turn + np.radians(rng.uniform(-10, 10, 60))
    angle = np.stack([first, first + np.radians(rng.uniform(60, 120, 60))], axis=1)
    return np.stack([np.cos(angle), np.sin(angle)], axis=2)


def blurred(normals: Array, size: Array, D: Array) -> Array:
    """(n, 2) blurs of the edges by s^2 I + D, s the `size` (n,)."""
    return np.sqrt(size[:, None] ** 2 + np.einsum("nei,ij,nej->ne", normals, D, normals))


@given(seed=st.integers(0, 99), turn=angles, along=st.floats(0, 0.3), direction=angles)
def test_one_anisotropy_is_found_whatever_the_focus(
    seed: int, turn: float, along: float, direction: float
) -> None:
    c, s = np.cos(direction), np.sin(direction)
    D = along * np.array([[c, s], [s, -c]])
    normals = edges(seed, turn)
    blurs = blurred(normals, np.random.default_rng(seed).uniform(0.7, 2.0, 60), D)
    np.testing.assert_allclose(
        estimate_blur_difference(normals, blurs), blurs[:, 0] - blurs[:, 1], rtol=0, atol=1e-12
    )


def test_what_is_not_common_to_the_board_is_averaged_out() -> None:
    normals = edges(1, 0.3)
    noise = np.random.default_rng(2).normal(0, 0.1, (60, 2))
    found = estimate_blur_difference(normals, np.full((60, 2), 1.0) + noise)
    assert np.sqrt(np.mean(found**2)) < 0.1 * np.sqrt(2) / 3


def test_edges_of_one_direction_leave_what_they_cannot_tell_at_its_least() -> None:
    """Of squares that stand upright only the difference along u and v can be seen."""
    normals = np.tile(np.array([[0.0, 1.0], [1.0, 0.0]]), (20, 1, 1))
    found = estimate_blur_difference(normals, np.tile([1.0, 1.5], (20, 1)))
    assert found == pytest.approx(-0.5)
