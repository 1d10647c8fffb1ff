"""A held value that the views contradict is named, not the views."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.result import DegenerateError
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import VGA, barrel, scene

VIEWS = scene(barrel(), 10, seed=3).noisy(0.1, np.random.default_rng(1))


@pytest.mark.parametrize(("name", "value"), [("k1", 50.0), ("k1", 1e300), ("fx", 1e-5)])
def test_impossible_value_is_named(name: str, value: float) -> None:
    with pytest.raises(CalibrationError) as caught:
        calibrate(VIEWS, VGA, fix={name: value, "p3": None})
    assert caught.value.message.startswith(f"The views contradict {name} = {value:g}, which is")
    assert f"Free {name}" in caught.value.hint


def test_views_are_named_where_they_are_at_fault() -> None:
    with pytest.raises(DegenerateError):
        calibrate(VIEWS[:1] * 3, VGA, fix={"k1": 0.25})
