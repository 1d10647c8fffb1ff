"""A lattice of corners, and what its neighbours say of each of its places."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, BoolArray, IntArray

STEPS = np.array([(0, 1), (1, 0), (0, -1), (-1, 0)])
"""(row, col) steps of the board's directions 0 to 3."""
DEVIATION = 0.3
"""Greatest distance from the neighbours' prediction, in steps of the lattice."""
MIN_CORNERS = 12
"""Of a board."""
MIN_LINES = 3
"""Rows and columns of a board."""
REACH = 3
"""Widest gap over which what is known of a lattice is carried, in steps."""


@dataclass(frozen=True, eq=False, slots=True)
class Lattice:
    """Junctions placed on a board whose size and origin are still open."""

    uv: Array
    """(rows, cols, 2) px, NaN where nothing was found."""
    dark: bool
    """Whether the square before cell (0, 0), above its row and left of its column, is dark."""

    @property
    def shape(self) -> tuple[int, int]:
        return self.uv.shape[0], self.uv.shape[1]

    @property
    def found(self) -> BoolArray:
        """(rows, cols) where there is a corner."""
        return np.isfinite(self.uv[..., 0])

    def __len__(self) -> int:
        return int(np.count_nonzero(self.found))

    def under(self, mask: BoolArray) -> Lattice:
        """The lattice's corners under a mask (rows, cols)."""
        return Lattice(np.where(mask[..., None], self.uv, np.nan), self.dark)

    def spacing(self) -> Array:
        """(rows, cols) shorter of the steps to the neighbours, px; NaN where nothing was found."""
        right, down = axes(self.uv)
        return np.fmin(np.linalg.norm(right, axis=2), np.linalg.norm(down, axis=2))


def trim(lattice: Lattice) -> Lattice | None:
    """The lattice without corners off their neighbours' prediction; None without a full cell."""
    lattice = lattice.under(~_strays(lattice))
    found = lattice.found
    cell = found[:-1, :-1] & found[1:, :-1] & found[:-1, 1:] & found[1:, 1:]
    return supported(lattice) if cell.any() else None


def _strays(lattice: Lattice) -> BoolArray:
    """(rows, cols) where there is a corner off its neighbours' prediction."""
    found = lattice.found
    offset = lattice.uv[found] - predict(lattice.uv)[found]
    right, down = (step[found] for step in axes(lattice.uv))
    found[found] = in_steps(offset, right, down) > DEVIATION
    return found


def large_enough(lattice: Lattice) -> bool:
    """Whether it may be a board."""
    return len(lattice) >= MIN_CORNERS and min(lattice.shape) >= MIN_LINES


def supported(lattice: Lattice) -> Lattice:
    """The lattice without corners whose steps are not known, and without empty border lines."""
    return crop(with_steps(lattice))


def with_steps(lattice: Lattice) -> Lattice:
    """The lattice without corners too far from all others for the steps there to be known."""
    while True:
        right, down = axes(lattice.uv)
        known = np.isfinite(right[..., 0] + down[..., 0])
        if known[lattice.found].all():
            return lattice
        lattice = lattice.under(known)


def crop(lattice: Lattice) -> Lattice:
    """The lattice without empty border lines."""
    if not lattice.found.any():
        return Lattice(lattice.uv[:0, :0], lattice.dark)
    rows, cols = (np.flatnonzero(lattice.found.any(axis=axis)) for axis in (1, 0))
    r, c = int(rows[0]), int(cols[0])
    dark = lattice.dark ^ bool((r + c) % 2)
    return Lattice(lattice.uv[r : rows[-1] + 1, c : cols[-1] + 1], dark)


def predict(uv: Array) -> Array:
    """Where its neighbours expect each place of a lattice `uv` (rows, cols, 2), found or not.

    The mean of the midpoints of opposite neighbours or, where there are none, of the
    extrapolations p_1 + (p_1 - p_2) + (p_1 - 2 p_2 + p_3) / 2 of the lines that end there
    (half the quadratic's second difference: all of it would amplify noise sevenfold).

    Returns:
        Predictions (rows, cols, 2) px, NaN where there is no basis.
    """
    if kernels.COMPILED:
        from calibgui.engine.kernels import lattice

        return lattice.predict(uv)
    shift = shifted(uv, 3)
    extrapolated = []
    for step in STEPS:
        p1, p2, p3 = (shift(k * step) for k in (1, 2, 3))
        slope = p1 - p2
        bend = np.where(np.isnan(p3), 0.0, slope - (p2 - p3))
        extrapolated.append(p1 + slope + 0.5 * bend)
    middle = [(shift(step) + shift(-step)) / 2 for step in STEPS[:2]]
    inner, outer = _nanmean(middle), _nanmean(extrapolated)
    return np.where(np.isnan(inner), outer, inner)


def in_steps(offset: Array, right: Array, down: Array) -> Array:
    """Largest coordinate (...,) of `offset` (..., 2) px in the local basis of lattice steps.

    NaN where a step is unknown; infinite or NaN where the steps are parallel.
    """
    det = right[..., 0] * down[..., 1] - right[..., 1] * down[..., 0]
    a = offset[..., 0] * down[..., 1] - offset[..., 1] * down[..., 0]
    b = right[..., 0] * offset[..., 1] - right[..., 1] * offset[..., 0]
    largest = np.maximum(abs(a), abs(b))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(largest / abs(det))


def _nanmean(values: list[Array]) -> Array:
    """Mean over the list where finite, NaN where nothing is."""
    stack = np.stack(values)
    finite = np.isfinite(stack)
    count = finite.sum(axis=0)
    total = np.where(finite, stack, 0.0).sum(axis=0)
    return np.divide(total, count, out=np.full_like(total, np.nan), where=count > 0)


def axes(uv: Array) -> tuple[Array, Array]:
    """Steps (rows, cols, 2) to the next column and to the next row of a lattice, px.

    From the nearest neighbours on the line, else from those two places away, else the mean of
    the steps of the four places around, from up to `REACH` places away; NaN beyond.
    """
    if kernels.COMPILED:
        from calibgui.engine.kernels import lattice

        return lattice.axes(uv, REACH)
    steps = []
    shift = shifted(uv, 2)
    for step in (STEPS[0], STEPS[1]):
        near = _nanmean([shift(step) - uv, uv - shift(-step)])
        far = _nanmean([(shift(2 * step) - uv) / 2, (uv - shift(-2 * step)) / 2])
        around = (shift(step) - shift(-step)) / 2
        own = np.where(np.isnan(near), np.where(np.isnan(around), far, around), near)
        for _ in range(REACH):
            own = _spread(own)
        steps.append(own)
    return steps[0], steps[1]


def _spread(values: Array) -> Array:
    """`values` (rows, cols, 2), the unknown ones from the four places around."""
    unknown = np.isnan(values)
    if not unknown.any():
        return values
    beside = shifted(values, 1)
    return np.where(unknown, _nanmean([beside(step) for step in STEPS]), values)


def shifted(uv: Array, reach: int) -> Callable[[IntArray], Array]:
    """What stands (drow, dcol) places away from each place of `uv` (rows, cols, 2), NaN outside;
    for steps of up to `reach`."""
    around = bordered(uv, reach)
    rows, cols = uv.shape[:2]

    def at(step: IntArray) -> Array:
        r, c = reach + step
        return around[r : r + rows, c : c + cols]

    return at


def bordered(uv: Array, width: int) -> Array:
    """`uv` (rows, cols, 2) with a border of NaN."""
    rows, cols = uv.shape[:2]
    result = np.full((rows + 2 * width, cols + 2 * width, 2), np.nan)
    result[width : width + rows, width : width + cols] = uv
    return result
