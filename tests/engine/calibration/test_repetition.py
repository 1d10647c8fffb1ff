"""A calibration made once more with other settings, against the same made from nothing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.repetition import calibrate_by_model, repeat_calibration
from tests.engine.scenes import VGA, barrel, scene


@pytest.fixture(scope="module")
def views() -> list[Observation]:
    return scene(barrel(), 8, seed=1).noisy(0.1, np.random.default_rng(0))


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"fix": {"k2": 0.02, "cx": 301.0}, "free": ()},
        {"board_shape": BoardShapeModel.AFFINE},
        {"model": "brown-conrady", "fix": (), "free": ()},
        {"cost": "reference"},
    ],
    ids=["nothing", "held", "shape", "lens", "cost"],
)
def test_it_ends_where_a_calibration_from_nothing_does(
    views: list[Observation], changes: dict[str, Any]
) -> None:
    first = calibrate(views, VGA)
    again, anew = repeat_calibration(first, views, **changes), calibrate(views, VGA, **changes)
    assert again.fixed == anew.fixed
    assert again.camera.names == anew.camera.names
    free = anew.sigma > 0
    apart = np.abs(again.camera.params - anew.camera.params)
    assert (apart[free] < 1e-3 * anew.sigma[free]).all()
    assert (apart[~free] == 0).all()


def test_another_lens_keeps_the_held_values_of_the_pinhole(views: list[Observation]) -> None:
    first = calibrate(views, VGA, fix={"cx": 301.0, "k3": 0.1})
    other = calibrate_by_model(first, views, "kannala-brandt")
    assert set(other.fixed) == {"cx"}
    assert dict(zip(other.camera.names, other.camera.params, strict=True))["cx"] == 301.0
