"""Find the boards in an image, whatever their size and place, from coarse to fine.

The image is halved until its short side is below 180 px. Each level, coarsest first, is searched
for X-junctions and their lattices. Coarse levels are quick and average blur and noise away; a
finer one is only needed while nothing was found or the squares are too small to be sure that
none was missed. Lattices of squares that small are left as they are until the finer levels have
been searched, and grown only if these do not show them in full. What is found is then carried
down to full resolution, refined at each level.

Squares that overlap or part by much show a crossing only where the blur is no less: not in fine
levels. Should no board have been found, the coarsest level is searched for crossings of that kind,
and some that are coarser still.

Pixel (u, v) of a level covers the block around (2u + 1/2, 2v + 1/2) of the next finer one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.detection.checkerboard import prefilter, verification
from calibgui.engine.detection.checkerboard.lattice_growth import Places, grow
from calibgui.engine.detection.checkerboard.neighbour_graph import find_lattices
from calibgui.engine.detection.checkerboard.saddle import at_saddles
from calibgui.engine.detection.checkerboard.x_junctions import (
    CROSSED,
    PARTED,
    Saddles,
    Tolerance,
    classify,
    find_saddles,
)
from calibgui.engine.detection.lattice import Lattice, large_enough

_COARSEST = 180
"""Short side below which an image is not halved further, px."""
_LEAST = 25
"""Short side of a level that is searched still for squares that part or overlap, px."""
_SMALLEST = 6.0
"""Squares of this side are found reliably, px."""
_CONTRAST = 0.05
"""Least contrast of a corner over the range of the image."""
_SHARED = 0.25
"""Part of its corners that a lattice may have in common with a larger one that is another."""
_MOVED = 2.0
"""How far a corner may lie from where the next coarser level shows it, px."""
_GROWN = 8
"""How many of the largest lattices of a level are grown."""


@dataclass(frozen=True, eq=False, slots=True)
class Candidate:
    """What may be a board."""

    lattice: Lattice
    others: int
    """X-junctions seen beside its own corners in the level that it was found in."""


@dataclass(frozen=True, eq=False, slots=True)
class _Seen:
    """In one level of the image."""

    image: GreyImage
    saddles: Saddles
    junctions: Saddles
    """Those of them that are X-junctions."""
    lattices: list[Lattice]
    """That these make up and that could be boards, largest first."""


def find_boards(
    image: GreyImage,
    inside: Array | None = None,
    enough: Callable[[Lattice], bool] = large_enough,
) -> Iterator[list[Candidate]]:
    """All lattices that may be boards, largest first, in full resolution but not yet verified.

    As many as the image was searched for: once when a finer level could hardly add to them, and
    then again after each level, should none of them be the board that is wanted.

    Args:
        image: (h, w) grey levels, uint8, uint16 or float32.
        inside: (4, 2) convex outline, px, that the corners must not leave.
        enough: whether so much of a lattice may be a board.
    """
    levels = [image]
    while min(levels[-1].shape) > _COARSEST:
        levels.append(opencv.half(levels[-1]))
    floor = _CONTRAST * _range(levels)
    if floor == 0:
        return
    outlines = [None if inside is None else _in_level(inside, k) for k in range(len(levels))]
    boards: list[Candidate] = []
    waiting: list[tuple[int, list[Lattice]]] = []
    for depth in reversed(range(len(levels))):
        found, small = _search(levels[depth], floor, outlines[depth], enough, finest=not depth)
        if small:
            waiting.append((depth, small))
            continue
        boards = _distinct([_carried(one, levels[:depth]) for one in found] + boards)
        sure = bool(found) and all(_surely_all(one.lattice) for one in found)
        if sure or not depth:
            for k, small in waiting:
                if missed := _missed(small, k, boards):
                    found = _grown(_look(levels[k], floor, outlines[k]), missed, enough)
                    boards = _distinct(boards + [_carried(one, levels[:k]) for one in found])
            waiting = []
            yield boards
    depth = len(levels) - 1
    while min(levels[depth].shape) > _LEAST:
        outline = None if inside is None else _in_level(inside, depth)
        seen = _look(levels[depth], floor, outline, PARTED)
        if found := _grown(seen, seen.lattices, enough):
            boards = _distinct([_carried(one, levels[:depth]) for one in found] + boards)
            yield boards
        levels.append(opencv.half(levels[depth]))
        depth += 1


def _range(levels: list[GreyImage]) -> float:
    """Of the grey levels, without the few darkest and brightest if what is left varies: 0 if none
    do. A coarse level may even out squares that fill the image."""
    for level in reversed(levels):
        low, high = np.percentile(level, (0.5, 99.5))
        if high > low:
            return float(high - low)
    return float(levels[0].max()) - float(levels[0].min())


def _in_level(uv: Array, depth: int) -> Array:
    """Points (..., 2) of the image in the coordinates of a level."""
    return (uv + 0.5) / 2**depth - 0.5


def _search(
    image: GreyImage,
    floor: float,
    outline: Array | None,
    enough: Callable[[Lattice], bool],
    finest: bool,
) -> tuple[list[Candidate], list[Lattice]]:
    """Lattices large enough for a board in one level, largest first, or, where their squares are
    too small for that to tell all, what will be of use only if the finer levels show less."""
    seen = _look(image, floor, outline)
    if seen.lattices and not finest and not _resolved(seen.lattices[0]):
        return [], seen.lattices
    return _grown(seen, seen.lattices, enough), []


def _look(
    image: GreyImage, floor: float, outline: Array | None, tolerance: Tolerance = CROSSED
) -> _Seen:
    """What there is in one level."""
    saddles = find_saddles(image, floor)
    if outline is not None:
        saddles = saddles.under(contains(outline, saddles.uv))
    passed, junctions = classify(saddles, tolerance)
    lattices = find_lattices(saddles, junctions, _GROWN, tolerance)
    hopeful = [one for one in lattices if not prefilter.hopeless(one, image)]
    return _Seen(image, saddles, saddles.under(passed), hopeful)


def _grown(seen: _Seen, seeds: list[Lattice], enough: Callable[[Lattice], bool]) -> list[Candidate]:
    """What lattices of one level grow to, if it is large enough for a board, largest first."""
    hopeless = partial(prefilter.hopeless, image=seen.image)
    smooth, junctions = seen.saddles.smooth, len(seen.junctions.uv)
    nearby, beyond = (Places(smooth, points.uv) for points in (seen.saddles, seen.junctions))
    grown: list[Lattice] = []
    hopeful: list[Lattice] = []
    for seed in seeds:
        if not any(_overlap(other, seed) for other in grown):
            grown.append(one := grow(seed, nearby, beyond, hopeless))
            if one is seed or not hopeless(one):  # the seeds were glanced at before
                hopeful.append(verification.without_strays(one, smooth))
    boards = [Candidate(one, max(junctions - len(one), 0)) for one in hopeful if enough(one)]
    return _distinct(boards)


def _missed(lattices: list[Lattice], depth: int, boards: list[Candidate]) -> list[Lattice]:
    """Those of the lattices seen in a level that are no part of the full `boards`."""
    full = [
        Lattice(_in_level(one.lattice.uv, depth), one.lattice.dark)
        for one in boards
        if one.lattice.found.all()
    ]
    return [
        lattice
        for lattice in lattices
        if not any(
            len(grid_size) >= len(lattice) and _overlap(grid_size, lattice) for grid_size in full
        )
    ]


def _distinct(candidates: list[Candidate]) -> list[Candidate]:
    """Those that are no parts of others; largest first."""
    kept: list[Candidate] = []
    for one in sorted(candidates, key=lambda one: len(one.lattice), reverse=True):
        if not any(_overlap(other.lattice, one.lattice) for other in kept):
            kept.append(one)
    return kept


def _overlap(one: Lattice, other: Lattice) -> bool:
    """Whether a lattice has a good part of another's corners, by half a step. (Where the pattern of
    a floor or a cloth goes on behind a board, its lattice may catch one of the board's.)"""
    distance, _ = scipy.spatial.cKDTree(one.uv[one.found]).query(other.uv[other.found])
    return bool(np.mean(distance < other.spacing()[other.found] / 2) > _SHARED)


def _surely_all(lattice: Lattice) -> bool:
    """Whether a finer level could hardly add to `lattice`: its squares are large, or very large
    where it has gaps."""
    return _resolved(lattice, _SMALLEST if lattice.found.all() else 5 * _SMALLEST)


def _resolved(lattice: Lattice, square: float = _SMALLEST) -> bool:
    """Whether the squares of `lattice` are larger than so many px."""
    return bool(np.nanpercentile(lattice.spacing(), 5) > square)


def _carried(candidate: Candidate, finer: list[GreyImage]) -> Candidate:
    """`candidate` in the coordinates of the first of the `finer` levels, refined at each."""
    lattice = candidate.lattice
    for image in reversed(finer):
        lattice, _ = at_saddles(image, Lattice(2 * lattice.uv + 0.5, lattice.dark), _MOVED)
    return Candidate(lattice, candidate.others)


def contains(outline: Array, uv: Array) -> BoolArray:
    """Which of the points `uv` (n, 2) lie inside the convex `outline` (m, 2)."""
    edge = np.roll(outline, -1, axis=0) - outline
    to = uv[:, None] - outline
    side = edge[:, 0] * to[..., 1] - edge[:, 1] * to[..., 0]
    return np.asarray((side >= 0).all(axis=1) | (side <= 0).all(axis=1))
