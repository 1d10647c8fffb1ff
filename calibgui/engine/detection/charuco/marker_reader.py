"""Reads the markers of an image: of a dictionary that is known, or of whichever it may be.

OpenCV's dictionaries of one family begin alike: the markers of the smallest are the first of all.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from functools import partial

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GreyImage, IntArray
from calibgui.engine.boards.charuco import Layout, dictionary_family
from calibgui.engine.detection import region_of_interest as region
from calibgui.engine.detection.charuco.marker_candidates import MarkerCandidates
from calibgui.engine.detection.charuco.markers import MIN_MARKERS, Markers, on_board
from calibgui.engine.detection.checkerboard.pyramid_search import contains

_COARSE = 1600
"""Longer side of the image in which markers are looked for first, px."""
_USUAL = (
    *(f"DICT_{k}X{k}" for k in (4, 5, 6, 7)),
    "DICT_ARUCO_ORIGINAL",
    "DICT_APRILTAG_36H11",
    "DICT_ARUCO_MIP_36H12",
)
"""Families of dictionaries that are tried where none is stated; others take longer."""


Seen = tuple[str, Markers]
"""A dictionary and the board's markers."""


class Reader:
    """Reads the markers of an image, coarsely first."""

    def __init__(self, image: GreyImage, outline: Array | None) -> None:
        self._levels = [image]
        while max(self._levels[-1].shape) > _COARSE:
            self._levels.append(opencv.half(self._levels[-1]))
        self._outline = None if outline is None else region.enlarged(outline)
        self._candidates: dict[int, MarkerCandidates] = {}
        self._read: dict[tuple[int, str], tuple[IntArray, Array]] = {}

    def grid_size(self, name: str, layouts: Collection[Layout]) -> Seen | None:
        """The dictionary, and its markers on a board of one of the layouts."""
        return self._first(lambda _: [name], layouts)

    def unknown(self, layouts: Collection[Layout]) -> Seen | None:
        """The same for a dictionary that is not stated: the smallest of its family that reads
        the most."""
        best = None
        for rank in (0, 2):
            best = best or self._first(partial(self._likely, _offamily(rank)), layouts)
        for larger in _larger(best[0]) if best is not None else ():
            found = self.grid_size(larger, layouts)
            if best is None or found is None or len(found[1].numbers) <= len(best[1].numbers):
                break
            best = found
        return best

    def _first(
        self, names: Callable[[int], Iterable[str]], layouts: Collection[Layout]
    ) -> Seen | None:
        """The first of the dictionaries to be tried at each depth that shows a board."""
        for depth in reversed(range(len(self._levels))):
            for name in names(depth):
                markers = on_board(*self._markers(depth, name), layouts)
                if markers is not None:
                    return name, markers
        return None

    def _likely(self, names: list[str], depth: int) -> list[str]:
        """The dictionaries that as many quadrilaterals may be of as a board needs."""
        if depth not in self._candidates:
            self._candidates[depth] = MarkerCandidates(self._levels[depth])
        seen = self._candidates[depth]
        return [name for name in names if seen.fitting(name) >= MIN_MARKERS]

    def _markers(self, depth: int, name: str) -> tuple[IntArray, Array]:
        if (depth, name) not in self._read:
            numbers, corners = opencv.markers(self._levels[depth], name)
            corners = (corners + 0.5) * 2**depth - 0.5
            if self._outline is not None and len(numbers):
                inside = contains(self._outline, corners.mean(axis=1))
                numbers, corners = numbers[inside], corners[inside]
            self._read[depth, name] = numbers, corners
        return self._read[depth, name]


def _sizes(stem: str) -> list[str]:
    """The dictionaries of a family, smallest first."""
    sizes = opencv.dictionaries()
    same = [name for name in sizes if dictionary_family(name) == stem]
    return sorted(same, key=lambda name: sizes[name])


def _offamily(rank: int) -> list[str]:
    """One dictionary of each of the usual families, the smallest for rank 0."""
    return [_sizes(stem)[min(rank, len(_sizes(stem)) - 1)] for stem in _USUAL]


def _larger(dictionary: str) -> list[str]:
    """The larger dictionaries of the same family."""
    same = _sizes(dictionary_family(dictionary))
    return same[same.index(dictionary) + 1 :]
