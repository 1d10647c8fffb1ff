"""Newton's method in a bracket, for many unknowns at once, such as the radii of image points."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from calibgui.engine.arrays import Array

_MAX_ITERATIONS = 100
"""Number of steps, at most; bisection alone takes 53."""
_MAX_STEP = 1e-14
"""Length of the last step, relative to 1 + |x|: a few units in the last place."""


def solve_in_bracket(
    curve: Callable[[Array], tuple[Array, Array]], start: Array, low: Array, high: Array
) -> Array:
    """Find where a curve is 0 by Newton's method, every step of which stays in a bracket.

    A step that leaves what is left of the bracket, or is longer than half of the step before, so
    that steps could go round in circles, is replaced by the bracket's bisection.

    Args:
        curve: a function from x (n,) to its values and slopes, negative below the zero and
            positive above it.
        start: (n,) first x.
        low: (n,) lower ends of the brackets.
        high: (n,) upper ends.
    """
    x = np.clip(start, low, high)
    moved = high - low
    found = np.zeros(x.shape, dtype=bool)
    with np.errstate(all="ignore"):  # there is no step from where the curve is flat
        for _ in range(_MAX_ITERATIONS):
            value, slope = curve(x)
            low, high = np.where(value <= 0, x, low), np.where(value >= 0, x, high)
            target = x - value / slope
            good = (target >= low) & (target <= high) & (np.abs(target - x) <= moved / 2)
            target = np.where(good, target, (low + high) / 2)
            moved = np.abs(target - x)
            x = np.where(found, x, target)
            found |= ~(moved > _MAX_STEP * (1 + np.abs(x)))
            if found.all():
                break
    return x
