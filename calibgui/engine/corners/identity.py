"""How all views of a board are counted alike: ``quality/counting.py`` with what colours allow."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calibgui.engine.corners.lattice import Lattice
from calibgui.engine.corners.ordering import numberings, place
from calibgui.engine.quality.counting import Way, alike, quarter_turn
from calibgui.engine.types import (
    Array,
    Calibration,
    Corners,
    IntArray,
    Observation,
    Target,
    frozen_int,
)


class Placing(NamedTuple):
    """A view's corners on the board."""

    grid: IntArray
    """(n, 2) row and column of each."""
    certain: bool
    """Whether all other ways to count them are improbable."""


class _Numbering(NamedTuple):
    """One way to count a view's corners."""

    grid: IntArray
    """(n, 2)"""
    turn: Array
    """Q (3, 3) of the plate."""


def identified(
    calibration: Calibration, corners: Sequence[Corners], target: Target
) -> tuple[Placing, ...]:
    """Count the corners of all views alike, where the board's deviations tell how.

    Args:
        calibration: from these views with the image cost, on the nominal plate.
        corners: of its views.
        target: the board.

    Returns:
        The views' places: as they were and not certain where nothing is to be told, in the view
        that the others are counted like as it was.
    """
    ways = [_ways(view) for view in corners]
    views = [Observation(view.uv, target.points(view.grid), view.cov) for view in corners]
    places = [[Way(way.grid @ np.array([target.cols, 1]), way.turn) for way in own] for own in ways]
    choices = alike(calibration, views, places, target.rows * target.cols)
    return tuple(
        Placing(own[choice.way].grid, choice.certain)
        for own, choice in zip(ways, choices, strict=True)
    )


def _ways(corners: Corners) -> list[_Numbering]:
    """The ways to count a view's corners that its colours allow, as they are first.

    Of a part whose place is known these are the turns of the whole board.
    """
    board, grid = corners.shape, corners.grid
    rows, cols = np.indices(board, dtype=np.float64)
    whole = np.stack([rows, cols], axis=-1)
    if corners.relative:
        part = np.full((*board, 2), np.nan)
        part[grid[:, 0], grid[:, 1]] = whole[grid[:, 0], grid[:, 1]]
        low, high = grid.min(axis=0), grid.max(axis=0) + 1
        whole = part[low[0] : high[0], low[1] : high[1]]
    first_dark = not corners.relative or int(grid.min(axis=0).sum()) % 2 == 0
    ways = []
    for way in numberings(Lattice(whole, first_dark), board):
        if not way.dark:
            continue
        places, was, _ = place(way)  # `was` holds the places as they are
        to = np.full((*board, 2), -1, dtype=np.int64)
        to[tuple(was.astype(np.int64).T)] = places
        numbered = frozen_int(to[grid[:, 0], grid[:, 1]])
        ways.append(_Numbering(numbered, quarter_turn(way.quarters)))
    ways.sort(key=lambda way: not np.array_equal(way.grid, grid))
    return ways
