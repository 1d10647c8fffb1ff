"""Tsai's method against the truth of synthetic scenes, maximum likelihood and published cameras."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods.tsai import (
    TSAI,
    TSAI_CLOSED_FORM,
    ViewEstimate,
    combine_views,
    describe_scatter,
    estimate_view,
    estimate_views,
    solve_stage_one,
)
from calibgui.engine.calibration.observations import Observation, pack_observations
from calibgui.engine.calibration.problem import recover_arguments
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import frames
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.scenes import BOARD, VGA, Scene, imaged, relative, scene, stored

MIDDLE = frames.centre_of_array(VGA)
CAMERA = Camera(VGA, [650.0, 650.0, *MIDDLE, 0.25, 0, 0, 0, 0, 0])
"""What the closed form can find: square pixels, the centre in the middle, one coefficient."""
KAPPA1 = 0.25 / 650.0**2


def check_scene(found: Calibration, scene: Scene) -> None:
    assert relative(found.camera.params, scene.camera.params) < 1e-6
    for pose, true in zip(found.poses, scene.poses, strict=True):
        assert np.abs(pose.rvec - true.rvec).max() < 1e-6
        assert relative(pose.tvec, true.tvec) < 1e-6


def test_the_closed_form_recovers_its_own_model() -> None:
    seen = scene(CAMERA, 6, seed=1)
    found = calibrate(seen.views, VGA, method=TSAI_CLOSED_FORM)
    check_scene(found, seen)
    assert found.fixed == ("fy", "cx", "cy", "k2", "k3", "p1", "p2", "p3")
    (remark,) = found.warnings
    assert remark.startswith("By themselves 6 of 6 views give focal lengths from 650 to 650 px")
    assert found.camera.params[4] == pytest.approx(0.25, rel=1e-6)


def test_the_refinement_recovers_centre_and_aspect_too() -> None:
    seen = scene(Camera(VGA, [650.0, 657.0, 303.0, 246.0, 0.25, 0, 0, 0, 0, 0]), 6, seed=2)
    found = calibrate(seen.views, VGA, method=TSAI)
    check_scene(found, seen)
    assert found.fixed == ("k2", "k3", "p1", "p2", "p3")
    assert found.warnings == ()


def test_every_view_finds_its_own_pose_focal_length_and_coefficient() -> None:
    """Boards are tilted in all directions, so that both signs of r3 and r6 occur."""
    seen = scene(CAMERA, 20, seed=3)
    for found, pose in zip(
        estimate_views(pack_observations(seen.views), MIDDLE), seen.poses, strict=True
    ):
        assert found.f == pytest.approx(650.0, rel=1e-6)
        assert found.kappa1 == pytest.approx(KAPPA1, rel=1e-6)
        assert np.abs(found.R - rotation_from_vector(pose.rvec)).max() < 1e-6
        assert relative(found.T, pose.tvec) < 1e-6


@pytest.mark.parametrize("turn", [0.0, np.pi / 2, np.pi])
def test_stage_one_needs_neither_focal_length_nor_distortion(turn: float) -> None:
    """A board that is tilted about its X axis alone makes r2, r4 and D simple."""
    R = rotation_from_vector(np.array([0, 0, turn])) @ rotation_from_vector(np.array([0.6, 0, 0]))
    X = BOARD.points() @ R[:, :2].T + [20.0, 30.0, 800.0]
    ideal = X[:, :2] / X[:, 2:]
    radius = np.linalg.norm(ideal, axis=1, keepdims=True)
    found, Tx, Ty = solve_stage_one(BOARD.points(), 777.0 * ideal * (1 - 0.3 * radius**3))
    # f and Tz alone tell a board from its mirror image in depth: R up to r3, r6, r7, r8's signs.
    # r3 is the root of what rounding leaves of 1 - r1^2 - r2^2.
    assert np.abs(np.abs(found) - np.abs(R)).max() < 1e-7
    assert np.abs(found[:2, :2] - R[:2, :2]).max() < 1e-9
    assert (Tx, Ty) == pytest.approx((20.0, 30.0))
    assert np.abs(found @ found.T - np.eye(3)).max() < 1e-7


def test_the_board_s_origin_may_lie_on_the_middle_row() -> None:
    """There Ty is 0, by which the five unknowns are divided."""
    pose = Pose(np.array([0.5, 0.3, 0.1]), np.array([-60.0, 0.0, 700.0]))
    uv = imaged(CAMERA, pose, BOARD.points())
    found = estimate_view(BOARD.points(), uv - MIDDLE)
    assert found.f == pytest.approx(650.0, rel=1e-6)
    assert relative(found.T, pose.tvec) < 1e-6


def test_a_board_whose_y_runs_up() -> None:
    seen = scene(CAMERA, 5, seed=4)
    views = [Observation(view.uv, view.xy * [1.0, -1.0]) for view in seen.views]
    found = calibrate(views, VGA, method=TSAI_CLOSED_FORM)
    assert relative(found.camera.params, CAMERA.params) < 1e-6


@pytest.mark.parametrize("sigma", [0.0, 0.2])
@pytest.mark.parametrize("method", [TSAI, TSAI_CLOSED_FORM], ids=lambda method: method.name)
def test_boards_parallel_to_the_sensor_are_refused_by_name(method: object, sigma: float) -> None:
    views = scene(CAMERA, 8, tilt=(0.0, 0.0)).noisy(sigma, np.random.default_rng(0))
    with pytest.raises(CalibrationError, match="parallel to the sensor in all views") as caught:
        calibrate(views, VGA, method=method)  # type: ignore[arg-type]
    assert "30 degrees" in caught.value.hint


def test_a_parallel_view_counts_nothing() -> None:
    rng = np.random.default_rng(5)
    tilted = scene(CAMERA, 5, seed=5, tilt=(25.0, 45.0)).noisy(0.2, rng)
    parallel = scene(CAMERA, 5, seed=6, tilt=(0.0, 0.0)).noisy(0.2, rng)
    with_them, without = (
        combine_views(estimate_views(observations, MIDDLE), observations, MIDDLE)
        for observations in map(pack_observations, (tilted + parallel, tilted))
    )
    assert with_them == without


def estimate_many(seen: Scene, draws: int) -> list[tuple[list[ViewEstimate], float]]:
    """Both stages of views with 0.2 px of noise, and the focal length of all, many times."""
    rng, found = np.random.default_rng(7), []
    for _ in range(draws):
        observations = pack_observations(seen.noisy(0.2, rng))
        views = estimate_views(observations, MIDDLE)
        found.append((views, combine_views(views, observations, MIDDLE)[0]))
    return found


def test_views_count_by_how_well_they_tell_the_focal_length() -> None:
    """Steep and flat boards together: weights make twice as good a focal length as the mean."""
    steep, flat = (scene(CAMERA, 3, seed=8, tilt=tilt) for tilt in ((40, 45), (10, 12)))
    both = Scene(CAMERA, steep.poses + flat.poses, steep.views + flat.views)
    drawn = estimate_many(both, 40)
    weighted = np.std([f for _, f in drawn])
    plain = np.std([np.mean([view.f for view in views]) for views, _ in drawn])
    assert weighted < 0.5 * plain
    assert abs(np.mean([f for _, f in drawn]) - 650.0) < 3.0


def test_the_refinement_ends_at_the_minimum_of_the_same_model() -> None:
    views = scene(CAMERA, 5, seed=9).noisy(0.1, np.random.default_rng(9))
    found = calibrate(views, VGA, method=TSAI)
    likely = calibrate(views, VGA, fix=("k2", "k3", "p1", "p2"))
    free = likely.sigma > 0
    miss = (found.camera.params - likely.camera.params)[free] / likely.sigma[free]
    assert np.abs(miss).max() < 1e-4


def test_noise_moves_the_closed_form_by_what_it_says() -> None:
    views = scene(CAMERA, 8, seed=10).noisy(0.1, np.random.default_rng(10))
    found = calibrate(views, VGA, method=TSAI_CLOSED_FORM)
    likely = calibrate(views, VGA, method=TSAI)
    off = np.abs(found.camera.params - CAMERA.params)[[0, 4]]
    assert (off < 4 * found.sigma[[0, 4]]).all()
    assert (found.sigma[[0, 4]] < 5 * likely.sigma[[0, 4]]).all()
    assert found.sigma[1] == 0.0


def test_a_known_focal_length_is_kept() -> None:
    seen = scene(CAMERA, 4, seed=11)
    found = calibrate(seen.views, VGA, method=TSAI_CLOSED_FORM, fix={"fx": 650.0})
    check_scene(found, seen)
    views = seen.noisy(0.2, np.random.default_rng(11))
    other = calibrate(views, VGA, method=TSAI_CLOSED_FORM, fix={"fx": 660.0})
    assert (other.camera.params[:2] == 660.0).all()
    assert other.fixed[:2] == ("fx", "fy")


def test_a_centre_that_is_known_is_taken_for_the_middle() -> None:
    camera = Camera(VGA, [650.0, 650.0, 300.0, 250.0, 0.25, 0, 0, 0, 0, 0])
    seen = scene(camera, 4, seed=12)
    found = calibrate(seen.views, VGA, method=TSAI_CLOSED_FORM, fix={"cx": 300.0, "cy": 250.0})
    check_scene(found, seen)


def test_the_closed_form_refuses_to_estimate_the_centre() -> None:
    seen = scene(CAMERA, 4, seed=13)
    with pytest.raises(CalibrationError, match="cannot estimate cx, k2") as caught:
        calibrate(seen.views, VGA, method=TSAI_CLOSED_FORM, free=("cx", "k2"))
    assert "'tsai'" in caught.value.hint


def test_one_view_is_enough_as_in_the_paper() -> None:
    seen = scene(CAMERA, 1, seed=15, tilt=(30.0, 45.0))
    check_scene(calibrate(seen.views, VGA, method=TSAI_CLOSED_FORM), seen)


def test_fy_follows_fx_when_a_calibration_is_repeated_on_other_views() -> None:
    """Its arguments hold fy at the value that it had, as they do all that was not estimated."""
    views = scene(CAMERA, 5, seed=16).noisy(0.3, np.random.default_rng(16))
    first = calibrate(views, VGA, method=TSAI_CLOSED_FORM)
    arguments = {**recover_arguments(first), "method": TSAI_CLOSED_FORM}
    again = calibrate(views[1:], VGA, **arguments)
    assert again.camera.params[0] == again.camera.params[1] != first.camera.params[1]
    np.testing.assert_array_equal(
        again.camera.params, calibrate(views[1:], VGA, method=TSAI_CLOSED_FORM).camera.params
    )


def test_a_view_of_five_corners_only_has_a_pose() -> None:
    seen = scene(CAMERA, 4, seed=14)
    few = [0, 11, 50, 96, 107]
    view = Observation(seen.views[0].uv[few], seen.views[0].xy[few])
    found = calibrate([view, *seen.views[1:]], VGA, method=TSAI_CLOSED_FORM)
    check_scene(found, seen)
    assert not estimate_view(view.xy, view.uv - MIDDLE).counts


def test_the_scatter_over_the_views_is_described() -> None:
    def estimate(f: float, tilt: float) -> ViewEstimate:
        R = rotation_from_vector(np.array([np.deg2rad(tilt), 0, 0]))
        return ViewEstimate(f, 0.0, R, np.zeros(3))

    views = [estimate(640.0, 30.0), estimate(660.0, 40.0), estimate(9000.0, 1.0)]
    text = describe_scatter(views)
    assert "2 of 3 views" in text
    assert "from 640 to 660 px" in text
    assert "deviation of 14 px" in text
    assert "1 of 2 views tells" in describe_scatter(views[1:])


@pytest.mark.data
@pytest.mark.parametrize(
    ("corners", "focal", "tolerance"),
    [
        ("zhang1998/corners.json", 832.5, 0.005),
        (
            "bouguet_calib_example/corners_and_results/corners_25img__benJephunneh.json",
            657.35,
            0.002,
        ),
    ],
)
def test_real_corners_give_about_the_published_focal_length(
    data_dir: Path, corners: str, focal: float, tolerance: float
) -> None:
    """Zhang's and Bouguet's: centre in the middle and one coefficient cost the closed form this."""
    views, size = stored(data_dir / corners)
    views = views[:: max(1, len(views) // 6)]
    closed = calibrate(views, size, method=TSAI_CLOSED_FORM)
    refined = calibrate(views, size, method=TSAI)
    assert closed.camera.params[0] == pytest.approx(focal, rel=5 * tolerance)
    assert refined.camera.params[0] == pytest.approx(focal, rel=tolerance)
