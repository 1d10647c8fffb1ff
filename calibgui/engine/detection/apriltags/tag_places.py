"""Places of tags on their board: the numbers and squares of the tags that agree.

The squares that tags were read in are known up to an offset; on the right layout, with the right
step, the square of tag 0 is the same for all of them. The layout that most tags agree on is taken,
if no other has as many. A tag that was misread, or is of another board, agrees with nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import BoolArray, IntArray
from calibgui.engine.boards.april_grid import TagLayout

MIN_TAGS = 3
"""Least number of tags that agree on a board."""
_MIN_AGREEING_SHARE = 0.5
"""Least share of the tags read that agree."""
MAX_COLS = 64
"""Greatest number of tags in a row where it is not stated."""


@dataclass(frozen=True, eq=False, slots=True)
class PlacedTags:
    """Tags that agree on a layout."""

    layout: TagLayout
    step: int
    """Squares from a tag to the next in its row or column."""
    origin: IntArray
    """(2,) row and column of the square of tag 0."""
    agree: BoolArray
    """(n,) True for the tags that stand where their number says."""

    def __len__(self) -> int:
        return int(np.count_nonzero(self.agree))


def list_layouts(cols: int, from_top: bool | None) -> list[TagLayout]:
    """List the layouts of `cols` tags in a row, of either order or the stated one."""
    return [TagLayout(cols, order) for order in (False, True) if from_top in (None, order)]


def list_layouts_of_columns(numbers: IntArray, may_be_beneath: BoolArray) -> list[TagLayout]:
    """List the layouts on which two tags are neighbours in a column, of numbers (n,) and pairs
    (n, n) that may be such."""
    between = np.unique(np.abs(np.subtract.outer(numbers, numbers))[may_be_beneath])
    return [
        layout
        for cols in between.tolist()
        if 0 < cols <= MAX_COLS
        for layout in list_layouts(cols, None)
    ]


def place_tags(
    numbers: IntArray,
    squares: IntArray,
    cols: int | None,
    from_top: bool | None,
    step: int | None,
) -> PlacedTags | None:
    """Find the layout on which most tags agree.

    Args:
        numbers: (n,) of the tags.
        squares: (n, 2) row and column of the squares that they were read in, from any origin.
        cols: number of tags in a row, if stated.
        from_top: order of the rows, if stated.
        step: squares from a tag to the next, if stated; else that of tags of consecutive numbers.

    Returns:
        None if too few tags agree, as many on two layouts, or most on another than is stated.
    """
    step = step or _find_step(numbers, squares)
    if step is None or len(numbers) < MIN_TAGS:
        return None
    layouts = dict.fromkeys(_list_likely_layouts(numbers, squares, step))
    if cols is not None:
        layouts |= dict.fromkeys(list_layouts(cols, from_top))
    placed = [_place_on_layout(numbers, squares, layout, step) for layout in layouts]
    placed.sort(key=len, reverse=True)
    if not placed or len(placed[0]) < max(MIN_TAGS, _MIN_AGREEING_SHARE * len(numbers)):
        return None
    if len(placed) > 1 and len(placed[1]) == len(placed[0]):
        return None
    best = placed[0].layout
    return placed[0] if cols in (None, best.cols) and from_top in (None, best.from_top) else None


def _place_on_layout(
    numbers: IntArray, squares: IntArray, layout: TagLayout, step: int
) -> PlacedTags:
    """Place tags on a layout where most of them agree."""
    offset = squares - step * layout.locate_squares(numbers)
    origins, which, count = np.unique(offset, axis=0, return_inverse=True, return_counts=True)
    most = int(count.argmax())
    return PlacedTags(layout, step, origins[most], which.ravel() == most)


def _list_likely_layouts(numbers: IntArray, squares: IntArray, step: int) -> list[TagLayout]:
    """List the layouts by which two of the tags are neighbours in a column, as they are seen."""
    away = np.abs(squares - squares[:, None])
    return list_layouts_of_columns(numbers, (away == np.array([step, 0])).all(axis=2))


def _find_step(numbers: IntArray, squares: IntArray) -> int | None:
    """Find the most frequent distance in one row of squares between tags k and k + 1."""
    following = numbers - numbers[:, None] == 1
    same_row = squares[:, 0] == squares[:, 0, None]
    i, j = np.nonzero(following & same_row)
    steps = (squares[j] - squares[i])[:, 1]
    steps, count = np.unique(steps[steps > 0], return_counts=True)
    return int(steps[count.argmax()]) if len(steps) else None
