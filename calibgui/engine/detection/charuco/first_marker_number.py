"""The first number of a board of stated size whose markers do not begin with number 0.

Several boards of one dictionary are made so. The relative places of markers tell the first number
up to a multiple of the squares in a row, since two rows hold as many markers as that. It is told
where one first number only has all markers read on the board: where they reach almost from the
first row to the last.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from calibgui.engine.arrays import GridSize
from calibgui.engine.boards.charuco import MarkerLayout
from calibgui.engine.detection.charuco.markers import Markers


def list_shifted_layouts(cols: int) -> list[MarkerLayout]:
    """List the layouts of `cols` squares a row that place markers differently to each other."""
    return [MarkerLayout(cols, first_dark=True, first=first) for first in range(cols)]


def find_first_marker_number(
    markers: Markers[MarkerLayout], layouts: Iterable[MarkerLayout], grid_size: GridSize
) -> Markers[MarkerLayout] | None:
    """Find the number that a board begins with.

    Args:
        markers: those that were read, in squares right to each other.
        layouts: those that a board of the stated size may have.
        grid_size: the board's rows and columns of inner corners.

    Returns:
        The markers on the layout that begins with that number; None if none or several do.
    """
    rows, cols = grid_size
    count = (rows + 1) * (cols + 1) // 2
    numbers = markers.numbers
    lowest, highest = max(int(numbers.max()) - count + 1, 0), int(numbers.min())
    placed = []
    for layout in layouts:
        for first in range(lowest, highest + 1):
            shifted = replace(layout, first=first)
            squares = shifted.locate_squares(numbers)
            away = squares - markers.squares
            if (away == away[0]).all() and (squares <= grid_size).all():
                placed.append(replace(markers, layout=shifted, squares=squares))
    return placed[0] if len(placed) == 1 else None
