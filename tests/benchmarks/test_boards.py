"""The benchmark of boards counts what readers find as it says."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from tests.benchmarks.board_readers import Read
from tests.benchmarks.boards import Photograph, score

_GRID = np.indices((4, 5)).reshape(2, -1).T
_TRUTH = 30.0 * np.indices((4, 5)).transpose(1, 2, 0)[..., ::-1] + 20


def _photograph() -> Photograph:
    bound = np.broadcast_to(0.01**2 * np.eye(2), (4, 5, 2, 2))
    return Photograph(np.zeros((9, 9), np.uint8), _TRUTH, np.ones((4, 5), np.bool_), bound)


def test_errors_over_the_bound_and_wrong_numbers() -> None:
    def read(*_: object) -> Read:
        uv = _TRUTH.reshape(-1, 2) + 0.02
        uv[0] += 30.0
        return Read(_GRID, uv, np.broadcast_to(0.02**2 * np.eye(2), (20, 2, 2)))

    result = score(read, Board(4, 5, 1.0, PuzzleBoard()), [_photograph()])
    assert (result.found, result.wrong) == (19 / 20, 1)
    assert result.ratio == pytest.approx(2)
    assert result.chi2 == pytest.approx(1)


@pytest.mark.parametrize(("pattern", "found"), [(Circles(), 1.0), (PuzzleBoard(), 0.0)])
def test_only_what_has_no_numbers_may_be_turned(
    pattern: Circles | PuzzleBoard, found: float
) -> None:
    def read(*_: object) -> Read:
        return Read(_GRID[::-1], _TRUTH.reshape(-1, 2))

    result = score(read, Board(4, 5, 1.0, pattern), [_photograph()])
    assert result.found == found
    assert result.wrong == (0 if found else 20)


def test_nothing_read_is_nothing_found() -> None:
    result = score(lambda *_: None, Board(4, 5, 1.0, Circles()), [_photograph()])
    assert (result.found, result.wrong) == (0.0, 0)
