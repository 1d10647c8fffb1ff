"""From the dots between corners to their place on the PuzzleBoard pattern.

**Dots.** A dot's level v is +1 where it is as bright as the bright square beside it, -1 where it is
as dark as the dark one; blur brings it nearer to 0. The levels of white and of dark dots are taken
for normally distributed around +m and -m with standard deviation s, both estimated from all dots
(`measure_dot_noise`). A dot of level v is then white with the probability F(2 m v / s^2), F being
the logistic function. Besides, a share e of the dots may be wrong: dirt, a reflection, a bad print.

**Places.** A place is a row and column of the pattern and one of four turns. Compared with dots of
which each is white or dark by the toss of a coin, the dots b_i = +-1 of a place are more likely by
the factor

    L(place, e) = product over i of 2 [(1 - e) F(b_i 2 m v_i / s^2) + e F(-b_i 2 m v_i / s^2)].

Row r and column c enter by r mod 3 and c mod 167 in the dots between rows, and by c mod 3 and
r mod 167 in those between columns; by the Chinese remainder theorem each of the 501 x 501 places is
one pair of the 501 offsets into either map. So log L is a sum of two of 2 x 501 numbers for every
turn and every e, and what is to be known about a million places takes some matrix products.

**Decision.** With prior weights for the shares e, for all places together, for those on a stated
board and for no such pattern at all, the factors L give the probability of the likeliest place. It
is accepted if all else, chance and other places, has at most `_MAX_DOUBT`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, GridSize, IntArray
from calibgui.engine.boards.puzzleboard import (
    CODE_COLS,
    CODE_LINES,
    CODE_ROWS,
    MAP_DOWN,
    MAP_RIGHT,
)

_MAX_DOUBT = 0.002
"""Greatest probability that the accepted place is not the true one. One dot tells 8 % of the parts
of 5 x 5 corners from another part: a smaller limit would refuse these."""
_MAX_DOUBT_ALONE = 1e-6
"""Greatest such probability up to which it is not asked whether an inverse print, or a mirror,
makes another place still likelier: what they show of the pattern may look like another part."""
_WRONG_SHARES = np.array([2e-4, 0.01, 0.05, 0.15, 0.3])
"""Shares e of wrong dots that are considered ..."""
_WRONG_SHARE_WEIGHTS = np.array([0.8, 0.05, 0.05, 0.05, 0.05])
"""... and their prior weights."""
_NOWHERE_WEIGHT = 1.0
"""Prior weight of dots at random, as a lattice seen in something else has ..."""
_ANYWHERE_WEIGHT = 1e-2
"""... of all places of the pattern together: dots at random are accepted in one of 50,000 cases
(by Markov's inequality, as the mean of L over them is 1) ..."""
_ON_BOARD_WEIGHT = 100.0
"""... and of those on a stated board together."""
_NEGLIGIBLE = 50.0
"""Logarithm of a ratio of factors that need not be considered: of a million such places all have a
probability of 1e-16 together."""
_MIN_LEVEL_SIGMA = 0.1
"""Least standard deviation s of the dots' levels: bilinear sampling and print are no better."""
_MIN_DOT_LEVEL = 0.15
"""Level m from which on there may be dots: those of rendered boards have 0.9 and more under a blur
of a third of a dot, bare edges 0.00, what is read between the dots of printed pictures up to 0.1 in
most places. With less no place could be certain."""
_MIN_DOTS_TO_TELL = 300
"""Number of dots from which on they are compared with the pattern before anything else is done with
the lattice: this takes as long as to fit so many corners."""
_MIN_EVIDENCE = 0.04
"""Least logarithm of the factor L of the best place, per dot: with 30 % of the dots wrong it is
0.08. What is read between the dots of printed pictures has mostly less."""
_MIN_ALL_EVIDENCE = 16.0
"""Least such logarithm of all dots together: chance alone reaches that of a million places, 14. So
many dots as are compared have 24 or more."""
_LEVEL_ROUNDS = 20
"""Number of rounds in which m and s are estimated; they change by less than 1 % after these."""


@dataclass(frozen=True, eq=False, slots=True)
class Dots:
    """The levels of the dots between the corners of a lattice; NaN where none was seen."""

    right: Array
    """(rows, cols - 1) between each corner and the next in its row."""
    down: Array
    """(rows - 1, cols) between each corner and the one below."""

    @property
    def grid_size(self) -> GridSize:
        """Rows and columns of the lattice."""
        return len(self.right), self.down.shape[1]

    def turn(self) -> Dots:
        """Return the dots of the lattice turned by a quarter, as by `numpy.rot90`."""
        return Dots(np.rot90(self.down), np.rot90(self.right))

    def mirror(self) -> Dots:
        """Return the dots as a mirror shows them."""
        return Dots(self.right[:, ::-1], self.down[:, ::-1])


@dataclass(frozen=True, slots=True)
class Place:
    """The place of a lattice on the pattern."""

    quarters: int
    """Number of quarters by which the lattice is turned first, as by `numpy.rot90`."""
    first: GridSize
    """Row and column on the pattern of the first corner of the turned lattice."""
    doubt: float
    """Probability that it is another place or no such pattern."""


@dataclass(frozen=True, slots=True)
class StatedBoard:
    """The part of the pattern that the board is said to be."""

    origin: GridSize
    """Row and column of its first corner."""
    grid_size: GridSize
    """Its rows and columns."""


class _Comparison(NamedTuple):
    """The evidence of dots between rows, or between columns, on the offsets into their map, for
    each of k shares of wrong ones: parts of log L."""

    even: Array
    """(k,) the same for all offsets."""
    odd: Array
    """(k, 501) what the map adds at each offset; less that if dark and white are exchanged."""


class _Turn(NamedTuple):
    """The comparison of dots, turned by some quarters, with the maps."""

    by_row: _Comparison
    """Comparison of the dots between rows."""
    by_col: _Comparison
    """Comparison of the dots between columns."""


def find_place(dots: Dots, board: StatedBoard | None = None) -> Place:
    """Find the likeliest place of the dots on the pattern; any, with a doubt of 1, if none is half
    as likely as that they are no such pattern.

    Args:
        dots: of a lattice that is not mirrored.
        board: the part of the pattern that is expected, if it is known.
    """
    return _choose_place(_compare_turns(dots), dots.grid_size, board)


def _choose_place(
    turns: list[_Turn],
    grid_size: GridSize,
    board: StatedBoard | None,
    is_inverted: bool = False,
) -> Place:
    """Choose the likeliest place of dots from what each turn of them says; of a print in which dark
    and white are exchanged, if `is_inverted`. See `find_place`."""
    logs = [_compute_logs(turn, is_inverted) for turn in turns]
    tops = [_find_top(*pair) for pair in logs]
    # Factors of hundreds of dots overflow: all weights are divided by the greatest that may be.
    shift = max(0.0, *tops)
    greatest = _ANYWHERE_WEIGHT / _count_places(grid_size)
    greatest += _ON_BOARD_WEIGHT if board is not None else 0.0
    if shift < np.log(_NOWHERE_WEIGHT / 2) - np.log(greatest):
        return Place(0, (0, 0), 1.0)
    total, best = _NOWHERE_WEIGHT * np.exp(-shift), (-1.0, 0, 0)
    for quarters, (top, factors) in enumerate(zip(tops, logs, strict=True)):
        if top < shift - _NEGLIGIBLE:
            continue
        turned = grid_size if quarters % 2 == 0 else grid_size[::-1]
        weights = _weigh_places(turned, board) * _multiply_factors(*factors, shift)
        total += float(weights.sum())
        best = max(best, (float(weights.max()), quarters, int(np.argmax(weights))))
    weight, quarters, at = best
    first = tuple(int(line.flat[at]) for line in _list_places())
    doubt = 1 - weight / total if weight > 0 else 1.0
    return Place(quarters, (first[0], first[1]), doubt)


def _compare_turns(dots: Dots) -> list[_Turn]:
    """Compare dots in all four turns with the pattern: those between rows, and those between
    columns."""
    mean, sigma = measure_dot_noise(dots)
    log_odds = 2 * mean / sigma**2
    right, down = (_weigh_dots(log_odds * each) for each in (dots.right, dots.down))
    turned = [Dots(right[1], down[1])]
    for _ in range(3):
        turned.append(turned[-1].turn())
    by_row = _compare_with_map([each.down for each in turned], "down")
    by_col = _compare_with_map([each.right.swapaxes(0, 1) for each in turned], "right")
    evens = [(down[0], right[0]), (right[0], down[0])] * 2  # a quarter turn exchanges them
    return [
        _Turn(_Comparison(a, odd_a), _Comparison(b, odd_b))
        for (a, b), odd_a, odd_b in zip(evens, by_row, by_col, strict=True)
    ]


def _compute_logs(turn: _Turn, is_inverted: bool = False) -> tuple[Array, Array]:
    """Compute the logarithms (k, 501) and (k, 501) of the factors L of the dots between rows and
    between columns, or of a print in which dark and white are exchanged."""
    sign = -1.0 if is_inverted else 1.0
    a, b = (each.even[:, None] + sign * each.odd for each in turn)
    return a, b


def _find_top(by_row: Array, by_col: Array) -> float:
    """Find the logarithm of the greatest factor L of any place and share of wrong dots; arguments
    as `_compute_logs` returns them."""
    return float((by_row.max(axis=1) + by_col.max(axis=1)).max())


def are_there_dots(dots: Dots) -> bool:
    """Return whether levels may be those of any dots: see `_MIN_DOT_LEVEL`."""
    return measure_dot_noise(dots)[0] >= _MIN_DOT_LEVEL


def may_be_dots(dots: Dots) -> bool:
    """Return whether levels may be those of dots of the pattern, before the corners between which
    they were measured are refined: see `_MIN_DOT_LEVEL` and `_MIN_EVIDENCE`."""
    if not are_there_dots(dots):
        return False
    count = sum(int(np.count_nonzero(np.isfinite(each))) for each in (dots.right, dots.down))
    if count < _MIN_DOTS_TO_TELL:
        return True
    least = max(_MIN_EVIDENCE * count, _MIN_ALL_EVIDENCE)
    return any(
        _find_top(*_compute_logs(turn, is_inverted)) > least
        for seen in (dots, dots.mirror())
        for turn in _compare_turns(seen)
        for is_inverted in (False, True)
    )


def find_place_of_print(dots: Dots, board: StatedBoard | None = None) -> tuple[Place, bool]:
    """Find the likeliest place of dots that may be printed inversely or seen in a mirror.

    Returns:
        The likeliest place, and whether it is that of the mirror image of the dots; if none is
        certain, the likeliest place of the dots as they are.
    """
    turns = _compare_turns(dots)
    place = _choose_place(turns, dots.grid_size, board)
    if place.doubt <= _MAX_DOUBT_ALONE:
        return place, False
    mirrored = _compare_turns(dots.mirror())
    best, is_mirrored = min(
        (place, False),
        (_choose_place(turns, dots.grid_size, board, is_inverted=True), False),
        (_choose_place(mirrored, dots.grid_size, board), True),
        (_choose_place(mirrored, dots.grid_size, board, is_inverted=True), True),
        key=lambda found: found[0].doubt,
    )
    return (best, is_mirrored) if is_certain(best) else (place, False)


def is_certain(place: Place) -> bool:
    """Return whether so little speaks for anything else that a place can be trusted."""
    return place.doubt <= _MAX_DOUBT


def measure_dot_noise(dots: Dots) -> tuple[float, float]:
    """Measure the level m of white dots, that of dark ones being -m, and their standard deviation.

    They are the maximum-likelihood estimates for two normal distributions of equal weight (by
    expectation maximisation, Dempster, Laird and Rubin 1977).
    """
    level = np.concatenate([dots.right.ravel(), dots.down.ravel()])
    level = level[np.isfinite(level)]
    square = float(np.mean(level**2)) if len(level) else 0.0
    mean = 0.9 * np.sqrt(square)
    for _ in range(_LEVEL_ROUNDS):
        variance = max(square - mean**2, _MIN_LEVEL_SIGMA**2)
        mean = float(np.mean(level * np.tanh(mean * level / variance))) if len(level) else 0.0
    return mean, float(np.sqrt(max(square - mean**2, _MIN_LEVEL_SIGMA**2)))


def _compare_with_map(white: list[Array], name: str) -> Array:
    """Compare sets of dots with a map at all of its offsets.

    Args:
        white: per set (n, m, k) what white dots add for each share of wrong ones, as `_weigh_dots`;
            the first index is the one that counts modulo 3.
        name: of the map, "down" or "right".

    Returns:
        Per set (k, 501) what the map adds for each share and each offset, 167 times the first
        offset plus the second.
    """
    odd = np.concatenate([_sum_by_cell(each) for each in white]) @ _list_offsets(name)
    return odd.reshape(len(white), -1, CODE_LINES)


def _weigh_dots(log_odds: Array) -> tuple[Array, Array]:
    """Weigh dots of the log odds (n, m) of white to dark, NaN where not seen, for each share of
    wrong ones: (k,) the part of log L that is the same for white and dark cells of a map, and
    (n, m, k) what a white one adds to it, and a dark one takes from it."""
    odds = np.where(np.isfinite(log_odds), log_odds, 0.0)[..., None]
    white, dark = scipy.special.expit(odds), scipy.special.expit(-odds)
    if_white = np.log(2 * ((1 - _WRONG_SHARES) * white + _WRONG_SHARES * dark))
    if_dark = np.log(2 * ((1 - _WRONG_SHARES) * dark + _WRONG_SHARES * white))
    return (if_white + if_dark).sum(axis=(0, 1)) / 2, (if_white - if_dark) / 2


def _sum_by_cell(white: Array) -> Array:
    """Sum what white dots (n, m, k) add by the cell of a map on which they lie: (k, 501)."""
    n, m, _ = white.shape
    cell = (np.arange(n)[:, None] % CODE_ROWS) * CODE_COLS + np.arange(m) % CODE_COLS
    return np.array(
        [np.bincount(cell.ravel(), each.ravel(), CODE_LINES) for each in np.moveaxis(white, 2, 0)],
        np.float64,
    )


def _multiply_factors(down: Array, right: Array, shift: float) -> Array:
    """Return (501, 501) the mean over the shares of wrong dots of the factors L of all places, by
    offset into either map, divided by e to the `shift`; arguments as `_compare_with_map` returns
    them."""
    tops = down.max(axis=1), right.max(axis=1)
    scale = _WRONG_SHARE_WEIGHTS * np.exp(tops[0] + tops[1] - shift)
    a, b = (np.exp(each - top[:, None]) for each, top in zip((down, right), tops, strict=True))
    return np.asarray((a * scale[:, None]).T @ b)


def _weigh_places(grid_size: GridSize, board: StatedBoard | None) -> Array:
    """Return (501, 501) the prior weights of the places of a lattice of rows x columns, by offset
    into either map; 0 where the lattice would leave the pattern."""
    row, col = _list_places()
    inside = (row <= CODE_LINES - grid_size[0]) & (col <= CODE_LINES - grid_size[1])
    turns = 4
    weights = inside * (_ANYWHERE_WEIGHT / (turns * max(int(np.count_nonzero(inside)), 1)))
    if board is not None:
        on_board = np.ones_like(inside)
        for line, first, whole, seen in zip(
            (row, col), board.origin, board.grid_size, grid_size, strict=True
        ):
            on_board &= (line >= first) & (line <= first + whole - seen)
        weights += on_board * (_ON_BOARD_WEIGHT / (turns * max(int(np.count_nonzero(on_board)), 1)))
    return np.asarray(weights)


def _count_places(grid_size: GridSize) -> int:
    """Count the places, in all four turns, of a lattice of rows x columns on the pattern."""
    return 4 * max(CODE_LINES - grid_size[0] + 1, 1) * max(CODE_LINES - grid_size[1] + 1, 1)


@cache
def _list_offsets(name: str) -> Array:
    """Return (501, 501) what each cell of a map, +1 or -1, is at each offset: [cell, offset]."""
    whole = np.where(MAP_DOWN if name == "down" else MAP_RIGHT, 1.0, -1.0)
    row, col = np.divmod(np.arange(CODE_LINES), CODE_COLS)
    return whole[np.add.outer(row, row) % CODE_ROWS, np.add.outer(col, col) % CODE_COLS]


@cache
def _list_places() -> tuple[IntArray, IntArray]:
    """Return (501, 501) the rows and the columns of the pattern, by offset into map A (row mod 3,
    column mod 167) and into map B (column mod 3, row mod 167)."""
    line = np.arange(CODE_LINES)
    by_remainders = np.empty((CODE_ROWS, CODE_COLS), dtype=np.int64)
    by_remainders[line % CODE_ROWS, line % CODE_COLS] = line
    small, large = np.divmod(line, CODE_COLS)
    row = by_remainders[small[:, None], large[None, :]]
    return row, by_remainders[small[None, :], large[:, None]]
