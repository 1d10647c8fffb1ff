"""Steps and predictions on a lattice, compiled: the loops of ``features.lattice``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.kernels.common import compiled, compiled_allocating_part, compiled_part


@compiled_part
def _get_at(uv: Array, row: int, col: int, k: int) -> float:
    """Return coordinate k at a place, NaN outside the lattice."""
    inside = 0 <= row < uv.shape[0] and 0 <= col < uv.shape[1]
    return uv[row, col, k] if inside else np.nan


@compiled_part
def _average_known(values: tuple[float, ...]) -> float:
    """Return the mean of the values that are not NaN, NaN where there are none."""
    total, count = 0.0, 0
    for value in values:
        if not np.isnan(value):
            total += value
            count += 1
    return total / count if count else np.nan


@compiled
def _estimate_steps_along(uv: Array, dr: int, dc: int, reach: int, out: Array) -> None:
    """Fill `out` with the steps in the direction (dr, dc)."""
    rows, cols, _ = uv.shape
    unknown = False
    for r in range(rows):
        for c in range(cols):
            for k in range(2):
                here = uv[r, c, k]
                after, before = _get_at(uv, r + dr, c + dc, k), _get_at(uv, r - dr, c - dc, k)
                step = _average_known((after - here, here - before))
                if np.isnan(step):
                    step = (after - before) / 2
                if np.isnan(step):
                    after = _get_at(uv, r + 2 * dr, c + 2 * dc, k)
                    before = _get_at(uv, r - 2 * dr, c - 2 * dc, k)
                    step = _average_known(((after - here) / 2, (here - before) / 2))
                out[r, c, k] = step
                unknown |= np.isnan(step)
    if unknown:
        for _ in range(reach):
            _spread_steps(out)


@compiled_allocating_part
def _spread_steps(steps: Array) -> None:
    """Fill unknown steps from those that were known around them."""
    rows, cols, _ = steps.shape
    # Two rows as they were, with a border on either side: the one above and the one being filled.
    above, here = np.full((cols + 2, 2), np.nan), np.full((cols + 2, 2), np.nan)
    for r in range(rows):
        for c in range(cols):
            here[c + 1, 0], here[c + 1, 1] = steps[r, c, 0], steps[r, c, 1]
        for c in range(cols):
            for k in range(2):
                if np.isnan(here[c + 1, k]):
                    below = _get_at(steps, r + 1, c, k)
                    steps[r, c, k] = _average_known(
                        (here[c + 2, k], below, here[c, k], above[c + 1, k])
                    )
        above, here = here, above


@compiled_part
def _extrapolate(uv: Array, r: int, c: int, dr: int, dc: int, k: int) -> float:
    """Extrapolate the line that ends one place away in the direction (dr, dc)."""
    p1, p2 = _get_at(uv, r + dr, c + dc, k), _get_at(uv, r + 2 * dr, c + 2 * dc, k)
    p3 = _get_at(uv, r + 3 * dr, c + 3 * dc, k)
    slope = p1 - p2
    return p1 + slope + (0.0 if np.isnan(p3) else 0.5 * (slope - (p2 - p3)))


@compiled
def _predict_places(uv: Array, out: Array) -> None:
    """Fill `out` with the predictions of `predict_places`."""
    for r in range(uv.shape[0]):
        for c in range(uv.shape[1]):
            for k in range(2):
                expected = _average_known(
                    (
                        (_get_at(uv, r, c + 1, k) + _get_at(uv, r, c - 1, k)) / 2,
                        (_get_at(uv, r + 1, c, k) + _get_at(uv, r - 1, c, k)) / 2,
                    )
                )
                if np.isnan(expected):
                    expected = _average_known(
                        (
                            _extrapolate(uv, r, c, 0, 1, k),
                            _extrapolate(uv, r, c, 1, 0, k),
                            _extrapolate(uv, r, c, 0, -1, k),
                            _extrapolate(uv, r, c, -1, 0, k),
                        )
                    )
                out[r, c, k] = expected


def estimate_steps(uv: Array, reach: int) -> tuple[Array, Array]:
    """Compute ``features.lattice._estimate_steps``."""
    uv = np.ascontiguousarray(uv)
    right, down = np.empty_like(uv), np.empty_like(uv)
    _estimate_steps_along(uv, 0, 1, reach, right)
    _estimate_steps_along(uv, 1, 0, reach, down)
    return right, down


def predict_places(uv: Array) -> Array:
    """Compute ``features.lattice.predict_places``."""
    expected = np.empty_like(uv)
    _predict_places(np.ascontiguousarray(uv), expected)
    return expected
