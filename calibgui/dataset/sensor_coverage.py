"""Coverage of the sensor by the corners of a set of views."""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, IntArray, Size

COVERAGE_CELLS = (9, 6)
"""Numbers of columns and rows of cells by which the coverage of the sensor is judged."""


def count_corners_per_cell(
    uv: Array, size: Size, cells: tuple[int, int] = COVERAGE_CELLS
) -> IntArray:
    """Count corners `uv` (n, 2), px, in equal cells (rows, columns) of the sensor."""
    w, h = size
    counts, _, _ = np.histogram2d(
        uv[:, 1],
        uv[:, 0],
        bins=(cells[1], cells[0]),
        range=((-0.5, h - 0.5), (-0.5, w - 0.5)),
    )
    return counts.astype(np.int64)
