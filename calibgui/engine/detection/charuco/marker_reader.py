"""Reading the markers of an image: of a stated dictionary, or of whichever it may be.

Reading is slow on large images and for large dictionaries. So the image is read at the coarsest
size first, and only those dictionaries are read of which the image's dark quadrilaterals
(`MarkerCandidates`) may be markers; at the coarsest size, which is quick, a stated one always is.
At the other sizes to look for quadrilaterals takes long as well, above all where the image is full
of texture: it is done quickly, once for dark and for bright markers, and only if a sample of the
image (`PrintSample`) shows two that fit near to each other; and they are read only if those found
lie as on a board.
The dictionaries of a family of OpenCV's begin alike: the markers of the smallest are the first of
all.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from functools import lru_cache, partial
from typing import NamedTuple

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GreyImage, IntArray
from calibgui.engine.boards.charuco import MARKER_LAYOUTS, MarkerLayout, dictionary_family
from calibgui.engine.detection.charuco.marker_candidates import MarkerCandidates, draw_markers
from calibgui.engine.detection.charuco.marker_growth import (
    MARKER_NEIGHBOURS,
    MarkerPrints,
    describe_prints,
    grow_markers,
    tell_rows_apart,
)
from calibgui.engine.detection.charuco.markers import Markers, are_some_near, identify_board
from calibgui.engine.detection.charuco.thresholds import CHARUCO_THRESHOLDS
from calibgui.engine.detection.print_samples import PrintSample, QuadSearch
from calibgui.engine.lattices import region_of_interest as region
from calibgui.engine.lattices.region_of_interest import are_inside

MAX_COARSE_SIDE = 1600
"""Longer side of the image in which markers or tags are looked for first, px."""
_FAMILIES = (
    *(f"DICT_{k}X{k}" for k in (4, 5, 6, 7)),
    "DICT_ARUCO_ORIGINAL",
    "DICT_APRILTAG_36H11",
    "DICT_ARUCO_MIP_36H12",
    "DICT_APRILTAG_36H10",
    "DICT_APRILTAG_25H9",
    "DICT_APRILTAG_16H5",
)
"""Families of dictionaries that are tried where none is stated, the usual ones first."""

Box = tuple[int, int, int, int]
"""First column and row of a part of an image, and those behind the last, px."""


class ReadBoard(NamedTuple):
    """A board whose markers were read."""

    dictionary: str
    """Name of the markers' dictionary."""
    readings: list[Markers[MarkerLayout]]
    """The markers on each of the layouts that they agree with equally well: one, or both colours of
    the first square."""

    def count_markers(self) -> int:
        """Return the number of markers of the board that were read."""
        return len(self.readings[0].numbers)


class MarkerReader:
    """A reader of the markers of one image, from its coarsest size to its full size."""

    def __init__(
        self,
        image: GreyImage,
        outline: Array | None,
        positive: MarkerReader | None = None,
        numbers: range | None = None,
    ) -> None:
        """
        Args:
            image: (h, w) 8-bit grey levels.
            outline: (4, 2) px, the region of interest; None for the whole image.
            positive: the reader of the image that `image` is the negative of, if it is one.
            numbers: those of the markers to read, in steps of 1; None for all.
        """
        self._levels = [image]
        while max(self._levels[-1].shape) > MAX_COARSE_SIDE:
            self._levels.append(opencv.halve_image(self._levels[-1]))
        self._outline = None if outline is None else region.enlarge_outline(outline)
        self._positive = positive
        self._numbers = numbers
        self._quads = QuadSearch(self._levels[-1])
        self._candidates: dict[int, MarkerCandidates] = {}
        self._samples: dict[int, MarkerCandidates] = {}
        self._boxes: dict[tuple[int, str], Box] = {}
        self._read: dict[tuple[int, str], tuple[IntArray, Array]] = {}
        self.is_undecided = False
        """True once markers of a board were read that do not tell the length of its rows."""

    def read_dictionary(
        self,
        name: str,
        layouts: Collection[MarkerLayout],
        count: int | None = None,
        least: int = CHARUCO_THRESHOLDS.min_markers,
    ) -> ReadBoard | None:
        """Read the markers of a stated dictionary on a board of one of the layouts.

        Args:
            name: of the dictionary.
            layouts: those that the board may have.
            count: number of markers on the board, if it is known.
            least: number of markers that have to agree on it.

        Returns:
            The dictionary and the markers; None if they show no such board.
        """

        def list_if_likely(depth: int) -> list[str]:
            is_coarsest = depth == len(self._levels) - 1
            if is_coarsest and not self._quads.are_many:
                return [name]
            return self._select_likely([name], least, False, depth)

        return self._read_first(list_if_likely, layouts, count, least)

    def search_dictionaries(
        self,
        layouts: Collection[MarkerLayout],
        count: int | None = None,
        least: int = CHARUCO_THRESHOLDS.min_markers,
        *,
        must_agree: bool = False,
    ) -> ReadBoard | None:
        """Read the markers of an unknown dictionary on a board of one of the layouts.

        Args:
            layouts: as of `read_dictionary`, like `count` and `least`.
            must_agree: True to read only dictionaries of which even a quick look shows markers that
                agree on a board: it takes half of the time, and misses boards that hardly show any.

        Returns:
            The smallest dictionary of its family that reads the most markers, and these; None if
            none shows such a board.
        """
        best: ReadBoard | None = None
        for rank in (0, 2):
            best = best or self._read_first(
                partial(self._select_likely, _list_family_members(rank), least, must_agree),
                layouts,
                count,
                least,
            )
        if best is None:
            return None
        for larger in _list_larger(best.dictionary):
            if not self._may_show_more(larger, best):
                break
            found = self.read_dictionary(larger, layouts, count, least)
            if found is None or found.count_markers() <= best.count_markers():
                break
            best = found
        return best

    def is_mirrored(self, dictionary: str | None) -> bool:
        """Return whether quadrilaterals of the coarsest level may be markers of a dictionary, or of
        any, in a mirror, and lie as on a board."""
        coarsest = self._find_candidates(len(self._levels) - 1)
        for name in [dictionary] if dictionary else _list_family_members(2):
            read = coarsest.read_fitting(name, is_mirrored=True)
            boards = _place(read, CHARUCO_THRESHOLDS.min_markers)
            if boards and tell_rows_apart(boards[0].squares, MARKER_NEIGHBOURS):
                return True
        return False

    def _may_show_more(self, dictionary: str, board: ReadBoard) -> bool:
        """Return whether more quadrilaterals may be markers of a dictionary than were read."""
        coarsest = self._find_candidates(len(self._levels) - 1)
        return coarsest.count_fitting(dictionary) > board.count_markers()

    def _read_first(
        self,
        names: Callable[[int], Iterable[str]],
        layouts: Collection[MarkerLayout],
        count: int | None,
        least: int,
    ) -> ReadBoard | None:
        """Read the first dictionary that shows a board, of those that `names` lists for each
        depth of the pyramid; without neighbours in different rows, markers that seem to agree on
        the length of a row may do so by chance."""
        is_stated = len({layout.cols for layout in layouts}) == 1
        for depth in reversed(range(len(self._levels))):
            for name in names(depth):
                read = self._read_markers(depth, name)
                readings = identify_board(*read, layouts, MARKER_LAYOUTS, least)
                if not readings:
                    continue
                prints = _describe_dictionary(name)
                readings = grow_markers(self._levels[0], readings, prints, count, self._outline)
                if not (is_stated or tell_rows_apart(readings[0].squares, MARKER_NEIGHBOURS)):
                    continue
                if len({reading.layout.cols for reading in readings}) == 1:
                    return ReadBoard(name, readings)
                self.is_undecided = True
        return None

    def _select_likely(
        self, names: list[str], least: int, must_agree: bool, depth: int
    ) -> list[str]:
        """Select the dictionaries of which enough quadrilaterals may be markers, two of them near
        each other where two are enough, and at a finer size, which takes long to read, or where
        they must, agree on a board: among thousands some fit by chance."""
        if depth < len(self._levels) - 1:
            return [name for name in names if self._agree_on_board(name, least, must_agree, depth)]
        coarsest = self._find_candidates(depth)
        likely = [name for name in names if coarsest.count_fitting(name) >= least]
        if must_agree:
            return [name for name in likely if _place(coarsest.read_fitting(name), least)]
        if least >= CHARUCO_THRESHOLDS.min_markers:
            return likely
        return [name for name in likely if are_some_near(coarsest.read_fitting(name)[1])]

    def _agree_on_board(self, dictionary: str, least: int, must_agree: bool, depth: int) -> bool:
        """Return whether quadrilaterals of one of the finer levels may be markers of a dictionary
        that lie as on a board; only if a sample shows two near to each other, which must agree on
        one or not, all are looked for."""
        is_inverted = self._positive is not None
        positive = self._positive or self
        sampled = positive._sample_candidates(depth).read_fitting(dictionary, is_inverted)
        if not (_place(sampled, 2) if must_agree else are_some_near(sampled[1])):
            return False
        read = positive._find_candidates(depth).read_fitting(dictionary, is_inverted)
        boards = _place(read, least)
        if boards:
            self._boxes[depth, dictionary] = _find_box(boards[0].corners, self._levels[depth].shape)
        return bool(boards)

    def _sample_candidates(self, depth: int) -> MarkerCandidates:
        """Find the quadrilaterals of a sample of one level of the pyramid, once."""
        if depth not in self._samples:
            level = self._levels[depth]
            quads = PrintSample(self._levels[depth + 1]).detect_dark_quads(level)
            self._samples[depth] = MarkerCandidates(level, quads)
        return self._samples[depth]

    def _find_candidates(self, depth: int) -> MarkerCandidates:
        """Find the quadrilaterals of one level of the pyramid, once."""
        if depth not in self._candidates:
            level, is_coarsest = self._levels[depth], depth == len(self._levels) - 1
            search = self._quads if is_coarsest else QuadSearch(level)
            quads = search.detect_dark_quads(is_quick=not is_coarsest)
            self._candidates[depth] = MarkerCandidates(level, quads)
        return self._candidates[depth]

    def _read_markers(self, depth: int, name: str) -> tuple[IntArray, Array]:
        """Read numbers (n,) and corners (n, 4, 2) px of markers in the region of interest, once; of
        a finer size only where some agree on a board: in texture OpenCV may take minutes."""
        if (depth, name) not in self._read:
            level = self._levels[depth]
            left, top, right, bottom = self._boxes.get((depth, name), (0, 0, *level.shape[::-1]))
            part = np.ascontiguousarray(level[top:bottom, left:right])
            numbers, corners, unread = opencv.detect_markers(part, name)
            if depth == len(self._levels) - 1 and depth not in self._candidates:
                quads = np.concatenate([corners, unread])
                self._candidates[depth] = MarkerCandidates(level, quads)
            corners = (corners + np.array([left, top]) + 0.5) * 2**depth - 0.5
            if self._outline is not None and len(numbers):
                inside = are_inside(self._outline, corners.mean(axis=1))
                numbers, corners = numbers[inside], corners[inside]
            if self._numbers is not None:
                wanted = (numbers >= self._numbers.start) & (numbers < self._numbers.stop)
                numbers, corners = numbers[wanted], corners[wanted]
            self._read[depth, name] = numbers, corners
        return self._read[depth, name]


def _place(read: tuple[IntArray, Array], least: int) -> list[Markers[MarkerLayout]]:
    """Place markers, numbers (n,) and corners (n, 4, 2) px, on a board of any layout if at least so
    many agree; see `identify_board`."""
    return identify_board(*read, MARKER_LAYOUTS, MARKER_LAYOUTS, least)


def _find_box(corners: Array, shape: tuple[int, ...]) -> Box:
    """Find the box twice as wide and high as the one around markers (n, 4, 2) px, within an image
    of `shape` (h, w)."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    margin = (high - low) / 2
    left, top = np.maximum(np.floor(low - margin), 0).astype(np.int64).tolist()
    limit = np.array(shape[::-1])
    right, bottom = np.minimum(np.ceil(high + margin), limit).astype(np.int64).tolist()
    return left, top, right, bottom


@lru_cache
def _describe_dictionary(name: str) -> MarkerPrints:
    """Describe the markers of a dictionary."""
    return describe_prints(draw_markers(name), MARKER_NEIGHBOURS)


def _list_family(family: str) -> list[str]:
    """List the dictionaries of a family, smallest first."""
    sizes = opencv.list_dictionaries()
    same = [name for name in sizes if dictionary_family(name) == family]
    return sorted(same, key=lambda name: sizes[name])


def _list_family_members(rank: int) -> list[str]:
    """List one dictionary of each family: that of a rank by size, from 0."""
    families = [_list_family(family) for family in _FAMILIES]
    return [members[min(rank, len(members) - 1)] for members in families]


def _list_larger(dictionary: str) -> list[str]:
    """List the larger dictionaries of the same family, smallest first."""
    members = _list_family(dictionary_family(dictionary))
    return members[members.index(dictionary) + 1 :]
