"""Steps and predictions on a lattice, compiled: ``corners.lattice.axes`` and ``predict``."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.kernels.common import compiled


@compiled
def _at(uv, row, col, k):  # type: ignore[no-untyped-def]
    """Coordinate k at a place, NaN outside the lattice."""
    inside = 0 <= row < uv.shape[0] and 0 <= col < uv.shape[1]
    return uv[row, col, k] if inside else np.nan


@compiled
def _mean(values):  # type: ignore[no-untyped-def]
    """Mean of those that are not NaN, NaN where there are none."""
    total, count = 0.0, 0
    for value in values:
        if not np.isnan(value):
            total += value
            count += 1
    return total / count if count else np.nan


@compiled
def _steps(uv, dr, dc, reach, out):  # type: ignore[no-untyped-def]
    rows, cols, _ = uv.shape
    unknown = False
    for r in range(rows):
        for c in range(cols):
            for k in range(2):
                here = uv[r, c, k]
                after, before = _at(uv, r + dr, c + dc, k), _at(uv, r - dr, c - dc, k)
                step = _mean((after - here, here - before))
                if np.isnan(step):
                    step = (after - before) / 2
                if np.isnan(step):
                    after = _at(uv, r + 2 * dr, c + 2 * dc, k)
                    before = _at(uv, r - 2 * dr, c - 2 * dc, k)
                    step = _mean(((after - here) / 2, (here - before) / 2))
                out[r, c, k] = step
                unknown |= np.isnan(step)
    if unknown:
        for _ in range(reach):
            _spread(out)


@compiled
def _spread(steps):  # type: ignore[no-untyped-def]
    """Fill unknown steps from those that were known around them."""
    rows, cols, _ = steps.shape
    # Two rows as they were, with a border on either side: the one above and the one being filled.
    above, here = np.full((cols + 2, 2), np.nan), np.full((cols + 2, 2), np.nan)
    for r in range(rows):
        here[1:-1] = steps[r]
        for c in range(cols):
            for k in range(2):
                if np.isnan(here[c + 1, k]):
                    below = _at(steps, r + 1, c, k)
                    steps[r, c, k] = _mean((here[c + 2, k], below, here[c, k], above[c + 1, k]))
        above, here = here, above


@compiled
def _beyond(uv, r, c, dr, dc, k):  # type: ignore[no-untyped-def]
    """Extrapolation of the line that ends one place away in the direction (dr, dc)."""
    p1, p2 = _at(uv, r + dr, c + dc, k), _at(uv, r + 2 * dr, c + 2 * dc, k)
    p3 = _at(uv, r + 3 * dr, c + 3 * dc, k)
    slope = p1 - p2
    return p1 + slope + (0.0 if np.isnan(p3) else 0.5 * (slope - (p2 - p3)))


@compiled
def _predict(uv, out):  # type: ignore[no-untyped-def]
    for r in range(uv.shape[0]):
        for c in range(uv.shape[1]):
            for k in range(2):
                expected = _mean(
                    (
                        (_at(uv, r, c + 1, k) + _at(uv, r, c - 1, k)) / 2,
                        (_at(uv, r + 1, c, k) + _at(uv, r - 1, c, k)) / 2,
                    )
                )
                if np.isnan(expected):
                    expected = _mean(
                        (
                            _beyond(uv, r, c, 0, 1, k),
                            _beyond(uv, r, c, 1, 0, k),
                            _beyond(uv, r, c, 0, -1, k),
                            _beyond(uv, r, c, -1, 0, k),
                        )
                    )
                out[r, c, k] = expected


def axes(uv: Array, reach: int) -> tuple[Array, Array]:
    """Steps (rows, cols, 2) to the next column and to the next row of a lattice, px, where they
    are unknown from up to `reach` places away."""
    uv = np.ascontiguousarray(uv)
    right, down = np.empty_like(uv), np.empty_like(uv)
    _steps(uv, 0, 1, reach, right)
    _steps(uv, 1, 0, reach, down)
    return right, down


def predict(uv: Array) -> Array:
    """Where its neighbours expect each place of a lattice `uv` (rows, cols, 2), px."""
    expected = np.empty_like(uv)
    _predict(np.ascontiguousarray(uv), expected)
    return expected
