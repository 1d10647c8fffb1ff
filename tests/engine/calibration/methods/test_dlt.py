"""The DLT against the truth of synthetic scenes: boards in known places before a fixed camera."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods.dlt import (
    DLT,
    decompose_projection,
    make_dlt,
    solve_dlt,
)
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation
from tests.engine.scenes import BOARD, VGA, Scene, imaged, relative, scene, seen

CAMERA = Camera(VGA, [650.0, 660.0, 303.0, 246.0, 0, 0, 0, 0, 2e-3], "brown-conrady-4")
FRAME = Pose(np.array([0.3, -2.0, 0.7]), np.array([400.0, -900.0, 1500.0]))
"""The camera's pose in a fixed frame: frame_from_camera."""


def place(poses: tuple[Pose, ...], frame: Pose = FRAME) -> list[Pose]:
    """The boards' poses in the fixed frame."""
    R = rotation_from_vector(frame.rvec)
    return [
        Pose(vector_from_rotation(R @ rotation_from_vector(pose.rvec)), R @ pose.tvec + frame.tvec)
        for pose in poses
    ]


def make_matrix(params: Array) -> Array:
    fx, fy, cx, cy = params[:4]
    return np.array([[fx, fx * params[8], cx], [0, fy, cy], [0, 0, 1]])


@pytest.mark.parametrize("count", [3, 6])
def test_camera_and_poses_are_recovered_from_known_places(count: int) -> None:
    exact = scene(CAMERA, count, seed=1)
    found = calibrate(exact.views, VGA, method=make_dlt(place(exact.poses)))
    assert relative(found.camera.params, CAMERA.params) < 1e-6
    assert found.camera.params[8] == pytest.approx(2e-3, rel=1e-5)
    for pose, true in zip(found.poses, exact.poses, strict=True):
        assert np.abs(pose.rvec - true.rvec).max() < 1e-6
        assert relative(pose.tvec, true.tvec) < 1e-6
    assert found.fixed == ("k1", "k2", "p1", "p2")


def test_views_may_show_parts_of_the_board() -> None:
    whole = scene(CAMERA, 3, seed=2)
    views = [Observation(v.uv[k:], v.xy[k:]) for k, v in zip((0, 30, 60), whole.views, strict=True)]
    found = calibrate(views, VGA, method=make_dlt(place(whole.poses)))
    assert relative(found.camera.params, CAMERA.params) < 1e-6


def test_every_corner_counts_once_where_views_show_parts() -> None:
    whole, rng = scene(CAMERA, 3, seed=2), np.random.default_rng(2)
    noisy = whole.noisy(0.2, rng)
    views = [Observation(v.uv[k:], v.xy[k:]) for k, v in zip((0, 60, 90), noisy, strict=True)]
    places = place(whole.poses)
    points = [
        v.xy @ rotation_from_vector(pose.rvec)[:, :2].T + pose.tvec
        for v, pose in zip(views, places, strict=True)
    ]
    A = decompose_projection(
        solve_dlt(np.concatenate(points), np.concatenate([v.uv for v in views]))
    ).A
    found = calibrate(views, VGA, method=make_dlt(places)).camera
    np.testing.assert_allclose(make_matrix(found.params), A, atol=1e-6)


def test_parallel_planes_at_a_known_distance_are_enough() -> None:
    tilted = rotation_from_vector(np.array([0.0, 0.0, 0.3]))
    points = np.concatenate(
        [np.column_stack([BOARD.points(), np.full(len(BOARD.points()), z)]) for z in (0.0, 150.0)]
    )
    X = (points - [165.0, 120.0, 0.0]) @ tilted.T + [0.0, 0.0, 700.0]
    A = make_matrix(CAMERA.params)
    projected = X @ A.T
    found = decompose_projection(solve_dlt(points, projected[:, :2] / projected[:, 2:]))
    np.testing.assert_allclose(found.A, A, atol=1e-6)
    np.testing.assert_allclose(found.R, tilted, atol=1e-9)
    np.testing.assert_allclose(found.T, [0, 0, 700.0] - tilted @ [165.0, 120.0, 0.0], atol=1e-6)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_projection_is_decomposed_whatever_its_scale(sign: float) -> None:
    """The sign of P is that of the depths, which solve_dlt sees to; its size means nothing."""
    A, R = make_matrix(CAMERA.params), rotation_from_vector(FRAME.rvec)
    P = 1e-3 * A @ np.column_stack([R, FRAME.tvec])
    if sign < 0:
        with pytest.raises(CalibrationError, match="mirrored"):
            decompose_projection(-P)
        return
    found = decompose_projection(P)
    np.testing.assert_allclose(found.A, A, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(found.R, R, atol=1e-12)
    np.testing.assert_allclose(found.T, FRAME.tvec)


def test_noise_moves_the_estimate_by_what_it_says() -> None:
    exact = scene(CAMERA, 5, seed=3)
    views = exact.noisy(0.1, np.random.default_rng(3))
    found = calibrate(views, VGA, method=make_dlt(place(exact.poses)))
    free = found.sigma > 0
    off = np.abs(found.camera.params - CAMERA.params)[free] / found.sigma[free]
    assert (off < 4).all()
    assert found.noise == pytest.approx(0.1, rel=0.15)
    assert found.sigma[0] < 1.0


def test_the_cause_is_named_where_no_places_are_known() -> None:
    with pytest.raises(CalibrationError, match="one plane only") as caught:
        calibrate(scene(CAMERA, 4).views, VGA, method=DLT)
    assert "points that are not in one plane" in caught.value.hint
    assert "does not move" in caught.value.hint


@pytest.mark.parametrize("sigma", [0.0, 0.3])
def test_boards_in_one_plane_are_refused(sigma: float) -> None:
    """Three places of the board in its own plane, seen by one camera."""
    first = Pose(np.array([0.5, 0.3, 0.1]), np.array([-150.0, -100.0, 900.0]))
    R = rotation_from_vector(first.rvec)
    poses = [
        Pose(first.rvec, first.tvec + R @ [x, y, 0.0]) for x, y in ((0, 0), (60, 10), (-40, 50))
    ]
    views = seen(CAMERA, poses).noisy(sigma, np.random.default_rng(4))
    with pytest.raises(CalibrationError, match="lie in one plane"):
        calibrate(views, VGA, method=make_dlt(place(tuple(poses))))


def test_a_part_of_the_views_needs_a_part_of_the_places() -> None:
    exact = scene(CAMERA, 4, seed=5)
    with pytest.raises(CalibrationError, match="poses of 4 boards for 3 views"):
        calibrate(exact.views[1:], VGA, method=make_dlt(place(exact.poses)))


def test_places_in_a_mirrored_frame_are_refused() -> None:
    exact = scene(CAMERA, 4, seed=6)
    mirrored = [
        Pose(pose.rvec * [-1.0, -1.0, 1.0], pose.tvec * [1.0, 1.0, -1.0])
        for pose in place(exact.poses)
    ]
    with pytest.raises(CalibrationError):
        calibrate(exact.views, VGA, method=make_dlt(mirrored))


@pytest.mark.parametrize(
    ("choice", "cause"),
    [
        ({"fix": {"fx": 650.0}}, "cannot hold fx"),
        ({"fix": {"k1": 0.1}}, "knows no distortion: k1"),
        ({"free": "p2"}, "knows no distortion: p2"),
    ],
)
def test_only_the_eleven_parameters_are_estimated(choice: dict[str, object], cause: str) -> None:
    exact = scene(CAMERA, 3, seed=7)
    with pytest.raises(CalibrationError, match=cause):
        calibrate(exact.views, VGA, method=make_dlt(place(exact.poses)), **choice)  # type: ignore[arg-type]


def test_a_distorted_image_shows_in_the_residuals() -> None:
    distorted = Camera(VGA, [650, 660, 303, 246, -0.25, 0.1, 0, 0, 0], "brown-conrady-4")
    exact: Scene = scene(distorted, 4, seed=8)
    found = calibrate(exact.views, VGA, method=make_dlt(place(exact.poses)))
    assert found.noise > 0.5
    assert imaged(found.camera, found.poses[0], exact.views[0].xy).shape == (len(BOARD.points()), 2)
