"""A board is told from squares that alternate by chance."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.lattices.a_contrario import is_meaningful
from tests.engine.drawn_boards import random_squares


@given(hnp.arrays(np.bool_, st.tuples(st.integers(1, 6), st.integers(1, 6))), st.integers(0, 5000))
def test_every_full_rectangle_is_counted(found: NDArray[np.bool_], others: int) -> None:
    rows, cols = found.shape
    expected = [
        max(others, 1) * a * b * 2.0 ** (4 - (a + 1) * (b + 1))
        for a, b in itertools.product(range(1, rows + 1), range(1, cols + 1))
        for r, c in itertools.product(range(rows - a + 1), range(cols - b + 1))
        if found[r : r + a, c : c + b].all()
    ]
    assert is_meaningful(found, others) == (min(expected, default=1) < 1 / 16)


def test_small_boards_count_where_little_else_is_seen() -> None:
    whole = np.ones((3, 4), np.bool_)
    assert is_meaningful(whole, 300)
    assert not is_meaningful(whole, 400)
    ragged = np.eye(9, dtype=np.bool_) | np.eye(9, k=1, dtype=np.bool_)
    assert not is_meaningful(ragged, 1)


@pytest.mark.parametrize(
    ("seed", "side", "shape"),
    [
        *((1, side, (900, 1200)) for side in (6, 10, 17)),
        # Some of those in which a dozen corners or more hang together.
        *((seed, 12, (480, 640)) for seed in (0, 25, 45)),
        *((seed, 10, (3000, 4000)) for seed in (0, 6, 10)),
    ],
)
def test_squares_at_random_are_no_board(seed: int, side: int, shape: tuple[int, int]) -> None:
    with pytest.raises(NoBoardError):
        find_corners(random_squares(seed, side, shape))
