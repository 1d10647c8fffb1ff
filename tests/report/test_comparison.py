"""Differences in units of their standard deviation."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui import engine
from calibgui.report.comparison import compare_parameters
from tests.engine import scenes


def test_difference_and_its_unit() -> None:
    scene = scenes.scene(scenes.barrel(), 8)
    a, b = (
        engine.calibrate(scene.noisy(0.1, np.random.default_rng(seed)), scene.size, fix=fix)
        for seed, fix in ((0, {"k3": 0.0}), (1, {"k3": 0.0, "p1": 2e-4}))
    )
    rows = {row.name: row for row in compare_parameters(a, b)}
    assert list(rows) == ["fx", "fy", "cx", "cy", "k1", "k2", "k3", "p1", "p2", "p3"]
    unit = np.hypot(a.sigma[0], b.sigma[0])
    change = b.camera.params[0] - a.camera.params[0]
    assert rows["fx"].change == pytest.approx(change)
    assert rows["fx"].sigmas == pytest.approx(change / unit)
    assert rows["p1"].sigmas == pytest.approx((2e-4 - a.camera.params[7]) / a.sigma[7])
    assert np.isnan(rows["k3"].sigmas)  # held in both


def test_only_pinhole_parameters_compare_across_models() -> None:
    scene = scenes.scene(scenes.barrel(), 8)
    a = engine.calibrate(scene.views, scene.size)
    b = engine.calibrate(scene.views, scene.size, model="brown-conrady")
    assert [row.name for row in compare_parameters(a, b)] == ["fx", "fy", "cx", "cy"]
