"""The compiled samples around corners against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine import kernels, opencv
from calibgui.engine.corners import appearance


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.float32])
def test_the_same_grey_levels_around_corners(dtype: type, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(5)
    image = opencv.smooth(rng.uniform(0, 255, (60, 80)).astype(np.float32), 2.0).astype(dtype)
    uv = rng.uniform(0, (79, 59), (300, 2))
    right, down = rng.uniform(-20, 20, (2, 300, 2))
    arguments = image, uv, right, down
    sectors = appearance._sectors(*arguments)
    around = appearance._around(*arguments, appearance.PLACES)
    monkeypatch.setattr(kernels, "COMPILED", False)
    expected = appearance._around(*arguments, appearance.PLACES)
    np.testing.assert_allclose(sectors, appearance._sectors(*arguments), rtol=1e-9)
    np.testing.assert_allclose(around, expected, rtol=1e-9)


def test_no_grey_level_where_there_is_no_place() -> None:
    nowhere, step = np.array([[np.nan, 5.0], [5.0, np.nan]]), np.ones((2, 2))
    around = appearance._around(np.ones((9, 9)), nowhere, step, step, appearance.PLACES)
    assert np.isnan(around).all()
