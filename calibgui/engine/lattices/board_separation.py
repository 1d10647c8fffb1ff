"""Take apart what the search has joined: boards on two walls, and a board and what surrounds it.

Neighbours hang together wherever edges lead from one to the next: over the crease between two walls
of a room with a board on each, from a board into another that lies over a part of it, and into a
pattern around it. But only the corners of one flat board lie on one smooth grid map. A lattice that
does not is cut where two maps follow its parts many times better than one follows all: between two
lines, along a line of what looks like corners where the squares of both boards meet, or around what
one of the maps expects. These two maps are rigid, a homography under a lens: walls are flat, while
a board that is curled, or that a shaken camera shows in waves, would else be cut, since a map that
bends as well follows any few lines.

What a board has grown into shows otherwise. From the largest rectangle without a gap that lies on
one map on, line by line, those corners are taken that lie where the map of the others expects them.
What this leaves is a board if it lies on a smooth map and is seen to end on all four sides.

The troubles "crease" and "screen" of ``tests.benchmarks.corner_troubles`` fixed the limits: over a
crease corners are 0.07 to 0.2 steps off one map and 0.002 to 0.007 off two; of one board they are
at most 0.02 off one, and two maps follow it no better than by half.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, BoolArray, GreyImage, compute_lengths
from calibgui.engine.features.lattice import (
    MIN_CORNERS,
    MIN_LINES,
    Lattice,
    add_border,
    crop_lattice,
    drop_isolated_and_crop,
    is_large_enough,
    list_full_rectangles,
)
from calibgui.engine.lattices import grid_map
from calibgui.engine.lattices.board_ends import find_ends
from calibgui.engine.lattices.numbering import turn_lattice

_MAX_JOINT_MISFIT = 0.03
"""Rms distance of the corners from one smooth grid map up to which they are left as they are,
steps."""
_MAX_CORE_DEVIATION = 0.1
"""Greatest distance of a corner from where the rigid map of those beside it expects it, steps.
The trouble "pile" fixed it: at 0.2 a board took corners of another that lies over it."""
_MAX_MISFIT_RATIO = 0.15
"""Greatest rms distance from the maps of two parts, over that from one map, at which a lattice
is cut."""
_MAX_EXCESS_MISFIT = 1.2
"""Rms distance of a cut, over that of the best, up to which the number of corners decides."""
_MAX_LINES = 20
"""Number of lines along the shorter side beyond which no cut is tried: it bounds the time."""
MAX_DEVIATION = 0.2
"""Greatest distance of a corner from its neighbours' prediction, steps."""

MapFit = Callable[[Array, Array], grid_map.GridMap | grid_map.RadialHomography]
"""A function that fits a map to cells (n, 2) that are seen at (n, 2) px."""
_NEGLIGIBLE_MISFIT = 1e-6
"""Rms distance from a grid map, steps, below which nothing but rounding tells maps apart."""


def separate_boards(lattice: Lattice, image: GreyImage) -> list[Lattice]:
    """Separate a lattice into parts that may be boards; the lattice alone if it may be one itself,
    or if nothing tells parts.

    Args:
        lattice: corners good to 2 px.
        image: (h, w) grey levels in which they were found.
    """
    misfit = _measure_misfit([lattice])
    if misfit <= _MAX_JOINT_MISFIT:
        return [lattice]
    max_deviation = MAX_DEVIATION
    board = _find_core(lattice, grid_map.fit_cells, max_deviation)
    is_board = (
        is_large_enough(board)
        and _measure_misfit([board]) <= _MAX_JOINT_MISFIT
        and all(find_ends(board, image))
    )
    if is_board and len(lattice) - len(board) < MIN_CORNERS:
        return [board]
    if parts := _cut_at_crease(lattice, misfit):
        # A board on a floor may be neither of two parts, if these are the floor on both its sides.
        rest = _subtract(_subtract(lattice, parts[0]), parts[1])
        pieces = [*parts, rest] if is_large_enough(rest) else parts
        return [board for piece in pieces for board in separate_boards(piece, image)]
    return [board if is_board else lattice]


def _measure_misfit(parts: list[Lattice], fit_map: MapFit = grid_map.fit_cells) -> float:
    """Measure the rms distance of corners from the maps of their parts, steps."""
    offsets = [_measure_offsets(part, fit_map) for part in parts]
    return float(np.sqrt(np.mean(np.concatenate(offsets) ** 2)))


def _measure_offsets(lattice: Lattice, fit_map: MapFit) -> Array:
    """Measure the distances (n,) of a lattice's corners from their map, steps of the map: those
    between the corners are 0 where two of them coincide. They are not finite where the map's are
    0, too."""
    found = lattice.found
    uv, cells = lattice.uv.copy(), np.argwhere(found).astype(np.float64)
    uv[found] = fit_map(cells, lattice.uv[found]).locate(cells)
    off = compute_lengths(lattice.uv[found] - uv[found])
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(off / Lattice(uv, lattice.dark).spacing()[found])


def _cut_at_crease(lattice: Lattice, misfit: float) -> tuple[Lattice, Lattice] | None:
    """Cut a lattice where two rigid maps follow the parts best; None if they do not follow them
    many times better than one smooth map, by which its corners are `misfit` steps off.

    Of cuts that are about as good the one that leaves out the fewest corners is taken. If one map
    follows the corners of both parts as those of one board, what they leave out is drawn aside, as
    by the edge of a shadow, and there is no crease.
    """
    cuts = [
        (_measure_misfit(list(parts), grid_map.fit_radial_homography), parts)
        for parts in _list_cuts(lattice)
    ]
    # A map of corners that coincide, as in textures, tells no misfit.
    good = [
        (off, parts)
        for off, parts in cuts
        if off <= _MAX_MISFIT_RATIO * misfit
        and _measure_misfit([_join(lattice, parts)]) > _MAX_JOINT_MISFIT
    ]
    if not good:
        return None
    least = min(off for off, _ in good)
    limit = _MAX_EXCESS_MISFIT * max(least, _NEGLIGIBLE_MISFIT)
    best = [parts for off, parts in good if off <= limit]
    return max(best, key=lambda parts: len(parts[0]) + len(parts[1]))


def _list_cuts(lattice: Lattice) -> Iterator[tuple[Lattice, Lattice]]:
    """List the pairs of lattices, large enough for boards, on both sides of a cut between two lines
    or along one, which is then left out, and the rigid core and that of what is around it."""
    core = _find_rigid_core(lattice)
    around = _subtract(lattice, core)
    if is_large_enough(core) and is_large_enough(around):
        other = _find_rigid_core(around)
        if is_large_enough(other):
            yield core, other
    if min(lattice.shape) > _MAX_LINES:
        return
    for quarters in (0, 1):
        turned = turn_lattice(lattice, quarters)
        rows = turned.shape[0]
        for row in range(MIN_LINES, rows - MIN_LINES + 1):
            for left_out in (0, 1):
                parts = _split_lattice(turned, row, row + left_out)
                if all(map(is_large_enough, parts)):
                    yield turn_lattice(parts[0], -quarters), turn_lattice(parts[1], -quarters)


def _join(lattice: Lattice, parts: tuple[Lattice, Lattice]) -> Lattice:
    """Return the corners of a lattice that are in one of two parts of it."""
    return lattice.select(
        np.logical_or.reduce([np.isin(lattice.uv[..., 0], part.uv[..., 0]) for part in parts])
        & lattice.found
    )


def _subtract(lattice: Lattice, part: Lattice) -> Lattice:
    """Return what is left of a lattice without the corners of a part of it."""
    is_left = ~np.isin(lattice.uv[..., 0], part.uv[..., 0])
    return drop_isolated_and_crop(lattice.select(is_left & lattice.found))


def _split_lattice(lattice: Lattice, end: int, start: int) -> tuple[Lattice, Lattice]:
    """Split a lattice into its rows before `end` and those from `start` on."""
    return (
        drop_isolated_and_crop(Lattice(lattice.uv[:end], lattice.dark)),
        drop_isolated_and_crop(Lattice(lattice.uv[start:], lattice.dark ^ bool(start % 2))),
    )


def _find_rigid_core(lattice: Lattice) -> Lattice:
    """Find the core on a map that does not bend: one that does would grow on into another board
    that is turned almost alike."""
    limit = _MAX_CORE_DEVIATION
    return _find_core(lattice, grid_map.fit_radial_homography, limit)


def _find_core(lattice: Lattice, fit_map: MapFit, max_deviation: float) -> Lattice:
    """Find the corners that lie where the map of those of the largest rectangle without a gap that
    lies on one, and then of all found so far, expects them to `max_deviation` steps, line by
    line."""
    max_misfit = _MAX_JOINT_MISFIT
    found, spacing = lattice.found, lattice.spacing()
    core = np.zeros(lattice.shape, dtype=np.bool_)
    rectangles = [
        rectangle
        for mask in (found, _find_even_corners(lattice))
        for rectangle in list_full_rectangles(mask)
    ]
    for row, col, rows, cols in sorted(rectangles, key=lambda each: -each[2] * each[3]):
        core[:] = False
        core[row : row + rows, col : col + cols] = True
        if _measure_misfit([lattice.select(core)], fit_map) <= max_misfit:
            break
    for _ in range(sum(lattice.shape)):
        # What does not hang together with the core, within its rows and columns, is near by chance.
        reached = opencv.dilate_image(core.astype(np.float32), np.ones((3, 3), np.bool_)) > 0
        near = found & reached
        expected = fit_map(np.argwhere(core).astype(np.float64), lattice.uv[core]).locate(
            np.argwhere(near).astype(np.float64)
        )
        off = compute_lengths(lattice.uv[near] - expected) / np.nanmedian(spacing[core])
        near[near] = off < max_deviation
        if np.array_equal(near, core):
            break
        core = near
        if not core.any():
            break
    return crop_lattice(lattice.select(core))


def _find_even_corners(lattice: Lattice) -> BoolArray:
    """Find the corners (rows, cols) in the middle of their four neighbours, as inside of a board:
    at its end, the lattice goes on in another pattern's steps."""
    uv = add_border(lattice.uv, 1)
    pairs = ((uv[1:-1, :-2], uv[1:-1, 2:]), (uv[:-2, 1:-1], uv[2:, 1:-1]))
    limit = _MAX_CORE_DEVIATION * lattice.spacing()
    return np.logical_and.reduce(
        [compute_lengths(lattice.uv - (one + other) / 2) < limit for one, other in pairs]
    )
