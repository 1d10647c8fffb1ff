"""Weights from covariances, and the floor that the residuals call for."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation, Observations, pack_observations
from calibgui.engine.calibration.refinement.whitening import (
    estimate_model_variance,
    whiten_observations,
)
from tests.engine.calibration.board_shape.test_parametrisation import (
    CAMERA,
    NOMINAL,
    SIZE,
    photographed,
)
from tests.engine.scenes import TRUE_BOARD


def covariances(count: int, seed: int) -> Array:
    """(count, 2, 2) of standard deviations from 0.02 to 0.3 px."""
    rng = np.random.default_rng(seed)
    angle, sd = rng.uniform(0, np.pi, count), rng.uniform(0.02, 0.3, (count, 2))
    axes = np.stack([np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)], axis=1)
    R = axes.reshape(-1, 2, 2)
    return R @ (sd[:, :, None] ** 2 * np.swapaxes(R, 1, 2))


def noisy(views: int, floor: float, seed: int) -> list[Observation]:
    """Views whose corners scatter by their covariances and by `floor` px besides."""
    rng = np.random.default_rng(seed)
    result = []
    for k, view in enumerate(photographed(np.zeros((len(NOMINAL), 3)), views, 0.0, seed)):
        cov = covariances(len(NOMINAL), 100 * seed + k)
        draws = (np.linalg.cholesky(cov) @ rng.normal(size=(len(NOMINAL), 2, 1)))[..., 0]
        shift = draws + rng.normal(0, floor, draws.shape)
        result.append(Observation(view.uv + shift, view.xy, cov))
    return result


def test_whitening_is_a_root_of_the_inverse_up_to_scale() -> None:
    packed = whiten_observations(pack_observations(noisy(3, 0.0, 1)), tau2=0.01)
    assert packed.whitening is not None and packed.cov is not None
    product = np.swapaxes(packed.whitening, -1, -2) @ packed.whitening
    total = packed.cov + 0.01 * np.eye(2)
    scaled = product @ total
    np.testing.assert_allclose(scaled, scaled[0, 0, 0, 0] * np.eye(2) + 0 * scaled, atol=1e-10)


@pytest.mark.parametrize("floor", [0.0, 0.05, 0.2])
def test_the_floor_is_found(floor: float) -> None:
    rng = np.random.default_rng(0)
    cov = np.stack([covariances(500, k) for k in range(10)])
    draws = (np.linalg.cholesky(cov) @ rng.normal(size=(10, 500, 2, 1)))[..., 0]
    residual = draws + rng.normal(0, floor, draws.shape)
    observations = Observations(residual, residual, np.ones((10, 500)), cov)
    # 10,000 coordinates: the variance is known to 1.4 % of its total.
    assert estimate_model_variance(observations, residual, 0) == pytest.approx(
        floor**2, abs=0.03 * (floor**2 + 0.02)
    )


@pytest.mark.parametrize("stretch", [0.0, 1e-12, 1.0, 1e6])
def test_corners_are_resolved_along_the_axes_of_their_covariances(stretch: float) -> None:
    rng = np.random.default_rng(4)
    axes = np.linalg.qr(rng.normal(size=(50, 2, 2)))[0]
    C = axes @ (np.diag([1.0, 1.0 + stretch]) @ np.swapaxes(axes, -1, -2))
    r = rng.normal(size=(50, 2))
    observations = Observations(r[None], r[None], np.ones((1, 50)), C[None])
    tau2 = estimate_model_variance(observations, 1e4 * r[None], 7)
    weights = np.linalg.inv(C + tau2 * np.eye(2))
    assert 1e8 * np.einsum("ni,nij,nj", r, weights, r) == pytest.approx(100 - 7, rel=1e-5)


def test_weights_beat_equal_weights_where_corners_differ() -> None:
    errors = {"weighted": [], "equal": []}
    reported = []
    for seed in range(30):
        views = noisy(8, 0.0, seed)
        result = calibrate(views, SIZE, prior=TRUE_BOARD)
        reported.append((result.camera.params - CAMERA.params)[:4] / result.sigma[:4])
        errors["weighted"].append((result.camera.params - CAMERA.params)[:4])
        equal = calibrate([Observation(v.uv, v.xy) for v in views], SIZE)
        errors["equal"].append((equal.camera.params - CAMERA.params)[:4])
    ratio = np.std(errors["weighted"], axis=0) / np.std(errors["equal"], axis=0)
    assert (ratio < 0.7).all()
    assert 0.85 < np.std(reported) < 1.15


def test_a_floor_above_the_covariances_makes_weights_equal() -> None:
    views = noisy(16, 2.0, 3)
    result = calibrate(views, SIZE)
    equal = calibrate([Observation(v.uv, v.xy) for v in views], SIZE)
    np.testing.assert_allclose(result.camera.params[:4], equal.camera.params[:4], atol=1.0)
    assert result.noise == pytest.approx(equal.noise, rel=0.02)
    assert [i.index for i in result.history] == list(range(len(result.history)))
