"""The renderer of checkerboards is held to its own truth."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import map_coordinates

from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions


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
