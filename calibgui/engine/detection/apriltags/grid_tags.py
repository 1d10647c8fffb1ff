"""The tags of an AprilGrid: found in an image, read, and placed on the board.

Tags are looked for among the dark quadrilaterals of the image, of its coarsest size first. A quick
look at it shows most boards. Where it does not, the image is searched anyway, but its other sizes,
at which that takes long, only if a sample of them (`PrintSample`) shows tags, and the negative, of
which few boards are printed, only if a look at it does. Noise breaks the outlines of tags, and the
small black squares that touch their corners join them; the image is therefore smoothed before.
Tags beside those that were read so are read where these predict them (`marker_growth`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property, lru_cache

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GreyImage, GridSize, IntArray
from calibgui.engine.boards.april_grid import AprilGrid, TagLayout
from calibgui.engine.boards.apriltags import load_family
from calibgui.engine.detection.apriltags.tag_places import (
    MAX_COLS,
    MIN_TAGS,
    list_layouts,
    list_layouts_of_columns,
)
from calibgui.engine.detection.apriltags.tag_reader import (
    TagPrint,
    TagReader,
    draw_tags,
    list_prints,
    rate_borders,
)
from calibgui.engine.detection.charuco.marker_growth import (
    TAG_NEIGHBOURS,
    MarkerPrints,
    describe_prints,
    grow_markers,
    tell_rows_apart,
)
from calibgui.engine.detection.charuco.marker_reader import MAX_COARSE_SIDE
from calibgui.engine.detection.charuco.markers import Markers, drop_repeated, identify_board
from calibgui.engine.detection.detector_io import invert_levels
from calibgui.engine.detection.print_samples import PrintSample, QuadSearch
from calibgui.engine.features import saddle
from calibgui.engine.images.sampling import sample_image
from calibgui.engine.lattices.region_of_interest import are_inside

_MIN_SIDE = 0.48
"""Least side of a tag over the distance of two, as measured: the gap of an AprilGrid is at most as
wide, which is 0.5."""
_REFINING_SIGMA, _SIGMA_LIMITS = 0.06, (0.8, 6.0)
"""Standard deviation of the weights with which the corners of a tag are refined, sides of the tag,
and its limits, px."""
_MAX_REFINING_SHIFT = 0.12
"""Greatest distance by which the corners of a tag are refined, sides of the tag: less than that to
any other crossing of edges."""
_SMOOTHING_SIGMA = 1.0
"""Standard deviation of the smoothing before an image is searched, px. Of 160 rendered boards on
textures, under blur and noise, that shows 136, in a quick look 132, in both together 143; the image
itself shows 79, and all three together 144."""
_OUTLINE_INSET = 0.6
"""How far within the sides of a tag its outline runs, px, on rendered tags: 0.3 to 0.5 px, and 0.8
to 1.0 px where small black squares join its corners."""
_BEYOND = 2.0
"""Distance from the sides of a quadrilateral at which it is looked whether they border on paper,
px."""
_PLACES_ALONG = np.linspace(0.2, 0.8, 5)[:, None, None, None]
"""(5, 1, 1, 1) where on the sides that is, over their length."""
_MIN_SURE_DISTANCE = 9
"""Distance of a family from which on tags that agree on a board are not mistaken for others'."""
_MIN_SURE_SHARE = 0.97
"""Share of the steps between the cells of such tags that are right beyond which no other width of
their border is tried: on 117 rendered boards it is 0.989 or more, with the wrong border 0.92 or
less."""
_MAX_CONTRADICTING = 0.5
"""Greatest number of tags that are read elsewhere than the board says, over those that agree, of a
family whose tags are hardly mistaken. Of boards it is 0; of the 11 tags on a sheet that is no board
4 agreed and 5 did not."""
_NEIGHBOUR_DISTANCE = 2.2
"""Greatest distance of neighbours in a column, sides of a tag: the gap is at most as wide as it."""
_MAX_BRIGHT_SHARE = 0.45
"""Greatest share of the outermost places of a refined quadrilateral that may be bright: one that is
read as a tag has at most 36 %."""
_MAX_READ, _MAX_SAMPLED = 150, 80
"""Number of quadrilaterals of an image, and of a sample of it, that are read, those of the darkest
borders: in brickwork there are thousands. Of rendered boards before textures those of all tags were
among the first 25; of a board of more tags the others are read beside these."""
_ALL_LAYOUTS = tuple(
    layout for cols in range(2, MAX_COLS + 1) for layout in list_layouts(cols, None)
)
"""The layouts that are considered where none is stated: a column of consecutive tags may be a row
of turned ones."""

GridTags = tuple[TagPrint, Markers[TagLayout]]
"""The print of the tags of a board, and the tags that were read on it."""


class GridTagFinder:
    """A finder of the tags of an AprilGrid in one 8-bit image, dark on bright.

    What the image shows is read once, for whichever boards it is asked.
    """

    def __init__(
        self, image: GreyImage, outline: Array | None, positive: GridTagFinder | None = None
    ) -> None:
        """
        Args:
            image: (h, w) 8-bit grey levels.
            outline: (m, 2) px, outline that the tags must not leave, if there is one.
            positive: the finder of the same image as it is, if this one is to search its negative.
        """
        self._image = image
        self._outline = outline
        self._readers: dict[int, TagReader] = {}
        self._is_negative = positive is not None
        # A negative has the same contrasts.
        self._samples: dict[int, PrintSample] = {} if positive is None else positive._samples
        self._looks: dict[int, TagReader] = {}

    @cached_property
    def _levels(self) -> list[GreyImage]:
        """The image, or its negative, and its halved copies, made once they are searched."""
        levels = [invert_levels(self._image) if self._is_negative else self._image]
        while max(levels[-1].shape) > MAX_COARSE_SIDE:
            levels.append(opencv.halve_image(levels[-1]))
        return levels

    @property
    def depth(self) -> int:
        """Number of sizes of the image."""
        return len(self._levels)

    def search(
        self, depth: int, pattern: AprilGrid, grid_size: GridSize | None
    ) -> Iterator[GridTags | None]:
        """Search one size of the image, again with more effort unless all tags of a board are read;
        see `find_grid_tags`.

        Yields:
            The board of most tags until then, None if there is none.
        """
        best: GridTags | None = None
        for reader in self._list_readers(depth):
            board = _read_board(reader, pattern, grid_size, self._outline)
            best = max(filter(None, (best, board)), key=_count_tags, default=None)
            yield best
            if best is not None and _is_wholly_read(best[1]):
                return

    def _list_readers(self, depth: int) -> Iterator[TagReader]:
        """List the readers of one size of the image, the quickest made first: that of a quick look,
        and if this shows tags those of all quadrilaterals. The coarsest size is searched in any
        case, but the negative, of which few boards are printed."""
        is_coarsest = depth == len(self._levels) - 1
        look = self._make_look(depth)
        if is_coarsest:
            yield look
        if (self._is_negative or not is_coarsest) and not _shows_tags(look):
            return
        if depth not in self._readers:
            more = TagReader(self._levels[0], self._find_quads(depth))
            self._readers[depth] = look.join(more)
        yield self._readers[depth]

    def _make_look(self, depth: int) -> TagReader:
        """Make the reader of a sample of one size of the image, or of all of the coarsest, quickly,
        once."""
        if depth not in self._looks:
            quads = self._find_quads(depth, is_sample=True)
            self._looks[depth] = TagReader(self._levels[0], quads)
        return self._looks[depth]

    def _find_quads(self, depth: int, is_sample: bool = False) -> Array:
        """Find the quadrilaterals (n, 4, 2) px of one size of the image, or of a sample of it, that
        may be tags."""
        image, level = self._levels[0], self._levels[depth]
        if depth == len(self._levels) - 1:
            quads = self._search_of_coarsest.detect_dark_quads(is_quick=is_sample)
        elif is_sample:
            if depth not in self._samples:
                self._samples[depth] = PrintSample(self._levels[depth + 1])
            quads = self._samples[depth].detect_dark_quads(level, _smooth)
        else:
            quads = opencv.detect_dark_quads(_smooth(level), is_quick=True)
        quads = _reach_paper(level, _widen(quads, _OUTLINE_INSET))
        most = _MAX_SAMPLED if is_sample else _MAX_READ
        quads = _select_dark_borders(level, quads, np.inf, most)
        quads = _refine_quads(image, (quads + 0.5) * 2**depth - 0.5)
        quads = _select_dark_borders(image, quads, _MAX_BRIGHT_SHARE, most)
        if self._outline is not None:
            quads = quads[are_inside(self._outline, quads.mean(axis=1))]
        return quads

    @cached_property
    def _search_of_coarsest(self) -> QuadSearch:
        """The search of the coarsest size of the image."""
        return QuadSearch(_smooth(self._levels[-1]))


def find_grid_tags(
    finders: Sequence[GridTagFinder], pattern: AprilGrid, grid_size: GridSize | None
) -> tuple[GridTags, int] | None:
    """Find the tags of a board in an image, or its negative, the coarsest size first.

    Where a look at the image shows no board the negative is searched before the image is searched
    in full: a look at it takes less.

    Args:
        finders: of the image, and of its negative if that is searched.
        pattern: what is stated of the board.
        grid_size: rows and columns of corners, if stated.

    Returns:
        The tags and the index of the finder that shows them; None if there is no such board.
    """
    for depth in reversed(range(finders[0].depth)):
        searches = [finder.search(depth, pattern, grid_size) for finder in finders]
        quick_look = next(searches[0], None)
        order = range(len(finders)) if quick_look is not None else (*range(1, len(finders)), 0)
        for which in order:
            *_, best = (quick_look if which == 0 else None, *searches[which])
            if best is not None:
                return best, which
    return None


def _shows_tags(reader: TagReader) -> bool:
    """Return whether quadrilaterals of a sample are read as tags: one of a family whose tags are
    hardly mistaken, or as many of another as agree on a board."""
    for tag_print in list_prints(None, None):
        if len(reader.read(tag_print).numbers) >= (1 if _is_sure(tag_print) else MIN_TAGS):
            return True
    return False


def _read_board(
    reader: TagReader, pattern: AprilGrid, grid_size: GridSize | None, outline: Array | None
) -> GridTags | None:
    """Read the tags of a board; None if there is none.

    That of most tags is taken, and of no other family once tags were read that are hardly mistaken.
    With a border of the wrong width some of the tags are read all the same, with cells misread.
    """
    best: GridTags | None = None
    most, sure_family = 0.0, None
    for tag_print in list_prints(pattern.family, pattern.border):
        if sure_family not in (None, tag_print.family):
            continue
        board = _identify_tags(reader, tag_print, pattern, grid_size, outline)
        if board is None:
            continue
        right = _describe_tags(board[0]).rate_markers(reader.image, board[1])[0]
        if right.sum() > most:
            best, most = board, float(right.sum())
        if _is_sure(tag_print):
            if right.mean() > _MIN_SURE_SHARE:
                break
            sure_family = tag_print.family
    return best


def _identify_tags(
    reader: TagReader,
    tag_print: TagPrint,
    pattern: AprilGrid,
    grid_size: GridSize | None,
    outline: Array | None,
) -> GridTags | None:
    """Identify the tags of one print that agree on a board, turned as most of them agree, and read
    those beside them; None if there are too few, or they do not tell where they are on it."""
    tags = reader.read(tag_print)
    if not len(tags.numbers):
        return None
    clockwise = (np.arange(4) + tags.turns[:, None]) % 4
    numbers, corners = drop_repeated(tags.numbers, reader.quads[tags.which[:, None], clockwise])
    on_board = numbers >= (pattern.first_tag or 0)
    if grid_size is not None and pattern.first_tag is not None:
        on_board &= numbers < pattern.first_tag + grid_size[0] * grid_size[1] // 4
    numbers, corners = numbers[on_board], corners[on_board]
    is_open = grid_size is None and _is_sure(tag_print)
    likely = _ALL_LAYOUTS if is_open else _list_likely_layouts(numbers, corners)
    stated = likely if grid_size is None else list_layouts(grid_size[1] // 2, None)
    first = pattern.first_tag or 0
    known, allowed = (
        [layout._replace(first=first) for layout in layouts if order in (None, layout.from_top)]
        for layouts, order in ((likely, None), (stated, pattern.from_top))
    )
    readings: list[Markers[TagLayout]] = []
    for turn in range(4) if pattern.tag_turn is None else (pattern.tag_turn,):
        upright = np.roll(corners, turn, axis=1)
        turned = identify_board(numbers, upright, allowed, known) if allowed else []
        if turned and (not readings or len(turned[0].numbers) > len(readings[0].numbers)):
            readings, tag_print = turned, tag_print._replace(turn=turn)
        if readings and len(readings[0].numbers) == len(numbers):
            break
    if not readings:
        return None
    count = None
    if grid_size is not None and pattern.first_tag is not None:
        count = first + grid_size[0] * grid_size[1] // 4
    readings = grow_markers(
        reader.image,
        readings,
        _describe_tags(tag_print),
        count,
        outline,
        lambda quads: _refine_quads(reader.image, quads),
    )
    if len(readings) != 1 or readings[0].side <= _MIN_SIDE:
        return None
    if _is_sure(tag_print) and _is_contradicted(numbers, readings[0]):
        return None
    is_placed = grid_size is not None or tell_rows_apart(readings[0].squares, TAG_NEIGHBOURS)
    return (tag_print, readings[0]) if is_placed else None


def _is_contradicted(numbers: IntArray, tags: Markers[TagLayout]) -> bool:
    """Return whether too many tags of the rows that a board was read in are not in their places.

    Args:
        numbers: (n,) of all tags that were read.
        tags: those that agree on the board. One of two equal boards has all of its own.
    """
    row, rows = tags.layout.locate_squares(numbers)[:, 0], tags.squares[:, 0]
    between = (row >= rows.min()) & (row <= rows.max())
    contradicting = np.setdiff1d(numbers[between], tags.numbers)
    return len(contradicting) > _MAX_CONTRADICTING * len(tags.numbers)


def _is_sure(tag_print: TagPrint) -> bool:
    """Return whether the tags of a print are hardly mistaken for others."""
    return load_family(tag_print.family).distance >= _MIN_SURE_DISTANCE


def _count_tags(board: GridTags) -> int:
    """Return the number of tags of a board that were read."""
    return len(board[1].numbers)


@lru_cache
def _describe_tags(tag_print: TagPrint) -> MarkerPrints:
    """Describe the tags of a print."""
    count = len(load_family(tag_print.family).cells)
    return describe_prints(draw_tags(tag_print, np.arange(count)), TAG_NEIGHBOURS)


def _list_likely_layouts(numbers: IntArray, corners: Array) -> list[TagLayout]:
    """List the layouts by which tags may be neighbours in one column that lie side by side; numbers
    (n,), corners (n, 4, 2) px."""
    centre = corners.mean(axis=1)
    side = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    near = np.linalg.norm(centre - centre[:, None], axis=2) < _NEIGHBOUR_DISTANCE * side
    return list_layouts_of_columns(numbers, near)


def _is_wholly_read(tags: Markers[TagLayout]) -> bool:
    """Return whether all tags were read within the rows and columns of those that were."""
    rows, cols = np.ptp(tags.squares, axis=0) + 1
    return bool(len(tags.numbers) == rows * cols)


def _smooth(image: GreyImage) -> GreyImage:
    """Return a smoothed copy of an image, in which noise breaks fewer outlines."""
    return opencv.smooth_image(image, _SMOOTHING_SIGMA)


def _select_dark_borders(image: GreyImage, quads: Array, limit: float, most: int) -> Array:
    """Select at most so many of the quadrilaterals (n, 4, 2) px, those of the darkest borders, of
    which no more than a share is bright; see `rate_borders`."""
    rating = rate_borders(image, quads)
    order = np.argsort(rating, kind="stable")[:most]
    return quads[order[np.isfinite(rating[order]) & (rating[order] <= limit)]]


def _refine_quads(image: GreyImage, quads: Array) -> Array:
    """Move the corners (n, 4, 2) px of quadrilaterals to the saddle points beside them, if all four
    have one, and no paper comes in. Beside tags without small squares there are none but in noise,
    and moves by 3 to 15 px: of 52 such quadrilaterals all were brighter along their sides then, of
    1360 that had saddle points none."""
    side = np.linalg.norm(quads - np.roll(quads, 1, axis=1), axis=2).min(axis=1)
    sigma, limit = np.clip(_REFINING_SIGMA * side, *_SIGMA_LIMITS), _MAX_REFINING_SHIFT * side
    moved, remaining = quads.copy(), np.arange(len(quads))
    for corners in ([0], [2], [1, 3]):  # most that lack one are done with after the first
        start, count = quads[remaining][:, corners], len(corners)
        uv, good = saddle.refine_saddles(
            image,
            start.reshape(-1, 2),
            np.repeat(sigma[remaining], count),
            np.repeat(limit[remaining], count),
        )
        moved[remaining[:, None], corners] = uv.reshape(start.shape)
        remaining = remaining[good.reshape(-1, count).all(axis=1)]
        if not len(remaining):
            return quads
    refined = remaining[
        rate_borders(image, moved[remaining]) <= rate_borders(image, quads[remaining])
    ]
    out = quads.copy()
    out[refined] = moved[refined]
    return out


def _reach_paper(image: GreyImage, quads: Array) -> Array:
    """Move the sides of quadrilaterals (n, 4, 2) px outwards that do not border on paper: a quick
    search takes what is farther from it than half of its window for evenly filled, so that of a
    broad border it finds the inner side of that seam, too."""

    def sample_sides(by: float) -> Array:
        widened = _widen(quads, by)
        places = widened + _PLACES_ALONG * (np.roll(widened, -1, axis=1) - widened)
        return np.asarray(sample_image(image, places).mean(axis=(0, 2)))

    is_inside = sample_sides(_BEYOND) - sample_sides(-_BEYOND) < opencv.DARKER
    moved = _widen(quads, opencv.QUICK_WINDOW / 2)
    return np.where(is_inside[:, None, None], moved, quads)


def _widen(quads: Array, by: float) -> Array:
    """Move the sides of quadrilaterals (n, 4, 2) outwards by `by` px."""
    centre = quads.mean(axis=1, keepdims=True)
    side = np.linalg.norm(quads - np.roll(quads, 1, axis=1), axis=2).mean(axis=1)
    return centre + (quads - centre) * (1 + 2 * by / side)[:, None, None]
