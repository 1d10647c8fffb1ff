"""The compiled variances of a board's deviations against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.board_shape.deviation_variances import (
    _MAX_MIXING,
    _MIN_RATIO,
    Noise,
    VariancePrior,
    find_stiffness,
    tridiagonalise_rough,
)
from calibgui.engine.calibration.board_shape.deviations import make_deviations


@pytest.mark.parametrize("corners", [4, 7, 40])
@pytest.mark.parametrize("nu", [0.3, np.inf])
@pytest.mark.parametrize("redundancy", [500, -1])
def test_compiled_and_readable_settle_alike(corners: int, nu: float, redundancy: int) -> None:
    """With no, few and many rough deviations, learnt and known, with noise and without."""
    rng = np.random.default_rng(corners)
    kind = make_deviations(rng.uniform(-1, 1, (corners, 2))).kind
    scale = np.array([3.0, 1.0, 0.2])[kind]
    J = rng.normal(size=(3 * len(kind), len(kind))) * scale
    S, right = J.T @ J, 5 * scale * rng.normal(size=len(kind))
    given = (
        tridiagonalise_rough(S, right, kind),
        VariancePrior(np.array([0.1, 0.3, 0.02]), nu),
        Noise(900.0, redundancy, 2.0),
        1e-12,
    )
    for steps, tolerance in ((1, 1e-12), (2, 1e-9), (5, 1e-7), (100, 1e-6)):
        limits = (steps, 1e-7, _MAX_MIXING, _MIN_RATIO)
        compiled, sigma2 = find_stiffness.kernel(*given, limits)
        readable, truth = find_stiffness.reference(*given, limits)
        np.testing.assert_allclose(compiled, readable, atol=tolerance)
        assert sigma2 == pytest.approx(truth, rel=tolerance)
