"""Zhang's method against known truth, scipy, and his own published figures."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import scipy

from calibgui.engine.arrays import Array, Size
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods.method import Method
from calibgui.engine.calibration.methods.zhang import (
    ZHANG,
    ZHANG_ALTERNATION,
    ZHANG_CLOSED_FORM,
    estimate_radial_terms,
)
from calibgui.engine.calibration.observations import Observation, pack_observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError
from calibgui.engine.calibration.refinement.residuals import State, compute_residuals
from calibgui.engine.calibration.result import (
    Calibration,
    Cost,
    DegenerateError,
    Iteration,
    Status,
)
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.scenes import VGA, Scene, relative, scene, stored

MODEL = "brown-conrady-4"
IDEAL = Camera(VGA, [650, 655, 303, 243, 0, 0, 0, 0, 2e-3], MODEL)
SKEWLESS = Camera(VGA, [650, 655, 303, 243, 0, 0, 0, 0, 0], MODEL)
DISTORTED = Camera(VGA, [650, 655, 303, 243, -0.25, 0.12, 0, 0, 2e-3], MODEL)

Set = tuple[list[Observation], Size]

TABLE_1 = [
    (ZHANG_CLOSED_FORM, 2, (825.59, 825.26, 0.0, 295.79, 217.69)),
    (ZHANG_CLOSED_FORM, 3, (917.65, 920.53, 2.2956, 277.09, 223.36)),
    (ZHANG_CLOSED_FORM, 4, (876.62, 876.22, 0.0658, 301.31, 220.06)),
    (ZHANG_CLOSED_FORM, 5, (877.16, 876.80, 0.1752, 301.04, 220.41)),
    (ZHANG, 2, (830.47, 830.24, 0.0, 307.03, 206.55)),
    (ZHANG, 4, (831.81, 831.82, 0.2867, 304.53, 206.79)),
    (ZHANG, 5, (832.50, 832.53, 0.2045, 303.96, 206.59)),
]
"""Method, number of his first views, and alpha, beta, gamma, u0, v0: MSR-TR-98-71, table 1."""


@pytest.fixture(scope="module")
def published(data_dir: Path) -> Set:
    return stored(data_dir / "zhang1998" / "corners.json")


@pytest.fixture(scope="module")
def found(published: Set) -> Calibration:
    return calibrate(*published, method=ZHANG)


def noisy(camera: Camera, count: int = 6, sigma: float = 0.1) -> list[Observation]:
    return scene(camera, count, seed=1).noisy(sigma, np.random.default_rng(0))


def in_zhangs_terms(found: Calibration) -> Array:
    """alpha, beta, gamma, u0, v0."""
    fx, fy, cx, cy = found.camera.params[:4]
    return np.array([fx, fy, fx * found.camera.params[-1], cx, cy])


def check_truth(found: Calibration, truth: Scene, tolerance: float = 1e-6) -> None:
    params = truth.camera.params
    np.testing.assert_allclose(found.camera.params, params, rtol=tolerance, atol=tolerance)
    for pose, true in zip(found.poses, truth.poses, strict=True):
        assert relative(pose.rvec, true.rvec) < tolerance
        assert relative(pose.tvec, true.tvec) < tolerance


def check_agreement(found: Calibration, best: Calibration) -> None:
    """Check that a camera is that of another calibration, to 0.003 of its standard deviations."""
    deviation = np.abs(found.camera.params - best.camera.params)
    assert (deviation <= 0.003 * best.sigma).all()


@pytest.mark.parametrize(("camera", "views"), [(SKEWLESS, 2), (IDEAL, 3), (IDEAL, 10)])
def test_the_closed_form_is_exact_on_an_ideal_lens(camera: Camera, views: int) -> None:
    truth = scene(camera, views, seed=1)
    found = calibrate(truth.views, VGA, method=ZHANG_CLOSED_FORM)
    check_truth(found, truth)
    assert set(found.fixed) == {"k1", "k2", "p1", "p2"} | ({"skew"} if views == 2 else set())


def test_the_closed_form_is_exact_on_a_large_sensor() -> None:
    """In pixels the columns of V would differ by 1e8 there."""
    camera = Camera((9000, 6000), [9000, 9010, 4400, 3100, 0, 0, 0, 0, 1e-3], MODEL)
    truth = scene(camera, 4, seed=2)
    check_truth(calibrate(truth.views, camera.size, method=ZHANG_CLOSED_FORM), truth)


def test_maximum_likelihood_is_exact_on_its_own_model() -> None:
    truth = scene(DISTORTED, 5, seed=1)
    found = calibrate(truth.views, VGA, method=ZHANG)
    check_truth(found, truth)
    assert found.fixed == ("p1", "p2")


def test_radial_terms_are_the_least_squares_solution() -> None:
    observations = pack_observations(noisy(DISTORTED))
    truth = scene(DISTORTED, 6, seed=1)
    R = rotation_from_vector(np.array([pose.rvec for pose in truth.poses]))
    T = np.array([pose.tvec for pose in truth.poses])

    def cost(k: Array) -> float:
        params = IDEAL.params.copy()
        params[4:6] = k
        state = State(params, R, T)
        return float(np.sum(compute_residuals(state, observations, MODEL, Cost.IMAGE)[0] ** 2))

    ideal = State(IDEAL.params.copy(), R, T)
    both = estimate_radial_terms(ideal, observations, np.array([4, 5])).params[4:6]
    best = scipy.optimize.minimize(cost, [0, 0], method="Nelder-Mead", tol=1e-9).x
    np.testing.assert_allclose(both, best, atol=1e-5)
    np.testing.assert_allclose(both, DISTORTED.params[4:6], atol=3e-3)
    one = estimate_radial_terms(ideal, observations, np.array([4])).params[4:6]
    step = np.array([1e-5, 0.0])
    assert one[1] == 0.0
    assert cost(one) < min(cost(one + step), cost(one - step))


def test_the_alternation_comes_to_the_minimum() -> None:
    views = noisy(DISTORTED)
    alternating = calibrate(views, VGA, method=ZHANG_ALTERNATION, max_iterations=2000)
    best = calibrate(views, VGA, method=ZHANG)
    assert alternating.status is Status.CONVERGED
    check_agreement(alternating, best)
    assert alternating.sigma == pytest.approx(best.sigma, rel=1e-3)
    costs = [iteration.cost for iteration in alternating.history]
    assert [iteration.index for iteration in alternating.history] == list(range(len(costs)))
    assert (np.diff(costs) < 0).all()
    assert len(costs) > 10 * len(best.history)
    residuals = np.concatenate([view.image for view in alternating.residuals])
    assert costs[-1] == pytest.approx(np.sum(residuals**2))


def test_the_alternation_is_exact_on_its_own_model() -> None:
    """With k2 known: both terms take thousands of rounds to as many digits."""
    truth = scene(DISTORTED, 5, seed=1)
    found = calibrate(
        truth.views, VGA, method=ZHANG_ALTERNATION, fix={"k2": 0.12}, max_iterations=1000
    )
    check_truth(found, truth)


def test_an_alternation_that_has_not_converged_says_so() -> None:
    found = calibrate(noisy(DISTORTED), VGA, method=ZHANG_ALTERNATION, max_iterations=5)
    assert found.status is Status.MAX_ITERATIONS
    assert len(found.history) == 6


def test_the_alternation_can_be_stopped() -> None:
    told: list[int] = []

    def stop_after_three(iteration: Iteration) -> bool:
        told.append(iteration.index)
        return len(told) < 3

    found = calibrate(noisy(DISTORTED), VGA, method=ZHANG_ALTERNATION, report=stop_after_three)
    assert found.status is Status.STOPPED
    assert told == [0, 1, 2]


def test_the_closed_form_scatters_more_than_maximum_likelihood() -> None:
    views = noisy(IDEAL, count=8)
    closed = calibrate(views, VGA, method=ZHANG_CLOSED_FORM)
    best = calibrate(views, VGA, method=ZHANG, fix=["k1", "k2"])
    free = best.sigma > 0
    assert (closed.sigma[free] > best.sigma_by_noise[free]).all()
    for found in (closed, best):
        off = np.abs(found.camera.params - IDEAL.params)[free]
        assert (off < 4 * found.sigma[free]).all()


def test_held_parameters() -> None:
    views = noisy(DISTORTED)
    for method in (ZHANG, ZHANG_ALTERNATION):
        found = calibrate(views, VGA, method=method, fix={"skew": None, "k1": -0.25, "cx": 303.0})
        assert found.camera.params[[2, 4, 8]].tolist() == [303.0, -0.25, 0.0]
        assert set(found.fixed) == {"skew", "k1", "cx", "p1", "p2"}
        assert found.camera.params[0] == pytest.approx(650, abs=2)
    centred = calibrate(noisy(IDEAL), VGA, method=ZHANG_CLOSED_FORM, fix=["cx", "cy"])
    assert centred.camera.centre.tolist() == [319.5, 239.5]


def test_decentering_can_be_freed_in_all_but_the_closed_form() -> None:
    camera = Camera(VGA, [650, 655, 303, 243, -0.25, 0.12, 3e-3, -2e-3, 2e-3], MODEL)
    truth = scene(camera, 6, seed=1)
    check_truth(calibrate(truth.views, VGA, method=ZHANG, free=["p1", "p2"]), truth)
    alternating = calibrate(
        noisy(camera), VGA, method=ZHANG_ALTERNATION, free=["p1", "p2"], max_iterations=2000
    )
    check_agreement(alternating, calibrate(noisy(camera), VGA, method=ZHANG, free=["p1", "p2"]))


@pytest.mark.parametrize("options", [{"free": ["k1"]}, {"fix": {"k1": -0.25}}])
def test_the_closed_form_refuses_distortion(options: dict[str, object]) -> None:
    with pytest.raises(CalibrationError, match="knows no distortion: k1 is 0") as caught:
        calibrate(noisy(IDEAL), VGA, method=ZHANG_CLOSED_FORM, **options)  # type: ignore[arg-type]
    assert "'zhang'" in caught.value.hint


@pytest.mark.parametrize("method", [ZHANG, ZHANG_CLOSED_FORM, ZHANG_ALTERNATION])
def test_views_parallel_to_the_sensor_have_no_closed_form(method: object) -> None:
    flat = scene(DISTORTED, 6, seed=1, tilt=(0, 0)).noisy(0.1, np.random.default_rng(0))
    with pytest.raises(StartError, match="its matrix B is not positive definite") as caught:
        calibrate(flat, VGA, method=method)  # type: ignore[arg-type]
    assert "tilted" in caught.value.hint


def test_one_view_determines_no_camera() -> None:
    """With the centre of the image and no skew, as he takes them, the closed form has a start."""
    with pytest.raises(DegenerateError, match="One view") as caught:
        calibrate(noisy(DISTORTED)[:1], VGA, method=ZHANG)
    partial = caught.value.partial
    assert partial is not None
    assert {"cx", "cy", "skew"} <= set(partial.fixed)
    assert partial.camera.focal == pytest.approx([650, 655], rel=0.05)


def test_remarks_state_gamma_and_what_is_open() -> None:
    views = noisy(DISTORTED)
    found = calibrate(views, VGA, method=ZHANG)
    (gamma,) = ZHANG.list_remarks(found)
    value, sigma = map(float, re.findall(r"([\d.]+) px", gamma))
    assert value == pytest.approx(found.camera.params[0] * found.camera.params[-1], rel=1e-3)
    assert sigma == pytest.approx(found.camera.params[0] * found.sigma[-1], rel=0.1)
    two = calibrate(views[:2], VGA, method=ZHANG)
    (remark,) = ZHANG.list_remarks(two)
    assert remark.startswith("Two views leave skew open")


@pytest.mark.data
@pytest.mark.parametrize(("method", "views", "expected"), TABLE_1)
def test_his_table_1(
    published: Set, method: Method, views: int, expected: tuple[float, ...]
) -> None:
    corners, size = published
    found = in_zhangs_terms(calibrate(corners[:views], size, method=method))
    np.testing.assert_allclose(found, expected, atol=5.1e-3)
    assert found[2] == pytest.approx(expected[2], abs=5.1e-5)


@pytest.mark.data
def test_his_complete_calibration(found: Calibration) -> None:
    """completecalibration.txt of his data (PROVENANCE.txt)."""
    expected = [832.5, 832.53, 0.204494, 303.959, 206.585]
    np.testing.assert_allclose(in_zhangs_terms(found), expected, rtol=5e-5)
    np.testing.assert_allclose(found.camera.params[4:6], [-0.228601, 0.190353], rtol=5e-5)


@pytest.mark.data
def test_his_standard_deviations(found: Calibration) -> None:
    """Those of alpha, beta, u0, v0 in table 1, from noise alone."""
    np.testing.assert_allclose(found.sigma_by_noise[:4], [1.41, 1.38, 0.71, 0.66], rtol=0.01)


@pytest.mark.data
def test_his_poses(found: Calibration, data_dir: Path) -> None:
    text = (data_dir / "zhang1998" / "PROVENANCE.txt").read_text()
    poses = re.findall(r"view\d: ([-\d. /]+) / t ([-\d. ]+)", text)
    assert len(poses) == 5
    for pose, (rows, t) in zip(found.poses, poses, strict=True):
        R = np.array([row.split() for row in rows.split("/")], dtype=np.float64)
        np.testing.assert_allclose(rotation_from_vector(np.array(pose.rvec)), R, atol=1e-3)
        np.testing.assert_allclose(pose.tvec, np.array(t.split(), np.float64), atol=1e-3)  # inches


@pytest.mark.data
def test_his_alternation_is_slow(published: Set, found: Calibration) -> None:
    short = calibrate(*published, method=ZHANG_ALTERNATION)
    assert short.status is Status.MAX_ITERATIONS
    assert short.camera.focal == pytest.approx([832.5, 832.5], abs=0.3)
    long = calibrate(*published, method=ZHANG_ALTERNATION, max_iterations=1000)
    assert long.status is Status.CONVERGED
    check_agreement(long, found)
