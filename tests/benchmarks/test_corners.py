"""The engine reaches the bound that the benchmark computes and sees no board without one."""

from __future__ import annotations

import os

import numpy as np
import pytest

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.benchmarks import corner_methods
from tests.benchmarks import corners as benchmark
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions
from tests.scenes.without_board import KINDS, draw_without_board


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["base", "noise 20", "blur 0", "tilt 70", "hard light", "ink -2 %", "fisheye"]
)
def test_the_engine_reaches_the_bound(name: str) -> None:
    scene = draw(Conditions(**benchmark.CONDITIONS[name]), 0, with_bound=True)
    result = benchmark.score(corner_methods.METHODS["ours"], [scene], 2)
    assert result.found == 1
    assert result.ratio < 1.25
    assert result.bias < 2
    assert 0.75 < result.chi2 < 1.4


@pytest.mark.slow
@pytest.mark.parametrize("name", ["3 x 3, 8 px", "3 x 3, 90 px", "3 x 4, 90 px"])
def test_few_corners_reach_it_too(name: str) -> None:
    scene = draw(Conditions(**benchmark.SMALL[name]), 0, with_bound=True)
    result = benchmark.score(corner_methods.METHODS["ours"], [scene], 6)
    assert result.found == 1
    assert result.ratio < 1.3
    assert 0.6 < result.chi2 < 1.5


@pytest.mark.parametrize("seed", range(2 * len(KINDS)))
def test_no_board_is_seen_where_there_is_none(seed: int) -> None:
    with pytest.raises(NoBoardError):
        find_corners(draw_without_board(seed))


@pytest.mark.skipif(os.name == "nt", reason="needs processes that fork")
def test_a_finder_that_crashes_finds_nothing() -> None:
    def crash(*_: object) -> tuple[None, float]:
        os._exit(1)

    def find_none(*_: object) -> tuple[None, float]:
        return None, 0.5

    image = np.zeros((9, 9), dtype=np.uint8)
    assert np.isnan(corner_methods.apart(crash)(image, (3, 3))[1])
    assert corner_methods.apart(find_none)(image, (3, 3)) == (None, 0.5)
