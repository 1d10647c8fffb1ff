"""An imperfect board widens the nominal board's uncertainties until they cover the truth."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from tests.engine.calibration.board_shape.test_parametrisation import (
    CAMERA,
    SIZE,
    deviation,
    photographed,
)


def errors(count: int, rms: float, draws: int) -> tuple[Array, int]:
    """Errors of the nine intrinsics in reported sigmas (draws, 9), and how many were alarmed."""
    z, alarms = [], 0
    for seed in range(draws):
        d = deviation(rms, seed) if rms > 0 else np.zeros_like(deviation())
        result = calibrate(photographed(d, count, 0.05, 1000 + seed), SIZE)
        z.append((result.camera.params - CAMERA.params)[:9] / result.sigma[:9])
        alarms += bool(result.board_shape_error)
    return np.array(z), alarms


@pytest.mark.slow
@pytest.mark.parametrize("count", [10, 25])
def test_a_bent_board_is_covered(count: int) -> None:
    z, alarms = errors(count, 0.1, 60)
    assert alarms == 60
    assert (np.abs(z) < 2).mean() >= 0.93
    # Binomial scatter of 60 draws at 95 %: 3 standard deviations down is 86 %.
    assert (np.abs(z) < 2).mean(axis=0).min() >= 0.86


@pytest.mark.slow
def test_a_true_board_raises_no_alarm() -> None:
    z, alarms = errors(10, 0.0, 40)
    assert alarms == 0
    assert 0.9 < z.std() < 1.1


def test_the_error_is_of_the_size_of_the_deviations() -> None:
    result = calibrate(photographed(deviation(0.2), 8, 0.05), SIZE)
    assert 0.1 < result.board_shape_error < 0.5
    assert not calibrate(
        photographed(deviation(0.2), 8, 0.05), SIZE, board_shape="free"
    ).board_shape_error
