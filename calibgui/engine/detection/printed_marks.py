"""Does a checkerboard bear marks? A look at its edges and squares, once its corners are known.

PuzzleBoards have dots on their edges, other boards have tags or markers in their squares. To read
them takes several times as long as to find the corners; to see that there is nothing to read takes
a few grey levels of each square:

- Half-way between two corners a bare edge is as dark on one side and as bright on the other as the
  squares that share it. Across a dot there is no such step.
- A bare square has one grey level.

Both are relative to the board's contrast. Whatever is drawn, printed or lies there counts as marks:
the look tells boards that need not be read, not what the others bear.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.puzzleboard import DOT_DIAMETER
from calibgui.engine.features.corners import Corners
from calibgui.engine.features.lattice import estimate_steps
from calibgui.engine.images.sampling import sample_image

_MIN_STEP = 0.65
"""Least step across bare edges, median, over the step of the squares beside them. In rendered
photographs it is 0.7 to 1.0 on boards without dots, but for strong blur, and up to 0.5 with."""
_MIN_SPREAD = 0.07
"""Least standard deviation of the grey levels in a square that bears a mark, over the board's
contrast. In rendered photographs of tags it is 0.08 to 0.7, in bare squares up to 0.056."""
_BESIDE_EDGE = np.array([(along, DOT_DIAMETER / 3) for along in (-0.08, 0.0, 0.08)])
"""(k, 2) where the edge's one side is sampled, along and across the edge, squares from its middle:
on the dot, if there is one."""
_BESIDE_DOT = np.array([(a, b) for a in (-0.15, 0.0, 0.15) for b in (0.28, 0.36)])
"""(m, 2) where the square is sampled, likewise: outside of the dot."""
_INSIDE = np.array([(a, b) for a in np.linspace(0.25, 0.75, 7) for b in np.linspace(0.25, 0.75, 7)])
"""(s, 2) where a square is sampled, sides from its first corner."""


class Marks(NamedTuple):
    """The places where a checkerboard may bear marks."""

    on_edges: bool
    """True if there may be dots on its edges."""
    in_squares: bool
    """True if something is seen in at least two of its squares."""


def look_for_marks(image: GreyImage, corners: Corners) -> Marks:
    """Look for marks on the checkerboard whose corners were found.

    Args:
        image: (h, w) grey levels.
        corners: its corners in this image.
    """
    row, col = (corners.grid - corners.grid.min(axis=0)).T
    uv = np.full((row.max() + 1, col.max() + 1, 2), np.nan)
    uv[row, col] = corners.uv
    right, down = estimate_steps(uv)
    steps = np.concatenate(
        [
            _measure_steps(image, uv, down),
            _measure_steps(image, uv.swapaxes(0, 1), right.swapaxes(0, 1)),
        ]
    )
    has_bare_edges = steps.size > 0 and np.median(steps) > _MIN_STEP
    return Marks(not has_bare_edges, bool(_measure_spread(image, uv) > _MIN_SPREAD))


def _measure_steps(image: GreyImage, uv: Array, across: Array) -> Array:
    """Measure the steps (n,) across the edges from each corner to the next in its row, over that of
    the squares.

    Args:
        image: (h, w) grey levels.
        uv: (rows, cols, 2) corners, px; NaN where missing.
        across: (rows, cols, 2) steps to the next row, px.
    """
    along, across = uv[:, 1:] - uv[:, :-1], (across[:, 1:] + across[:, :-1]) / 2
    seen = np.isfinite(along + across).all(axis=2)
    middle, along, across = ((uv[:, 1:] + uv[:, :-1]) / 2)[seen], along[seen], across[seen]

    def measure_difference(places: Array) -> Array:
        offset = places[:, :1] * along[:, None] + places[:, 1:] * across[:, None]
        sides = [sample_image(image, middle[:, None] + sign * offset) for sign in (1, -1)]
        return np.asarray((sides[0] - sides[1]).mean(axis=1))

    step, contrast = measure_difference(_BESIDE_EDGE), measure_difference(_BESIDE_DOT)
    return np.asarray(step[contrast != 0] / contrast[contrast != 0])


def _measure_spread(image: GreyImage, uv: Array) -> float:
    """Measure the second largest standard deviation of the grey levels in squares of one colour,
    over the contrast; infinite if that cannot be measured.

    Args:
        image: (h, w) grey levels.
        uv: (rows, cols, 2) corners, px; NaN where missing.
    """
    quads = np.stack([uv[:-1, :-1], uv[:-1, 1:], uv[1:, 1:], uv[1:, :-1]], axis=2)
    seen = np.isfinite(quads).all(axis=(2, 3))
    a, b = _INSIDE.T
    weights = np.column_stack([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b])
    levels = sample_image(image, np.einsum("sc,nci->nsi", weights, quads[seen]))
    is_even = np.indices(seen.shape).sum(axis=0)[seen] % 2 == 0
    colours = [levels[is_even], levels[~is_even]]
    if min(map(len, colours)) < 2:
        return np.inf
    contrast = abs(np.subtract(*(np.median(each) for each in colours)))
    spread = max(np.sort(each.std(axis=1))[-2] for each in colours)
    return float(spread / contrast) if contrast > 0 else np.inf
