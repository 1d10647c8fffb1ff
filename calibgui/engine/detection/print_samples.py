"""A look at a part of a large image: may it show small marks at all?

To search an image of many megapixels for the outlines of small marks takes many times as long as to
find a board of usual size in a copy of it. So a part of it is searched first: the tiles that look
most like marks, and only if these show some the whole is.

Marks are black beside white every few pixels. How much of that there is in a block is measured by

    detail = mean of |level - mean of the 5 x 5 pixels around|

in the image halved: next to nothing where it is plain or out of focus, little in noise, which
halving averages away, and in leaves or walls, whose edges lie farther apart. A tile counts by its
best blocks, so that a board smaller than it does not drown in what is around. Of boards of 140 to
330 px in 12 megapixels of leaves, polygons, bricks or grain the tiles are among the first three.

Where hundreds of things are as dark quadrilaterals as marks are, as in brickwork, small ones are
looked for in such tiles at every size (`QuadSearch`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GreyImage

_TILE, _MARGIN = 320, 32
"""Side of a tile and the margin around it that is searched as well, px: what lies across its sides
and is no larger than a mark that the next coarser copy does not show."""
_BLOCK, _AROUND = 32, 5
"""Side of a block, and of the surroundings of a pixel, px of the halved image."""
_BEST_BLOCKS = 4
"""Number of a tile's blocks that count: those of a board of 130 px."""
_MIN_DETAIL = 0.5
"""Detail below which a tile is plain, grey levels: noise has as much."""
_SEARCHED_SHARE, _MIN_TILES = 1 / 24, 4
"""Share of the tiles that are searched, and the least number: the time is then a fraction of that
for the whole, which in noise takes ten times as long as to find a board."""
_MAX_QUADS = 1000
"""Number of quadrilaterals after which no further tile is searched: more than 300 marks of 20 px
have, within and around them, and brickwork has thousands."""


_COUNTING_WINDOW, _MIN_PERIMETER = 11, 20
"""Side of the surroundings with which quadrilaterals are counted, and the perimeter of those that
count, px of the halved image: that of the smallest marks."""
_MAX_COMPARED = 300
"""Number of quadrilaterals beyond which OpenCV's comparison of each with all markers takes longer
than to find them: 0.1 s for 500 bricks in 640 x 480; a board of 130 marks has as many."""
_MAX_COUNT = 600
"""Number of quadrilaterals beyond which OpenCV's search, whose time grows with its square, takes
longer than to find a board: brickwork has 600 to 2000, a board of 300 marks no more than 600."""


class QuadSearch:
    """A search of an image for dark quadrilaterals; how many there are is counted once, and small
    ones are looked for once where there are hundreds."""

    def __init__(self, image: GreyImage) -> None:
        """
        Args:
            image: (h, w) 8-bit grey levels.
        """
        self._image = image

    @cached_property
    def _halved(self) -> GreyImage:
        """The image in half its size."""
        return opencv.halve_image(self._image)

    @cached_property
    def _count(self) -> int:
        """Number of quadrilaterals as far as it is of interest; 0 if there are few."""
        limits = _MAX_COMPARED, _MAX_COUNT
        return opencv.count_quads(self._halved, _COUNTING_WINDOW, _MIN_PERIMETER, *limits)

    @property
    def are_many(self) -> bool:
        """True if there are hundreds: OpenCV compares each of them with each marker."""
        return self._count >= _MAX_COMPARED

    @cached_property
    def _sampled(self) -> Array | None:
        """The quadrilaterals of a sample, None if small ones are looked for everywhere."""
        if self._count < _MAX_COUNT:
            return None
        return PrintSample(self._halved).detect_dark_quads(self._image)

    def detect_dark_quads(self, is_quick: bool = False) -> Array:
        """Return corners (n, 4, 2) px of the dark quadrilaterals, quickly or not. Where there are
        hundreds the small ones are looked for in a sample."""
        if self._sampled is None:
            return opencv.detect_dark_quads(self._image, is_quick)
        large = opencv.detect_dark_quads(self._image, is_quick, least_side=_MARGIN)
        return np.concatenate([large, self._sampled])


class PrintSample:
    """The tiles of an image that look most like marks."""

    def __init__(self, halved: GreyImage) -> None:
        """
        Args:
            halved: (h, w) 8-bit grey levels of the image in half its size.
        """
        scores = _score_tiles(halved)
        most = max(_MIN_TILES, round(_SEARCHED_SHARE * scores.size))
        best = np.argsort(-scores, axis=None, kind="stable")[:most]
        rows, cols = np.unravel_index(best[scores.flat[best] > _MIN_DETAIL], scores.shape)
        self._corners = _TILE * np.column_stack([rows, cols])

    def detect_dark_quads(
        self,
        image: GreyImage,
        prepare: Callable[[GreyImage], GreyImage] = np.ascontiguousarray,
    ) -> Array:
        """Return corners (n, 4, 2) px of the dark quadrilaterals in the tiles of the image, its
        negative or a filtered copy, 8 bits, quickly; some of them twice.

        Args:
            image: (h, w) grey levels.
            prepare: filters a tile before it is searched.
        """
        parts = [np.zeros((0, 4, 2))]
        for row, col in self._corners.tolist():
            top, left = max(row - _MARGIN, 0), max(col - _MARGIN, 0)
            part = image[top : row + _TILE + _MARGIN, left : col + _TILE + _MARGIN]
            quads = opencv.detect_dark_quads(prepare(part), is_quick=True, is_part=True)
            parts.append(quads + np.array([left, top]))
            if sum(map(len, parts)) > _MAX_QUADS:
                break
        return np.concatenate(parts)


def _score_tiles(halved: GreyImage) -> Array:
    """Score the tiles (rows, cols) of an image whose halved copy (h, w) is given; see the head of
    this module."""
    detail = opencv.average_detail(halved, _AROUND, _BLOCK)
    in_row = _TILE // (2 * _BLOCK)
    padded = np.pad(detail, [(0, -length % in_row) for length in detail.shape])
    rows, cols = (length // in_row for length in padded.shape)
    tiles = padded.reshape(rows, in_row, cols, in_row).transpose(0, 2, 1, 3)
    best = np.sort(tiles.reshape(rows, cols, in_row * in_row), axis=2)[..., -_BEST_BLOCKS:]
    return np.asarray(best.mean(axis=2))
