"""What a board may deviate by is in the uncertainties of a calibration that takes it as drawn."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.boards.shape import BoardShapePrior
from calibgui.engine.calibration.board_shape.parametrisation import make_gauge
from calibgui.engine.calibration.board_shape.uncertainty import make_deviations
from calibgui.engine.calibration.calibrate import calibrate
from tests.engine.calibration.board_shape.test_parametrisation import (
    ACROSS,
    CAMERA,
    NOMINAL,
    SIZE,
    deviation,
    photographed,
)
from tests.engine.scenes import TRUE_BOARD, stored

TRUTH_OF_THE_25 = np.array([658.65, 659.12, 301.69, 243.52])
"""fx, fy, cx, cy of the paper's camera from all 25 images, the board's shape estimated, px."""


def bent(kind: str, rms: float, seed: int) -> Array:
    """(n, 3) deviations of a board, mm."""
    rng, d = np.random.default_rng(seed), np.zeros((len(NOMINAL), 3))
    x, y = ACROSS.T
    if kind == "bow":
        d[:, 2] = x**2 + rng.uniform(-1, 1) * y**2
    elif kind == "twist":
        d[:, 2] = x * y
    elif kind == "stretched":
        d[:, 1], d[:, 0] = y, rng.uniform(-1, 1) * y
    elif kind == "rough":
        d = rng.normal(size=d.shape)
    elif kind == "bow and rough print":
        d[:, 2] = x**2 - np.mean(x**2)
        return d * 0.2 / np.std(d[:, 2]) + rng.normal(0, 0.07, d.shape) * [1, 1, 0]
    d -= d.mean(axis=0)
    return d * rms / np.sqrt(np.mean(np.sum(d**2, axis=1)))


def errors(kind: str, rms: float, count: int, draws: int) -> Array:
    """Errors of the nine intrinsics in reported sigmas (draws, 9)."""
    z = []
    for seed in range(draws):
        d = bent(kind, rms, seed) if kind else np.zeros((len(NOMINAL), 3))
        result = calibrate(photographed(d, count, 0.05, 1000 + seed), SIZE)
        z.append((result.camera.params - CAMERA.params)[:9] / result.sigma[:9])
    return np.abs(z)


@pytest.mark.slow
@pytest.mark.parametrize("count", [4, 25])
@pytest.mark.parametrize(
    ("kind", "rms"),
    [
        ("bow", 0.05),
        ("bow", 1.0),
        ("twist", 0.2),
        ("stretched", 0.2),
        ("rough", 0.3),
        ("bow and rough print", 0.0),
    ],
)
def test_any_board_is_covered(kind: str, rms: float, count: int) -> None:
    z = errors(kind, rms, count, 40)
    assert (z < 2).mean() >= 0.95
    # Binomial scatter of 40 draws at 95 %: 3 standard deviations down is 85 %.
    assert (z < 2).mean(axis=0).min() >= 0.85


@pytest.mark.slow
def test_a_true_board_costs_little_where_the_views_show_it() -> None:
    for seed in range(10):
        result = calibrate(photographed(0 * deviation(), 25, 0.05, seed), SIZE)
        assert result.board_shape_error == 0
        assert (result.sigma[:2] < 2 * result.sigma_by_noise[:2]).all()
        assert (result.sigma[:9] < 5 * result.sigma_by_noise[:9]).all()


def test_few_views_rest_on_the_prior() -> None:
    views = photographed(0 * deviation(), 3, 0.05)
    usual, flat, poor = (
        calibrate(views, SIZE, prior=prior)
        for prior in (None, TRUE_BOARD, BoardShapePrior(0.5, 0.5))
    )
    np.testing.assert_allclose(flat.sigma[:9], flat.sigma_by_noise[:9], rtol=0.02)
    assert (usual.sigma[:4] > 1.2 * flat.sigma[:4]).all()
    assert (poor.sigma[:4] > 1.5 * usual.sigma[:4]).all()
    for found in (usual, poor):
        np.testing.assert_array_equal(found.camera.params, flat.camera.params)
        np.testing.assert_array_equal(found.sigma_by_noise, flat.sigma_by_noise)


def test_the_error_is_of_the_size_of_the_deviations() -> None:
    result = calibrate(photographed(bent("bow", 0.2, 0), 8, 0.05), SIZE)
    assert result.board_shape_error == pytest.approx(0.2, rel=0.2)
    views = photographed(bent("bow", 0.2, 0), 8, 0.05)
    assert not calibrate(views, SIZE, board_shape="free").board_shape_error


@pytest.mark.parametrize("cost", ["reference", "paper"])
def test_other_costs_are_as_uncertain(cost: str) -> None:
    """Their distance from the truth is covered by what the image cost knows of the board."""
    views = photographed(bent("bow", 0.3, 1), 10, 0.05)
    image, other = calibrate(views, SIZE), calibrate(views, SIZE, cost=cost)
    assert (other.sigma[:2] > 0.5 * image.sigma[:2]).all()
    assert (other.sigma[:2] > 3 * other.sigma_by_noise[:2]).all()
    assert (np.abs(other.camera.params - CAMERA.params)[:4] < 3 * other.sigma[:4]).all()
    assert other.board_shape_error == pytest.approx(image.board_shape_error, rel=0.2)


def test_deviations_are_orthonormal_and_free_of_the_gauge() -> None:
    for points in (NOMINAL, NOMINAL[:6], np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]])):
        B, kind = make_deviations(points)
        flat = B.reshape(3 * len(points), -1)
        np.testing.assert_allclose(flat.T @ flat, np.eye(len(kind)), atol=1e-9)
        np.testing.assert_allclose(make_gauge(points).T @ flat, 0, atol=1e-9)


@pytest.mark.data
@pytest.mark.slow
@pytest.mark.parametrize("count", [2, 3, 5, 8, 12])
def test_subsets_of_the_papers_photographs_hold_the_value_from_all(
    data_dir: Path, count: int
) -> None:
    file = "bouguet_calib_example/corners_and_results/corners_25img__benJephunneh.json"
    views, size = stored(data_dir / file)
    truth = calibrate(views, size, board_shape="free").camera.params[:4]
    rng, z = np.random.default_rng(count), []
    for _ in range(40):
        chosen = rng.choice(len(views), count, replace=False)
        found = calibrate([views[k] for k in sorted(chosen)], size)
        z.append(np.abs(found.camera.params[:4] - truth) / found.sigma[:4])
    assert (np.array(z) < 2.5).mean(axis=0).min() >= 0.9
    assert 0.2 < np.median(z, axis=0).min()
    assert np.median(z, axis=0).max() < 1.3
