"""Take apart what the search has joined: boards on two walls, and a board and what surrounds it.

Neighbours hang together wherever edges lead from one to the next: over the crease between two walls
of a room with a board on each, and from a board into a pattern around it. But only the corners of
one flat board lie on one smooth grid map. A lattice that does not is cut where two maps follow its
parts many times better than one follows all: between two lines, or along a line of what looks like
corners where the squares of both boards meet. If no cut does that, its ragged lines are left out,
provided that what remains lies on a smooth map and is seen to end on all four sides.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from calibgui.engine.arrays import Array, GreyImage, compute_lengths
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.checkerboard.numbering import turn_lattice
from calibgui.engine.detection.checkerboard.thresholds import THRESHOLDS
from calibgui.engine.detection.checkerboard.verification import find_ends
from calibgui.engine.detection.lattice import (
    MIN_LINES,
    Lattice,
    crop_lattice,
    drop_isolated_and_crop,
    is_large_enough,
)

_NEGLIGIBLE_MISFIT = 1e-6
"""Rms distance from a grid map, steps, below which nothing but rounding tells maps apart."""


def separate_boards(lattice: Lattice, image: GreyImage) -> list[Lattice]:
    """Separate a lattice into parts that may be boards; the lattice alone if it may be one itself,
    or if nothing tells parts.

    Args:
        lattice: corners good to 2 px.
        image: (h, w) grey levels in which they were found.
    """
    limits = THRESHOLDS.separation
    misfit = _measure_misfit([lattice])
    if misfit <= limits.max_joint_misfit:
        return [lattice]
    if min(lattice.shape) <= limits.max_lines:
        if parts := _cut_at_crease(lattice, misfit):
            return [piece for part in parts for piece in separate_boards(part, image)]
        core = _drop_ragged_lines(lattice)
        if (
            is_large_enough(core)
            and _measure_misfit([core]) <= limits.max_joint_misfit
            and all(find_ends(core, image))
        ):
            return [core]
    return [lattice]


def _measure_misfit(parts: list[Lattice]) -> float:
    """Measure the rms distance of corners from the smooth grid maps of their parts, steps."""
    return float(np.sqrt(np.mean(np.concatenate([_measure_offsets(part) for part in parts]) ** 2)))


def _measure_offsets(lattice: Lattice) -> Array:
    """Measure the distances (n,) of a lattice's corners from its smooth grid map, steps of the map:
    those between the corners are 0 where two of them coincide."""
    found = lattice.found
    uv = lattice.uv.copy()
    uv[found] = grid_map.fit_grid_map(lattice).locate(np.argwhere(found).astype(np.float64))
    off = compute_lengths(lattice.uv[found] - uv[found])
    return np.asarray(off / Lattice(uv, lattice.dark).spacing()[found])


def _cut_at_crease(lattice: Lattice, misfit: float) -> tuple[Lattice, Lattice] | None:
    """Cut a lattice where two smooth maps follow its parts best; None if they do not follow them
    many times better than one map, by which its corners are `misfit` steps off.

    Of cuts that are about as good the one that leaves out the fewest corners is taken.
    """
    limits = THRESHOLDS.separation
    cuts = [(_measure_misfit(list(parts)), parts) for parts in _list_cuts(lattice)]
    least = min((off for off, _ in cuts), default=np.inf)
    if least > limits.max_misfit_ratio * misfit:
        return None
    limit = limits.max_excess_misfit * max(least, _NEGLIGIBLE_MISFIT)
    good = [parts for off, parts in cuts if off <= limit]
    return max(good, key=lambda parts: len(parts[0]) + len(parts[1]))


def _list_cuts(lattice: Lattice) -> Iterator[tuple[Lattice, Lattice]]:
    """List the pairs of lattices, large enough for boards, on both sides of a cut between two lines
    or along one, which is then left out."""
    for quarters in (0, 1):
        turned = turn_lattice(lattice, quarters)
        rows = turned.shape[0]
        for row in range(MIN_LINES, rows - MIN_LINES + 1):
            for left_out in (0, 1):
                start = row + left_out
                parts = (
                    drop_isolated_and_crop(Lattice(turned.uv[:row], turned.dark)),
                    drop_isolated_and_crop(
                        Lattice(turned.uv[start:], turned.dark ^ bool(start % 2))
                    ),
                )
                if all(map(is_large_enough, parts)):
                    yield turn_lattice(parts[0], -quarters), turn_lattice(parts[1], -quarters)


def _drop_ragged_lines(lattice: Lattice) -> Lattice:
    """Drop the border line with the most gaps, over its length, as long as it has too many."""
    while len(lattice):
        turned = [turn_lattice(lattice, quarters) for quarters in range(4)]
        gaps = [np.mean(~each.found[0]) for each in turned]
        worst = int(np.argmax(gaps))
        if gaps[worst] <= THRESHOLDS.separation.max_gaps:
            break
        rest = crop_lattice(Lattice(turned[worst].uv[1:], not turned[worst].dark))
        lattice = turn_lattice(rest, -worst)
    return lattice
