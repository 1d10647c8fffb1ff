"""Find the boards in an image, whatever their size and place, from coarse to fine.

A board may fill the image or a tenth of it, sharp or blurred; no single scale suits all. The image
is therefore halved until its short side is at most 180 px, and each level, coarsest first, is
searched for X-junctions and their lattices. Coarse levels are quick and average blur and noise
away; a finer one is only needed while nothing was found or the squares are too small to be sure
that none was missed. Lattices of squares that small are left as they are until the finer levels
have been searched, and grown only if these do not show them in full. What is found is then carried
down to full resolution, refined at each level.

Squares that overlap or part by much show a crossing only where the blur is no less: not in fine
levels. Should no board have been found, the coarsest level is searched for crossings of that kind,
and some that are coarser still.

Pixel (u, v) of a level covers the block around (2u + 1/2, 2v + 1/2) of the next finer one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np
import scipy

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.features.lattice import (
    MIN_CORNERS,
    Lattice,
    compute_filled_share,
    is_large_enough,
    is_part,
)
from calibgui.engine.features.saddle import refine_lattice
from calibgui.engine.lattices import a_contrario, board_ends, prefilter
from calibgui.engine.lattices.lattice_growth import MIN_FILLED_IN_TEXTURE, PointIndex, grow_lattice
from calibgui.engine.lattices.neighbour_graph import find_lattices
from calibgui.engine.lattices.prefilter import Refusal
from calibgui.engine.lattices.region_of_interest import are_inside
from calibgui.engine.lattices.x_junctions import (
    CROSSING_TOLERANCE,
    PARTED_TOLERANCE,
    Junctions,
    JunctionTolerance,
    Saddles,
    classify_saddles,
    find_saddles,
)

_MAX_TOP_LEVEL_SIDE = 180
"""Short side of the coarsest level, px; a larger level is halved."""
_MIN_PARTED_LEVEL_SIDE = 25
"""Short side of a level, px, down to which squares that overlap or part are searched for."""
_MIN_SQUARE = 6.0
"""Side of squares, px, from which on a level shows all of a board; boards of smaller ones are
left to the finer levels."""
_MIN_SQUARE_WITH_GAPS = 30.0
"""Side of squares, px, from which on a finer level is not searched either for a board that has
gaps."""
_MIN_CONTRAST = 0.05
"""Least contrast of a corner, over the range of the image's grey levels."""
_MAX_LEVEL_SHIFT = 2.0
"""Greatest distance of a corner from where the next coarser level shows it, px; a corner
without a saddle point within keeps its place."""
_MIN_LEVEL_STEP = 0.02
"""Length of a step at which a corner has converged in a level, px: what is left is made up for
in the next, and in full resolution when the board is refined."""
_MAX_GROWN_LATTICES = 8
"""Number of lattices, those with the most junctions, that are grown in a level."""
_MAX_SPARSE_LATTICES = 2
"""Number of grown lattices of a level that fill less than the share `MIN_FILLED_IN_TEXTURE` of
their rows and columns, after which others that do are not grown. The "waves" and the "halftone"
of `tests.benchmarks.refusals` have up to 8 of a third and less, which take long."""
MIN_JUDGED_CORNERS = 320
"""Number of corners from which on a lattice is asked whether it is another board before it
grows, which takes longer."""
_RANGE_PERCENTILES = (0.5, 99.5)
"""Percentiles of the grey levels between which their range is measured, %."""
_SMALL_SQUARES = 0.05
"""Share of a lattice's spacings up to which they count as those of its small squares."""
_SAME_CORNER = 0.5
"""Distance up to which corners that two levels show are the same: both are saddle points of the
full resolution, and where there is none, places that are refined from there, px."""


IsOther = Callable[[Lattice, int], bool]
"""Test of whether a lattice, placed in full resolution as a level of a depth shows it, is none of
the boards that are looked for; the full resolution is of depth 0."""
OnRefusal = Callable[[Refusal], object]
"""What is called with every lattice that the prefilter refuses though it is large enough."""


@dataclass(frozen=True, eq=False, slots=True)
class Candidate:
    """A lattice that may be a board."""

    lattice: Lattice
    others: int
    """Number of X-junctions seen beside its own corners in the level that it was found in, but for
    those too faint to be corners of the same board."""
    is_other: bool = False
    """True if it is none of the boards that are looked for: it was neither grown nor refined."""


@dataclass(frozen=True, eq=False, slots=True)
class _LevelContent:
    """The junctions and lattices of one level of the image."""

    image: GreyImage
    depth: int
    """How often the image was halved."""
    saddles: Saddles
    junctions: Junctions
    """The saddles that are X-junctions."""
    lattices: list[Lattice]
    """The junctions' lattices, largest first."""
    bare_reach: float
    """How far from the corners nothing is printed, squares: see `find_candidates`."""
    on_refusal: OnRefusal
    grid_size: GridSize | None
    """Rows and columns of the board, if stated."""
    is_judged: bool = False
    """True if the lattices that are refused by what is seen at once were dropped."""


@dataclass(eq=False, slots=True)
class _Texture:
    """A count of a picture's sparse lattices: a texture holds any number of them, in any level, and
    all turn out as the first few did."""

    count: int = 0
    """Number of lattices that were sparse once grown."""

    def is_one_too_many(self, lattice: Lattice) -> bool:
        """Return whether a lattice is sparse, as enough others were."""
        return self.count >= _MAX_SPARSE_LATTICES and _is_sparse(lattice)

    def takes(self, lattice: Lattice | None) -> bool:
        """Return whether a grown lattice is one too many, or None since it stayed ragged; count
        these, and others that are sparse."""
        is_taken = lattice is None or self.is_one_too_many(lattice)
        self.count += lattice is None or _is_sparse(lattice)
        return is_taken


def _is_sparse(lattice: Lattice) -> bool:
    """Return whether a lattice fills as little of its rows and columns as those of textures."""
    return compute_filled_share(lattice) < MIN_FILLED_IN_TEXTURE


def find_candidates(
    image: GreyImage,
    outline: Array | None = None,
    is_sufficient: Callable[[Lattice], bool] = is_large_enough,
    bare_reach: float = 0.5,
    on_refusal: OnRefusal = lambda _: None,
    is_other: IsOther = lambda *_: False,
    grid_size: GridSize | None = None,
) -> Iterator[list[Candidate]]:
    """Find all lattices that may be boards, in full resolution but not yet verified.

    Args:
        image: (h, w) grey levels, uint8 or uint16.
        outline: (m, 2) convex outline, px, that the corners must not leave.
        is_sufficient: test of whether a lattice is large enough to be kept.
        bare_reach: how far from the corners nothing is printed in the squares and on their edges.
        on_refusal: is told which lattices that are large enough were refused, and why.
        is_other: tells of which lattices no more than what is seen of them need be known.
        grid_size: rows and columns of the board, if stated.

    Yields:
        The candidates, that of the most corners first: once when a finer level could hardly add to
        them, and then again after each level, should none of them be the board that is wanted.
    """
    levels = [image]
    while min(levels[-1].shape) > _MAX_TOP_LEVEL_SIDE:
        levels.append(opencv.halve_image(levels[-1]))
    min_contrast = _MIN_CONTRAST * _measure_range(levels)
    if min_contrast == 0:
        return
    outlines = [_scale_to_level(outline, k) for k in range(len(levels))]
    candidates: list[Candidate] = []
    waiting: list[tuple[int, _LevelContent]] = []
    texture = _Texture()
    for depth in reversed(range(len(levels))):
        content = _analyse_level(
            levels[depth], depth, min_contrast, outlines[depth], bare_reach, on_refusal, grid_size
        )
        if len(content.lattices) > 1 or any(map(_is_resolved, content.lattices)) or not depth:
            # A single one, as of a board, is judged only if the finer levels do not show it.
            content = _drop_refused(content)
        if depth and content.lattices and not _is_resolved(content.lattices[0]):
            # The finer levels may show all of its small squares: until then it is of no use.
            waiting.append((depth, content))
            continue
        grown = _grow_lattices(content, content.lattices, texture, is_sufficient, is_other)
        del content  # its images, while the next level's are made
        candidates = _drop_parts(_carry_down(grown, candidates, levels[:depth]) + candidates)
        is_sure = bool(grown) and all(_is_surely_complete(new.lattice) for new in grown)
        if is_sure or not depth:
            for k, content in waiting:
                if missed := _drop_refused(content).lattices:
                    grown = _grow_lattices(content, missed, texture, is_sufficient, is_other)
                    candidates = _drop_parts(
                        candidates + _carry_down(grown, candidates, levels[:k])
                    )
            waiting = []
            yield candidates
    texture = _Texture()
    depth = len(levels) - 1
    while min(levels[depth].shape) > _MIN_PARTED_LEVEL_SIDE:
        content = _analyse_level(
            levels[depth],
            depth,
            min_contrast,
            _scale_to_level(outline, depth),
            bare_reach,
            on_refusal,
            grid_size,
            PARTED_TOLERANCE,
        )
        content = _drop_refused(content)
        if grown := _grow_lattices(content, content.lattices, texture, is_sufficient, is_other):
            candidates = _drop_parts(_carry_down(grown, candidates, levels[:depth]) + candidates)
            yield candidates
        levels.append(opencv.halve_image(levels[depth]))
        depth += 1


def _measure_range(levels: list[GreyImage]) -> float:
    """Measure the range of the grey levels, 0 if they do not vary.

    The few darkest and brightest do not count if what is left varies, in the coarsest level where
    it does: a coarse level may even out squares that fill the image.
    """
    for level in reversed(levels):
        low, high = _measure_percentiles(level)
        if high > low:
            return float(high - low)
    return float(levels[0].max()) - float(levels[0].min())


def _measure_percentiles(level: GreyImage) -> Array:
    """Measure the `_RANGE_PERCENTILES` of a level, as `np.percentile`. Grey levels are counted, in
    a third of the time that it takes to put them in order."""
    place = np.array(_RANGE_PERCENTILES) / 100 * (level.size - 1)
    up_to = np.cumsum(np.bincount(level.ravel()))
    below, above = np.searchsorted(up_to, [np.floor(place), np.ceil(place)], side="right")
    return np.asarray(below + (place % 1) * (above - below))


def _scale_to_level(uv: Array | None, depth: int) -> Array | None:
    """Return points (n, 2) px of the image in the coordinates of a level, if there are any."""
    return None if uv is None else (uv + 0.5) / 2**depth - 0.5


def _place_in_image(lattice: Lattice, depth: int) -> Lattice:
    """Place a lattice of a level in full resolution, where it lies to some 2^depth / 2 px."""
    return Lattice(2**depth * (lattice.uv + 0.5) - 0.5, lattice.dark)


def _analyse_level(
    image: GreyImage,
    depth: int,
    min_contrast: float,
    outline: Array | None,
    bare_reach: float,
    on_refusal: OnRefusal,
    grid_size: GridSize | None,
    tolerance: JunctionTolerance = CROSSING_TOLERANCE,
) -> _LevelContent:
    """Find the junctions and the lattices of one level.

    Args:
        image: (h, w) grey levels.
        depth: how often the image was halved to it.
        min_contrast: least contrast of a junction, grey levels.
        outline: (m, 2) convex outline, px, that junctions must not leave.
        bare_reach: how far from the corners nothing is printed, squares.
        on_refusal: as in `find_candidates`.
        grid_size: rows and columns of the board, if stated.
        tolerance: what is tolerated in junctions and between them.
    """
    saddles = find_saddles(image, min_contrast)
    if outline is not None:
        saddles = saddles.select(are_inside(outline, saddles.uv))
    _, junctions = classify_saddles(saddles, tolerance)
    most = _MAX_GROWN_LATTICES
    lattices = find_lattices(saddles, junctions, most, tolerance, bare_reach)
    return _LevelContent(
        image, depth, saddles, junctions, lattices, bare_reach, on_refusal, grid_size
    )


def _drop_refused(content: _LevelContent) -> _LevelContent:
    """Drop the lattices of a level that are refused by what is seen at once, unless they were."""
    if content.is_judged:
        return content
    kept = [each for each in content.lattices if not _refuse(each, content)]
    return replace(content, lattices=kept, is_judged=True)


def _refuse(lattice: Lattice, content: _LevelContent) -> bool:
    """Return whether a lattice is refused by what is seen at once, and report why if it is large
    enough."""
    objection = prefilter.find_early_objection(
        lattice, content.image, content.bare_reach, content.grid_size
    )
    if objection and is_large_enough(lattice):
        content.on_refusal(Refusal(lattice.shape, objection))
    return bool(objection)


def _grow_lattices(
    content: _LevelContent,
    seeds: list[Lattice],
    texture: _Texture,
    is_sufficient: Callable[[Lattice], bool],
    is_other: IsOther,
) -> list[Candidate]:
    """Grow lattices of one level; return those that are sufficient, largest first.

    Those that turn out as of a `texture` are counted there, and left out once these are too many.
    """
    if not seeds:
        return []

    def is_none_wanted(lattice: Lattice) -> bool:
        return is_other(_place_in_image(lattice, content.depth), content.depth)

    def is_hopeless(lattice: Lattice) -> bool:
        return (
            texture.is_one_too_many(lattice)
            or prefilter.is_hopeless(lattice, content.image, content.bare_reach, content.grid_size)
            or is_none_wanted(lattice)
        )

    smooth, min_judged = content.saddles.smooth, MIN_JUDGED_CORNERS
    nearby, beyond = (
        PointIndex(smooth, points.uv) for points in (content.saddles, content.junctions)
    )
    grown: list[Lattice] = []
    candidates: list[Candidate] = []
    for seed in seeds:
        if texture.is_one_too_many(seed) or any(is_part(seed, other) for other in grown):
            continue
        is_wanted = len(seed) < min_judged or not is_none_wanted(seed)
        # A board that is all there would only grow into the floor or the cloth that it lies on.
        has_floor = len(content.junctions) - len(seed) >= MIN_CORNERS
        may_grow = is_wanted and not (has_floor and board_ends.is_whole(seed, smooth))
        lattice = grow_lattice(seed, nearby, beyond, is_hopeless) if may_grow else seed
        grown.append(seed if lattice is None else lattice)
        if texture.takes(lattice) or lattice is None or not is_sufficient(lattice):
            continue
        if lattice is not seed and _refuse(lattice, content):  # the seeds passed that before
            continue
        if is_wanted:
            lattice = board_ends.drop_stray_lines(lattice, smooth)
        if is_sufficient(lattice):
            others = a_contrario.count_others(lattice, content.junctions)
            candidates.append(Candidate(lattice, others, is_other=not is_wanted))
    return _drop_parts(candidates)


def _drop_parts(candidates: list[Candidate]) -> list[Candidate]:
    """Drop the candidates that are parts of others; return the rest, largest first."""
    kept: list[Candidate] = []
    for candidate in sorted(candidates, key=lambda each: len(each.lattice), reverse=True):
        if not any(is_part(candidate.lattice, larger.lattice) for larger in kept):
            kept.append(candidate)
    return kept


def find_same(candidate: Candidate, tried: Iterable[Candidate]) -> Candidate | None:
    """Find a candidate that was tried before with the same corners, to `_SAME_CORNER` px, and among
    no more others: what holds of it holds of this one, which another level shows once more."""
    uv = candidate.lattice.uv[candidate.lattice.found]
    for other in tried:
        if len(other.lattice) != len(uv) or other.others > candidate.others:
            continue
        tree = scipy.spatial.cKDTree(other.lattice.uv[other.lattice.found])
        if np.asarray(tree.query(uv)[0]).max() < _SAME_CORNER:
            return other
    return None


def _is_surely_complete(lattice: Lattice) -> bool:
    """Return whether a finer level could hardly add to a lattice: its squares are large, or very
    large where it has gaps."""
    whole = lattice.found.all()
    return _is_resolved(lattice, _MIN_SQUARE if whole else _MIN_SQUARE_WITH_GAPS)


def _is_resolved(lattice: Lattice, min_square: float = _MIN_SQUARE) -> bool:
    """Return whether the squares of a lattice are larger than `min_square` px."""
    spacing = lattice.spacing()
    known = np.sort(spacing[np.isfinite(spacing)])
    return bool(known[int(_SMALL_SQUARES * (len(known) - 1))] > min_square)


def _carry_down(
    found: list[Candidate], known: list[Candidate], finer: list[GreyImage]
) -> list[Candidate]:
    """Carry the candidates found in a level to the first of the `finer` ones, refining those that
    may be wanted at each, but for parts of larger ones that are known: of as many corners as
    textures have, that would take longer than all else."""
    carried = []
    for candidate in found:
        lattice = candidate.lattice
        placed = _place_in_image(lattice, len(finer))
        larger = (each.lattice for each in known if len(each.lattice) > len(lattice))
        if any(is_part(placed, each) for each in larger):
            continue
        if candidate.is_other:
            carried.append(replace(candidate, lattice=placed))
            continue
        for image in reversed(finer):
            doubled = Lattice(2 * lattice.uv + 0.5, lattice.dark)
            lattice, _ = refine_lattice(image, doubled, _MAX_LEVEL_SHIFT, min_step=_MIN_LEVEL_STEP)
        carried.append(Candidate(lattice, candidate.others))
    return carried
