"""Fill a lattice's holes and extend its borders, one line of corners at a time.

An empty place next to the lattice is predicted from its neighbours. It is filled by the
saddle point within 0.3 steps that looks most as the place requires (`appearance`). At the true
border of a board none does, since beyond it three or four sectors are alike.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.checkerboard.corner_template import Look, typical
from calibgui.engine.detection.lattice import (
    DEVIATION,
    MIN_CORNERS,
    REACH,
    Lattice,
    axes,
    bordered,
    in_steps,
    predict,
    trim,
)

_TRIED = 6
"""How many saddle points near a prediction are looked at."""
_ACROSS = 0.2
"""Greatest distance from where the whole lattice expects a corner beyond a gap, steps."""
_NEW = 1.2
"""Growth at which the look of a lattice's corners is seen anew."""
_LITTLE, _IDLE = 1.02, 8
"""Growth in a round that is little, and how many such rounds there may be: a board grows by whole
lines, only textures by straggling corners on and on."""


def grow(
    lattice: Lattice,
    nearby: Places,
    beyond: Places,
    hopeless: Callable[[Lattice], bool],
    max_shape: int = 200,
) -> Lattice:
    """`lattice` with every hole and border filled that the saddle points allow.

    Args:
        lattice: to start from.
        nearby: saddle points, which may fill a place beside the lattice's corners.
        beyond: junctions, which may fill a place beyond a gap.
        hopeless: whether it is not worth going on.
        max_shape: rows or columns at which growth ends.
    """
    look, known = typical(lattice, nearby.smooth), len(lattice)
    idle = 0
    while idle < _IDLE:
        if len(lattice) > _NEW * known:
            if hopeless(lattice):
                break
            look, known = typical(lattice, nearby.smooth), len(lattice)
        grown = _fill(lattice, 1, predict, nearby, DEVIATION, look)
        if grown is None and beyond.exceed(lattice):
            grown = _fill(lattice, REACH, _from_sheet, beyond, _ACROSS, look)
        if grown is None or max(grown.shape) > max_shape:
            break
        idle += len(grown) < _LITTLE * len(lattice)
        lattice = grown
    return lattice


class Places:
    """Points of an image by their place."""

    def __init__(self, smooth: GreyImage, uv: Array) -> None:
        self.smooth, self.uv = smooth, uv
        self._tree = scipy.spatial.cKDTree(uv) if len(uv) else None

    def exceed(self, lattice: Lattice) -> bool:
        """Whether there are others than the corners of `lattice`."""
        if self._tree is None:
            return False
        _, corners = self._tree.query(lattice.uv[lattice.found])
        return len(np.unique(corners)) < len(self.uv)

    def near(self, uv: Array) -> tuple[IntArray, IntArray]:
        """Pairs (m,), (m,) of a query in `uv` (n, 2) and a point that is among the nearest."""
        if self._tree is None:
            return np.empty(0, np.int64), np.empty(0, np.int64)
        tried = min(_TRIED, len(self.uv))
        _, index = self._tree.query(uv, np.arange(1, tried + 1))
        return np.repeat(np.arange(len(uv)), tried), np.asarray(index).ravel()


def _from_sheet(uv: Array) -> Array:
    """Where the whole lattice expects the places of `uv` (rows, cols, 2), if it is large."""
    lattice = Lattice(uv, dark=True)
    expected = np.full_like(uv, np.nan)
    if len(lattice) >= MIN_CORNERS:
        missing = ~lattice.found
        expected[missing] = grid_map.fit_grid_map(lattice).at(
            np.argwhere(missing).astype(np.float64)
        )
    return expected


def _fill(
    lattice: Lattice,
    border: int,
    expected: Callable[[Array], Array],
    places: Places,
    deviation: float,
    look: Look,
) -> Lattice | None:
    """The lattice with what fits into its empty places and has the `look`, up to `border` steps
    outside too, within `deviation` steps of where it is `expected`; None where nothing does."""
    uv = bordered(lattice.uv, border)
    framed = Lattice(uv, lattice.dark)
    predicted = expected(uv)
    right, down = axes(uv)
    known = np.isfinite(predicted + right + down).all(axis=2)
    rows, cols = np.nonzero(~framed.found & known)
    place, index = places.near(predicted[rows, cols])
    r, c = rows[place], cols[place]
    offset = places.uv[index] - predicted[r, c]
    near = in_steps(offset, right[r, c], down[r, c]) < deviation
    index, r, c = index[near], r[near], c[near]
    free = _free(places.uv[index], right[r, c], down[r, c], lattice)
    index, r, c = index[free], r[free], c[free]
    if not len(index):
        return None
    dark = framed.dark ^ ((r + c) % 2 == 1)
    fits, gap = look.shown(places.smooth, places.uv[index], right[r, c], down[r, c], dark)
    order = np.flatnonzero(fits)[np.argsort(gap[fits], kind="stable")]  # the best is written last
    uv[r[order], c[order]] = places.uv[index[order]]
    filled = trim(Lattice(uv, framed.dark))
    return filled if filled is not None and len(filled) > len(lattice) else None


def _free(uv: Array, right: Array, down: Array, lattice: Lattice) -> BoolArray:
    """(n,) which of the points are no corners of `lattice`, by half a step."""
    distance, _ = scipy.spatial.cKDTree(lattice.uv[lattice.found]).query(uv)
    step = np.minimum(np.linalg.norm(right, axis=1), np.linalg.norm(down, axis=1))
    return np.asarray(distance > step / 2)
