"""What degenerate sets still determine, against the truth that they were made from."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.partial import partial_calibration
from calibgui.engine.calibration.partial.reparametrisation import Quantities
from calibgui.engine.calibration.result import (
    Calibration,
    Degeneracy,
    DegenerateError,
    Diagnosis,
    Status,
)
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry.frames import paper_from_intrinsics
from tests.engine.degenerate_scenes import LONG, in_one_spot, one_view, parallel, turned_in_place
from tests.engine.scenes import Scene, barrel, brown, central_differences, relative, scene, stored

NOISES = [0.0, 0.05, 0.3, 1.0]


def partial(made: Scene, noise: float, seed: int = 3, **settings: object) -> Calibration:
    return partly(made.noisy(noise, np.random.default_rng(seed)), made, **settings)


def partly(views: list[Observation], made: Scene, **settings: object) -> Calibration:
    with pytest.raises(DegenerateError) as caught:
        calibrate(views, made.size, **settings)  # type: ignore[arg-type]
    found = caught.value.partial
    assert found is not None
    assert found.status is Status.PARTIAL
    assert diagnosis(found).message == caught.value.message
    return found


def diagnosis(found: Calibration) -> Diagnosis:
    assert found.diagnosis is not None
    return found.diagnosis


def assert_true(found: Calibration, truth: Camera) -> None:
    """Every parameter within four of its standard deviations."""
    free = found.sigma > 0
    miss = np.abs(found.camera.params - truth.params)[free]
    assert (miss < 4 * found.sigma[free] + 1e-3).all(), miss / found.sigma[free]


def aspect(found: Calibration) -> tuple[float, float]:
    """fy / fx and its standard deviation."""
    fx, fy = found.camera.params[:2]
    J = np.array([-fy / fx**2, 1 / fx])
    return fy / fx, float(np.sqrt(J @ found.covariance[:2, :2] @ J))


def curvature(found: Calibration) -> tuple[float, float]:
    """The paper's k1, px^-2, and its standard deviation."""
    values, J = paper_from_intrinsics(found.camera.params, found.camera.size)
    return values[2], float(np.sqrt(J[2] @ found.covariance @ J[2]))


@pytest.mark.parametrize("noise", NOISES)
def test_parallel_to_the_sensor_all_but_the_focal_length(noise: float) -> None:
    truth = barrel(aspect=1.2, focal=900.0)
    found = partial(parallel(truth, 0.0), noise)
    assert diagnosis(found).kind is Degeneracy.PARALLEL_TO_SENSOR
    named = {quantity.name: quantity.value for quantity in diagnosis(found).assumptions}
    assert named["fx"] == found.camera.params[0] == 640
    assert found.sigma[0] == pytest.approx(320)
    assert_true(found, truth)
    ratio, sigma = aspect(found)
    assert sigma < 2e-3
    assert abs(ratio - 1.2) < 4 * sigma + 1e-9
    k1, sigma = curvature(found)
    assert sigma < max(0.5, noise) * k1
    assert abs(k1 - paper_from_intrinsics(truth.params, truth.size)[0][2]) < 4 * sigma + 1e-12


@pytest.mark.parametrize("noise", NOISES)
def test_one_orientation(noise: float) -> None:
    found = partial(parallel(LONG, 30.0), noise)
    assert diagnosis(found).kind is Degeneracy.ONE_ORIENTATION
    assert_true(found, LONG)
    assert found.sigma[0] < 0.1 * LONG.params[0]


@pytest.mark.parametrize("tilt", [0.0, 30.0])
@pytest.mark.parametrize("noise", NOISES)
def test_turned_about_its_normal(noise: float, tilt: float) -> None:
    found = partial(turned_in_place(LONG, tilt), noise)
    assert diagnosis(found).kind is Degeneracy.ONE_PLACE
    assert_true(found, LONG)
    assert ("fx" in [quantity.name for quantity in diagnosis(found).assumptions]) == (tilt == 0)


@pytest.mark.parametrize("towards", [0.0, 40.0, 90.0])
@pytest.mark.parametrize("noise", NOISES)
def test_one_tilted_view_determines_the_focal_length(noise: float, towards: float) -> None:
    found = partial(one_view(LONG, towards), noise)
    assert diagnosis(found).kind is Degeneracy.ONE_VIEW
    assert_true(found, LONG)
    assert found.sigma[0] < 0.15 * LONG.params[0]


@pytest.mark.parametrize("noise", NOISES)
def test_one_spot_determines_the_focal_length_but_not_the_lens(noise: float) -> None:
    made = in_one_spot(LONG)
    if noise < 0.3:  # the spot's corners tell all, only less well
        views = made.noisy(noise, np.random.default_rng(3))
        assert calibrate(views, made.size).status is Status.CONVERGED
        return
    found = partial(made, noise)
    assert diagnosis(found).kind is Degeneracy.ONE_SPOT
    assert {"p1", "p2", "k3"} <= {quantity.name for quantity in diagnosis(found).assumptions}
    assert_true(found, LONG)
    assert found.sigma[0] < 0.15 * LONG.params[0]


def test_copies_count_once() -> None:
    made = one_view(LONG)
    views = made.noisy(0.1, np.random.default_rng(2))
    ten, one = partly(views * 10, made), partly(views, made)
    assert diagnosis(ten).kind is Degeneracy.COPIES
    assert len(ten.poses) == len(ten.residuals) == 10
    np.testing.assert_allclose(ten.camera.params, one.camera.params, rtol=1e-9)
    np.testing.assert_allclose(ten.sigma, one.sigma, rtol=1e-6)
    np.testing.assert_allclose(ten.pose_covariances[7], one.pose_covariances[0], rtol=1e-6)


@pytest.mark.parametrize("cost", ["image", "reference", "paper"])
def test_every_cost(cost: str) -> None:
    found = partial(parallel(LONG, 0.0), 0.1, cost=cost)
    assert found.sigma[0] > 300
    assert aspect(found)[1] < 1e-3


def test_the_forward_model() -> None:
    truth = brown()
    found = partial(parallel(truth, 0.0), 0.1, model="brown-conrady")
    assert_true(found, truth)


def test_what_the_user_knows_is_held_and_not_assumed() -> None:
    found = partial(parallel(LONG, 0.0), 0.1, fix={"fy": 900.0, "k3": -0.04})
    assert found.camera.params[[1, 6]].tolist() == [900.0, -0.04]
    assert {"fx", "fx/fy"}.isdisjoint(quantity.name for quantity in diagnosis(found).assumptions)
    assert_true(found, LONG)


@pytest.mark.slow
def test_the_standard_deviations_are_those_of_repeated_photographs() -> None:
    """Aspect and curvature from boards parallel to the sensor, over 14 draws of the noise."""
    made = parallel(LONG, 0.0)
    k1 = paper_from_intrinsics(LONG.params, LONG.size)[0][2]
    off = []
    for seed in range(14):
        found = partial(made, 0.1, seed)
        (ratio, s_ratio), (k, s_k) = aspect(found), curvature(found)
        off.append([(ratio - 1) / s_ratio, (k - k1) / s_k])
    spread = np.sqrt(np.mean(np.square(off), axis=0))
    # The deviations include what an assumed centre may be off by; the draws have but one centre.
    assert (spread > [0.2, 0.75]).all()
    assert (spread < 1.25).all()


def test_quantities_and_their_derivatives() -> None:
    for base in (0, 1):
        quantities = Quantities(base, np.array([2.0, 4.0, 0.0, 1.0, 1.0, 2.0]))
        params = np.array([800.0, 900.0, 320.0, 240.0, 0.2, -0.1, 0.3, 1e-3, -2e-3, 0.1])
        q = quantities.from_params(params)
        np.testing.assert_allclose(quantities.to_params(q), params, rtol=1e-14)
        numeric = central_differences(quantities.to_params, q, 1e-3 * np.abs(q))
        assert relative(quantities.differentiate(q) * q, numeric * q) < 1e-11


def test_considered_covariance_is_that_of_the_held_fit() -> None:
    """Against the fit itself: linear data, two of five quantities off by their doubts."""
    rng = np.random.default_rng(0)
    A, doubt = rng.normal(size=(40, 5)), np.array([1.0, 2.0, 0.5, 3.0, 1.5])
    held = np.array([False, True, False, True, False])
    fit = np.zeros((5, 45))  # from noise (40,) and held quantities' errors (5,) to errors
    fit[~held, :40] = np.linalg.pinv(A[:, ~held])
    fit[np.ix_(~held, 40 + np.flatnonzero(held))] = -np.linalg.pinv(A[:, ~held]) @ A[:, held]
    fit[held, 40 + np.flatnonzero(held)] = 1.0
    inputs = np.concatenate([np.full(40, 0.1**2), doubt**2])
    covariance, by_noise = partial_calibration.compute_consider_covariances(
        A.T @ A / 0.1**2, doubt, held
    )
    assert relative(covariance, fit * inputs @ fit.T) < 1e-12
    assert relative(by_noise, 0.1**2 * fit[:, :40] @ fit[:, :40].T) < 1e-12


def test_least_is_assumed() -> None:
    """A well known sum of two: the one that is better known beforehand is assumed."""
    S = 1e6 * np.ones((2, 2)) + 1e-9 * np.eye(2)
    known: list[Array] = [
        partial_calibration.choose_assumed(S, np.array(d)) for d in ([1.0, 0.1], [0.1, 1.0])
    ]
    assert [k.tolist() for k in known] == [[1], [0]]
    assert partial_calibration.choose_assumed(1e6 * np.eye(2), np.ones(2)).size == 0


def test_good_views_need_no_assumption() -> None:
    made = scene(LONG, 8)
    assert calibrate(made.noisy(0.3, np.random.default_rng(0)), made.size).diagnosis is None


@pytest.mark.data
def test_any_single_photograph_of_the_papers_set_knows_the_focal_length(data_dir: Path) -> None:
    file = "bouguet_calib_example/corners_and_results/corners_25img__benJephunneh.json"
    views, size = stored(data_dir / file)
    whole = calibrate(views, size).camera.params
    off, sigma = [], []
    for view in views:
        with pytest.raises(DegenerateError) as caught:
            calibrate([view], size)
        found = caught.value.partial
        assert found is not None
        off.append(found.camera.params[0] - whole[0])
        sigma.append(found.sigma[0])
    assert (np.abs(off) < 2 * np.array(sigma)).all()
    assert np.median(np.abs(off)) < 0.02 * whole[0]
    assert np.median(sigma) < 0.1 * whole[0]
