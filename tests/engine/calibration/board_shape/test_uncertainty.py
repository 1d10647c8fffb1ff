"""What a board may deviate by is in the uncertainties of a calibration that takes it as drawn."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import block_diag
from scipy.special import ndtr

from calibgui.engine.arrays import Array
from calibgui.engine.boards.shape import BoardShapePrior
from calibgui.engine.calibration.board_shape.deviation_variances import (
    solve_stiffened,
    tridiagonalise_rough,
)
from calibgui.engine.calibration.board_shape.deviations import FLATNESS, PRINT, make_deviations
from calibgui.engine.calibration.board_shape.parametrisation import make_gauge
from calibgui.engine.calibration.board_shape.uncertainty import (
    _SHIFT_WEIGHT,
    LinearisedBoard,
    estimate_board_error,
    linearise_board,
)
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation, pack_observations
from calibgui.engine.calibration.refinement.covariances import (
    Estimate,
    make_estimate,
    measure_precision,
)
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import State, build_stage_two
from calibgui.engine.calibration.result import Cost, Status
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.calibration.board_shape.test_parametrisation import (
    ACROSS,
    CAMERA,
    NOMINAL,
    SIZE,
    deviation,
    photographed,
)
from tests.engine.scenes import TRUE_BOARD, barrel, scene, stored

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
    z = errors(kind, rms, count, 30)
    # Binomial scatter of 30 draws at 95 and 68 %: 3 standard deviations down is 83 and 42 %. Of
    # standard deviations that are a quarter too small 55 % would be within one.
    assert (z < 2).mean() >= 0.94
    assert (z < 2).mean(axis=0).min() >= 0.83
    assert (z < 1).mean() >= 0.62
    assert (z < 1).mean(axis=0).min() >= 0.42


def test_a_shift_that_is_known_weighs_as_much_as_one_sigma_asks_for() -> None:
    """Of whatever is shifted by beta of its own standard deviations, 68.3 % lie within one."""
    beta = np.linspace(0, 30, 3001)
    s = np.sqrt(1 + _SHIFT_WEIGHT * beta**2)
    held = ndtr(s - beta) - ndtr(-s - beta)
    assert held.min() == pytest.approx(ndtr(1) - ndtr(-1), abs=1e-5)


@pytest.mark.slow
def test_a_true_board_costs_little_where_the_views_show_it() -> None:
    for seed in range(4):
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
    assert (flat.sigma[:9] < 2 * flat.sigma_by_noise[:9]).all()  # and what three views disagree by
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


@pytest.mark.parametrize(
    ("points", "count"),
    [
        (NOMINAL, 3 * 30 + 2),  # six rows do not tell y^6, x y^6 and y^7 from lower degrees
        (NOMINAL[:12], 3 * 9 + 2),
        (np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]]), 3 + 2),
    ],
)
def test_deviations_are_orthonormal_and_free_of_the_gauge(points: Array, count: int) -> None:
    """They are all that a board of so many corners can do, up to the seventh degree."""
    n, deviations = len(points), make_deviations(points)
    whole = deviations.contract(np.eye(3 * n).reshape(n, 3, 3 * n)).T  # B^T
    assert len(deviations.kind) == count
    np.testing.assert_allclose(whole @ whole.T, np.eye(count), atol=1e-9)
    np.testing.assert_allclose(whole @ make_gauge(points), 0, atol=1e-9)
    rng = np.random.default_rng(0)
    H = rng.normal(size=(n, 3, 3))
    H = H + H.swapaxes(1, 2)
    B = whole.T.reshape(n, 3, count)
    np.testing.assert_allclose(
        deviations.contract_twice(H), np.einsum("iaq,iab,ibr->qr", B, H, B), atol=1e-9
    )


def linearise(views: list[Observation]) -> tuple[Estimate, LinearisedBoard, int]:
    """An estimate for the board as drawn, linearised, and the number of its corners."""
    observations, free = pack_observations(views), np.arange(9)
    found = calibrate(views, SIZE)
    R = rotation_from_vector(np.array([pose.rvec for pose in found.poses]))
    state = State(found.camera.params, R, np.array([pose.tvec for pose in found.poses]))
    normal = build_stage_two(observations, "lucchese", Cost.IMAGE, 1.0, free)(state)
    names = tuple(found.camera.names[i] for i in free)
    precision = measure_precision(normal, names, observations.count, np.full(9, np.inf))
    estimate = make_estimate(Solution(state, normal, (), Status.CONVERGED), observations, precision)
    return estimate, linearise_board(estimate, observations, "lucchese", free), observations.count


def test_a_known_prior_is_the_joint_estimate() -> None:
    """Of camera, board and poses, all in one matrix, with the prior's stiffness."""
    prior = BoardShapePrior(0.1, 0.2)
    estimate, board, count = linearise(photographed(bent("bow", 0.1, 2), 4, 0.05))
    error = estimate_board_error(board, estimate, count, prior)
    U, W, V, shared, pose, cost = board.normal[:6]
    P, K, n, kind = 9, len(V), len(NOMINAL), board.deviations.kind
    flat, in_plane = n * 0.2**2 / np.sum(kind == FLATNESS), n * 0.1**2 / np.sum(kind == PRINT)
    variances = np.array([flat, in_plane, 0.25 * 0.1 * 0.2])[kind]
    whole = np.block([[U, np.hstack(list(W))], [np.vstack([w.T for w in W]), block_diag(*V)]])
    gradient, each = np.append(shared, pose), np.arange(P, len(U))
    sigma2 = estimate.sigma2
    for _ in range(20):
        stiff = whole.copy()
        stiff[each, each] += sigma2 / variances
        inverse = np.linalg.inv(stiff)
        known = len(kind) - np.sum(np.diag(inverse)[each] * sigma2 / variances)
        step = -inverse @ gradient
        sigma2 = (cost + step @ gradient) / (2 * count - P - 6 * K - known)
    np.testing.assert_allclose(error.covariance, sigma2 * inverse[:P, :P], rtol=1e-4)
    np.testing.assert_allclose(error.shift, step[:P], rtol=1e-4)
    np.testing.assert_allclose(
        error.pose_covariances[:, 3:, 3:],
        [sigma2 * inverse[i : i + 3, i : i + 3] for i in len(U) + 6 * np.arange(K) + 3],
        rtol=1e-4,
        atol=1e-9,
    )
    np.testing.assert_allclose(
        error.pose_shift[:, 3:].ravel(), step[len(U) :].reshape(-1, 6)[:, 3:].ravel(), rtol=1e-4
    )


def test_learnt_variances_are_their_own_expectation() -> None:
    """They are those that expectation-maximisation comes to in hundreds of plain steps."""
    estimate, board, count = linearise(photographed(bent("stretched", 0.05, 2), 4, 0.05))
    error = estimate_board_error(board, estimate, count)
    (U, W, V, shared, pose, cost), kind = board.normal[:6], board.deviations.kind
    solved = np.linalg.solve(V, np.concatenate([W.swapaxes(1, 2), pose[..., None]], axis=2))
    S = U - np.sum(W @ solved[..., :-1], axis=0)
    gradient, q = shared - np.sum(W @ solved[..., -1:], axis=0)[:, 0], np.arange(9, len(U))
    usual = 3e-4 * np.ptp(NOMINAL, axis=0).max()
    counts = np.bincount(kind)
    expected = usual**2 * np.append(len(NOMINAL) / counts[:2], 0.25)
    sigma2, variances = estimate.sigma2, expected
    for _ in range(500):
        stiff = S.copy()
        stiff[q, q] += sigma2 / variances[kind]
        inverse = np.linalg.inv(stiff)
        step = -inverse @ gradient
        known = len(kind) - np.sum(np.diag(inverse)[q] * sigma2 / variances[kind])
        sigma2 = (cost + step @ gradient) / (2 * count - 9 - 6 * len(V) - known)
        squares = step[q] ** 2 + sigma2 * np.diag(inverse)[q]
        variances = (0.3 * expected + np.bincount(kind, squares)) / (0.3 + counts)
    np.testing.assert_allclose(
        np.sqrt(np.diag(error.covariance)), np.sqrt(sigma2 * np.diag(inverse)[:9]), rtol=1e-3
    )


@pytest.mark.parametrize("count", [4, 7, 40])
def test_few_corners_have_few_rough_deviations(count: int) -> None:
    """None, three and many of them: a known prior leads to the same as one matrix of all."""
    rng = np.random.default_rng(count)
    points = rng.uniform(-1, 1, (count, 2))
    kind = make_deviations(points).kind
    J = rng.normal(size=(3 * len(kind), len(kind)))
    S, right, stiffness = J.T @ J, rng.normal(size=len(kind)), np.array([3.0, 0.4, 20.0])
    inverse = np.linalg.inv(S + np.diag(stiffness[kind]))
    q = -inverse @ right
    squares, inverses, gained = solve_stiffened(tridiagonalise_rough(S, right, kind), stiffness)
    np.testing.assert_allclose(squares, np.bincount(kind, q**2, 3), rtol=1e-10)
    np.testing.assert_allclose(inverses, np.bincount(kind, np.diag(inverse), 3), rtol=1e-10)
    assert gained == pytest.approx(-right @ q, rel=1e-10)


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
    for _ in range(20):
        chosen = rng.choice(len(views), count, replace=False)
        found = calibrate([views[k] for k in sorted(chosen)], size)
        z.append(np.abs(found.camera.params[:4] - truth) / found.sigma[:4])
    assert (np.array(z) < 2.5).mean(axis=0).min() >= 0.9
    assert 0.2 < np.median(z, axis=0).min()
    assert np.median(z, axis=0).max() < 1.2


def test_a_corner_may_be_seen_from_one_side_only() -> None:
    """In four copies of one view, which leave open how far away it is."""
    first, *others = scene(barrel(), 3, seed=4).noisy(0.1, np.random.default_rng(1))
    views = [first, *(Observation(view.uv[1:], view.xy[1:]) for view in others)]
    calibration = calibrate(views * 4, barrel().size)
    assert np.isfinite(calibration.sigma).all()
