"""Reported covariances against the errors of calibrations of noisy corners."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation
from tests.engine.honesty import check_honest
from tests.engine.scenes import TRUE_BOARD, barrel, brown, scene

pytestmark = pytest.mark.slow

DRAWS = 80
NOISE = 0.1


@pytest.mark.parametrize("model", ["lucchese", "brown-conrady"])
def test_reported_covariances_are_those_of_the_errors(model: str) -> None:
    made = scene(brown(0.9) if model == "brown-conrady" else barrel(0.9), 10, seed=6)
    rng = np.random.default_rng(0)
    results = [
        calibrate(made.noisy(NOISE, rng), made.size, model=model, prior=TRUE_BOARD)
        for _ in range(DRAWS)
    ]
    free = results[0].sigma > 0
    errors = np.array([found.camera.params - made.camera.params for found in results])[:, free]
    check_honest(errors, np.array([found.covariance[np.ix_(free, free)] for found in results]))
    # A mean of 80 draws is known to 0.11 standard deviations.
    assert (np.abs(errors.mean(axis=0)) < 0.4 * errors.std(axis=0)).all()
    for k, true in enumerate(made.poses):
        poses = [found.poses[k] for found in results]
        moved = [np.r_[pose.rvec - true.rvec, pose.tvec - true.tvec] for pose in poses]
        check_honest(np.array(moved), np.array([found.pose_covariances[k] for found in results]))
    assert np.mean([found.noise for found in results]) == pytest.approx(NOISE, rel=0.01)


def test_rotation_vectors_scatter_as_reported_beyond_small_angles() -> None:
    """A board numbered with Y up is seen at nearly a half turn, where rvec is not the local w."""
    made = scene(barrel(), 10, seed=6)
    up = np.diag([1.0, -1.0, -1.0])
    truth = np.array([vector_from_rotation(rotation_from_vector(p.rvec) @ up) for p in made.poses])
    errors, sigmas = [], []
    for seed in range(DRAWS // 2):
        views = made.noisy(NOISE, np.random.default_rng(seed))
        found = calibrate([(v.uv, v.xy * [1, -1]) for v in views], made.size, prior=TRUE_BOARD)
        rvecs = np.array([p.rvec for p in found.poses])
        # Of the two vectors of a rotation take the one next to the truth's.
        angle = np.linalg.norm(rvecs, axis=1, keepdims=True)
        other = rvecs * (1 - 2 * np.pi / angle)
        nearer = np.linalg.norm(rvecs - truth, axis=1) < np.linalg.norm(other - truth, axis=1)
        errors.append(np.where(nearer[:, None], rvecs, other) - truth)
        sigmas.append(np.sqrt(np.diagonal(found.pose_covariances, axis1=1, axis2=2))[:, :3])
    ratio = np.std(errors, axis=0, ddof=1) / np.mean(sigmas, axis=0)
    # 40 draws: 11 % each.
    assert ratio == pytest.approx(np.ones((10, 3)), abs=0.4)
