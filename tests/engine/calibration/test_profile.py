"""Profiles: the width that other solves find, parameters open on one side, parabolas left alone."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from tests.engine.scenes import TRUE_BOARD, VGA, scene

MEI = Camera(VGA, [350, 350, 310, 235, 0.8, -0.1, 0.02, 1e-3, -1e-3], "mei")
"""A wide lens whose focal length and xi few views hardly tell apart."""


def photograph(camera: Camera, count: int, noise: float) -> list[Observation]:
    """Make views of a true board."""
    return scene(camera, count, seed=2).noisy(noise, np.random.default_rng(1))


def sum_squares(found: Calibration) -> float:
    """Return the sum of squared residuals."""
    return float(sum(np.sum(view.image**2) for view in found.residuals))


def test_width_is_that_of_solves_with_the_parameter_held() -> None:
    views = photograph(MEI, 20, 0.03)
    found = calibrate(views, VGA, model="mei", prior=TRUE_BOARD)
    assert found.overdispersion == 0 and not found.undetermined
    xi, sigma = found.camera.params[4], found.sigma[4]
    assert sigma > 1.2 * found.sigma_by_noise[4]  # the linear one is too small
    rises = []
    for side in (2, -2):
        held = calibrate(views, VGA, model="mei", prior=TRUE_BOARD, fix={"xi": xi + side * sigma})
        rises.append((sum_squares(held) - sum_squares(found)) / found.noise**2)
    assert rises[0] == pytest.approx(4, rel=0.2) and rises[1] > 6
    assert np.linalg.eigvalsh(found.covariance[:9, :9]).min() > 0


def test_parameters_that_trade_without_bound_are_named() -> None:
    found = calibrate(photograph(MEI, 10, 0.03), VGA, model="mei", prior=TRUE_BOARD)
    reasons = {u.name: u.reason for u in found.undetermined}
    assert {"fx", "fy", "xi"} <= set(reasons)
    assert "one side" in reasons["fx"] and np.isnan(found.sigma[[0, 1, 4]]).all()
    assert np.isfinite(found.sigma[[2, 3]]).all()


@pytest.mark.parametrize("count", [4, 10])
def test_plain_camera_keeps_its_deviations(count: int) -> None:
    plain = Camera(VGA, [650, 650, 310, 235, -0.25, 0.12, 0, 0, 0, 0], "lucchese")
    views = photograph(plain, count, 0.05)
    found = calibrate(views, VGA, prior=TRUE_BOARD)
    assert found.overdispersion == 0 and not found.undetermined
    np.testing.assert_allclose(found.sigma[:9], found.sigma_by_noise[:9], rtol=0.02)
