"""The gap between the tags of an AprilGrid.

It shows, s sides of a tag, in four corners in a row, at 0, 1, 1 + s and 2 + s on the board: their
cross-ratio (1 + s)^2 / (s (2 + s)) is the same from every side. A lens changes it: under a fisheye
a gap of 0.3 is measured as 0.31, which makes all corners of a tag disagree with those of the next.

Once all corners are known, s follows from them together. Let r(s) be what a homography and a radial
lens leave of them if they are fitted to the board with this gap. The least |r|^2 is at

    s - (r . r') / (r' . r'),   r' = dr / ds,

to the first order (Gauss and Newton; Golub and Pereyra 1973, with the map's parameters eliminated).
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, IntArray, compute_lengths, compute_median
from calibgui.engine.errors import NoBoardError
from calibgui.engine.lattices.grid_map import fit_radial_homography

_CORNERS = np.array([(0, 0), (0, 1), (1, 1), (1, 0)])
"""(4, 2) rows and columns of the corners of a tag from its upper left one."""
_STEP = 0.01
"""Change of the gap, sides of a tag, over which r' is measured."""
_ITERATIONS = 2
"""Number of Gauss-Newton steps: a third one changes the gap by less than 2e-5."""
_MAX_CHANGE = 0.05
"""Greatest difference of a fitted gap from the cross-ratios', sides of a tag: more is no lens's
doing, but that of corners that do not tell the gap."""
_MAX_EXCESS = 0.05
"""Greatest excess of a measured gap over the widest, a tag's side: noise, or a lens."""


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

    Returns:
        The gap, at most the side of a tag, which is the widest of an AprilGrid.

    Raises:
        NoBoardError: it is wider.
    """
    ratios = []
    for lines in (uv, uv.transpose(1, 0, 2)):
        count = max(lines.shape[1] // 2 - 1, 0)
        a, b, c, d = (lines[:, k::2][:, :count] for k in range(4))
        ac, bd, bc, ad = (compute_lengths(p - q) for p, q in ((a, c), (b, d), (b, c), (a, d)))
        ratios.append((ac * bd / (bc * ad)).ravel())
    ratio = np.concatenate(ratios)
    ratio = ratio[np.isfinite(ratio) & (ratio > 1)]
    if not len(ratio):
        return gap
    cross = float(compute_median(ratio))
    measured = float(np.sqrt(cross / (cross - 1))) - 1
    if measured > 1 + _MAX_EXCESS:
        raise explain_wide_gap()
    return min(measured, 1.0)


def explain_wide_gap() -> NoBoardError:
    """Return the error that tags are those of a checkerboard, not of an AprilGrid."""
    return NoBoardError(
        "Tags were read, but they stand too far apart for an AprilGrid.",
        "For a checkerboard with tags in some of its squares, choose that pattern.",
    )


def fit_gap(grid: IntArray, uv: Array, gap: float) -> float:
    """Fit the gap between tags, sides of a tag, to all corners of a board.

    Args:
        grid: (n, 2) rows and columns of the corners.
        uv: (n, 2) px, where they are seen.
        gap: `measure_gap` of them, which is returned if they do not tell it better.
    """
    fitted = gap
    for _ in range(_ITERATIONS):
        left, less, more = (
            _compute_misfit(grid, uv, fitted + change) for change in (0.0, -_STEP, _STEP)
        )
        by_gap = (more - less) / (2 * _STEP)
        with np.errstate(all="ignore"):  # tags in one row and one column show no gap
            fitted -= float(left @ by_gap / (by_gap @ by_gap))
        if not abs(fitted - gap) < _MAX_CHANGE:
            return gap
    return min(fitted, 1.0)


def _compute_misfit(grid: IntArray, uv: Array, gap: float) -> Array:
    """Compute what homography and lens leave, (2 n,) px, of corners if the gap is `gap` sides."""
    tag, corner = np.divmod(grid[:, ::-1], 2)
    places = (1 + gap) * tag + corner
    seen = fit_radial_homography(places, uv, are_exact=True)
    return np.asarray((uv - seen.locate(places)).ravel())
