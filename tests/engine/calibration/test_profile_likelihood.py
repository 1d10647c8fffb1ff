"""Profiles: the width that other solves find, parameters open on one side, parabolas left alone,
and that nothing ever becomes better known."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration import standard_deviations
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import BOARD, TRUE_BOARD, VGA, imaged, looking, scene

MEI = Camera(VGA, [350, 350, 310, 235, 0.8, -0.1, 0.02, 1e-3, -1e-3], "mei")
"""A wide lens whose focal length and xi few views hardly tell apart."""

POORLY_KNOWN = [
    (MEI, 0.03, 0),  # open on both sides, and named for it
    (Camera(VGA, [300, 300, 310, 235, -0.05, 4e-3, -3e-3, 4e-4], "kannala-brandt"), 1.0, 1),
    (Camera(VGA, [300, 300, 310, 235, -0.2, 0.55], "double-sphere"), 0.1, 1),
    (Camera(VGA, [650, 650, 310, 235, 0.25, 0.1, -0.04, 4e-4, -7e-4, 0.0], "lucchese"), 1.0, 1),
    (Camera(VGA, [650, 650, 310, 235, -0.25, 0.12, 3e-4, -5e-4, -0.03], "brown-conrady"), 1.0, 1),
]
"""Lenses, the noise, px, that makes few views know them poorly, and how many of six calibrations
are then widened at least."""


def photograph(camera: Camera, count: int, noise: float) -> list[Observation]:
    """Make views of a true board."""
    return scene(camera, count, seed=2).noisy(noise, np.random.default_rng(1))


def photograph_parts(camera: Camera, count: int, noise: float, seed: int) -> list[Observation]:
    """Make views of the part of a little tilted board that is in the image."""
    rng = np.random.default_rng(seed)
    views: list[Observation] = []
    xy = BOARD.points()[:, :2]
    while len(views) < count:
        uv = imaged(camera, looking(camera, rng, (5, 20), (0.3, 0.7)), xy)
        inside = ((uv > 0) & (uv < VGA)).all(axis=1)  # not where it is NaN
        if inside.sum() >= 20:
            uv = uv[inside] + rng.normal(scale=noise, size=(inside.sum(), 2))
            views.append(Observation(uv, xy[inside]))
    return views


def leave_profiles_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave uncertainties as they are before profiles are followed."""
    monkeypatch.setattr(standard_deviations, "add_profile_width", lambda estimate, *_: estimate)


def find_least_eigenvalue(matrix: Array, unit: Array) -> float:
    """Return the least eigenvalue of a matrix (P, P), its parameters in units of their deviations
    by a covariance (P, P): only those of a covariance are free of rounding."""
    free = np.diag(unit) > 0
    scale = np.sqrt(np.diag(unit)[free])
    return float(np.linalg.eigvalsh(matrix[np.ix_(free, free)] / np.outer(scale, scale))[0])


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
def test_plain_camera_keeps_its_deviations(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    plain = Camera(VGA, [650, 650, 310, 235, -0.25, 0.12, 0, 0, 0, 0], "lucchese")
    views = photograph(plain, count, 0.05)
    found = calibrate(views, VGA, prior=TRUE_BOARD)
    assert found.overdispersion == 0 and not found.undetermined
    leave_profiles_out(monkeypatch)
    linear = calibrate(views, VGA, prior=TRUE_BOARD)
    np.testing.assert_allclose(found.sigma, linear.sigma, rtol=0.02)


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize(
    ("camera", "noise", "least"), POORLY_KNOWN, ids=[case[0].model for case in POORLY_KNOWN]
)
def test_no_combination_becomes_better_known(
    camera: Camera, noise: float, least: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    widened = 0
    for seed in range(6):
        views = photograph_parts(camera, 2 + seed % 3, noise, seed)
        try:
            found = calibrate(views, VGA, model=camera.model)
        except CalibrationError:  # degenerate, or without a start
            continue
        with monkeypatch.context() as patch:
            leave_profiles_out(patch)
            linear = calibrate(views, VGA, model=camera.model)
        widened += bool((np.diag(found.covariance) > 1.05 * np.diag(linear.covariance)).any())
        pairs = [
            (found.covariance, linear.covariance),
            *zip(found.pose_covariances, linear.pose_covariances, strict=True),
        ]
        for covariance, by_parabola in pairs:
            assert find_least_eigenvalue(covariance, covariance) > -1e-9
            assert find_least_eigenvalue(covariance - by_parabola, covariance) > -1e-9
    assert widened >= least
