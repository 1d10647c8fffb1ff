"""Dark quadrilaterals of an image, and the dictionaries that they may be markers of.

Reading the markers of one dictionary takes OpenCV long where the dictionary is large, whatever
the image shows. What may be a marker at all is found once for all of them: a dark quadrilateral,
sampled in k + 2 cells a side. The outermost cells are dark; the k x k others, as +1 and -1,
have with each marker of the dictionary, turned by quarters, the inner product k^2 less twice the
number of cells that differ. As many may differ as OpenCV would correct.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, BoolArray, FloatImage, GreyImage, IntArray
from calibgui.engine.detection.charuco.marker_cells import find_dark_cells
from calibgui.engine.detection.charuco.markers import drop_repeated
from calibgui.engine.detection.charuco.thresholds import CHARUCO_THRESHOLDS


class MarkerCandidates:
    """The dark quadrilaterals of one image, each of which may be a marker."""

    def __init__(self, image: GreyImage, quads: Array) -> None:
        """
        Args:
            image: (h, w) 8-bit grey levels.
            quads: (n, 4, 2) px.
        """
        self._image = image
        self._quads = quads
        self._cells: dict[int, BoolArray] = {}
        self._bordered: dict[tuple[int, bool], tuple[IntArray, FloatImage, IntArray]] = {}
        self._matches: dict[tuple[str, bool, bool], tuple[IntArray, IntArray]] = {}

    def count_fitting(self, dictionary: str, is_inverted: bool = False) -> int:
        """Count the quadrilaterals that may be markers of a dictionary, or, `is_inverted`, markers
        printed bright on dark: the dark around these has an inner edge."""
        return len(self._match_dictionary(dictionary, is_inverted)[0])

    def read_fitting(
        self, dictionary: str, is_inverted: bool = False, is_mirrored: bool = False
    ) -> tuple[IntArray, Array]:
        """Read the quadrilaterals that may be markers, as `count_fitting`, each once; or,
        `is_mirrored`, what may be markers in a mirror.

        Returns:
            Numbers (n,) and corners (n, 4, 2) px, clockwise as printed from the upper left.
        """
        which, best = self._match_dictionary(dictionary, is_inverted, is_mirrored)
        numbers, turns = np.divmod(best, 4)
        turned = (np.arange(4) - turns[:, None]) % 4
        if is_mirrored:
            turned = -turned % 4
        return drop_repeated(numbers, self._quads[which[:, None], turned])

    def _match_dictionary(
        self, dictionary: str, is_inverted: bool, is_mirrored: bool = False
    ) -> tuple[IntArray, IntArray]:
        """Find the quadrilaterals (n,) that may be markers, and the turned markers (n,), as
        `_encode_markers` lists them, that they are most alike; once."""
        key = dictionary, is_inverted, is_mirrored
        if key not in self._matches:
            self._matches[key] = self._match_cells(*key)
        return self._matches[key]

    def _match_cells(
        self, dictionary: str, is_inverted: bool, is_mirrored: bool
    ) -> tuple[IntArray, IntArray]:
        """Compare the cells of all quadrilaterals with a dictionary; see `_match_dictionary`."""
        if not len(self._quads):
            return np.zeros(0, np.int64), np.zeros(0, np.int64)
        codes = _encode_markers(dictionary)
        k = int(np.sqrt(codes.cells.shape[1]))
        which, cells, darkness = self._find_bordered(k, is_inverted)
        # What is as dark or as bright all over as bricks, unlike any marker, need not be compared.
        is_like = np.abs(darkness - codes.middle) <= codes.half_range + codes.correctable
        which, seen = which[is_like], cells[is_like]
        if is_mirrored:
            seen = seen.swapaxes(1, 2)
        alike = seen.reshape(-1, k * k) @ codes.cells.T
        fits = alike.max(axis=1, initial=-np.inf) >= k * k - 2 * codes.correctable
        return which[fits], alike[fits].argmax(axis=1)

    def _find_bordered(self, k: int, is_inverted: bool) -> tuple[IntArray, FloatImage, IntArray]:
        """Find the quadrilaterals (n,) with the border of a marker of k x k cells, these cells
        (n, k, k), +1 or -1, and how many of them are dark (n,); once."""
        if k not in self._cells:
            self._cells[k] = find_dark_cells(self._image, self._quads, k + 2)
        if (k, is_inverted) not in self._bordered:
            dark = ~self._cells[k] if is_inverted else self._cells[k]
            inner = dark[:, 1:-1, 1:-1]
            darkness = inner.sum(axis=(1, 2))
            bright = (k + 2) ** 2 - k * k - (dark.sum(axis=(1, 2)) - darkness)
            which = np.flatnonzero(bright <= CHARUCO_THRESHOLDS.max_border_error_share * k * k)
            cells = np.where(inner[which], 1.0, -1.0).astype(np.float32)
            self._bordered[k, is_inverted] = which, cells, darkness[which]
        return self._bordered[k, is_inverted]


class _Codes(NamedTuple):
    """The markers of a dictionary."""

    cells: FloatImage
    """(4 m, k^2) float32, +1 where dark and -1 where bright, in all four turns."""
    middle: float
    """Middle of the numbers of their dark cells."""
    half_range: float
    """Half the range of these numbers."""
    correctable: int
    """Number of misread cells that OpenCV corrects."""


@lru_cache
def draw_markers(dictionary: str) -> BoolArray:
    """Return the cells (m, k, k) of a dictionary's markers, their border of one cell included, True
    where dark."""
    count = opencv.list_dictionaries()[dictionary]
    return np.array([opencv.draw_marker_cells(dictionary, number) for number in range(count)])


@lru_cache
def _encode_markers(dictionary: str) -> _Codes:
    """Encode the markers of a dictionary."""
    cells = draw_markers(dictionary)[:, 1:-1, 1:-1]
    turned = np.stack([np.rot90(cells, turn, axes=(1, 2)) for turn in range(4)], axis=1)
    darkness = cells.sum(axis=(1, 2))
    least, most = float(darkness.min()), float(darkness.max())
    return _Codes(
        np.where(turned, 1.0, -1.0).astype(np.float32).reshape(4 * len(cells), -1),
        (least + most) / 2,
        (most - least) / 2,
        opencv.count_correctable_cells(dictionary),
    )
