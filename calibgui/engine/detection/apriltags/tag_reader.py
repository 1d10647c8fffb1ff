"""Reading AprilTags in quadrilaterals of an image that may be tags.

A quadrilateral is sampled in n = k + 2 b cells a side, k those of the family's data and b those of
its border. The border has to be dark; the data cells are compared with every tag of the family in
its four turns. Fewer cells may be misread than would tell two tags apart: a tag is believed only
together with others that stand where its number says.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, FloatImage, GreyImage, IntArray
from calibgui.engine.boards.april_grid import MAX_BORDER
from calibgui.engine.boards.apriltags import FAMILIES, load_family
from calibgui.engine.detection.charuco.marker_cells import find_dark_cells

_MAX_BRIGHT_BORDER_SHARE = 0.2
"""Greatest share of a border's cells that may look bright. A plausibility limit."""


class TagPrint(NamedTuple):
    """The properties that all tags of a board share."""

    family: str
    border: int
    """Width of the border, cells."""

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
    """A reader of the tags in an image's quadrilaterals, which are sampled once for each n."""

    def __init__(self, image: GreyImage, quads: Array) -> None:
        """
        Args:
            image: (h, w) grey levels, tags dark on bright.
            quads: (m, 4, 2) px, corners in the sense from u to v.
        """
        self._image = image
        self._quads = quads
        self._cells: dict[int, BoolArray] = {}

    def read(self, tag_print: TagPrint) -> ReadTags:
        """Read the quadrilaterals as tags of a print; those that are none are left out."""
        n, b = tag_print.side, tag_print.border
        if n not in self._cells:
            self._cells[n] = find_dark_cells(self._image, self._quads, n)
        dark = self._cells[n]
        data = dark[:, b:-b, b:-b]
        around = n * n - data[0].size if len(data) else 1
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


@lru_cache(maxsize=len(FAMILIES))
def _encode_turned_tags(family: str) -> FloatImage:
    """Return the dark (+1) and bright (-1) data cells (4 m, k^2), float32, of a family's m tags as
    seen in quadrilaterals whose corner 0, 1, 2, 3 is the tag's upper left one."""
    cells = load_family(family).cells
    turned = [np.rot90(cells, -turn, axes=(1, 2)) for turn in range(4)]
    return np.where(turned, 1.0, -1.0).astype(np.float32).reshape(4 * len(cells), -1)
