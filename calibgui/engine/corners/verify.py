"""Is it a board? A wrong grid is worse than none.

After refinement at full resolution every corner must
- have converged to a saddle,
- lie where its neighbours on the lattice expect it (regularity),
- be surrounded by four sectors that alternate as its place requires, with a contrast
  comparable to the board's (alternating colours).
Corners that fail are left out; so many failures that the rest no longer holds together, or a
rest too small, condemn the board.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.corners.edges import Fit
from calibgui.engine.corners.growth import sectors
from calibgui.engine.corners.lattice import (
    Lattice,
    axes,
    bordered,
    crop,
    in_steps,
    predict,
    supported,
)
from calibgui.engine.opencv import Image
from calibgui.engine.types import Array, BoolArray

_IRREGULAR = 0.2
"""Greatest distance from the neighbours' prediction, steps of the lattice."""
_CLEAR = 0.25
"""Least gap between dark and bright sectors over their difference."""
_WEAKEST = 0.2
"""Least contrast over the board's median."""
_FAILING = 0.25
"""Share of corners that may fail before the board does."""
_WIDEST = 0.18
"""Greatest blur of a board's edges, squares: of a sine wave it would be 0.25."""
_WORST_MISFIT = 0.25
"""Greatest median residual over the contrast."""
_MOVED = 0.1
"""Farthest that the edge fit may move a corner, squares."""
_UNEXPLAINED = 4.0
"""Greatest residual of the edge fit over the board's median residual ..."""
_MISFIT = 0.15
"""... or over the corner's contrast, whichever is more."""
_SPARSE = 0.4
"""Least share found of a border line's visible places."""
BORDERS = (np.s_[0], np.s_[-1], np.s_[:, 0], np.s_[:, -1])
"""First and last row, first and last column of a lattice."""
_EDGE = 4.0
"""Width of the image's border in which no corner is expected to be found, px."""
_MOSTLY = 0.9
"""Share of a line inside the image from which it would have been seen."""


def sound(lattice: Lattice, image: Image) -> BoolArray:
    """(rows, cols) which corners of a lattice pass: see the head of this module."""
    right, down = axes(lattice.uv)
    regular = in_steps(lattice.uv - predict(lattice.uv), right, down) < _IRREGULAR
    at = np.nonzero(lattice.found)
    dark = lattice.dark ^ ((at[0] + at[1]) % 2 == 1)
    gap, contrast = sectors(image, lattice.uv[at], right[at], down[at], dark)
    clear = np.zeros(lattice.shape, dtype=np.bool_)
    clear[at] = (gap > _CLEAR * contrast) & (contrast > _WEAKEST * np.nanmedian(contrast))
    return np.asarray(lattice.found & regular & clear)


def credible(good: BoolArray, found: BoolArray) -> bool:
    """Whether enough of the corners found are good for their board to be trusted."""
    return bool(np.count_nonzero(found & ~good) <= _FAILING * np.count_nonzero(found))


def described(fit: Fit, start: Array, spacing: Array) -> BoolArray:
    """(n,) which corners the edge model describes: it stayed near the saddle point where it
    started, its edges are as strong as the board's, and it leaves no more unexplained."""
    moved = np.linalg.norm(fit.uv - start, axis=1)
    typical = float(np.median(fit.residual))
    return np.asarray(
        (moved <= np.maximum(_MOVED * spacing, 1.0))
        & (fit.contrast > _WEAKEST * np.median(fit.contrast))
        & (fit.residual <= np.maximum(_UNEXPLAINED * typical, _MISFIT * fit.contrast))
        & np.isfinite(fit.covariance).all(axis=(1, 2))
    )


def stepped(fit: Fit) -> bool:
    """Whether the squares are flat inside and step at their edges: waves cross likewise, only
    wider, and are not described by steps."""
    widths = np.median(fit.edges.unknowns[:, 4:6] / fit.edges.size, axis=0)
    misfit = np.median(fit.residual / fit.contrast)
    return bool(widths.max() < _WIDEST and misfit < _WORST_MISFIT)


def filled(lattice: Lattice, shape: tuple[int, ...]) -> Lattice:
    """The lattice with its gaps where the neighbours expect their corners, inside the image."""
    expected = predict(lattice.uv)
    try_here = ~lattice.found & _inside(expected, shape)
    return Lattice(np.where(try_here[..., None], expected, lattice.uv), lattice.dark)


def without_strays(lattice: Lattice, shape: tuple[int, ...]) -> Lattice:
    """The lattice less border lines of which little was found though the image shows them."""
    lattice = crop(supported(lattice))
    while min(lattice.shape) > 1:
        seen = lattice.found | _inside(predict(lattice.uv), shape)
        shares = [float(lattice.found[line].sum() / max(seen[line].sum(), 1)) for line in BORDERS]
        worst = int(np.argmin(shares))
        if shares[worst] >= _SPARSE:
            break
        keep = np.ones(lattice.shape, dtype=np.bool_)
        keep[BORDERS[worst]] = False
        lattice = crop(supported(lattice.under(keep)))
    return lattice


def visible_ends(lattice: Lattice, shape: tuple[int, ...]) -> tuple[tuple[bool, bool], ...]:
    """Whether the image (h, w) = `shape` shows where the lattice ends.

    Returns:
        For the rows, then for the columns: whether the next line before the first and after the
        last would lie inside the image, so that it would have been found if it existed.
    """
    expected = predict(bordered(lattice.uv, 1))
    inside, known = _inside(expected, shape), np.isfinite(expected[..., 0])
    top, bottom, left, right = (
        bool(inside[line][known[line]].mean() > _MOSTLY) for line in BORDERS
    )
    return (top, bottom), (left, right)


def _inside(uv: Array, shape: tuple[int, ...]) -> BoolArray:
    """Which positions (..., 2) lie in an image of `shape` (h, w), a little off its border."""
    limit = np.array(shape[::-1]) - 1.0 - _EDGE
    return np.asarray(np.all((uv > _EDGE) & (uv < limit), axis=-1))
