"""That a board of glass is worth being stated is said where it is, and holds if it is done."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import Settings
from calibgui.app.calibrating.true_board import GLASS, measure_gain_of_glass
from calibgui.dataset import CornerSet, View, ViewStatus
from tests.engine.scenes import BOARD, barrel, scene

CAMERA = barrel()


@pytest.fixture(scope="module")
def corner_set() -> CornerSet:
    views = scene(CAMERA, 12, seed=6).noisy(0.1, np.random.default_rng(1))
    named = tuple(View(f"{k}.png", ViewStatus.FOUND, points=view) for k, view in enumerate(views))
    return CornerSet(CAMERA.size, named, BOARD)


def test_what_is_promised_is_what_comes(corner_set: CornerSet) -> None:
    result = calibrate_views(corner_set)
    promised = measure_gain_of_glass(result)
    assert promised.keys() >= {"cx", "cy"}
    stated = calibrate_views(corner_set, Settings(prior=GLASS)).calibration
    for name, sigma in promised.items():
        i = stated.camera.names.index(name)
        assert sigma == stated.sigma[i] < 0.5 * result.calibration.sigma[i]
        assert abs(stated.camera.params[i] - CAMERA.params[i]) < 3 * sigma  # the board is flat


def test_nothing_is_promised_where_more_is_known(corner_set: CornerSet) -> None:
    stated = calibrate_views(corner_set, Settings(prior=GLASS))
    assert measure_gain_of_glass(stated) == {}
    assert (
        measure_gain_of_glass(replace(calibrate_views(corner_set), lengths_confirmed=False)) == {}
    )
