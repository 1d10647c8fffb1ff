"""Covariances against dense linear algebra, and what counts as undetermined."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.refinement import covariances
from calibgui.engine.calibration.refinement.schur import (
    NormalEquations,
    Reduced,
    eliminate_poses,
)
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.geometry import rotations
from tests.engine.calibration.refinement.test_schur import make_falling_apart
from tests.engine.scenes import TRUE_BOARD, barrel, central_differences, imaged, relative, scene

MADE = scene(barrel(0.9), 6, seed=4)
VIEWS = MADE.noisy(0.2, np.random.default_rng(0))


@pytest.fixture(scope="module")
def calibration() -> Calibration:
    return calibrate(VIEWS, MADE.size, prior=TRUE_BOARD)


def test_covariances_are_those_of_all_unknowns_together(calibration: Calibration) -> None:
    """sigma^2 (J^T J)^-1 with J by differences in rvec, tvec and the parameters themselves."""
    camera, free = calibration.camera, np.arange(9)
    packed = np.concatenate(
        [camera.params[free], *[np.concatenate([p.rvec, p.tvec]) for p in calibration.poses]]
    )

    def predicted(z: Array) -> Array:
        params = np.append(z[:9], 0.0)
        at = type(camera)(camera.size, params)
        poses = z[9:].reshape(-1, 6)
        return np.concatenate(
            [
                imaged(at, type(calibration.poses[0])(p[:3], p[3:]), view.xy).ravel()
                for p, view in zip(poses, VIEWS, strict=True)
            ]
        )

    step = np.concatenate([np.full(4, 0.2), np.full(5, 3e-4), np.tile([3e-4] * 3 + [0.2] * 3, 6)])
    J = central_differences(predicted, packed, step)
    scale = np.linalg.norm(J, axis=0)
    inverse = np.linalg.inv((J / scale).T @ (J / scale)) / np.outer(scale, scale)
    r = predicted(packed) - np.concatenate([np.asarray(view.uv).ravel() for view in VIEWS])
    sigma2 = r @ r / (len(r) - len(packed))
    assert calibration.noise == pytest.approx(np.sqrt(sigma2), rel=1e-9)
    # The dense inverse loses 1e-12 times a condition number of about 1e6.
    assert relative(calibration.covariance[:9, :9], sigma2 * inverse[:9, :9]) < 1e-5
    for k in range(6):
        at = slice(9 + 6 * k, 15 + 6 * k)
        assert relative(calibration.pose_covariances[k], sigma2 * inverse[at, at]) < 1e-5
    np.testing.assert_allclose(calibration.sigma**2, np.diag(calibration.covariance))
    assert calibration.sigma[9] == 0.0  # p3, held


def test_the_papers_standard_deviations(calibration: Calibration) -> None:
    """sqrt(diag((2 J^T J)^-1)) in its units: the honest ones over sqrt(2) sigma."""
    values, honest, printed = covariances.make_paper_table(calibration)
    params, sigma = calibration.camera.params, calibration.sigma
    np.testing.assert_allclose(values[[8, 9]], params[:2])
    np.testing.assert_allclose(honest[[0, 1, 8, 9]], sigma[[2, 3, 0, 1]])
    assert values[2] == pytest.approx(params[4] / params[0] ** 2)
    # k1 in px^-2 follows from k1 and fx, which are correlated.
    by = np.zeros(10)
    by[4], by[0] = params[0] ** -2, -2 * params[4] / params[0] ** 3
    assert honest[2] == pytest.approx(np.sqrt(by @ calibration.covariance @ by))
    np.testing.assert_allclose(printed * np.sqrt(2) * calibration.noise, honest)


def test_correlations() -> None:
    cov = np.array([[4.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    found = covariances.compute_correlations(cov)
    assert found[0, 1] == pytest.approx(0.5)
    np.testing.assert_allclose(np.diag(found)[:2], 1.0)
    assert np.isnan(found[2]).all()


def test_variance_needs_redundancy() -> None:
    assert covariances.estimate_variance(10.0, 10, 10) == pytest.approx(1.0)
    assert np.isnan(covariances.estimate_variance(10.0, 5, 10))


def normal(U: Array) -> NormalEquations:
    """Normal equations with the given shared block and nothing to trade."""
    K, P = 3, len(U)
    V = np.tile(np.eye(6), (K, 1, 1))
    costs = np.full(K, 20.0 / K)
    return NormalEquations(U, np.zeros((K, P, 6)), V, np.zeros(P), np.zeros((K, 6)), 20.0, costs)


def test_lost_rank_and_blank_parameters_are_named() -> None:
    U = np.diag([1.0, 2.0, 3.0, 0.0])
    U[0, 1] = U[1, 0] = np.sqrt(2.0)  # the first two only appear as a sum
    found = covariances.measure_precision(normal(U), ("a", "b", "c", "d"), 50, np.full(4, np.inf))
    reasons = {u.name: u.reason for u in found.undetermined}
    assert set(reasons) == {"a", "b", "d"}
    assert "traded" in reasons["a"]
    assert "no corner" in reasons["d"]


def test_a_deviation_beyond_the_tolerated_is_named() -> None:
    found = covariances.measure_precision(
        normal(np.diag([1.0, 0.01])), ("a", "b"), 20, np.array([5.0, 5.0])
    )
    assert found.variance == pytest.approx(1.0)
    np.testing.assert_allclose(np.diag(found.shared), [1.0, 100.0])
    assert [u.name for u in found.undetermined] == ["b"]
    assert "noise" in found.undetermined[0].reason


def test_what_poses_absorb_is_lost() -> None:
    found = normal(np.diag([1.0, 1.0]))
    W = np.zeros((3, 2, 6))
    W[:, 0, 0] = np.sqrt(1 / 3)  # S = 1 - 3 W^2 = 0 for the first
    left, _ = covariances.decompose_information(eliminate_poses(found._replace(W=W)))
    np.testing.assert_allclose(left, [0.0, 1.0], atol=1e-12)


@pytest.mark.parametrize("share", [1e-3, 1e-6, 1e-10])
def test_inverse_and_information_left_by_either_way(share: float) -> None:
    """A combination of two parameters keeps only a share of its information."""
    found = normal(np.diag([4.0, 9.0, 1.0]))
    W = np.zeros((3, 3, 6))
    W[:, :2, 0] = np.sqrt((1 - share) / 6) * np.array([2.0, 3.0])
    reduced = eliminate_poses(found._replace(W=W))
    inverse, left = covariances.invert_information(reduced)
    np.testing.assert_allclose(inverse, np.linalg.inv(reduced.S), rtol=1e-3)
    assert share / np.sqrt(3) < left < 1.01 * share


def test_pose_covariance_follows_the_rotation_vector() -> None:
    """The solver's local rotation and rvec differ by the left Jacobian's inverse."""
    rvecs = np.array([[0.5, -0.3, 0.2], [0.0, 0.0, 0.0], [2.0, 1.0, 0.5]])
    local = covariances.compute_pose_covariances(
        eliminate_poses(normal(np.eye(2))), np.eye(2), 0.01
    )
    found = covariances.convert_pose_covariances(local, rvecs)
    for k in range(3):
        J = rotations.compute_inverse_left_jacobian(rvecs[k])
        np.testing.assert_allclose(found[k, :3, :3], 0.01 * J @ J.T, atol=1e-14)
        np.testing.assert_allclose(found[k, 3:, 3:], 0.01 * np.eye(3))


def test_the_inverse_of_what_falls_apart() -> None:
    """Parameters in pairs are inverted by themselves; the information left is theirs as well."""
    S = make_falling_apart(np.random.default_rng(5))
    for pair in ([[3.0, 1.0], [1.0, 2.0]], [[1.0, 1 - 1e-7], [1 - 1e-7, 1.0]]):
        S[110:112, 110:112] = pair
        unit = 1 / np.sqrt(np.diag(S))
        reduced = Reduced(S, np.zeros((1, 130, 6)), np.eye(6)[None], unit)
        inverse, left = covariances.invert_information(reduced)
        np.testing.assert_allclose(inverse, np.linalg.inv(S), rtol=1e-7, atol=1e-12)
        least = np.linalg.eigvalsh(S * np.outer(unit, unit))[0]
        assert least / (2 * np.sqrt(130)) < left < 1.01 * least


def test_poses_hardly_depend_on_what_no_corner_touches() -> None:
    """Leaving out rows of 0 changes nothing."""
    rng = np.random.default_rng(6)
    W, root = rng.normal(size=(4, 8, 6)), rng.normal(size=(8, 8))
    W[:, [1, 4, 5]] = 0.0
    found = normal(np.eye(8))._replace(W=W, V=np.tile(100 * np.eye(6), (4, 1, 1)))
    shared = root @ root.T
    local = covariances.compute_pose_covariances(eliminate_poses(found), shared, 0.01)
    for k in range(4):
        expected = 0.01 * np.eye(6) / 100 + W[k].T @ shared @ W[k] / 100**2
        np.testing.assert_allclose(local[k], expected, atol=1e-12)
