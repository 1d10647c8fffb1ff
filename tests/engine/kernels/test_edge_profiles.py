"""The compiled profiles across edges against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine import kernels
from calibgui.engine.features import edge_profiles
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions


@pytest.mark.parametrize("deep", [False, True])
def test_the_same_profiles(deep: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = draw(Conditions(size=(320, 240), square=22.0, deep=deep, ink=0.05), 1)
    right, down = np.gradient(scene.uv, axis=1), np.gradient(scene.uv, axis=0)
    uv, right, down = (x.reshape(-1, 2) for x in (scene.uv, right, down))
    u, v = np.rint(uv + (right + down) / 2).astype(int).T
    sign = np.where(scene.clean[v, u] > 127, 1.0, -1.0)
    height = abs(np.linalg.det(np.stack([right, down], axis=1))) / np.linalg.norm(right, axis=1)
    arguments = scene.photograph(0), uv, right, down, height, sign
    compiled = edge_profiles.measure_edge_profiles(*arguments)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = edge_profiles.measure_edge_profiles(*arguments)
    for one, other in zip(compiled, readable, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9)
    np.testing.assert_allclose(np.median(compiled.spread), 0.05, atol=0.005)
