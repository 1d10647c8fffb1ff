"""Views of a board that deviates from its drawing, some of them numbered from the other end."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.redetection.labelling import align_board_turns
from tests.engine.scenes import barrel, uneven

CAMERA = barrel()
BOARD = Board(6, 9, 30.0)
XY = BOARD.points()


@pytest.mark.parametrize("turned", [(), (0, 1), (3, 7)])
@pytest.mark.parametrize("board", [BOARD, Board(7, 7, 30.0)], ids=["oblong", "square"])
def test_turned_views_are_turned_back(board: Board, turned: tuple[int, ...]) -> None:
    made = uneven(CAMERA, board, 10, 0.3, turned)
    found = align_board_turns(calibrate(made, CAMERA.size), made)
    for k, (before, after) in enumerate(zip(made, found, strict=True)):
        assert (after is not before) == (k in turned)
        if k in turned:
            np.testing.assert_allclose(after.xy, board.points()[::-1], atol=1e-9)


def test_parts_are_turned_about_the_middle_of_the_whole_board() -> None:
    made = uneven(CAMERA, BOARD, 10, 0.3, turned=(2,))
    made = [
        v._replace(uv=v.uv[:40], xy=v.xy[:40]) if k in (2, 5) else v for k, v in enumerate(made)
    ]
    found = align_board_turns(calibrate(made, CAMERA.size), made)
    assert [k for k in range(10) if found[k] is not made[k]] == [2]
    np.testing.assert_allclose(found[2].xy, XY[::-1][:40], atol=1e-9)


def test_on_a_perfect_board_nothing_is_turned() -> None:
    made = uneven(CAMERA, BOARD, 10, 0.0, turned=(2, 5))
    assert align_board_turns(calibrate(made, CAMERA.size), made) == tuple(made)
