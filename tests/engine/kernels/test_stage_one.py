"""The compiled Stage I against the readable one."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine import kernels
from calibgui.engine.calibration.initialisation.stage_one import register_views


def test_compiled_and_readable_find_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(5)
    K, N = 130, 40  # more views than one block
    grid = rng.uniform(-200, 200, (K, N, 2))
    bend = np.sum(grid**2, axis=-1, keepdims=True)
    perspective = 1 + grid @ rng.uniform(-1e-3, 1e-3, (K, 2, 1))
    reference = 1.3 * grid * (1 + 5e-7 * bend) / perspective + rng.normal(0, 0.2, grid.shape)
    mask = (rng.random((K, N)) < 0.9).astype(float)
    compiled = register_views(grid, reference, mask)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = register_views(grid, reference, mask)
    np.testing.assert_array_equal(compiled.converged, readable.converged)
    assert compiled.converged.all()
    # Both stop within 1e-5 standard deviations of the minimum.
    assert (np.abs(compiled.centre - readable.centre) < 1e-3 * readable.spread[:, :2]).all()
    assert (np.abs(compiled.k1 - readable.k1) < 1e-3 * readable.spread[:, 2]).all()
    np.testing.assert_allclose(compiled.rms, readable.rms, rtol=1e-9)
    np.testing.assert_allclose(compiled.spread, readable.spread, rtol=1e-3)
