"""Reported standard deviations against the scatter of 200 calibrations of noisy corners."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation
from tests.engine.scenes import TRUE_BOARD, barrel, brown, scene

pytestmark = pytest.mark.slow

DRAWS = 200
NOISE = 0.1


def drawn(model: str) -> tuple[Array, Array, Array, Array, Array]:
    """Errors and reported sigmas of the intrinsics (D, P) and the poses (D, K, 6); sigma (D,)."""
    made = scene(brown(0.9) if model == "brown-conrady" else barrel(0.9), 10, seed=6)
    errors, sigmas, pose_errors, pose_sigmas, noises = [], [], [], [], []
    for seed in range(DRAWS):
        views = made.noisy(NOISE, np.random.default_rng(seed))
        found = calibrate(views, made.size, model=model, prior=TRUE_BOARD)
        errors.append(found.camera.params - made.camera.params)
        sigmas.append(found.sigma)
        pose_errors.append(
            [
                np.concatenate([p.rvec - t.rvec, p.tvec - t.tvec])
                for p, t in zip(found.poses, made.poses, strict=True)
            ]
        )
        pose_sigmas.append(np.sqrt(np.diagonal(found.pose_covariances, axis1=1, axis2=2)))
        noises.append(found.noise)
    return (
        np.array(errors),
        np.array(sigmas),
        np.array(pose_errors),
        np.array(pose_sigmas),
        np.array(noises),
    )


# A standard deviation of 200 draws is itself known to 1 / sqrt(400) = 5 %: 15 % is three times
# that. A mean of 200 draws is known to 0.07 standard deviations: 0.25 is three and a half times.
@pytest.mark.parametrize("model", ["lucchese", "brown-conrady"])
def test_reported_deviations_are_the_scatter(model: str) -> None:
    errors, sigmas, pose_errors, pose_sigmas, noises = drawn(model)
    free = sigmas[0] > 0
    scatter = errors[:, free].std(axis=0, ddof=1)
    ratio = scatter / sigmas[:, free].mean(axis=0)
    assert ratio == pytest.approx(np.ones(free.sum()), abs=0.15)
    assert (np.abs(errors[:, free].mean(axis=0)) < 0.25 * scatter).all()

    pose_scatter = pose_errors.std(axis=0, ddof=1)
    # Of 60 numbers the worst is expected near three of its own deviations.
    assert pose_scatter / pose_sigmas.mean(axis=0) == pytest.approx(np.ones((10, 6)), abs=0.2)
    assert (np.abs(pose_errors.mean(axis=0)) < 0.3 * pose_scatter).all()

    assert noises.mean() == pytest.approx(NOISE, rel=0.01)
    covered = np.abs(errors[:, free]) < 1.96 * sigmas[:, free]
    assert covered.mean() == pytest.approx(0.95, abs=0.02)


def test_correlated_parameters_move_together() -> None:
    """The whole covariance: squared Mahalanobis lengths of the errors have the mean P."""
    made = scene(barrel(0.9), 10, seed=6)
    lengths = []
    for seed in range(DRAWS):
        found = calibrate(
            made.noisy(NOISE, np.random.default_rng(seed)), made.size, prior=TRUE_BOARD
        )
        error = (found.camera.params - made.camera.params)[:9]
        lengths.append(error @ np.linalg.solve(found.covariance[:9, :9], error))
    # chi^2 with 9 degrees of freedom: its mean over 200 draws is known to 0.3.
    assert np.mean(lengths) == pytest.approx(9.0, abs=1.0)


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
    # 100 draws: 7 % each.
    assert ratio == pytest.approx(np.ones((10, 3)), abs=0.3)
