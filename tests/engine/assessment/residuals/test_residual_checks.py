"""Whether residuals look like noise: no alarms on noise, and every usual fault by its name."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.residuals import residual_checks
from calibgui.engine.assessment.residuals.residual_checks import NoiseReport, check_residuals
from calibgui.engine.assessment.residuals.systematic_errors import prepare_fit
from calibgui.engine.assessment.residuals.view_weights import calibrate_weighted
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import Cancelled
from calibgui.engine.geometry import rotations
from calibgui.engine.geometry.pose import Pose
from tests.engine.scenes import BOARD, barrel, scene

SIZE = barrel().size
XY = BOARD.points()
SCENE = scene(barrel(), 12, seed=1)
Z = np.zeros((len(XY), 1))
BOW = 1 - ((XY[:, :1] - XY[:, 0].mean()) / (np.ptp(XY[:, 0]) / 2)) ** 2

X, Y = (2 * (XY - XY.mean(axis=0)) / np.ptp(XY, axis=0)).T
CUBICS = np.stack([X**3, X**2 * Y, X * Y**2, Y**3], axis=1)


def _solid(pose: Pose, grid_size: Array) -> Array:
    """(n, 2) the image of a board's corners (n, 3)."""
    p = grid_size @ rotations.rotation_from_vector(pose.rvec).T + pose.tvec
    return pixels_from_rays(p, SCENE.camera)


def _rolling(pose: Pose, velocity: Array, spin: Array) -> Array:
    """(n, 2) the image while the board moves by `velocity`, mm from the first row to the last, and
    turns about its middle by `spin`."""
    uv = _solid(pose, np.hstack([XY, Z]))
    p = np.hstack([XY, Z]) @ rotations.rotation_from_vector(pose.rvec).T + pose.tvec
    motion = velocity + np.cross(spin, p - p.mean(axis=0))
    for _ in range(5):
        q = p + (uv[:, 1:] / SIZE[1] - 0.5) * motion
        uv = pixels_from_rays(q, SCENE.camera)
    return uv


def _images(fault: str, rng: np.random.Generator) -> list[Array]:
    poses = SCENE.poses
    bent: dict[str, Callable[[Pose], Array]] = {
        "none": lambda pose: _solid(pose, np.hstack([XY, Z])),
        "squares": lambda pose: _solid(pose, np.hstack([XY * [1.003, 1.0], Z])),
        "bow": lambda pose: _solid(pose, np.hstack([XY, 0.5 * BOW])),
        "rows": lambda pose: _rolling(pose, *rng.normal(scale=[[0.5], [0.002]], size=(2, 3))),
        "bending": lambda pose: _solid(pose, np.hstack([XY, rng.normal() * BOW])),
        "smooth": lambda pose: _solid(pose, np.hstack([XY, CUBICS @ rng.normal(size=(4, 1))])),
        "focus": lambda pose: (
            SCENE.camera.centre
            + (_solid(pose, np.hstack([XY, Z])) - SCENE.camera.centre) * rng.normal(1, 0.005)
        ),
        "centre": lambda pose: _solid(pose, np.hstack([XY, Z])) + rng.normal(scale=8.0, size=2),
    }
    if fault == "board":
        true = np.hstack([XY, Z]) + rng.normal(scale=0.1, size=(len(XY), 3))
        return [_solid(pose, true) for pose in poses]
    if fault == "views":
        exact = [bent["none"](pose) for pose in poses]
        blurred = [uv + rng.normal(scale=0.6, size=(len(uv), 1)) * [0.8, 0.3] for uv in exact[:3]]
        return blurred + exact[3:]
    if fault == "lines":
        rows = np.linspace(0, SIZE[1], 12)
        images = [bent["none"](pose) for pose in poses]
        shifts = [np.interp(uv[:, 1], rows, rng.normal(scale=0.2, size=12)) for uv in images]
        return [uv + np.outer(shift, [1, 0]) for uv, shift in zip(images, shifts, strict=True)]
    return [bent[fault if fault in bent else "none"](pose) for pose in poses]


def list_failed(report: NoiseReport) -> list[str]:
    return [check.name for check in report.checks if not check.passed]


def get_advice(report: NoiseReport, name: str) -> str:
    """What a failed test of that name advises."""
    (failed,) = (check for check in report.checks if check.name == name and not check.passed)
    return failed.advice


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    "fault",
    [
        "squares", "bow", "lens", "focus", "centre", "bending", "rows", "lines", "smooth",
        "board", "views",
    ],
)  # fmt: skip
def test_a_fault_is_named(fault: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    views = [
        Observation(uv + rng.normal(scale=0.1, size=uv.shape), XY) for uv in _images(fault, rng)
    ]
    held = ["k2", "k3"] if fault == "lens" else []
    report = check_residuals(calibrate(views, SIZE, fix=held), views)
    assert fault in list_failed(report)


def test_a_decentred_lens_is_no_moving_board() -> None:
    """Its displacement is quadratic in every view, as is a rolling shutter's."""
    lens = replace(barrel(), params=[*barrel().params[:7], 4e-3, -3e-3, 0.0])
    views = scene(lens, 12, seed=1).noisy(0.1, np.random.default_rng(0))
    report = check_residuals(calibrate(views, SIZE, fix=["p1", "p2"]), views)
    likeliest = min(report.checks, key=lambda check: check.criterion)
    assert likeliest.name == "lens" and not likeliest.passed


def test_a_lens_that_is_not_followed_is_no_bent_board() -> None:
    """The board keeps to the middle, so that a free shape explains nearly as much as the lens."""
    views = scene(barrel(), 12, seed=1).noisy(0.1, np.random.default_rng(0))
    result = calibrate(views, SIZE, model="pinhole")
    report = check_residuals(result, views)
    share = {check.name: check.share for check in report.checks}
    assert share["lens"] > 0.9
    assert share["squares"] + share["bow"] + share["board"] < 0.05
    # Judged as if the lens were sound, the board explains more than half.
    report = check_residuals(replace(result, lens_error=0.0), views)
    assert next(check.share for check in report.checks if check.name == "board") > 0.5


def test_outliers_and_rounding_are_told_apart() -> None:
    rng = np.random.default_rng(0)
    rounded = [Observation(np.round(2 * view.uv) / 2, view.xy) for view in SCENE.views]
    report = check_residuals(calibrate(rounded, SIZE), rounded)
    assert "rounded" in get_advice(report, "shape")
    for spoilt in (12, 3):  # views: a few with misplaced corners are not blurred
        displaced = SCENE.noisy(0.1, rng)
        for k, view in enumerate(displaced[:spoilt]):
            uv = np.array(view.uv)
            uv[rng.integers(len(uv))] += 3.0
            displaced[k] = view._replace(uv=uv)
        report = check_residuals(calibrate(displaced, SIZE), displaced)
        assert "misplaced" in get_advice(report, "shape")


def test_corners_that_are_far_off_but_as_uncertain_are_counted() -> None:
    rng = np.random.default_rng(4)
    views = []
    for k, view in enumerate(SCENE.views):
        sigma = np.full(len(view.uv), 0.02)
        sigma[:2] = 2.0 if k < 3 else 0.02
        error = rng.normal(size=view.uv.shape)
        error[:2] /= np.linalg.norm(error[:2], axis=1, keepdims=True)
        cov = sigma[:, None, None] ** 2 * np.eye(2)
        views.append(Observation(view.uv + sigma[:, None] * error, view.xy, cov))
    report = check_residuals(calibrate(views, SIZE), views)
    assert report.passed
    assert (report.far_corners, report.far_views) == (6, 3)
    misplaced = [Observation(view.uv, view.xy) for view in views]
    report = check_residuals(calibrate(misplaced, SIZE), misplaced)
    assert report.far_corners == 0
    assert not report.passed


def test_blurred_views_are_listed_and_weigh_less() -> None:
    rng = np.random.default_rng(3)
    exact = scene(barrel(), 12, seed=1)
    noise = np.where(np.arange(12) < 4, 1.0, 0.1)
    views = [
        Observation(view.uv + rng.normal(scale=s, size=view.uv.shape), view.xy)
        for view, s in zip(exact.views, noise, strict=True)
    ]
    plain = calibrate(views, SIZE)
    report = check_residuals(plain, views)
    found = next(check for check in report.checks if check.name == "views")
    assert not found.passed
    listed = found.finding.split("most in ")[1].split(", ")
    assert sorted(listed) == ["View 1", "View 2", "View 3", "View 4"]
    result, used = calibrate_weighted(views, SIZE)
    assert result.noise == pytest.approx(0.1, rel=0.05)  # of the median corner, px
    assert check_residuals(result, used).passed
    assert (result.sigma[:4] < 0.5 * plain.sigma[:4]).all()
    fit = prepare_fit(plain, views)
    sigma = residual_checks.estimate_view_sigma(fit.linearise(slice(0, 12)).residual, fit)
    assert sigma == pytest.approx(noise, rel=0.35)


def test_what_does_no_harm_is_no_fault() -> None:
    """Views that differ a little, and tails a little heavier than a Gaussian's without outliers."""
    rng = np.random.default_rng(5)
    noise = np.where(np.arange(12) % 2 == 0, 0.085, 0.115)
    differing = [
        Observation(view.uv + rng.normal(scale=s, size=view.uv.shape), view.xy)
        for view, s in zip(SCENE.views, noise, strict=True)
    ]
    tailed = []
    for view in SCENE.views:
        error = 0.1 * rng.standard_t(5, size=view.uv.shape)
        length = np.linalg.norm(error, axis=1, keepdims=True)
        tailed.append(Observation(view.uv + error * np.minimum(0.4 / length, 1), view.xy))
    for views, name in ((differing, "views"), (tailed, "shape")):
        result = calibrate(views, SIZE)
        report = check_residuals(result, views)
        assert report.passed
        with pytest.MonkeyPatch.context() as patch:
            # It is seen all the same, and fails where it does harm.
            patch.setattr(residual_checks, "_MIN_GAIN_OF_WEIGHING", 1.0)
            patch.setattr(residual_checks, "_MAX_LENGTH_IN_SIGMA", 2.0)
            report = check_residuals(result, views)
            assert name in [check.name for check in report.checks if not check.passed]


def test_covariances_count_in_the_weights() -> None:
    rng = np.random.default_rng(3)
    far = np.arange(len(XY)) % 3 == 0
    cov = np.where(far, 0.5, 0.05)[:, None, None] ** 2 * np.eye(2)
    views = [
        Observation(
            view.uv + rng.normal(size=view.uv.shape) * np.where(far, 0.5, 0.05)[:, None], XY, cov
        )
        for view in SCENE.views
    ]
    result = calibrate(views, SIZE)
    assert check_residuals(result, views).passed
    _, used = calibrate_weighted(views, SIZE)
    assert used[0].cov is not None
    assert used[0].cov[0, 0, 0] / used[0].cov[1, 0, 0] == pytest.approx(100, rel=0.1)


@pytest.mark.slow
def test_the_level_is_the_one_stated(monkeypatch: pytest.MonkeyPatch) -> None:
    """At one in twenty, where it can be counted: no check alarms more often than that."""
    monkeypatch.setattr(residual_checks, "_MAX_FALSE_ALARM_RATE", 0.05)
    alarms: Counter[str] = Counter()
    for seed in range(30):
        true = scene(barrel(), (4, 8, 16)[seed % 3], seed)
        views = true.noisy(0.2, np.random.default_rng(seed))
        report = check_residuals(calibrate(views, SIZE), views)
        alarms.update(check.name for check in report.checks if not check.passed)
    # 1.5 are expected; more than 7 have a chance of 2e-3 in any of eleven checks.
    assert max(alarms.values()) <= 7


def test_it_can_be_abandoned() -> None:
    calls = []

    def twice(done: int, total: int) -> None:
        calls.append((done, total))
        if done == 1:
            raise Cancelled

    with pytest.raises(Cancelled):
        check_residuals(calibrate(SCENE.views, SIZE), SCENE.views, progress=twice)
    assert calls == [(0, 10), (1, 10)]
