"""A lattice of corners, and where its neighbours expect each of its places.

Everything between the graph of neighbours and the numbered board works on lattices: arrays of
positions by row and column with holes. Perspective and lenses bend them, so all that is said of a
place is taken from the few places around it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
import scipy

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, BoolArray, IntArray, compute_lengths

DIRECTIONS = np.array([(0, 1), (1, 0), (0, -1), (-1, 0)])
"""(4, 2) steps in row and column of the board's directions 0 to 3."""
MAX_DEVIATION = 0.3
"""Greatest distance of a corner from its neighbours' prediction, steps of the lattice; a corner
farther away is a stray. A plausibility limit."""
MIN_LINES = 3
"""Number of rows, and of columns, of the smallest board, whatever its pattern."""
MIN_CORNERS = MIN_LINES**2
"""Number of corners of the smallest board."""
MIN_SCATTERED_CORNERS = 12
"""Number of corners from which on a board may have gaps anywhere; fewer have to fill the smallest
board: ragged parts of textures do not."""
MAX_GAP = 3
"""Width of the widest gap over which steps and predictions of a lattice are carried, steps."""
_MAX_SHARED_CORNERS = 0.25
"""Share of its corners that a lattice may have in common with a larger one before it counts as
part of that: the pattern of a floor that goes on behind a board may catch some of its."""
_MIN_FILLED_SHARE, _MIN_SCATTERED = 0.25, 30
"""Least share of the places within its rows and columns that a lattice fills, and the number of
corners from which on that is asked. Those of boards, partly hidden or with tags in their squares,
fill 0.39 or more from when they begin to grow; of halftones, grown, 0.1 to 0.2."""


@dataclass(frozen=True, eq=False, slots=True)
class Lattice:
    """Corners in rows and columns of a board whose size and origin are still open."""

    uv: Array
    """(rows, cols, 2) px, NaN where nothing was found."""
    dark: bool
    """True if the square before cell (0, 0), above its row and left of its column, is dark."""
    _steps: tuple[Array, Array] | None = field(default=None, init=False, repr=False)
    """The steps to the next column and row, once they were asked for; see `steps`."""
    _found: BoolArray | None = field(default=None, init=False, repr=False)
    """The mask of the corners, once it was asked for; it is not handed out."""

    @property
    def shape(self) -> tuple[int, int]:
        return self.uv.shape[0], self.uv.shape[1]

    @property
    def found(self) -> BoolArray:
        """(rows, cols) mask of the corners; a new array each time."""
        return self._mask_corners().copy()

    def __len__(self) -> int:
        return int(np.count_nonzero(self._mask_corners()))

    def _mask_corners(self) -> BoolArray:
        """Return the mask of the corners, made once, that must not be changed."""
        if self._found is None:
            object.__setattr__(self, "_found", np.isfinite(self.uv[..., 0]))
        assert self._found is not None
        return self._found

    def select(self, mask: BoolArray) -> Lattice:
        """Return the lattice with the corners under a mask (rows, cols) only: itself, with
        the steps that it knows, if these are all."""
        if mask[self._mask_corners()].all():
            return self
        return Lattice(np.where(mask[..., None], self.uv, np.nan), self.dark)

    def steps(self) -> tuple[Array, Array]:
        """Return the steps (rows, cols, 2) px to the next column and to the next row, estimated
        once: see `estimate_steps`."""
        if self._steps is None:
            object.__setattr__(self, "_steps", estimate_steps(self.uv))
        assert self._steps is not None
        return self._steps

    def with_steps(self, right: Array, down: Array) -> Lattice:
        """Return the lattice with steps (rows, cols, 2) px that something else tells than its
        corners, where these are few."""
        lattice = Lattice(self.uv, self.dark)
        object.__setattr__(lattice, "_steps", (right, down))
        return lattice

    def spacing(self) -> Array:
        """Return (rows, cols) the shorter of the steps to the neighbours, px; NaN where unknown."""
        right, down = self.steps()
        return np.fmin(compute_lengths(right), compute_lengths(down))


def trim_lattice(lattice: Lattice) -> Lattice | None:
    """Drop the corners off their neighbours' prediction, those that are isolated and empty border
    lines; return None if no full cell is left."""
    lattice = lattice.select(~_find_strays(lattice))
    return drop_isolated_and_crop(lattice) if _find_closed_cells(lattice.found).any() else None


def _find_strays(lattice: Lattice) -> BoolArray:
    """Return a mask (rows, cols) of the corners off their neighbours' prediction."""
    found = lattice.found
    offset = lattice.uv[found] - predict_places(lattice.uv)[found]
    right, down = (step[found] for step in lattice.steps())
    found[found] = measure_in_steps(offset, right, down) > MAX_DEVIATION
    return found


def find_closed_corners(lattice: Lattice) -> BoolArray:
    """Return a mask (rows, cols) of the corners that close a cell with three others."""
    found = lattice.found
    cell = _find_closed_cells(found)
    closed = np.zeros_like(found)
    for row in (np.s_[:-1], np.s_[1:]):
        for col in (np.s_[:-1], np.s_[1:]):
            closed[row, col] |= cell
    return closed


def _find_closed_cells(found: BoolArray) -> BoolArray:
    """Return a mask (rows - 1, cols - 1) of the cells whose four corners are `found`
    (rows, cols)."""
    return np.asarray(found[:-1, :-1] & found[1:, :-1] & found[:-1, 1:] & found[1:, 1:])


def is_large_enough(lattice: Lattice) -> bool:
    """Return whether a lattice has corners and lines enough for a board."""
    if min(lattice.shape) < MIN_LINES or len(lattice) < MIN_CORNERS:
        return False
    return len(lattice) >= MIN_SCATTERED_CORNERS or _has_full_block(lattice.found)


def compute_filled_share(lattice: Lattice) -> float:
    """Return the share of the places within its rows and columns that a lattice fills."""
    return len(lattice) / (lattice.shape[0] * lattice.shape[1])


def is_scattered(lattice: Lattice, min_filled: float = _MIN_FILLED_SHARE) -> bool:
    """Return whether many corners fill so little of their rows and columns as those of no board."""
    return len(lattice) >= _MIN_SCATTERED and compute_filled_share(lattice) < min_filled


def _has_full_block(found: BoolArray) -> bool:
    """Return whether the corners `found` (rows, cols) fill the smallest board somewhere."""
    blocks = np.lib.stride_tricks.sliding_window_view(found, (MIN_LINES, MIN_LINES))
    return bool(blocks.all(axis=(2, 3)).any())


def list_full_rectangles(found: BoolArray) -> Iterator[tuple[int, int, int, int]]:
    """List the widest full rectangle of each height in a mask `found` (rows, cols): first row and
    column, rows and columns."""
    full = np.ones(found.shape, dtype=np.bool_)
    column = np.arange(1, found.shape[1] + 1)
    for height in range(1, len(found) + 1):
        # Rows from which on the columns are full over the height, and how many such to the left.
        full = full[: len(found) - height + 1] & found[height - 1 :]
        run = column - np.maximum.accumulate(np.where(full, 0, column), axis=1)
        row, end = np.unravel_index(np.argmax(run), run.shape)
        width = int(run[row, end])
        if width == 0:
            return
        yield int(row), int(end) - width + 1, height, width


def drop_isolated_and_crop(lattice: Lattice) -> Lattice:
    """Drop the corners that are isolated, see `drop_isolated`, and empty border lines."""
    return crop_lattice(drop_isolated(lattice))


def drop_isolated(lattice: Lattice) -> Lattice:
    """Drop the corners that are too far from all others for the steps there to be known."""
    while True:
        right, down = lattice.steps()
        has_steps = np.isfinite(right[..., 0] + down[..., 0])
        if has_steps[lattice.found].all():
            return lattice
        lattice = lattice.select(has_steps)


def crop_lattice(lattice: Lattice) -> Lattice:
    """Drop empty border lines."""
    if not lattice.found.any():
        return Lattice(lattice.uv[:0, :0], lattice.dark)
    rows, cols = (np.flatnonzero(lattice.found.any(axis=axis)) for axis in (1, 0))
    r, c = int(rows[0]), int(cols[0])
    if (len(rows), len(cols)) == lattice.shape:
        return lattice
    dark = lattice.dark ^ bool((r + c) % 2)
    return Lattice(lattice.uv[r : rows[-1] + 1, c : cols[-1] + 1], dark)


def cut_middle(lattice: Lattice, most: int) -> Lattice:
    """Cut the middle out of a lattice, `most` rows and columns at most, less isolated corners."""
    (top, left), (bottom, right) = (
        [max((lines - most) // 2, 0) for lines in lattice.shape],
        [min((lines + most) // 2, lines) for lines in lattice.shape],
    )
    dark = lattice.dark ^ bool((top + left) % 2)
    return drop_isolated_and_crop(Lattice(lattice.uv[top:bottom, left:right], dark))


@kernels.with_kernel("lattice", "predict_places")
def predict_places(uv: Array) -> Array:
    """Predict where its neighbours expect each place of a lattice, found or not.

    The prediction is the mean of the midpoints of opposite neighbours or, where there are none, of
    the extrapolations p_1 + (p_1 - p_2) + (p_1 - 2 p_2 + p_3) / 2 of the lines that end there
    (half the quadratic's second difference: all of it would amplify noise sevenfold).

    Args:
        uv: (rows, cols, 2) px, NaN where nothing was found.

    Returns:
        Predictions (rows, cols, 2) px, NaN where there is no basis.
    """
    shift = make_shifter(uv, 3)
    extrapolated = []
    for step in DIRECTIONS:
        p1, p2, p3 = (shift(k * step) for k in (1, 2, 3))
        slope = p1 - p2
        bend = np.where(np.isnan(p3), 0.0, slope - (p2 - p3))
        extrapolated.append(p1 + slope + 0.5 * bend)
    middle = [(shift(step) + shift(-step)) / 2 for step in DIRECTIONS[:2]]
    inner, outer = _average_known(middle), _average_known(extrapolated)
    return np.where(np.isnan(inner), outer, inner)


def measure_in_steps(offset: Array, right: Array, down: Array) -> Array:
    """Measure an offset in the local basis of lattice steps.

    Args:
        offset: (..., 2) px.
        right: (..., 2) step to the next column, px.
        down: (..., 2) step to the next row, px.

    Returns:
        The larger coordinate (...,), steps; NaN where a step is unknown, infinite or NaN where the
        steps are parallel.
    """
    det = right[..., 0] * down[..., 1] - right[..., 1] * down[..., 0]
    a = abs(offset[..., 0] * down[..., 1] - offset[..., 1] * down[..., 0])
    b = abs(right[..., 0] * offset[..., 1] - right[..., 1] * offset[..., 0])
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.maximum(a, b) / abs(det))


def _average_known(values: list[Array]) -> Array:
    """Return the mean over the list of what is finite, NaN where nothing is."""
    stack = np.stack(values)
    finite = np.isfinite(stack)
    count = finite.sum(axis=0)
    total = np.where(finite, stack, 0.0).sum(axis=0)
    return np.divide(total, count, out=np.full_like(total, np.nan), where=count > 0)


def estimate_steps(uv: Array) -> tuple[Array, Array]:
    """Estimate the steps to the next column and to the next row at each place of a lattice.

    They are taken from the nearest neighbours on the line, else from those two places away, else
    from the mean of the steps of the four places around, from up to `MAX_GAP` places away.

    Args:
        uv: (rows, cols, 2) px, NaN where nothing was found.

    Returns:
        Steps (rows, cols, 2) and (rows, cols, 2) px, NaN where they are not known.
    """
    return _estimate_steps(uv, MAX_GAP)


@kernels.with_kernel("lattice", "estimate_steps")
def _estimate_steps(uv: Array, reach: int) -> tuple[Array, Array]:
    """Estimate steps from up to `reach` places away: see `estimate_steps`."""
    steps = []
    shift = make_shifter(uv, 2)
    for step in (DIRECTIONS[0], DIRECTIONS[1]):
        near = _average_known([shift(step) - uv, uv - shift(-step)])
        far = _average_known([(shift(2 * step) - uv) / 2, (uv - shift(-2 * step)) / 2])
        around = (shift(step) - shift(-step)) / 2
        estimate = np.where(np.isnan(near), np.where(np.isnan(around), far, around), near)
        for _ in range(reach):
            estimate = _spread_steps(estimate)
        steps.append(estimate)
    return steps[0], steps[1]


def _spread_steps(values: Array) -> Array:
    """Fill the unknown of `values` (rows, cols, 2) from the four places around."""
    unknown = np.isnan(values)
    if not unknown.any():
        return values
    beside = make_shifter(values, 1)
    return np.where(unknown, _average_known([beside(step) for step in DIRECTIONS]), values)


def make_shifter(uv: Array, reach: int) -> Callable[[IntArray], Array]:
    """Return a function that shifts a lattice by rows and columns.

    Args:
        uv: (rows, cols, 2) px.
        reach: greatest number of places that it will be shifted by.

    Returns:
        A function that takes (drow, dcol) and returns (rows, cols, 2) what stands so many places
        away from each place, NaN outside.
    """
    around = add_border(uv, reach)
    rows, cols = uv.shape[:2]

    def at(step: IntArray) -> Array:
        r, c = reach + step
        return around[r : r + rows, c : c + cols]

    return at


def add_border(uv: Array, width: int) -> Array:
    """Return `uv` (rows, cols, 2) with a border of NaN of the given width."""
    rows, cols = uv.shape[:2]
    result = np.full((rows + 2 * width, cols + 2 * width, 2), np.nan)
    result[width : width + rows, width : width + cols] = uv
    return result


def is_part(lattice: Lattice, larger: Lattice) -> bool:
    """Return whether a good share of a lattice's corners are another's, to half a step."""
    distance, _ = scipy.spatial.cKDTree(larger.uv[larger.found]).query(lattice.uv[lattice.found])
    shared = np.mean(distance < lattice.spacing()[lattice.found] / 2)
    return bool(shared > _MAX_SHARED_CORNERS)
