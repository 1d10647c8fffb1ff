"""The tags of an AprilGrid: found in an image, read, and placed on the board.

Tags are looked for among the dark quadrilaterals of the image, of its coarsest size first. At the
others it takes long: it is done quickly, and only if a sample of the image (`PrintSample`) shows
tags. So it is with the negative, of which few boards are printed. The small black squares touch the
corners of the tags, and blur may join them; so the image is also searched after each pixel took the
brightest level around it, which parts them.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GreyImage, GridSize, IntArray
from calibgui.engine.boards.april_grid import AprilGrid, TagLayout
from calibgui.engine.boards.apriltags import load_family
from calibgui.engine.detection.apriltags.tag_places import MAX_COLS, MIN_TAGS, list_layouts
from calibgui.engine.detection.apriltags.tag_reader import (
    TagPrint,
    TagReader,
    list_prints,
    rate_borders,
)
from calibgui.engine.detection.charuco.markers import Markers, drop_repeated, identify_board
from calibgui.engine.detection.checkerboard import saddle
from calibgui.engine.detection.print_samples import PrintSample, detect_dark_quads
from calibgui.engine.detection.region_of_interest import are_inside

_MAX_COARSE_SIDE = 1600
"""Longer side of the image in which tags are looked for first, px."""
_MIN_SIDE = 0.5
"""Least side of a tag over the distance of two: the gap of an AprilGrid is at most as wide."""
_REFINING_SIGMA, _SIGMA_LIMITS = 0.06, (0.8, 6.0)
"""Standard deviation of the weights with which the corners of a tag are refined, sides of the tag,
and its limits, px."""
_MAX_REFINING_SHIFT = 0.12
"""Greatest distance by which the corners of a tag are refined, sides of the tag: less than that to
any other crossing of edges."""
_PARTED_BY = 1.0
"""Width by which a tag becomes narrower on every side as each pixel takes the brightest level
around it, px."""
_MIN_SURE_DISTANCE = 9
"""Distance of a family from which on tags that agree on a board are not mistaken for others'."""
_NEIGHBOUR_DISTANCE = 2.2
"""Greatest distance of neighbours in a column, sides of a tag: the gap is at most as wide as it."""
_MIN_READ_SHARE = 0.8
"""Least share of the tags within the rows and columns seen that makes a further search needless."""
_MAX_BRIGHT_SHARE = 0.45
"""Greatest share of the outermost places of a refined quadrilateral that may be bright: one that is
read as a tag has at most 36 %."""
_MAX_SAMPLED = 200
"""Number of quadrilaterals of a sample that are read, those of the darkest borders: in brickwork
there are thousands."""

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
            positive: the finder of the image that `image` is the negative of, if it is one.
        """
        self._outline = outline
        self._levels = [image]
        while max(self._levels[-1].shape) > _MAX_COARSE_SIDE:
            self._levels.append(opencv.halve_image(self._levels[-1]))
        self._readers: dict[tuple[int, bool], TagReader] = {}
        self._is_negative = positive is not None
        # A negative has the same contrasts.
        self._samples: dict[int, PrintSample] = {} if positive is None else positive._samples
        self._shown: dict[int, bool] = {}

    def find(self, pattern: AprilGrid, grid_size: GridSize | None) -> GridTags | None:
        """Find the tags of a board.

        Args:
            pattern: what is stated of the board.
            grid_size: rows and columns of corners, if stated.

        Returns:
            None if there is no such board.
        """
        for depth in reversed(range(len(self._levels))):
            board = None
            if not self._may_show_tags(depth):
                continue
            for is_parted in (True, False):
                board = _read_board(self._make_reader(depth, is_parted), pattern, grid_size)
                if board is not None and _is_mostly_read(board[1]):
                    break
            if board is not None:
                return board
        return None

    def _may_show_tags(self, depth: int) -> bool:
        """Return whether a sample of one size of the image shows tags, once. The coarsest is quick:
        it is searched anyway, but the negative, of which few boards are printed, only if a look at
        it shows tags."""
        if depth == len(self._levels) - 1 and not self._is_negative:
            return True
        if depth not in self._shown:
            self._shown[depth] = any(
                _shows_tags(TagReader(self._levels[0], self._find_quads(depth, is_parted, True)))
                for is_parted in (True, False)
            )
        return self._shown[depth]

    def _find_quads(self, depth: int, is_parted: bool, is_sample: bool = False) -> Array:
        """Find the quadrilaterals (n, 4, 2) px of one size of the image, or of a sample of it, that
        may be tags."""
        image, level = self._levels[0], self._levels[depth]
        searched = level
        if is_parted:
            parted = opencv.dilate_image(level, np.ones((3, 3), dtype=np.bool_))
            searched = np.asarray(parted, dtype=np.uint8)
        is_coarsest = depth == len(self._levels) - 1
        if is_sample and not is_coarsest:
            if depth not in self._samples:
                self._samples[depth] = PrintSample(self._levels[depth + 1])
            found = self._samples[depth].detect_dark_quads(searched)
        elif is_coarsest:
            found = detect_dark_quads(searched, is_quick=is_sample)
        else:
            found = opencv.detect_dark_quads(searched, is_quick=True)
        found = _widen(found, _PARTED_BY if is_parted else 0)
        rating = rate_borders(level, found)
        order = (
            np.argsort(rating, kind="stable")[:_MAX_SAMPLED] if is_sample else np.arange(len(found))
        )
        found = found[order[np.isfinite(rating[order])]]
        found = _refine_quads(image, (found + 0.5) * 2**depth - 0.5)
        found = found[rate_borders(image, found) <= _MAX_BRIGHT_SHARE]
        if self._outline is not None:
            found = found[are_inside(self._outline, found.mean(axis=1))]
        return found

    def _make_reader(self, depth: int, is_parted: bool) -> TagReader:
        """Make the reader of the quadrilaterals of one size of the image, once: of those seen after
        each pixel took the brightest level around it, or of these and those seen before."""
        if (depth, is_parted) not in self._readers:
            reader = TagReader(self._levels[0], self._find_quads(depth, is_parted))
            if not is_parted:
                reader = self._make_reader(depth, is_parted=True).join(reader)
            self._readers[depth, is_parted] = reader
        return self._readers[depth, is_parted]


def _shows_tags(reader: TagReader) -> bool:
    """Return whether quadrilaterals of a sample are read as tags: one of a family whose tags are
    hardly mistaken, or as many of another as agree on a board."""
    for tag_print in list_prints(None, None):
        is_sure = load_family(tag_print.family).distance >= _MIN_SURE_DISTANCE
        if len(reader.read(tag_print).numbers) >= (1 if is_sure else MIN_TAGS):
            return True
    return False


def _read_board(
    reader: TagReader, pattern: AprilGrid, grid_size: GridSize | None
) -> GridTags | None:
    """Read the tags of a board: the first of a family whose tags are hardly mistaken, else that of
    most tags; None if there is none."""
    cols = None if grid_size is None else grid_size[1] // 2
    boards: list[GridTags] = []
    for tag_print in list_prints(pattern.family, pattern.border):
        tags = reader.read(tag_print)
        if not len(tags.numbers):
            continue
        turned = (np.arange(4) + tags.turns[:, None]) % 4
        numbers, corners = drop_repeated(tags.numbers, reader.quads[tags.which[:, None], turned])
        known = _list_likely_layouts(numbers, corners)
        allowed = [
            layout
            for layout in (known if cols is None else list_layouts(cols, None))
            if pattern.from_top in (None, layout.from_top)
        ]
        readings = identify_board(numbers, corners, allowed, known) if allowed else []
        if len(readings) == 1 and readings[0].side > _MIN_SIDE:
            boards.append((tag_print, readings[0]))
            if load_family(tag_print.family).distance >= _MIN_SURE_DISTANCE:
                break
    return max(boards, key=lambda board: len(board[1].numbers), default=None)


def _list_likely_layouts(numbers: IntArray, corners: Array) -> list[TagLayout]:
    """List the layouts by which tags may be neighbours in one column that lie side by side; numbers
    (n,), corners (n, 4, 2) px."""
    centre = corners.mean(axis=1)
    side = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    near = np.linalg.norm(centre - centre[:, None], axis=2) < _NEIGHBOUR_DISTANCE * side
    between = np.unique(np.abs(np.subtract.outer(numbers, numbers))[near])
    return [
        layout
        for cols in between.tolist()
        if 0 < cols <= MAX_COLS
        for layout in list_layouts(cols, None)
    ]


def _is_mostly_read(tags: Markers[TagLayout]) -> bool:
    """Return whether most tags were read within the rows and columns of those that were."""
    rows, cols = np.ptp(tags.squares, axis=0) + 1
    return bool(len(tags.numbers) > _MIN_READ_SHARE * rows * cols)


def _refine_quads(image: GreyImage, quads: Array) -> Array:
    """Move the corners (n, 4, 2) px of quadrilaterals to the saddle points beside them, if all four
    have one."""
    side = np.repeat(np.linalg.norm(quads - np.roll(quads, 1, axis=1), axis=2).min(axis=1), 4)
    uv, good = saddle.refine_saddles(
        image,
        quads.reshape(-1, 2),
        np.clip(_REFINING_SIGMA * side, *_SIGMA_LIMITS),
        _MAX_REFINING_SHIFT * side,
    )
    refined = np.asarray(good.reshape(-1, 4).all(axis=1))
    return np.where(refined[:, None, None], uv.reshape(-1, 4, 2), quads)


def _widen(quads: Array, by: float) -> Array:
    """Move the sides of quadrilaterals (n, 4, 2) outwards by `by` px."""
    centre = quads.mean(axis=1, keepdims=True)
    side = np.linalg.norm(quads - np.roll(quads, 1, axis=1), axis=2).mean(axis=1)
    return centre + (quads - centre) * (1 + 2 * by / side)[:, None, None]
