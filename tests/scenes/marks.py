"""Marks in the bright squares of a checkerboard: dots, triangles and letters."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_LETTERS = {
    "T": [((-1, -1), (1, -1)), ((0, -1), (0, 1))],
    "L": [((-0.6, -1), (-0.6, 1)), ((-0.6, 1), (0.6, 1))],
    "A": [((-0.8, 1), (0, -1)), ((0, -1), (0.8, 1)), ((-0.5, 0.3), (0.5, 0.3))],
    "K": [((-0.7, -1), (-0.7, 1)), ((-0.7, 0.1), (0.7, -1)), ((-0.7, 0.1), (0.7, 1))],
}
"""Strokes of letters between points (x, y) in units of half their height."""
_STROKE = 0.25
"""Half the width of a stroke, in the same units."""


def marks(
    x: Array, y: Array, grid_size: tuple[int, int], rng: np.random.Generator
) -> NDArray[np.bool_]:
    """Where points (x, y) of a board, squares, lie on a mark. Marks are of one kind, reach 0.15 to
    0.35 squares from the middle of their squares, and are in a third of these or more."""
    rows, cols = grid_size
    reach, share, kind = rng.uniform(0.15, 0.35), rng.uniform(0.3, 1.0), rng.integers(3)
    letters = rng.choice(list(_LETTERS), (rows + 1, cols + 1))
    chosen = rng.random((rows + 1, cols + 1)) < share
    inside = (x > -1) & (x < cols) & (y > -1) & (y < rows)
    col, row = (np.floor(np.where(inside, c, 0.0)).astype(int) for c in (x, y))
    bright = inside & ((col + row) % 2 == 1) & chosen[row + 1, col + 1]
    result = np.zeros(x.shape, np.bool_)
    a, b = (x[bright] - col[bright] - 0.5) / reach, (y[bright] - row[bright] - 0.5) / reach
    if kind == 0:
        result[bright] = np.hypot(a, b) < 1
    elif kind == 1:
        result[bright] = (b < 0.8) & (2 * abs(a) < b + 1)
    else:
        result[bright] = _write(a, b, letters[row[bright] + 1, col[bright] + 1])
    return result


def _write(a: Array, b: Array, letters: NDArray[np.str_]) -> NDArray[np.bool_]:
    """Where points (a, b), half heights from the middle, lie on their letter."""
    on = np.zeros(len(a), np.bool_)
    for letter, strokes in _LETTERS.items():
        for start, end in strokes:
            p, d = np.array(start), np.subtract(end, start)
            t = np.clip(((a - p[0]) * d[0] + (b - p[1]) * d[1]) / (d @ d), 0, 1)
            near = np.hypot(a - p[0] - t * d[0], b - p[1] - t * d[1]) < _STROKE
            on |= near & (letters == letter)
    return on
