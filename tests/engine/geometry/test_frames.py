"""Frames and rotations against scipy, themselves backwards, and central differences."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from calibgui.engine.arrays import Array
from calibgui.engine.camera.models.lucchese import Lucchese
from calibgui.engine.geometry import frames, rotations
from calibgui.engine.geometry.pose import Pose
from tests.engine.scenes import central_differences, relative

SIZE = (640, 480)
angle = st.floats(-np.pi, np.pi)
component = st.floats(-1.0, 1.0)
rvec = st.tuples(component, component, component, st.floats(0.0, np.pi)).map(
    lambda v: np.array(v[:3]) / max(float(np.linalg.norm(v[:3])), 1e-9) * v[3]
)


def test_pixel_centres_and_the_papers_axes() -> None:
    np.testing.assert_array_equal(frames.paper_from_array(np.zeros(2), SIZE), [-319.5, 239.5])
    # Bouguet's row 242.4 is the paper's yp = -2.90.
    assert frames.array_from_paper(np.array([-16.48, -2.90]), SIZE)[1] == pytest.approx(242.4)


@given(st.lists(st.tuples(st.floats(-5e3, 5e3), st.floats(-5e3, 5e3)), min_size=1))
def test_image_frames_round_trip(points: list[tuple[float, float]]) -> None:
    uv = np.array(points)
    back = frames.array_from_paper(frames.paper_from_array(uv, SIZE), SIZE)
    np.testing.assert_allclose(back, uv, atol=1e-11)


@given(rvec)
def test_rotation_agrees_with_scipy_and_comes_back(w: Array) -> None:
    R = rotations.rotation_from_vector(w)
    np.testing.assert_allclose(R, Rotation.from_rotvec(w).as_matrix(), atol=1e-14)
    # A half turn has two vectors, so compare the matrices.
    np.testing.assert_allclose(
        rotations.rotation_from_vector(rotations.vector_from_rotation(R)), R, atol=1e-14
    )


@pytest.mark.parametrize("size", [0.0, 1e-9, 1e-5, 1e-3, 3.0, np.pi - 1e-5, np.pi - 1e-9, np.pi])
def test_rotation_vector_keeps_its_digits_at_the_ends(size: float) -> None:
    w = size * np.array([0.6, -0.48, 0.64])
    back = rotations.vector_from_rotation(rotations.rotation_from_vector(w))
    if size == np.pi:  # then w and -w are the same rotation
        back = np.copysign(back, w)
    np.testing.assert_allclose(back, w, atol=1e-14)


def test_rotation_takes_stacks() -> None:
    w = np.random.default_rng(1).normal(size=(4, 3))
    np.testing.assert_array_equal(
        rotations.rotation_from_vector(w)[2], rotations.rotation_from_vector(w[2])
    )


@given(rvec, st.tuples(component, component, component))
def test_cross_matrix_is_the_cross_product(w: Array, a: tuple[float, ...]) -> None:
    np.testing.assert_allclose(rotations.make_cross_matrix(w) @ a, np.cross(w, a), atol=1e-15)


@pytest.mark.parametrize("size", [0.0, 9e-5, 1e-3, 0.4, 2.0, 3.0])
def test_rvec_by_local_against_differences(size: float) -> None:
    r = size * np.array([0.6, -0.48, 0.64])

    def moved(w: Array) -> Array:
        return rotations.vector_from_rotation(
            rotations.rotation_from_vector(w) @ rotations.rotation_from_vector(r)
        )

    numeric = central_differences(moved, np.zeros(3), 1e-3)
    # Derivatives grow towards the half turn, and the differences' truncation with them.
    np.testing.assert_allclose(
        rotations.compute_inverse_left_jacobian(r), numeric, atol=1e-9 if size > 2 else 1e-11
    )


@given(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5), angle)
def test_the_papers_angles_round_trip(omega: float, phi: float, theta: float) -> None:
    R = rotations.rotation_from_paper_angles(omega, phi, theta)
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(R) == pytest.approx(1.0)
    np.testing.assert_allclose(
        rotations.paper_angles_from_rotation(R), (omega, phi, theta), atol=1e-9
    )


def test_the_papers_rotation_is_eq_8() -> None:
    omega, phi, theta = 0.3, -0.2, 0.7
    c, s = np.cos, np.sin
    about_x = np.array([[1, 0, 0], [0, c(omega), s(omega)], [0, -s(omega), c(omega)]])
    about_y = np.array([[c(phi), 0, -s(phi)], [0, 1, 0], [s(phi), 0, c(phi)]])
    about_z = np.array([[c(theta), s(theta), 0], [-s(theta), c(theta), 0], [0, 0, 1]])
    np.testing.assert_allclose(
        rotations.rotation_from_paper_angles(omega, phi, theta),
        about_x @ about_y @ about_z,
        atol=1e-15,
    )


poses = st.builds(
    lambda w, x, y, z, y_up: Pose(
        rotations.vector_from_rotation(
            rotations.rotation_from_vector(w)
            @ np.diag([1.0, -1.0, -1.0] if y_up else [1.0, 1.0, 1.0])
        ),
        np.array([x, y, z]),
    ),
    rvec.map(lambda w: 0.4 * w),  # tilts below 72 degrees: the board's face stays in sight
    st.floats(-300, 300),
    st.floats(-300, 300),
    st.floats(200, 3000),
    st.booleans(),
)


@given(poses, st.floats(100, 3000), st.tuples(st.floats(-200, 200), st.floats(-200, 200)))
def test_the_papers_pose_round_trips(
    pose: Pose, distance: float, centre: tuple[float, float]
) -> None:
    c = np.array(centre)
    y_up = bool(rotations.rotation_from_vector(pose.rvec)[2, 2] < 0)
    paper = frames.paper_from_pose(pose, c, distance)
    assert abs(paper.omega) < np.pi / 2
    back = frames.pose_from_paper(paper, c, y_up)
    # Near the half turn that a board with Y up is about, the vector has two values.
    np.testing.assert_allclose(
        rotations.rotation_from_vector(back.rvec),
        rotations.rotation_from_vector(pose.rvec),
        atol=1e-12,
    )
    np.testing.assert_allclose(back.tvec, pose.tvec, atol=1e-9)
    np.testing.assert_allclose(paper.translation, distance * paper.vector[3:], rtol=1e-15)


def test_the_papers_pose_places_the_board_as_in_eq_6() -> None:
    """X_cam = R X' + T with X' = (X', Y', L + f), all in the left-handed frame with y up."""
    pose = Pose([0.3, -0.4, 0.1], [-100.0, -80.0, 700.0])
    centre, distance = np.array([165.0, 120.0]), 850.0
    paper = frames.paper_from_pose(pose, centre, distance)
    R = rotations.rotation_from_paper_angles(paper.omega, paper.phi, paper.theta)
    for point in np.array([[0.0, 0.0], [30.0, 240.0], [330.0, 90.0]]):
        X, Y = point - centre
        by_paper = R @ [X, -Y, distance] + paper.translation  # the board's Y down, the paper's up
        by_pose = rotations.rotation_from_vector(pose.rvec) @ [*point, 0.0] + pose.tvec
        np.testing.assert_allclose(by_paper * [1, -1, 1], by_pose, atol=1e-10)


def test_paper_intrinsics_by_params() -> None:
    params = np.array([650.0, 600.0, 310.0, 245.0, 0.25, 0.1, -0.04, 4e-4, -7e-4, 0.3])

    def values(p: Array) -> Array:
        return frames.paper_from_intrinsics(p, SIZE)[0]

    # Each parameter at its own scale: the values span 1e-18 to 1e3.
    numeric = central_differences(values, params, 1e-3 * np.abs(params))
    J = frames.paper_from_intrinsics(params, SIZE)[1]
    for row, expected in zip(J, numeric, strict=True):
        assert relative(row, expected) < 1e-10


def test_paper_intrinsics_correct_the_same_point() -> None:
    """Eq. 9-11 in the paper's pixels and frame against the dimensionless model, fx = fy."""
    params = np.array([650.0, 650.0, 310.0, 245.0, 0.25, 0.1, -0.04, 4e-4, -7e-4, 0.3])
    xp, yp, k1, k2, k3, p1, p2, p3, fx, _ = frames.paper_from_intrinsics(params, SIZE)[0]
    uv = np.array([600.0, 20.0])
    x, y = frames.paper_from_array(uv, SIZE)
    dx, dy = x - xp, y - yp
    r2 = dx**2 + dy**2
    rho, q = k1 * r2 + k2 * r2**2 + k3 * r2**3, 1 + p3 * r2
    psi = np.array(
        [
            x + dx * rho + q * (p1 * (r2 + 2 * dx**2) + 2 * p2 * dx * dy),
            y + dy * rho + q * (2 * p1 * dx * dy + p2 * (r2 + 2 * dy**2)),
        ]
    )
    d = (uv - params[2:4]) / params[:2]
    n = Lucchese().correct(d, params[4:]).points
    expected = frames.paper_from_array(params[2:4] + fx * n, SIZE)
    np.testing.assert_allclose(psi, expected, atol=1e-11)
