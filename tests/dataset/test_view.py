"""Targets, and views with their regions."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.dataset import View
from calibgui.engine.boards.board import Board
from calibgui.engine.errors import CalibrationError


@pytest.mark.parametrize(
    ("rows", "cols", "square"),
    [(0, 8, 25.0), (6, -1, 25.0), (6, 8, 0.0), (6, 8, float("nan")), (6, 8, float("inf"))],
)
def test_what_makes_no_board_is_named(rows: int, cols: int, square: float) -> None:
    with pytest.raises(CalibrationError, match="no board"):
        Board(rows, cols, square)


def test_a_views_region_is_its_own() -> None:
    roi = np.zeros((4, 2))
    view = View("a.png", roi=roi)
    roi[0] = 1.0
    assert view.roi is not None
    assert not view.roi.any()
