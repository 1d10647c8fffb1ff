"""The gap between the tags of an AprilGrid.

It shows, s sides of a tag, in four corners in a row, at 0, 1, 1 + s and 2 + s on the board: their
cross-ratio (1 + s)^2 / (s (2 + s)) is the same from every side.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.errors import NoBoardError

_CORNERS = np.array([(0, 0), (0, 1), (1, 1), (1, 0)])
"""(4, 2) rows and columns of the corners of a tag from its upper left one."""


def measure_gap_of_tags(squares: IntArray, corners: Array, gap: float) -> float:
    """Measure the gap between tags at `squares` (n, 2), from 0, whose corners (n, 4, 2) px are
    known; see `measure_gap`."""
    grid = 2 * squares[:, None] + _CORNERS
    uv = np.full((*(grid.max(axis=(0, 1)) + 1), 2), np.nan)
    uv[grid[..., 0], grid[..., 1]] = corners
    return measure_gap(uv, gap)


def measure_gap(uv: Array, gap: float) -> float:
    """Measure the gap between tags, sides of a tag, where four corners in a row show it.

    Args:
        uv: (rows, cols, 2) px of the corners of a board's tags, NaN where unknown.
        gap: what is returned where nothing shows it.

    Raises:
        NoBoardError: it is wider than a tag, which that of an AprilGrid is not.
    """
    ratios = []
    for lines in (uv, uv.transpose(1, 0, 2)):
        a, b, c, d = (lines[:, k : lines.shape[1] - 2 + k : 2] for k in (0, 1, 2, 3))
        a, b = a[:, : d.shape[1]], b[:, : d.shape[1]]
        c = c[:, : d.shape[1]]
        ac, bd, bc, ad = (
            np.linalg.norm(p - q, axis=2) for p, q in ((a, c), (b, d), (b, c), (a, d))
        )
        ratios.append((ac * bd / (bc * ad)).ravel())
    ratio = np.concatenate(ratios)
    ratio = ratio[np.isfinite(ratio) & (ratio > 1)]
    if not len(ratio):
        return gap
    cross = float(np.median(ratio))
    measured = float(np.sqrt(cross / (cross - 1))) - 1
    if measured > 1:
        raise NoBoardError(
            "Tags were read, but they stand too far apart for an AprilGrid.",
            "For a checkerboard with tags in some of its squares, choose that pattern.",
        )
    return measured
