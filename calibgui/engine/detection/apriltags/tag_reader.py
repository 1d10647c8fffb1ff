"""Reading AprilTags in quadrilaterals of an image that may be tags.

A quadrilateral is sampled in n = k + 2 b cells a side, k those of the family's data and b those of
its border. The border has to be dark; the data cells are compared with every tag of the family in
its four turns. Fewer cells may be misread than would tell two tags apart: a tag is believed only
together with others that stand where its number says.
"""

from __future__ import annotations

from functools import cache, lru_cache
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import (
    Array,
    BoolArray,
    FloatImage,
    GreyImage,
    IntArray,
    compute_median,
)
from calibgui.engine.boards.april_grid import MAX_BORDER
from calibgui.engine.boards.apriltags import FAMILIES, load_family
from calibgui.engine.detection.charuco.marker_cells import find_dark_cells, measure_cells
from calibgui.engine.detection.charuco.marker_growth import MIN_RIGHT_STEPS
from calibgui.engine.images.sampling import make_mesh, sample_image

_MAX_BRIGHT_BORDER_SHARE = 0.2
"""Greatest share of a border's cells that may look bright. A plausibility limit."""

_SAMPLES = 10
"""Number of places along a side at which a quadrilateral is looked at before it is read."""
_MIN_BRIGHT_SHARE = 0.05
"""Share of these places that are bright in every tag, whose border takes half of them or more."""
_PAPER_DISTANCE = 0.08
"""Distance from a quadrilateral at which there is paper around a tag, sides."""
_MIN_RELATIVE_SWING = 0.2
"""Least rise of the level within a quadrilateral, over that to the paper around it: what is filled
evenly is no tag. A plausibility limit."""
_MAX_BRIGHT_RING_SHARE = 0.6
"""Greatest share of the outermost of these places that may be bright: they lie on the border, but
for those along two sides if the quadrilateral is not refined yet."""
_RING = np.pad(np.zeros((_SAMPLES - 2, _SAMPLES - 2), dtype=np.bool_), 1, constant_values=True)
"""(samples, samples) True for the outermost places."""


class TagPrint(NamedTuple):
    """The properties that all tags of a board share."""

    family: str
    border: int
    """Width of the border, cells."""
    turn: int = 0
    """Number of quarters by which each tag is turned clockwise on the board."""

    @property
    def side(self) -> int:
        """n, number of cells along a side, the border included."""
        return load_family(self.family).side + 2 * self.border


def list_prints(family: str | None, border: int | None) -> list[TagPrint]:
    """List the prints that agree with what is stated, the most common first."""
    return [
        TagPrint(name, width)
        for width in range(MAX_BORDER, 0, -1)
        for name in FAMILIES
        if family in (None, name) and border in (None, width)
    ]


class ReadTags(NamedTuple):
    """Quadrilaterals that were read as tags of one print."""

    which: IntArray
    """(n,) their indices."""
    numbers: IntArray
    """(n,) numbers in the family."""
    turns: IntArray
    """(n,) by how many quarters a tag is turned: its upper left corner is the quadrilateral's
    corner of that index."""

    def select(self, mask: BoolArray) -> ReadTags:
        """Select tags by a mask (n,)."""
        return ReadTags(self.which[mask], self.numbers[mask], self.turns[mask])


class TagReader:
    """A reader of the tags in an image's quadrilaterals, which are sampled once for each n and read
    once for each print."""

    def __init__(self, image: GreyImage, quads: Array) -> None:
        """
        Args:
            image: (h, w) grey levels, tags dark on bright.
            quads: (m, 4, 2) px, corners in the sense from u to v.
        """
        self.image = image
        self.quads = quads
        self._cells: dict[int, BoolArray] = {}
        self._read: dict[TagPrint, ReadTags] = {}

    def join(self, more: TagReader) -> TagReader:
        """Return a reader of its quadrilaterals and then those of another, in the same image, which
        keeps what it has sampled."""
        joined = TagReader(self.image, np.concatenate([self.quads, more.quads]))
        joined._cells = {
            n: np.concatenate([cells, more._find_dark_cells(n)]) for n, cells in self._cells.items()
        }
        return joined

    def read(self, tag_print: TagPrint) -> ReadTags:
        """Read the quadrilaterals as tags of a print; those that are none are left out."""
        if tag_print not in self._read:
            self._read[tag_print] = self._read_anew(tag_print)
        return self._read[tag_print]

    def _read_anew(self, tag_print: TagPrint) -> ReadTags:
        """Read the quadrilaterals; see `read`."""
        if not len(self.quads):
            return ReadTags(*np.zeros((3, 0), dtype=np.int64))
        n, b = tag_print.side, tag_print.border
        dark = self._find_dark_cells(n)
        data = dark[:, b:-b, b:-b]
        around = n * n - data[0].size
        bright = around - (dark.sum(axis=(1, 2)) - data.sum(axis=(1, 2)))
        which = np.flatnonzero(bright <= _MAX_BRIGHT_BORDER_SHARE * around)
        codes = _encode_turned_tags(tag_print.family)
        alike = np.where(data[which].reshape(len(which), (n - 2 * b) ** 2), 1.0, -1.0)
        match = alike.astype(np.float32) @ codes.T
        best = match.argmax(axis=1)
        misread = (codes.shape[1] - match.max(axis=1, initial=-np.inf)) / 2
        turns, numbers = np.divmod(best, len(codes) // 4)
        tags = ReadTags(which, numbers, turns)
        return tags.select(misread <= (load_family(tag_print.family).distance - 3) // 2)

    def _find_dark_cells(self, n: int) -> BoolArray:
        """Find the dark cells (m, n, n) of the quadrilaterals, once."""
        if n not in self._cells:
            self._cells[n] = find_dark_cells(self.image, self.quads, n)
        return self._cells[n]


def verify_tags(
    image: GreyImage, quads: Array, tag_print: TagPrint, numbers: IntArray
) -> BoolArray:
    """Verify which quadrilaterals (n, 4, 2) px show the tags of given numbers (n,), by the
    steps between neighbouring cells: in part of a shadow no level parts dark cells from bright."""
    return rate_tags(image, quads, tag_print, numbers) > MIN_RIGHT_STEPS


def rate_tags(image: GreyImage, quads: Array, tag_print: TagPrint, numbers: IntArray) -> Array:
    """Rate quadrilaterals (n, 4, 2) px as the tags of given numbers (n,) by the share of
    the steps between neighbouring cells that have the sign that the number says, (n,)."""
    ink = draw_tags(tag_print, numbers)
    level = measure_cells(image, quads, tag_print.side)
    right, steps = np.zeros(len(quads)), np.zeros(len(quads))
    for axis in (1, 2):
        expected = -np.diff(ink.astype(np.int64), axis=axis)
        right += (expected * np.diff(level, axis=axis) > 0).sum(axis=(1, 2))
        steps += (expected != 0).sum(axis=(1, 2))
    return right / steps


def draw_tags(tag_print: TagPrint, numbers: IntArray) -> BoolArray:
    """Draw tags of given numbers (n,) as they stand on the board: their cells (n, k, k), True where
    dark, the border included."""
    width = 2 * ((tag_print.border,) * 2,)
    cells = np.rot90(load_family(tag_print.family).cells[numbers], -tag_print.turn, axes=(1, 2))
    return np.pad(cells, ((0, 0), *width), constant_values=True)


def rate_borders(image: GreyImage, quads: Array) -> Array:
    """Rate dark quadrilaterals (m, 4, 2) px by how much of their outermost places is bright, which
    in a tag is little.

    Returns:
        The shares (m,); infinite for those that are filled evenly, or bright along their sides, and
        so are no tags.
    """
    inside, around = _weigh_border_samples()
    levels, paper = (sample_image(image, weights @ quads) for weights in (inside, around))
    inner, white = np.sort(levels, axis=1), compute_median(paper, axis=1)
    dark = inner[:, len(inside) // 2]
    bright = inner[:, -int(_MIN_BRIGHT_SHARE * len(inside)) :].mean(axis=1)
    is_patterned = bright - dark >= _MIN_RELATIVE_SWING * (white - dark)
    middle = (inner[:, int(_MIN_BRIGHT_SHARE * len(inside))] + bright) / 2
    share = (levels[:, _RING.ravel()] > middle[:, None]).mean(axis=1)
    return np.where(is_patterned & (share <= _MAX_BRIGHT_RING_SHARE), share, np.inf)


@cache
def _weigh_border_samples() -> tuple[Array, Array]:
    """Return the weights (k, 4) of a quadrilateral's corners in the places within it at which it is
    looked at, row by row, and in those around it."""
    centres = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    low, high = (np.full(_SAMPLES, end) for end in (-_PAPER_DISTANCE, 1 + _PAPER_DISTANCE))
    inside = make_mesh(centres, centres).reshape(-1, 2)
    sides = [(centres, low), (centres, high), (low, centres), (high, centres)]
    around = np.concatenate([np.column_stack(side) for side in sides])
    within, beside = (
        np.column_stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v])
        for u, v in (inside.T, around.T)
    )
    return within, beside


@lru_cache(maxsize=len(FAMILIES))
def _encode_turned_tags(family: str) -> FloatImage:
    """Return the dark (+1) and bright (-1) data cells (4 m, k^2), float32, of a family's m tags as
    seen in quadrilaterals whose corner 0, 1, 2, 3 is the tag's upper left one."""
    cells = load_family(family).cells
    turned = [np.rot90(cells, -turn, axes=(1, 2)) for turn in range(4)]
    return np.where(turned, 1.0, -1.0).astype(np.float32).reshape(4 * len(cells), -1)
