"""Another board than the one that was looked for: what photographs show in its place."""

from __future__ import annotations

from collections.abc import Sequence
from threading import Event
from typing import NamedTuple

from calibgui.app.photographs.board_recognition import (
    choose_samples,
    find_grid_size,
    find_mirrored_pattern,
    find_other_pattern,
    recognise_pattern,
)
from calibgui.dataset import View
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import Pattern
from calibgui.engine.errors import CalibrationError


class OtherBoard(NamedTuple):
    """The board that photographs show in place of the one that was looked for, if any."""

    pattern: Pattern | None = None
    """Another pattern, or the same; None if nothing was found or `grid_size` is another."""
    is_mirrored: bool = False
    """True if its marks can be read in a mirror only."""
    grid_size: GridSize | None = None
    """Another number of corners."""


def find_other_board(
    views: Sequence[View], pattern: Pattern, grid_size: GridSize | None, stop: Event
) -> OtherBoard:
    """Find the board in photographs that show none of a kind and size.

    Args:
        views: the photographs.
        pattern: the kind.
        grid_size: the size; None if it was to be counted.
        stop: ends the search when it is set.
    """
    samples = choose_samples(views)
    if grid_size is not None:
        other = find_grid_size(samples, pattern, stop)
        if other not in (None, grid_size):
            return OtherBoard(grid_size=other)
    if (mirrored := find_mirrored_pattern(samples, stop)) is not None:
        return OtherBoard(mirrored, is_mirrored=True)
    return OtherBoard(find_other_pattern(samples, pattern, stop))


def read_marks(views: Sequence[View]) -> OtherBoard:
    """Find out whether boards that were found as plain ones bear marks."""
    try:
        return OtherBoard(recognise_pattern(views))
    except CalibrationError:
        return OtherBoard(is_mirrored=True)
