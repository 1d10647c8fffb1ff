"""Distortion from straight lines alone, against lenses whose correction is known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods.plumb_line import (
    LINE_METHODS,
    LineMethod,
    PlumbLine,
    compare_with_camera,
    measure_straightness,
)
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import VGA, scene, seen, stored

DEVERNAY = LINE_METHODS["devernay-faugeras"]
STEIN = LINE_METHODS["stein"]
U, V = np.linspace(0, 639, 17), np.linspace(0, 479, 13)


def lens(k1: float, k2: float = 0.0, aspect: float = 1.0) -> Camera:
    """A radial lens whose pixels are `aspect` times as wide as high."""
    return Camera(VGA, [650.0 / aspect, 650.0, 305.0, 250.0, k1, k2, 0.0, 0.0, 0.0, 0.0])


def truth(camera: Camera, names: Sequence[str]) -> Array:
    """cx, cy, k1, k2, and the aspect, in px: the radius is measured in units of fy."""
    fx, fy, cx, cy, k1, k2 = camera.params[:6]
    values = {"cx": cx, "cy": cy, "k1": k1 / fy**2, "k2": k2 / fy**4, "aspect": fx / fy}
    return np.array([values[name] for name in names])


def values(found: PlumbLine) -> Array:
    """What was found, in the order of its names."""
    parts = {"cx": found.centre[0], "cy": found.centre[1], "k1": found.k[0], "aspect": found.aspect}
    return np.array([parts[name] if name in parts else found.k[1] for name in found.names])


def test_every_method_is_described() -> None:
    for name, method in LINE_METHODS.items():
        assert method.name == name
        assert method.title
        assert method.limits.endswith(".")
        assert method.source


@pytest.mark.parametrize(
    ("method", "camera"),
    [
        (DEVERNAY, lens(0.25)),
        (DEVERNAY, lens(-0.2)),
        (DEVERNAY, lens(0.25, aspect=0.9)),
        (STEIN, lens(0.25, 0.15)),
        (STEIN, lens(-0.2, 0.1)),
    ],
)
def test_the_methods_own_lens_is_recovered(method: LineMethod, camera: Camera) -> None:

    views = scene(camera, 3, seed=5).views
    found = method.estimate(views, VGA)
    np.testing.assert_allclose(values(found), truth(camera, found.names), rtol=1e-6)
    assert found.converged
    assert found.remarks == ()
    assert found.estimated == found.names
    assert found.straightness_before > 0.1
    assert found.straightness_after < 1e-9
    assert found.lines == 3 * 21
    assert found.points == 3 * 2 * 108
    np.testing.assert_allclose(compare_with_camera(found, camera, U, V), 0, atol=1e-6)


def test_boards_that_the_image_cuts_serve_as_well() -> None:
    camera = lens(0.25)
    poses = [
        replace(pose, tvec=np.asarray(pose.tvec) * [1.0, 1.0, 0.6])
        for pose in scene(camera, 4, seed=5).poses
    ]
    cut = seen(camera, poses, partial=True)
    assert min(len(view.uv) for view in cut.views) < 108
    found = DEVERNAY.estimate(cut.views, VGA)
    np.testing.assert_allclose(values(found), truth(camera, found.names), rtol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("method", "camera"), [(DEVERNAY, lens(0.25, aspect=0.95)), (STEIN, lens(0.25, 0.15))]
)
def test_sigma_is_the_scatter_and_the_mean_the_truth(method: LineMethod, camera: Camera) -> None:
    """At 0.5 px a sum of squares in the corrected image would shift k by 0.6 sigma."""
    views = scene(camera, 2, seed=3)
    rng = np.random.default_rng(0)
    found = [method.estimate(views.noisy(0.5, rng), VGA) for _ in range(200)]
    drawn = np.array([values(each) for each in found])
    scatter = drawn.std(axis=0, ddof=1)
    ratio = np.sqrt(np.mean([each.sigma**2 for each in found], axis=0)) / scatter
    assert ((ratio > 0.85) & (ratio < 1.15)).all(), ratio
    shift = (drawn.mean(axis=0) - truth(camera, found[0].names)) / scatter
    assert (np.abs(shift) < 0.35).all(), shift
    assert np.mean([each.noise for each in found]) == pytest.approx(0.5, rel=0.02)


@pytest.mark.parametrize("noise", [0.0, 0.1])
@pytest.mark.parametrize("name", LINE_METHODS)
def test_a_lens_without_distortion_has_no_centre(name: str, noise: float) -> None:
    views = scene(lens(0.0), 4, seed=2).noisy(noise, np.random.default_rng(3))
    found = LINE_METHODS[name].estimate(views, VGA)
    assert "show no distortion" in found.remarks[0]
    np.testing.assert_array_equal(found.centre, [319.5, 239.5])
    assert found.aspect == 1.0
    assert found.estimated == tuple(n for n in found.names if n.startswith("k"))
    assert np.isnan(found.sigma[:2]).all()
    assert found.straightness_after == pytest.approx(found.straightness_before, rel=0.05, abs=1e-9)


def test_a_centre_that_weak_distortion_leaves_open_is_held() -> None:
    views = scene(lens(0.01), 1, seed=2).noisy(0.1, np.random.default_rng(1))
    found = STEIN.estimate(views, VGA)
    assert "leave the centre of distortion open by ± 1" in found.remarks[0]
    assert found.estimated == ("k1", "k2")
    np.testing.assert_array_equal(found.centre, [319.5, 239.5])
    miss = (values(found) - truth(lens(0.01), found.names)) / found.sigma
    assert (np.abs(miss[2:]) < 3).all()


def test_too_few_lines_are_refused() -> None:
    xy = np.array([[x, y] for y in (0.0, 30.0) for x in (0.0, 30.0, 60.0, 90.0, 120.0)])
    with pytest.raises(CalibrationError, match=r"2 rows and columns .* too few") as caught:
        DEVERNAY.estimate([Observation(xy + 100.0, xy)], VGA)
    assert "at least 5" in caught.value.hint


def test_held_out_views_are_as_straight_as_the_lens_model_allows() -> None:
    views = scene(lens(0.25, 0.15), 8, seed=6).noisy(0.1, np.random.default_rng(5))
    found = STEIN.estimate(views[:4], VGA)
    assert measure_straightness(views[:4], found) == pytest.approx(found.straightness_after)
    unseen = measure_straightness(views[4:], found)
    # Two parameters of each line of 12 or 9 points are fitted: (1 - 42 / 216) of the variance.
    assert unseen == pytest.approx(0.1 * np.sqrt(1 - 42 / 216), rel=0.05)
    uncorrected = replace(found, k=np.zeros(2))
    plain = measure_straightness(views[:4], uncorrected)
    assert plain == pytest.approx(found.straightness_before)
    assert plain > 5 * unseen


def make_plumb_line(k1: float) -> PlumbLine:
    """A correction about the middle of the image."""
    views = scene(lens(0.25), 2, seed=5).views
    return replace(DEVERNAY.estimate(views, VGA), centre=[319.5, 239.5], k=[k1], aspect=1.0)


def test_correction_ends_at_its_fold() -> None:
    """Of r (1 - c r^2) the slope is 0 at r^2 = 1 / (3 c)."""
    correction = make_plumb_line(-1 / (3 * 200.0**2))
    uv = np.array([[320.5, 239.5], [319.5 + 199.9, 239.5], [319.5, 239.5 - 200.1]])
    n = correction.correct_points(uv)
    np.testing.assert_allclose(n[0], [320.5, 239.5], atol=1e-4)
    assert np.isfinite(n[1]).all()
    assert np.isnan(n[2]).all()
    with pytest.raises(CalibrationError, match="does not reach all corners"):
        measure_straightness(scene(lens(0.0), 2).views, correction)
    beyond = np.isnan(compare_with_camera(correction, lens(0.0), U, V)).any(axis=-1)
    radius = np.hypot(U - 319.5, V[:, None] - 239.5)
    np.testing.assert_array_equal(beyond, radius >= 200)


def test_comparison_is_undefined_where_the_camera_has_no_correction() -> None:
    wide = Camera(VGA, [180.0, 180.0, 319.5, 239.5, 0, 0, 0, 0], "kannala-brandt")
    vector = compare_with_camera(make_plumb_line(0.0), wide, U, V)
    radius = np.hypot(U - 319.5, V[:, None] - 239.5)
    np.testing.assert_array_equal(np.isnan(vector[..., 0]), radius >= 180 * np.pi / 2)


def test_comparison_leaves_what_no_homography_takes_up() -> None:
    """Little distortion less its part along the eight derivatives of a homography at identity."""
    k1 = 1e-4
    camera = Camera(VGA, [650.0, 650.0, 319.5, 239.5, k1, 0, 0, 0, 0, 0])
    vector = compare_with_camera(make_plumb_line(0.0), camera, U, V)
    x, y = (np.stack(np.meshgrid(U - 319.5, V - 239.5), axis=-1).reshape(-1, 2) / 650.0).T
    zero, one = np.zeros_like(x), np.ones_like(x)
    columns = [
        [[x, zero], [y, zero], [one, zero], [zero, x], [zero, y], [zero, one]],
        [[x * x, x * y], [x * y, y * y]],
    ]
    D = np.array([np.stack(pair, axis=-1).ravel() for part in columns for pair in part]).T
    moved = -650.0 * k1 * ((x * x + y * y)[:, None] * np.stack([x, y], axis=-1)).ravel()
    left = moved - D @ np.linalg.lstsq(D, moved, rcond=None)[0]
    np.testing.assert_allclose(vector.ravel(), left, atol=2e-3 * np.abs(left).max())


@pytest.mark.data
@pytest.mark.parametrize(("name", "limit"), [("devernay-faugeras", 0.35), ("stein", 0.2)])
def test_the_papers_25_images(data_dir: Path, name: str, limit: float) -> None:
    """Its lens has little decentering, so that a radial correction is near the calibrated one."""
    folder = data_dir / "bouguet_calib_example" / "corners_and_results"
    views, size = stored(folder / "corners_25img__benJephunneh.json")
    found = LINE_METHODS[name].estimate(views, size)
    vector = compare_with_camera(found, calibrate(views, size).camera, U, V)
    assert np.linalg.norm(vector, axis=-1).max() < limit
    assert found.straightness_before > 0.5
    assert found.straightness_after < 0.1
    held_out = measure_straightness(views[::2], LINE_METHODS[name].estimate(views[1::2], size))
    assert held_out == pytest.approx(found.straightness_after, rel=0.1)
