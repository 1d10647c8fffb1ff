"""A rig is calibrated: truth without noise, honest errors with it, and no wrong view spoils it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.rig import Rig, RigCamera, calibrate_rig, triangulate_points
from tests.engine.honesty import check_honest
from tests.engine.rig.scenes import (
    BOARD,
    LENSES,
    RigScene,
    check_rigs_honest,
    compose,
    disturb,
    make_rig,
    measure_pose_error,
)


@pytest.mark.parametrize("count", [2, 4, 8])
def test_mixed_lenses_without_noise_are_found_exactly(count: int) -> None:
    scene = make_rig(count, instants=9 + 5 * (count - 1))
    if count == 8:  # cameras at both ends never see the board together
        assert not set(scene.cameras[0].views) & set(scene.cameras[-1].views)
    rig = calibrate_rig(disturb(scene.cameras, np.random.default_rng(1)))
    turn, move = measure_pose_error(rig.poses, scene.poses)
    assert turn < 1e-9
    assert move < 1e-9 * 1000  # mm, of distances of some 1000
    for found, true in zip(rig.cameras, scene.cameras, strict=True):
        np.testing.assert_allclose(found.params, true.camera.params, atol=1e-7)
    assert rig.rms < 1e-9
    assert not rig.left_out


def test_a_known_camera_is_held_or_pulled_by_its_covariance() -> None:
    scene = make_rig(2, instants=10)
    rng = np.random.default_rng(3)
    left, right = scene.noisy(0.2, rng)
    held = calibrate_rig([left.hold(), right])
    np.testing.assert_array_equal(held.cameras[0].params, left.camera.params)
    assert not held.camera_sigma(0).any()

    free = calibrate_rig([left, right])
    own = np.diag(np.maximum(free.camera_sigma(0), 1e-9) ** 2)
    fixed = ("k3", "skew")
    beside = replace(left, covariance=own * 1e-6, fixed=fixed)
    pulled = calibrate_rig([beside, replace(right, fixed=("beta",))])
    # A prior a thousand times as sure as the views leaves them little to say.
    moved = np.abs(pulled.cameras[0].params - left.camera.params)
    assert (moved < 0.05 * np.maximum(free.camera_sigma(0), 1e-12)).all()
    assert (pulled.camera_sigma(0)[:4] < 0.01 * free.camera_sigma(0)[:4]).all()


def test_a_prior_counts_as_much_as_the_views_that_it_stands_for() -> None:
    """Two halves of the views, one as a prior, give what all give."""
    scene = make_rig(2, instants=40, lenses=LENSES[1:2])
    left, right = scene.noisy(0.1, np.random.default_rng(4))
    early, late = ([take_instants(each, part) for each in (left, right)] for part in (0, 1))
    whole, alone = calibrate_rig([left, right]), calibrate_rig(early)
    place = alone.layout.camera(0)
    covariance = alone.noise_covariance[place, place]
    known = replace(late[0], camera=alone.cameras[0], covariance=covariance)
    both = calibrate_rig([known, late[1]])
    ratio = both.camera_sigma(0)[:4] / whole.camera_sigma(0)[:4]
    np.testing.assert_allclose(ratio, 1.0, atol=0.15)


def take_instants(camera: RigCamera, half: int) -> RigCamera:
    """Return the camera with the first 20 instants, or with those after them."""
    views = {k: view for k, view in camera.views.items() if k // 20 == half}
    return replace(camera, views=views)


@pytest.mark.slow
def test_covariances_are_those_of_draws() -> None:
    """Of 300 draws every standard deviation was the scatter within 16 %."""
    scene, sigma, rng = make_rig(3, instants=16), 0.1, np.random.default_rng(5)
    rigs = [calibrate_rig(scene.noisy(sigma, rng)) for _ in range(30)]
    check_rigs_honest(rigs, scene)
    point = np.array([60.0, 20.0, 700.0])
    pixels = {c: see_point(scene, c, point) for c in (0, 1)}
    found = [
        triangulate_points(
            rig, {c: uv + rng.normal(0, sigma, uv.shape) for c, uv in pixels.items()}, sigma
        )
        for rig in rigs
    ]
    check_honest(
        np.array([each.points[0] - point for each in found]),
        np.array([each.covariance[0] for each in found]),
    )


def see_point(scene: RigScene, c: int, point: Array) -> Array:
    """The pixel (1, 2) of a point in the rig's frame."""
    at = compose(scene.poses[c], Pose(np.zeros(3), point))
    return project_points(np.zeros((1, 2)), scene.cameras[c].camera, at)


def test_instants_that_do_not_belong_together_are_left_out() -> None:
    scene = make_rig(2, instants=25)
    left, right = scene.noisy(0.1, np.random.default_rng(7))
    views = dict(right.views)
    order = [3, 8, 14, 20]
    for to, source in zip(order, order[1:] + order[:1], strict=True):
        views[to] = right.views[source]
    rig = calibrate_rig([left, replace(right, views=views)])
    assert {view.instant for view in rig.left_out} == set(order)
    clean = calibrate_rig([left, right])
    turn, move = measure_pose_error(rig.poses, clean.poses)
    assert turn < 5 * clean.pose_sigma(1)[:3].max()
    assert move < 5 * clean.pose_sigma(1)[3:].max()


def test_a_board_counted_from_its_other_end_in_one_camera_is_turned_back() -> None:
    scene = make_rig(2, instants=12)
    left, right = scene.cameras
    far = BOARD.points()[-1]
    turned = {
        instant: view._replace(xy=far - view.xy) if instant in (2, 5, 9) else view
        for instant, view in right.views.items()
    }
    rig = calibrate_rig([left, replace(right, views=turned)])
    assert rig.rms < 1e-9
    assert measure_pose_error(rig.poses, scene.poses)[1] < 1e-6
    differ = {
        instant
        for instant in turned
        if len({v.turned for v in rig.views if v.instant == instant}) == 2
    }
    assert differ == {2, 5, 9}


def test_cameras_that_never_see_the_board_together_are_named() -> None:
    scene = make_rig(4, instants=24, spacing=400.0)
    left, _, _, right = scene.cameras
    with pytest.raises(CalibrationError, match=r"2 groups .*: cam0; cam3") as raised:
        calibrate_rig([left, right])
    assert "cam0 and cam3" in raised.value.hint


def test_corners_with_covariances_count_by_them() -> None:
    scene = make_rig(2, instants=12)
    rng = np.random.default_rng(8)
    cameras = []
    for camera, sigma in zip(scene.cameras, (0.05, 0.5), strict=True):
        views = {
            k: Observation(
                view.uv + rng.normal(0, sigma, view.uv.shape),
                view.xy,
                np.tile(sigma**2 * np.eye(2), (len(view.uv), 1, 1)),
            )
            for k, view in camera.views.items()
        }
        cameras.append(replace(camera, views=views))
    plain = [
        replace(c, views={k: v._replace(cov=None) for k, v in c.views.items()}) for c in cameras
    ]
    weighted, unweighted = calibrate_rig(cameras), calibrate_rig(plain)
    assert weighted.camera_sigma(0)[0] < 0.5 * unweighted.camera_sigma(0)[0]
    assert weighted.noise == pytest.approx(np.sqrt((0.05**2 + 0.5**2) / 2), rel=0.1)


def test_a_single_camera_is_no_rig() -> None:
    with pytest.raises(CalibrationError, match="at least two"):
        calibrate_rig(make_rig(2, instants=4).cameras[:1])
    camera: RigCamera = make_rig(2, instants=4).cameras[0]
    with pytest.raises(CalibrationError, match="cam0 has no view"):
        calibrate_rig([replace(camera, views={}), camera])


def test_the_rig_does_not_depend_on_where_its_first_camera_stands() -> None:
    """A turned first camera turns the rig's frame and nothing else."""
    scene = make_rig(3, instants=16)
    forward = calibrate_rig(scene.noisy(0.1, np.random.default_rng(9)))
    backward = calibrate_rig(scene.noisy(0.1, np.random.default_rng(9))[::-1])

    def measure_distance(rig: Rig, a: int, b: int) -> float:
        centres = [-rotation_from_vector(rig.poses[c].rvec).T @ rig.poses[c].tvec for c in (a, b)]
        return float(np.linalg.norm(centres[0] - centres[1]))

    assert measure_distance(forward, 0, 2) == pytest.approx(measure_distance(backward, 2, 0))
    assert forward.rms == pytest.approx(backward.rms, rel=1e-6)
