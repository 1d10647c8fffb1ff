"""What was found in photographs of boards, compared with their truth.

A corner is right less than a tenth of a square, or 1 px if that is more, from the true one at its
place on the board, up to the turns that the numbering leaves open. A board of which no corner is
right counts as false.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tests.scenes.photograph import Photograph

Array = NDArray[np.float64]
Found = tuple[NDArray[np.int64], Array]
"""Rows and columns (n, 2) on the board, and positions (n, 2) px, of the corners found."""


@dataclass(frozen=True)
class Tally:
    """Of photographs of one trouble."""

    photographs: int = 0
    whole: int = 0
    """Those with every corner of a board that is seen in its place and none besides."""
    lost: int = 0
    wrong: int = 0
    false: int = 0
    """Boards where there is none."""

    def __add__(self, other: Tally) -> Tally:
        return Tally(
            self.photographs + other.photographs,
            self.whole + other.whole,
            self.lost + other.lost,
            self.wrong + other.wrong,
            self.false + other.false,
        )

    def __str__(self) -> str:
        return f"{self.whole:3d} of {self.photographs:2d} {self.lost:5d} {self.wrong:5d}"


def judge(photograph: Photograph, found: Found | None) -> Tally:
    """Compare what was found with the board that most of it belongs to."""
    needed = [np.ones(board.shape[:2], np.bool_) for board in photograph.boards]
    if photograph.hidden is not None:
        needed[0] = ~photograph.hidden
    if found is None:
        return Tally(1, lost=int(needed[0].sum()))
    grid, uv = found
    right, need = max(
        (
            (_find_right(grid, uv, board), need)
            for board, need in zip(photograph.boards, needed, strict=True)
        ),
        key=lambda pair: len(pair[0]),
    )
    seen = np.zeros(need.shape, np.bool_)
    seen[tuple(right.T)] = True
    lost, wrong = int(np.count_nonzero(need & ~seen)), len(uv) - len(right)
    return Tally(1, int(lost == wrong == 0), lost, wrong, int(len(right) == 0))


def _find_right(grid: NDArray[np.int64], uv: Array, truth: Array) -> NDArray[np.int64]:
    """Find the true places (k, 2) of the corners that are in one numbering of the board where they
    truly are."""
    cols = truth.shape[1]
    flat = truth.reshape(-1, 2)
    distance = np.linalg.norm(uv[:, None] - flat, axis=2)
    nearest = np.argmin(distance, axis=1)
    others = np.linalg.norm(flat[:, None] - flat, axis=2) + 1e9 * np.eye(len(flat))
    at = distance.min(axis=1) < np.maximum(others.min(axis=1)[nearest] / 10, 1.0)
    place = np.column_stack(np.divmod(nearest, cols))
    best = np.empty((0, 2), np.int64)
    for quarters in range(4):
        turn = np.linalg.matrix_power(np.array([[0, 1], [-1, 0]]), quarters)
        moved = (grid - place @ turn.T)[at]
        if len(moved):
            _, which, counts = np.unique(moved, axis=0, return_inverse=True, return_counts=True)
            if counts.max() > len(best):
                best = place[at][which.ravel() == np.argmax(counts)]
    return best
