"""Newton's method in a bracket against known roots."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.root import solve_in_bracket


def test_roots_of_a_sine() -> None:
    goals = np.array([-0.9, 0.0, 0.3, 0.999999])

    def curve(x: Array) -> tuple[Array, Array]:
        return np.sin(x) - goals, np.cos(x)

    low, high = np.full(4, -np.pi / 2), np.full(4, np.pi / 2)
    found = solve_in_bracket(curve, np.full(4, 1.5), low, high)
    np.testing.assert_allclose(found, np.arcsin(goals), atol=1e-12)


def test_steps_do_not_go_round_in_circles() -> None:
    """Newton's method alone goes from 1 to -1 and back on sign(x) sqrt(|x|)."""

    def curve(x: Array) -> tuple[Array, Array]:
        return np.sign(x) * np.sqrt(np.abs(x)), 0.5 / np.sqrt(np.abs(x))

    found = solve_in_bracket(curve, np.ones(1), np.full(1, -3.0), np.full(1, 2.0))
    np.testing.assert_allclose(found, 0.0, atol=1e-13)


def test_a_flat_start_is_left_by_bisection() -> None:
    def curve(x: Array) -> tuple[Array, Array]:
        return x**3 - 8, 3 * x * x

    found = solve_in_bracket(curve, np.zeros(1), np.zeros(1), np.full(1, 100.0))
    np.testing.assert_allclose(found, 2.0, rtol=1e-15)
