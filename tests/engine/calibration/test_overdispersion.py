"""Covariances clustered by view: the jackknife they stand for, coverage, silence under noise."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import DegenerateError
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.calibration.board_shape.test_parametrisation import (
    ACROSS,
    CAMERA,
    CENTRE,
    NOMINAL,
    SIZE,
)
from tests.engine.calibration.test_profile_likelihood import leave_profiles_out
from tests.engine.scenes import TRUE_BOARD

FLAT = np.column_stack([NOMINAL, np.zeros(len(NOMINAL))])
NOISE = 0.05
FAULTS = ["bending", "rolling", "jitter", "lens"]


def _displaced(fault: str, uv: Array, rng: np.random.Generator) -> Array:
    """(n, 2) corners with a displacement of the view's own."""
    if fault == "jitter":  # sideways from row to row, as of an analogue camera's lines
        knots = np.linspace(0, SIZE[1], 10)
        return uv + np.outer(np.interp(uv[:, 1], knots, rng.normal(0, 0.1, 10)), [1, 0])
    if fault == "lens":  # bends the image, as refraction by warm air does
        x, y = ((uv - uv.mean(axis=0)) / 200).T
        return uv + np.column_stack([x**2, x * y, y**2]) @ rng.normal(0, 0.1, (3, 2))
    return uv


def _photographed(fault: str, rng: np.random.Generator) -> Array:
    """(n, 2) one noisy view of the board, with an error of its own."""
    board_shape, R = FLAT.copy(), rotation_from_vector(rng.uniform(-0.6, 0.6, 3))
    T = rng.uniform([-60, -40, 500], [60, 40, 700])
    if fault == "bending":
        board_shape[:, 2] = (1 - ACROSS**2) @ rng.normal(0, 0.3, 2)
    p = board_shape @ R.T + T - R[:, :2] @ CENTRE
    uv = pixels_from_rays(p, CAMERA)
    if fault == "rolling":
        velocity = rng.normal(0, 0.5, 3)  # mm while the rows are read
        for _ in range(5):
            q = p + (uv[:, 1:] / SIZE[1] - 0.5) * velocity
            uv = pixels_from_rays(q, CAMERA)
    return _displaced(fault, uv, rng) + rng.normal(0, NOISE, uv.shape)


def photographed(fault: str, count: int, seed: int) -> list[Observation]:
    """Views inside the image, each with its own error."""
    rng = np.random.default_rng(seed)
    views: list[Observation] = []
    while len(views) < count:
        uv = _photographed(fault, rng)
        if ((uv > 0) & (uv < SIZE)).all():
            views.append(Observation(uv, NOMINAL))
    return views


@pytest.mark.parametrize("board_shape", ["nominal", "free"])
def test_widened_deviations_are_those_of_leaving_views_out(board_shape: str) -> None:
    views = photographed("bending", 16, 3)
    whole = calibrate(views, SIZE, board_shape=board_shape)
    assert whole.overdispersion > 1.5
    assert (whole.sigma[:9] > whole.sigma_by_noise[:9]).all()
    without = np.array(
        [
            calibrate([*views[:k], *views[k + 1 :]], SIZE, board_shape=board_shape).camera.params
            for k in range(len(views))
        ]
    )
    jackknife = np.sqrt(15 * without.var(axis=0))[:9]
    if board_shape == "nominal":  # the bends' mean is doubted as well, which only adds
        assert (whole.sigma[:9] > 0.9 * jackknife).all()
    else:  # nine tenths are left out, what noise alone makes larger is kept, and without a view the
        # variances of the board's deviations are others
        assert whole.sigma[:9] == pytest.approx(jackknife, rel=0.3)
    assert np.linalg.eigvalsh(whole.covariance[:9, :9]).min() > 0


def test_poses_and_board_shape_follow_the_camera() -> None:
    views = photographed("bending", 16, 3)
    found = calibrate(views, SIZE, board_shape="free")
    sound = calibrate(photographed("none", 16, 3), SIZE, board_shape="free")
    assert sound.overdispersion == 0
    np.testing.assert_array_equal(sound.sigma, sound.sigma_by_noise)
    # T_z goes with the focal length: its relative deviation cannot be much smaller.
    deviation = np.sqrt(found.pose_covariances[:, 5, 5]) / [pose.tvec[2] for pose in found.poses]
    assert (deviation > 0.5 * found.sigma[0] / found.camera.params[0]).all()
    assert found.board_shape is not None and sound.board_shape is not None
    assert (
        found.board_shape.sigma.max() > found.board_shape.sigma.min()
    ) and found.board_shape.sigma.min() > 0


@pytest.mark.parametrize("count", [4, 5])
def test_what_one_view_alone_determines_is_no_disagreement(count: int) -> None:
    """Of three views two show so few corners that only the other one determines the lens."""
    few = [0, 5, 42, 47, 20][:count]
    for seed in range(8):
        whole, *others = photographed("none", 3, seed)
        parts = [Observation(view.uv[few], view.xy[few]) for view in others]
        found = calibrate([whole, *parts], SIZE, prior=TRUE_BOARD)
        assert found.overdispersion == 0
        assert np.isfinite(found.covariance).all()


def test_two_views_are_taken_to_disagree_without_a_test(monkeypatch: pytest.MonkeyPatch) -> None:
    leave_profiles_out(monkeypatch)
    found = calibrate(photographed("bending", 2, 3), SIZE, prior=TRUE_BOARD)
    assert found.overdispersion == 0
    np.testing.assert_allclose(found.sigma[:9], 2 * found.sigma_by_noise[:9], rtol=0.01)


def test_disagreement_that_three_views_do_not_prove_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    leave_profiles_out(monkeypatch)
    widened = []
    for seed in range(12):
        found = calibrate(photographed(FAULTS[seed % 4], 3, seed), SIZE, prior=TRUE_BOARD)
        if found.overdispersion == 0:
            widened.append(found.sigma[:9] / found.sigma_by_noise[:9])
    assert len(widened) >= 3 and np.min(widened) > 0.99
    assert np.median(np.max(widened, axis=1)) > 1.2


@pytest.mark.slow
def test_two_views_of_a_bending_board_hold_the_truth() -> None:
    inside = []
    for seed in range(36):
        try:
            found = calibrate(photographed("bending", 2, seed), SIZE)
        except DegenerateError:  # named instead
            continue
        error = np.abs(found.camera.params - CAMERA.params)[:9]
        inside.append(error < 2.5 * found.sigma[:9])
    assert len(inside) >= 24
    assert np.mean(inside) >= 0.9


@pytest.mark.slow
@pytest.mark.parametrize(("board_shape", "count"), [("nominal", 25), ("free", 10)])
def test_errors_that_hang_together_are_covered(board_shape: str, count: int) -> None:
    inside, by_noise = [], []
    for seed in range(48):
        found = calibrate(
            photographed(FAULTS[seed % 4], count, seed), SIZE, board_shape=board_shape
        )
        error = np.abs(found.camera.params - CAMERA.params)[:9]
        inside.append(error < 2 * found.sigma[:9])
        by_noise.append(error < 2 * found.sigma_by_noise[:9])
    assert np.mean(inside) >= 0.9
    assert np.mean(by_noise) < 0.85


@pytest.mark.slow
def test_noise_alone_is_rarely_widened() -> None:
    """The board shape is free; ``test_honesty.py`` tests the nominal one for every lens model."""
    z, widened = [], 0
    for seed in range(60):
        found = calibrate(photographed("none", 10, seed), SIZE, board_shape="free")
        z.append((found.camera.params - CAMERA.params)[:9] / found.sigma[:9])
        widened += found.overdispersion > 0
    assert widened <= 9  # 5 % expected; 16 % is four deviations of the binomial away
    assert np.sqrt(np.mean(np.square(z))) == pytest.approx(1.0, abs=0.12)
