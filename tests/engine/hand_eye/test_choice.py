"""The convention of the robot's poses is told, whatever it is."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from calibgui.engine.arrays import Array
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import rotation_from_vector
from calibgui.engine.hand_eye import calibrate_hand_eye
from calibgui.engine.hand_eye.motions import Motions
from calibgui.engine.hand_eye.readings import MM_OF_UNITS, list_readings
from tests.engine.hand_eye.arms import CAMERA, X, make_arm


def write(poses: Motions, words: str) -> Array:
    """Write poses so that `words` describe them."""
    kind, *_, unit = words.split(", ")
    t = poses.t / MM_OF_UNITS[unit]
    R = np.swapaxes(poses.R, 1, 2) if "transposed" in words else poses.R
    rotations = Rotation.from_matrix(R)
    if words.startswith("angles"):
        _, _, product = words.partition(" of ")
        product, _, measure = product.partition(" in ")
        sequence = "".join(part[1].upper() for part in product.split())
        angles = rotations.as_euler(sequence, degrees=measure.startswith("degrees"))
        return np.column_stack([t, angles if "(a)" in product.split()[0] else angles[:, ::-1]])
    if words.startswith("rotation vectors"):
        return np.column_stack([t, rotations.as_rotvec(degrees="degrees" in words)])
    if words.startswith("quaternions"):
        quaternion = rotations.as_quat()
        quaternion = quaternion if "x, y, z, w" in words else quaternion[:, [3, 0, 1, 2]]
        return np.column_stack([quaternion, t] if "before" in words else [t, quaternion])
    matrices = np.concatenate([R, t[..., None]], axis=2)
    if kind.endswith("by column"):
        matrices = np.swapaxes(matrices, 1, 2)
    return matrices.reshape(len(t), 12)


def list_words() -> list[str]:
    rng = np.random.default_rng(0)
    poses = make_arm(rng, 5).poses
    rows = {
        6: rng.normal(size=(5, 6)),
        7: write(poses, "quaternions x, y, z, w, metres"),
        12: write(poses, "matrices row by row, metres"),
    }
    return [reading.words for numbers in rows.values() for reading in list_readings(numbers)]


@pytest.mark.parametrize("inverted", [False, True])
@pytest.mark.parametrize(
    "words",
    [
        "matrices row by row, millimetres",
        "matrices column by column, metres",
        "matrices row by row, rotations transposed, millimetres",
        "quaternions x, y, z, w, metres",
        "quaternions w, x, y, z, millimetres",
        "quaternions before the place w, x, y, z, metres",
        "rotation vectors in radians, metres",
        "angles a, b, c of Rz(a) Ry(b) Rx(c) in degrees, millimetres",
        "angles a, b, c of Rz(c) Ry(b) Rx(a) in degrees, millimetres",
        "angles a, b, c of Rz(a) Ry(b) Rz(c) in radians, metres",
    ],
)
def test_swapped_conventions_are_told(words: str, inverted: bool) -> None:
    """All twenty: ten ways to write, each of base_from_hand and of hand_from_base."""
    arm = make_arm(np.random.default_rng(len(words)), 12, noise=0.1, robot=(5e-4, 0.3))
    written = write(arm.poses.invert() if inverted else arm.poses, words)
    found = calibrate_hand_eye(CAMERA, arm.views, written, eye_in_hand=True)
    direction = "hand from base" if inverted else "base from hand"
    assert found.reading == f"{words}, {direction}"
    assert not found.rivals and found.next_scatter > 10 * found.scatter
    turn = rotation_from_vector(found.camera_pose.rvec) @ X.R.T
    assert np.trace(turn) > 3 - 1e-4
    assert np.linalg.norm(found.camera_pose.tvec - X.t) < 2.0


def test_every_reading_reads_what_is_written_so() -> None:
    poses = make_arm(np.random.default_rng(0), 5).poses
    words = list_words()
    assert len(words) > 100
    for each in words:
        by_words = {reading.words: reading.poses for reading in list_readings(write(poses, each))}
        np.testing.assert_allclose(by_words[each].R, poses.R, atol=1e-9, err_msg=each)
        np.testing.assert_allclose(by_words[each].t, poses.t, atol=1e-9, err_msg=each)


@pytest.mark.parametrize("count", [3, 5, 12])
@pytest.mark.parametrize("ratio", [0.8, 1.02])
def test_squares_of_another_length_than_stated_are_named(count: int, ratio: float) -> None:
    """The camera would be off by 30 mm and more, and nothing else shows it."""
    arm = make_arm(np.random.default_rng(4), count)
    views = [(uv, xy / ratio) for uv, xy in arm.views]
    message = f"squares are {ratio:g} times as long as stated"
    with pytest.raises(CalibrationError, match=message):
        calibrate_hand_eye(CAMERA, views, arm.take_matrices(), eye_in_hand=True)


def test_squares_that_are_2_percent_shorter_are_named_in_spite_of_noise() -> None:
    arm = make_arm(np.random.default_rng(0), 15, noise=0.1, robot=(5e-4, 0.3))
    views = [(uv, 1.02 * xy) for uv, xy in arm.views]
    with pytest.raises(CalibrationError, match=r"squares are 0\.98 times as long"):
        calibrate_hand_eye(CAMERA, views, arm.take_matrices())


@pytest.mark.parametrize("count", [3, 4, 12])
def test_squares_as_stated_are_not(count: int) -> None:
    for seed in range(10):
        rng = np.random.default_rng(seed)
        arm = make_arm(rng, count, noise=0.1, robot=(1e-3, 0.5))
        calibrate_hand_eye(CAMERA, arm.views, arm.take_matrices(), eye_in_hand=True)


def test_equal_readings_count_once() -> None:
    """A robot that turns about Z alone has the same poses in many orders of angles."""
    rows = np.zeros((4, 6))
    rows[:, :3] = np.random.default_rng(0).normal(size=(4, 3))
    rows[:, 3] = [10.0, 20.0, 30.0, 40.0]
    readings = list_readings(rows)
    assert readings[0].words.startswith("angles a, b, c of Rz(a) Ry(b) Rx(c) in degrees")
    assert len(readings) == 2 * 2 * 3  # units of place and angle, axes


def test_a_matrix_that_is_none_is_refused() -> None:
    with pytest.raises(CalibrationError, match="no matrix is a rotation"):
        list_readings(np.tile(np.diag([1.0, 1.0, -1.0, 1.0]).ravel(), (3, 1)))
