"""What single views say of the camera, against the solver's own covariances."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.problem import find_free_parameters
from calibgui.engine.calibration.result import Cost
from calibgui.engine.geometry import rotations
from calibgui.engine.uncertainty.fisher_information import compute_information
from tests.engine.scenes import TRUE_BOARD, barrel, relative, scene


@pytest.mark.parametrize("cost", [Cost.IMAGE, Cost.REFERENCE])
def test_the_views_add_up_to_the_covariance(cost: Cost) -> None:
    views = scene(barrel(), 6).noisy(0.2, np.random.default_rng(1))
    result = calibrate(views, barrel().size, cost=cost, prior=TRUE_BOARD)
    free = find_free_parameters(result)
    S = compute_information(result, views).camera.sum(axis=0)
    expected = result.noise_covariance[np.ix_(free, free)]
    unit = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert relative(result.noise**2 * np.linalg.inv(S) / unit, expected / unit) < 1e-6


@pytest.mark.parametrize("claimed", [0.05, 0.2, 0.5])  # of 0.2 px: a floor, none, and too much
def test_weights_are_those_of_the_calibration(claimed: float) -> None:
    rng = np.random.default_rng(1)
    views = [
        view._replace(
            cov=claimed**2 * rng.uniform(0.5, 2.0, len(view.uv))[:, None, None] * np.eye(2)
        )
        for view in scene(barrel(), 6).noisy(0.2, rng)
    ]
    result = calibrate(views, barrel().size, prior=TRUE_BOARD)
    free = find_free_parameters(result)
    S = compute_information(result, views).camera.sum(axis=0)
    expected = result.noise_covariance[np.ix_(free, free)]
    unit = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert relative(result.noise**2 * np.linalg.inv(S) / unit, expected / unit) < 5e-3


def test_motions_of_the_views_have_the_poses_covariances() -> None:
    views = scene(barrel(), 6).noisy(0.2, np.random.default_rng(1))
    result = calibrate(views, barrel().size, prior=TRUE_BOARD)
    free = find_free_parameters(result)
    says = compute_information(result, views)
    C = result.covariance[np.ix_(free, free)]
    motion = (
        says.motion_by_camera @ C @ np.swapaxes(says.motion_by_camera, 1, 2)
        + result.noise**2 * says.pose_covariance
    )
    for pose, expected, found in zip(result.poses, result.pose_covariances, motion, strict=True):
        J = np.zeros((6, 6))  # of (rvec, tvec) by the motion: tau = t - T x w
        J[:3, :3] = rotations.compute_inverse_left_jacobian(pose.rvec)
        J[3:, :3] = -rotations.make_cross_matrix(pose.tvec)
        J[3:, 3:] = np.eye(3)
        assert relative(J @ found @ J.T, expected) < 1e-6


def test_some_of_the_views() -> None:
    views = scene(barrel(), 5).noisy(0.2, np.random.default_rng(1))
    result = calibrate(views, barrel().size, prior=TRUE_BOARD)
    all_of_them = compute_information(result, views)
    some = all_of_them.chosen(np.array([3, 1]))
    assert np.array_equal(some.camera, all_of_them.camera[[3, 1]])
    assert np.array_equal(some.pose_covariance[1], all_of_them.pose_covariance[1])
