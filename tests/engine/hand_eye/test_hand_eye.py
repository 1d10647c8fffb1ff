"""Hand and eye against arms of which everything is known."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import Pose, rotation_from_vector
from calibgui.engine.hand_eye import HandEye, calibrate_hand_eye
from calibgui.engine.hand_eye.motions import Motions
from tests.engine.hand_eye.arms import (
    CAMERA,
    Arm,
    W,
    X,
    make_arm,
    make_standing_arm,
    move_four_axes,
    move_without_turning,
    turn_about_board,
)


def solve(arm: Arm, **settings: object) -> HandEye:
    return calibrate_hand_eye(CAMERA, arm.views, arm.take_matrices(), **settings)  # type: ignore[arg-type]


def measure_error(pose: Pose, truth: Motions) -> Array:
    """Return (6,) the local turn, rad, and shift, mm, from the truth."""
    found = Motions(rotation_from_vector(pose.rvec), pose.tvec)
    return found.measure_step_from(truth)


@pytest.mark.parametrize("count", [3, 4, 12])
def test_a_camera_in_the_hand_without_noise(count: int) -> None:
    found = solve(make_arm(np.random.default_rng(count), count), eye_in_hand=True)
    assert found.eye_in_hand and found.shift == 0
    assert np.abs(measure_error(found.camera_pose, X)).max() < 1e-9
    assert np.abs(measure_error(found.board_pose, W)).max() < 1e-9
    assert found.rms < 1e-9 and found.scatter < 1e-9
    assert found.names[0] == "View 1" and not len(found.open_turns) and not len(found.open_shifts)


@pytest.mark.parametrize("stated", [None, False])
def test_a_camera_that_stands_without_noise(stated: bool | None) -> None:
    found = solve(make_standing_arm(np.random.default_rng(1)), eye_in_hand=stated)
    assert not found.eye_in_hand and "base from hand" in found.reading
    assert np.abs(measure_error(found.camera_pose, X)).max() < 1e-9
    assert np.abs(measure_error(found.board_pose, W)).max() < 1e-9


def test_where_the_camera_is_can_be_stated() -> None:
    """What turns the poses round is then told."""
    found = solve(make_standing_arm(np.random.default_rng(1)), eye_in_hand=True)
    assert found.eye_in_hand and "hand from base" in found.reading
    assert np.abs(measure_error(found.camera_pose, X)).max() < 1e-9


def test_a_robot_of_four_axes_leaves_a_shift_open() -> None:
    found = solve(move_four_axes(np.random.default_rng(3)), eye_in_hand=True)
    error = measure_error(found.camera_pose, X)
    axis = found.open_shifts[0]
    assert found.open_shifts.shape == (1, 3) and found.open_turns.shape == (0, 3)
    assert np.abs(error[:3]).max() < 1e-9
    assert np.abs(error[3:] - (error[3:] @ axis) * axis).max() < 1e-6
    assert np.isfinite(found.sigma).all()


def test_turns_on_one_spot_leave_a_turn_and_a_shift_open() -> None:
    found = solve(move_four_axes(np.random.default_rng(3), still=True), eye_in_hand=True)
    assert found.open_shifts.shape == (1, 3) and found.open_turns.shape == (1, 3)
    assert abs(abs(found.open_shifts[0] @ found.open_turns[0]) - 1) < 1e-9
    assert found.rms < 1e-9
    assert found.rivals


def test_motions_without_turns_leave_all_shifts_open() -> None:
    found = solve(move_without_turning(np.random.default_rng(3)), eye_in_hand=True)
    assert found.open_shifts.shape == (3, 3) and found.open_turns.shape == (0, 3)
    assert np.abs(measure_error(found.camera_pose, X)[:3]).max() < 1e-9


def test_a_robot_of_four_axes_with_noise() -> None:
    """Its ± is that of what it determines."""
    rng = np.random.default_rng(4)
    arm = move_four_axes(rng)
    noisy = Arm(
        [(uv + rng.normal(scale=0.1, size=uv.shape), xy) for uv, xy in arm.views], arm.poses
    )
    found = solve(noisy, eye_in_hand=True)
    axis = found.open_shifts[0]
    error = measure_error(found.camera_pose, X)
    across = error[3:] - (error[3:] @ axis) * axis
    assert np.linalg.norm(across) < 5 * np.sqrt(np.trace(found.covariance[3:, 3:]))
    assert np.linalg.norm(across) < 1.0


@pytest.mark.parametrize("by", [1, -1])
def test_an_order_shifted_by_one_is_named_and_used(by: int) -> None:
    arm = make_arm(np.random.default_rng(1), 10, noise=0.1, robot=(5e-4, 0.3))
    first, last = slice(1, None), slice(None, -1)
    pictures, rows = (first, last) if by == -1 else (last, first)
    shifted = Arm(arm.views[pictures], arm.poses.select(rows))
    found = solve(shifted)
    assert found.shift == by and len(found.names) == 8
    assert np.abs(measure_error(found.camera_pose, X)[3:]).max() < 2.0


def test_repeated_poses_are_named() -> None:
    arm = make_arm(np.random.default_rng(1), 8).select([0, 0, 1, 2, 3, 3])
    found = solve(arm)
    assert found.repeated == (("View 1", "View 2"), ("View 5", "View 6"))


def test_the_tool_may_be_named() -> None:
    """Far from the camera its error is that of the rotation."""
    arm = make_arm(np.random.default_rng(2), 12, noise=0.1, robot=(5e-4, 0.3))
    near, far = (solve(arm, tool=[0.0, 0.0, z]).tool for z in (100.0, 1e6))
    assert near.sigma_rad == far.sigma_rad
    assert 0.3 * far.sigma_rad * 1e6 < far.sigma_mm < 1.01 * far.sigma_rad * 1e6
    assert near.sigma_mm < 1.0
    standing = Arm(arm.views, arm.poses.invert())
    assert solve(standing, tool=[0.0, 0.0, 100.0]).tool.sigma_mm < 5.0
    with pytest.raises(CalibrationError, match="The tool's point is not three finite numbers"):
        solve(arm, tool=[0.0, 1.0])


def test_who_is_to_blame_is_told() -> None:
    rng = np.random.default_rng(2)
    robot = solve(make_arm(rng, 15, noise=0.02, robot=(1e-3, 0.5))).tool
    camera = solve(make_arm(rng, 15, noise=0.5, robot=(1e-7, 1e-4))).tool
    assert robot.robot_share > 0.95 and camera.robot_share < 0.3


def test_an_uncertain_camera_widens_every_sigma() -> None:
    arm = make_arm(np.random.default_rng(2), 12, noise=0.05, robot=(1e-4, 0.05))
    covariance = np.diag([4.0, 4.0, 9.0, 9.0, *6 * [0.0]])
    sure, unsure = solve(arm), solve(arm, covariance=covariance)
    assert (unsure.sigma > sure.sigma).all()
    assert unsure.tool.robot_share < sure.tool.robot_share


def test_a_wrong_camera_is_moved_within_its_covariance() -> None:
    """The robot tells focal length and centre where the camera's file does not."""
    arm = make_arm(np.random.default_rng(2), 20, noise=0.02, robot=(1e-6, 1e-3))
    params = CAMERA.params + np.array([0, 0, 3.0, -2.0, *6 * [0.0]])
    wrong = Camera(CAMERA.size, params, CAMERA.model)
    covariance = np.diag([0.0, 0.0, 9.0, 9.0, *6 * [0.0]])
    held, moved = (
        calibrate_hand_eye(wrong, arm.views, arm.take_matrices(), covariance=cov)
        for cov in (None, covariance)
    )
    errors = [np.linalg.norm(measure_error(f.camera_pose, X)[:3]) for f in (held, moved)]
    assert errors[1] < errors[0] / 10


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda views, rows: (views, rows[:-1]), "There are 8 photographs and 7 poses"),
        (lambda views, rows: (views, rows[:, :5]), "cannot have 5 numbers"),
        (lambda views, rows: (views, rows[:, :7]), "no quaternion has the length 1"),
        (lambda views, rows: (views, 2 * rows), "no matrix is a rotation"),
        (lambda views, rows: (views, np.where(rows == rows[2, 3], np.nan, rows)), "View 3: the"),
        (lambda views, rows: (views[:2], rows[:2]), "There are 2 different poses"),
        (
            lambda views, rows: (views, rows[[0, 0, 0, 1, 1, 1, 1, 1]]),
            "View 1, View 2, View 3 have",
        ),
        (lambda views, rows: (views, rows[[3, 6, 1, 7, 0, 4, 2, 5]]), "poses do not fit"),
    ],
)
def test_what_cannot_be_done_is_refused(change: object, message: str) -> None:
    arm = make_arm(np.random.default_rng(7), 8, noise=0.1)
    views, rows = change(arm.views, arm.take_matrices())  # type: ignore[operator]
    with pytest.raises(CalibrationError, match=message):
        calibrate_hand_eye(CAMERA, views, rows)


def test_another_camera_is_refused() -> None:
    arm = make_arm(np.random.default_rng(7), 8)
    other = Camera((64, 48), [60.0, 60.0, 32.0, 24.0, 0.9, 5.0, 0, 0, 0], "brown-conrady")
    with pytest.raises(CalibrationError, match=r"No poses of a flat board|do not fit"):
        calibrate_hand_eye(other, arm.views, arm.take_matrices())


@pytest.mark.slow
def test_stated_errors_are_those_of_draws() -> None:
    """Of translation, rotation, and at the tool; the robot's own noise is found as well.

    Of 80 draws a ratio scatters by some 6 %: chance exceeds its bound once in 1,000 times.
    """
    rng, count, robot = np.random.default_rng(0), 12, (5e-4, 0.3)
    point = np.array([0.0, 0.0, 400.0])
    boards = turn_about_board(rng, 0.4 * rng.normal(size=(count, 3)))
    errors, sigmas, tools, robots = [], [], [], []
    for _ in range(80):
        arm = make_arm(rng, noise=0.1, robot=robot, boards=boards)
        found = solve(arm, eye_in_hand=True, tool=point)
        error = measure_error(found.camera_pose, X)
        errors.append([*error, *np.cross(error[:3], point - X.t) + error[3:]])
        sigmas.append(found.sigma)
        tools.append(found.tool.sigma_mm)
        robots.append(found.robot_sigmas)
    scatter = np.std(errors, axis=0)
    turned = np.mean(np.square(sigmas), axis=0) ** 0.5
    assert np.linalg.norm(turned[3:]) / np.linalg.norm(scatter[3:6]) == pytest.approx(1, abs=0.2)
    assert np.linalg.norm(turned[:3]) / np.linalg.norm(scatter[:3]) == pytest.approx(1, abs=0.2)
    worst = np.linalg.eigvalsh(np.cov(np.array(errors)[:, 6:].T))[-1] ** 0.5
    assert 0.8 < np.mean(np.square(tools)) ** 0.5 / worst < 1.25
    np.testing.assert_allclose(np.mean(np.square(robots), axis=0) ** 0.5, robot, rtol=0.1)
