"""The benchmark's renderer is held to its truth, and the engine to the bound it computes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import map_coordinates

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.benchmarks import corner_methods
from tests.benchmarks import corners as benchmark
from tests.benchmarks.corner_boardless import KINDS, boardless
from tests.benchmarks.corner_scenes import Conditions, draw


@pytest.mark.parametrize("settings", [{}, {"ink": 0.03}, {"motion": 4.0}, {"gamma": 2.2}])
def test_grey_levels_are_point_symmetric_about_the_truth(settings: dict[str, float]) -> None:
    scene = draw(Conditions(tilt=0.0, size=(320, 240), square=20.0, blur=1.2, **settings), 1)
    offsets = np.random.default_rng(0).uniform(-5, 5, (60, 2))
    for corner in scene.uv.reshape(-1, 2):
        there, back = (
            map_coordinates(scene.clean, (corner + s * offsets)[:, ::-1].T, order=3)
            for s in (1, -1)
        )
        # Half of it is the cubic interpolation; 0.01 px off would leave 0.7 grey levels.
        assert np.sqrt(np.mean((there - back) ** 2)) < 0.3


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["base", "noise 20", "blur 0", "tilt 70", "hard light", "ink -2 %", "fisheye"]
)
def test_the_engine_reaches_the_bound(name: str) -> None:
    scene = draw(Conditions(**benchmark.CONDITIONS[name]), 0)
    result = benchmark.score(corner_methods.METHODS["ours"], [scene], 2)
    assert result.found == 1
    assert result.ratio < 1.25
    assert result.bias < 2
    assert 0.75 < result.chi2 < 1.4


@pytest.mark.parametrize("seed", range(2 * len(KINDS)))
def test_no_board_is_seen_where_there_is_none(seed: int) -> None:
    with pytest.raises(NoBoardError):
        find_corners(boardless(seed))
